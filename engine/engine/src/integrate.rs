//! Integrators of ẏ = f(t, y), y = (q, q̇), and the contract between them and the mechanism.

mod augmented;
mod chart;
mod dop853;
mod dopri5;
mod explicit;
mod in_chart;
mod matlab;
mod method;
mod penalty;
mod progress;
mod radau;
mod rattle;
mod stepper;
mod stiffness;
mod tableau;
mod taylor;

pub use augmented::Augmented;
pub use chart::{Chart, Choice};
pub use dop853::DOP853;
pub use dopri5::DOPRI5;
pub use explicit::Explicit;
pub use in_chart::InChart;
pub use matlab::DEFAULT_TOLERANCE as ODE45_TOLERANCE;
pub use method::{Integrator, choose};
pub use penalty::{Penalty, Strength};
pub use radau::Radau;
pub use rattle::Rattle;
pub use stepper::Stepper;
pub use stiffness::stiffness;
pub use tableau::Tableau;
pub use taylor::Taylor;

use triad_dynamics::constraints::mechanism::Mechanism;

/// What an integrator moves.
pub trait Plant {
    /// Writes ẏ = f(t, y). Must not depend on anything but t and y.
    fn rate(&mut self, t: f64, y: &[f64], rate: &mut [f64]);

    /// Called once for each accepted step with ẏ = f(t, y) at its end: may move y onto the constraints, and then
    /// must renew ẏ if the move was not negligible.
    fn settle(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]);
}

/// Why an integrator cannot go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The step that meets the tolerance is below the resolution of time.
    StepTooSmall {
        /// Time, s.
        time: f64,
        /// The step that was refused, s.
        step: f64,
    },
    /// The accelerations are not finite.
    NotFinite {
        /// Time, s.
        time: f64,
    },
    /// Steps have become so small that the run would never end.
    Stalled {
        /// Time, s.
        time: f64,
        /// Their size, s.
        step: f64,
    },
    /// Which motions the constraints leave free cannot be told, or there are none.
    Undetermined {
        /// Time, s.
        time: f64,
    },
    /// The equations of an implicit step cannot be solved.
    NoConvergence {
        /// Time, s.
        time: f64,
        /// The step that was tried, s.
        step: f64,
    },
}

/// Steps of an integrator so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Steps {
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps.
    pub rejected: u64,
}

impl Plant for Mechanism {
    fn rate(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        Mechanism::rate(self, t, y, rate);
    }
    fn settle(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]) {
        Mechanism::settle(self, t, y, rate);
    }
}

impl<P: Plant + ?Sized> Plant for &mut P {
    fn rate(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        (**self).rate(t, y, rate);
    }
    fn settle(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]) {
        (**self).settle(t, y, rate);
    }
}

/// The least step that changes a time in a run to `end`, s.
fn resolution(t: f64, end: f64) -> f64 {
    16.0 * f64::EPSILON * t.abs().max(end.abs())
}

/// Root mean square of x relative to tol (1 + max(|y|, |y'|)): the norm in which errors are compared with one.
pub fn weighted_norm(x: impl Iterator<Item = f64>, y: &[f64], y_new: &[f64], tolerance: f64) -> f64 {
    let sum: f64 = x
        .zip(y.iter().zip(y_new))
        .map(|(x, (a, b))| (x / (tolerance * (1.0 + a.abs().max(b.abs())))).powi(2))
        .sum();
    (sum / y.len().max(1) as f64).sqrt()
}

/// out ← y + h Σ a_j k_j.
fn combine(out: &mut [f64], y: &[f64], h: f64, weights: &[(usize, f64)], k: &[Vec<f64>]) {
    out.copy_from_slice(y);
    for &(j, a) in weights {
        let factor = h * a;
        for (out, k) in out.iter_mut().zip(&k[j]) {
            *out += factor * k;
        }
    }
}

/// Value and rate at s of the polynomial of degree 5 with the given values, rates and second derivatives.
fn quintic(start: [f64; 3], end: [f64; 3], h: f64, s: f64) -> (f64, f64) {
    let change = end[0] - start[0] - h * start[1] - 0.5 * h * h * start[2];
    let slope = h * (end[1] - start[1]) - h * h * start[2];
    let bend = h * h * (end[2] - start[2]);
    let c3 = 10.0 * change - 4.0 * slope + 0.5 * bend;
    let c4 = -15.0 * change + 7.0 * slope - bend;
    let c5 = 6.0 * change - 3.0 * slope + 0.5 * bend;
    let (c1, c2) = (h * start[1], 0.5 * h * h * start[2]);
    let value = start[0] + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
    let rate = c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
    (value, rate / h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quintic_is_exact_for_degree_five() {
        let p = |x: f64| (x.powi(5) - x, 5.0 * x.powi(4) - 1.0, 20.0 * x.powi(3));
        let (a, b) = (p(1.0), p(3.0));
        let (value, rate) = quintic([a.0, a.1, a.2], [b.0, b.1, b.2], 2.0, 0.3);
        let (expected, slope, _) = p(1.6);
        assert!((value - expected).abs() < 1e-10 && (rate - slope).abs() < 1e-10);
    }
}
