//! Integrators of ẏ = f(t, y), y = (q, q̇), and the contract between them and the mechanism.

mod dop853;
mod dop853_coefficients;
mod dopri5;
mod method;
mod taylor;

pub use dop853::Dop853;
pub use dopri5::Dopri5;
pub use method::{Integrator, choose};
pub use taylor::Taylor;

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
}

/// Steps of an integrator so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Steps {
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps.
    pub rejected: u64,
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
