//! The friction that loads itself.

use nalgebra::Vector3;

/// Newton steps for one friction; four or five are usual.
const MAX_STEPS: usize = 60;

/// The friction f of least size with f = c (|u₁ + f w₁| + |u₂ + f w₂|), if there is one.
pub fn least_friction(c: f64, u: &[Vector3<f64>; 2], w: &[Vector3<f64>; 2]) -> Option<f64> {
    let (sign, c) = (1.0f64.copysign(c), c.abs());
    let mut x = 0.0;
    for _ in 0..MAX_STEPS {
        let (mut value, mut slope) = (x, 1.0);
        for (u, w) in u.iter().zip(w) {
            let w = w * sign;
            let end = u + w * x;
            let pressing = end.norm();
            value -= c * pressing;
            // Where nothing presses yet, it is about to.
            slope -= c * if pressing > 0.0 { end.dot(&w) / pressing } else { w.norm() };
        }
        // Beyond the greatest value there is no root; false for NaN as well.
        let rising = slope > 0.0;
        if value >= 0.0 {
            break;
        }
        if !rising {
            return None;
        }
        let next = x - value / slope;
        if next <= x {
            break;
        }
        x = next;
    }
    x.is_finite().then_some(sign * x)
}
