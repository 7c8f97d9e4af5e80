//! Power series of prescribed functions of time about any moment — THEORY section 11.
//!
//! Piecewise functions are expanded in the piece that begins or continues at that time; `next_break` gives its end.

use super::{Curve, VectorCurve};
use nalgebra::Vector3;

/// Greatest number of coefficients of an expansion: the highest order of the integrator is 30.
pub const MAX_TERMS: usize = 32;

impl Curve {
    /// Writes the coefficients of the series in τ about time t, at most [`MAX_TERMS`].
    pub fn expand(&self, t: f64, out: &mut [f64]) {
        match self {
            Self::Polynomial(coefficients) => shift(coefficients, t, out),
            &Self::Harmonic { mean, amplitude, frequency, phase } => {
                let (sin, cos) = libm::sincos(frequency * t + phase);
                let mut factor = amplitude;
                for (k, out) in out.iter_mut().enumerate() {
                    *out = factor * [sin, cos, -sin, -cos][k % 4];
                    factor *= frequency / (k + 1) as f64;
                }
                if let Some(first) = out.first_mut() {
                    *first += mean;
                }
            }
            Self::Pieces { knots, pieces } => {
                let piece = knots.partition_point(|&knot| knot <= t).saturating_sub(1);
                shift(&pieces[piece], t - knots[piece], out);
            }
            Self::Formula(formula) => formula.expand(t, out),
        }
    }

    /// The first time after t at which a formula begins to change after it did not, s, or infinity.
    pub fn next_wake(&self, t: f64) -> f64 {
        if let Self::Formula(formula) = self { formula.next_wake(t) } else { f64::INFINITY }
    }

    /// The first time after t at which another piece begins, or a formula begins to change, s, or infinity.
    pub fn next_break(&self, t: f64) -> f64 {
        match self {
            Self::Polynomial(_) | Self::Harmonic { .. } => f64::INFINITY,
            Self::Formula(formula) => formula.next_wake(t),
            Self::Pieces { knots, .. } => {
                // Nothing begins at the first knot: its piece holds before it, too.
                let next = knots.partition_point(|&knot| knot <= t).max(1);
                knots.get(next).copied().unwrap_or(f64::INFINITY)
            }
        }
    }
}

impl VectorCurve {
    /// Writes the coefficients of the series in τ about time t, at most [`MAX_TERMS`].
    pub fn expand(&self, t: f64, out: &mut [Vector3<f64>]) {
        let terms = out.len().min(MAX_TERMS);
        let mut series = [0.0; MAX_TERMS];
        match self {
            Self::Components(components) | Self::Rotated(_, components) => {
                for (c, component) in components.iter().enumerate() {
                    component.expand(t, &mut series[..terms]);
                    for (out, x) in out.iter_mut().zip(series) {
                        out[c] = x;
                    }
                }
                if let Self::Rotated(rotation, _) = self {
                    for v in out.iter_mut() {
                        *v = rotation * *v;
                    }
                }
            }
            Self::Turning { along, across, turned, angle } => {
                angle.expand(t, &mut series[..terms]);
                let (mut sin, mut cos) = ([0.0; MAX_TERMS], [0.0; MAX_TERMS]);
                sine_cosine(&series[..terms], &mut sin, &mut cos);
                for (k, out) in out.iter_mut().enumerate().take(terms) {
                    *out = across * cos[k] + turned * sin[k];
                }
                if let Some(first) = out.first_mut() {
                    *first += along;
                }
            }
        }
    }

    /// The first moment after t at which another piece begins, s, or infinity.
    pub fn next_break(&self, t: f64) -> f64 {
        self.first(|curve| curve.next_break(t))
    }

    /// The least of what its functions say.
    pub fn first(&self, of: impl Fn(&Curve) -> f64) -> f64 {
        match self {
            Self::Components(components) | Self::Rotated(_, components) => {
                components.iter().map(of).fold(f64::INFINITY, f64::min)
            }
            Self::Turning { angle, .. } => of(angle),
        }
    }
}

/// The polynomial Σ cₖ xᵏ about x = x₀ — repeated synthetic division.
fn shift(coefficients: &[f64], x0: f64, out: &mut [f64]) {
    out.fill(0.0);
    for &c in coefficients.iter().rev() {
        for k in (1..out.len()).rev() {
            out[k] = out[k] * x0 + out[k - 1];
        }
        if let Some(first) = out.first_mut() {
            *first = *first * x0 + c;
        }
    }
}

/// Series of sin θ and cos θ from that of θ — eq. (11.5).
pub fn sine_cosine(theta: &[f64], sin: &mut [f64], cos: &mut [f64]) {
    for k in 0..theta.len() {
        if k == 0 {
            (sin[0], cos[0]) = libm::sincos(theta[0]);
            continue;
        }
        let (mut s, mut c) = (0.0, 0.0);
        for j in 1..=k {
            let rate = j as f64 * theta[j];
            s += rate * cos[k - j];
            c -= rate * sin[k - j];
        }
        sin[k] = s / k as f64;
        cos[k] = c / k as f64;
    }
}
