//! The step control of MATLAB's ode45, on which the published counts of steps rest.
//!
//! Orders 5(4) of Dormand and Prince; relative tolerance as asked, 1e-3 by default, absolute tolerance a thousandth of
//! it; largest step a tenth of the run. The error is the largest of all components, and after a first refusal, steps
//! are halved.

use super::dopri5::E;

/// Default relative tolerance of ode45.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;
/// Absolute tolerance divided by the relative one: the default of ode45, 1e-6, by its relative one, 1e-3.
const THRESHOLD: f64 = 1e-3;

/// Bounds of the step control.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ode45Control {
    /// Relative tolerance.
    pub relative: f64,
    /// Largest step, s.
    pub largest: f64,
}

impl Ode45Control {
    /// For a tolerance and a length of the run.
    pub fn new(relative: f64, duration: f64) -> Self {
        Self { relative, largest: 0.1 * duration }
    }

    /// The first step, from the slope at the start.
    pub fn first_step(&self, y: &[f64], rate: &[f64], duration: f64) -> f64 {
        let h = self.largest.min(duration);
        let slope = y.iter().zip(rate).fold(0.0f64, |a, (y, f)| a.max((f / y.abs().max(THRESHOLD)).abs()));
        let inverse = slope / (0.8 * libm::pow(self.relative, 0.2));
        if h * inverse > 1.0 { 1.0 / inverse } else { h }
    }

    /// max |Σ E_j k_j| / max(|y|, |y'|, threshold).
    pub fn error(k: &[Vec<f64>], y: &[f64], y_new: &[f64]) -> f64 {
        let mut largest = 0.0f64;
        for i in 0..y.len() {
            let error: f64 = E.iter().map(|&(j, e)| e * k[j][i]).sum();
            let relative = (error / y[i].abs().max(y_new[i].abs()).max(THRESHOLD)).abs();
            // Unlike `max`, keeps a NaN.
            if relative > largest || relative.is_nan() {
                largest = relative;
            }
        }
        largest
    }

    /// By how much a refused step becomes smaller.
    pub fn shrink(&self, error: f64, first: bool) -> f64 {
        if first { (0.8 * libm::pow(self.relative / error, 0.2)).max(0.1) } else { 0.5 }
    }

    /// The step after one that was accepted at once.
    pub fn next(&self, h: f64, error: f64) -> f64 {
        let relative = 1.25 * libm::pow(error / self.relative, 0.2);
        if relative > 0.2 { h / relative } else { 5.0 * h }
    }

    /// out ← y + h (Σ a_j k_j), the sum first.
    pub fn combine(out: &mut [f64], y: &[f64], h: f64, weights: &[(usize, f64)], k: &[Vec<f64>]) {
        out.fill(0.0);
        for &(j, a) in weights {
            for (out, k) in out.iter_mut().zip(&k[j]) {
                *out += a * k;
            }
        }
        for (out, y) in out.iter_mut().zip(y) {
            *out = y + h * *out;
        }
    }
}
