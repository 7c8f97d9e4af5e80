//! An explicit Runge-Kutta method as data.

use crate::integrate::step::weighted_norm;

/// Coefficients of an explicit Runge-Kutta method with an error estimate and dense output.
#[derive(Debug)]
pub struct Tableau {
    /// Order of the solution that goes on.
    pub order: u32,
    /// Stages of a step.
    pub stages: usize,
    /// Whether the last stage is ẏ at the end of the step, the first of the next one.
    pub reuses_last: bool,
    /// Nodes c, those of the additional stages of the dense output included.
    pub nodes: &'static [f64],
    /// Nonzero coefficients a_ij of stage i as (j, a_ij); after the stages, the weights b.
    pub rows: &'static [&'static [(usize, f64)]],
    /// The error estimate.
    pub estimate: Estimate,
    /// The higher differences of the dense output, as weights of the stages.
    pub dense: &'static [&'static [(usize, f64)]],
    /// Least and greatest change of the step.
    pub change: (f64, f64),
}

/// Weights of an error estimate.
#[derive(Debug)]
pub enum Estimate {
    /// The difference of two solutions.
    Single(&'static [(usize, f64)]),
    /// Two differences that are combined into one of higher order — eq. (10.1).
    Pair {
        /// That of order 5.
        fifth: &'static [(usize, f64)],
        /// That of order 3.
        third: &'static [(usize, f64)],
    },
}

impl Tableau {
    /// Stages that are stored, those of the dense output included.
    pub fn stored(&self) -> usize {
        self.nodes.len()
    }

    /// Error of a step of size h from y to y', relative to the tolerance.
    pub fn error(&self, h: f64, k: &[Vec<f64>], y: &[f64], y_new: &[f64], tolerance: f64) -> f64 {
        let norm = |weights: &[(usize, f64)]| {
            let sum = |i: usize| weights.iter().map(|&(j, e)| e * k[j][i]).sum::<f64>();
            weighted_norm((0..y.len()).map(sum), y, y_new, tolerance)
        };
        match self.estimate {
            Estimate::Single(weights) => h * norm(weights),
            Estimate::Pair { fifth, third } => {
                let (e5, e3) = (norm(fifth), norm(third));
                if e5 == 0.0 && e3 == 0.0 { 0.0 } else { h * e5 * e5 / (e5 * e5 + 0.01 * e3 * e3).sqrt() }
            }
        }
    }
}
