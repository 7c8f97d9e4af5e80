//! Orthonormal bases.

use nalgebra::Vector3;

/// Two unit vectors that make a right-handed frame with the unit vector s.
///
/// Duff et al., Building an orthonormal basis, revisited, JCGT 6 (2017): no branch that could jump except at
/// s = −e₃, and none is needed to be smooth.
///
/// ```
/// use nalgebra::Vector3;
/// use triad_linalg::orthonormal_basis;
///
/// let s = Vector3::new(2.0, -1.0, 2.0) / 3.0;
/// let [a, b] = orthonormal_basis(&s);
/// assert!(a.dot(&s).abs() < 1e-15 && b.dot(&s).abs() < 1e-15 && a.dot(&b).abs() < 1e-15);
/// assert!((a.cross(&b) - s).norm() < 1e-15);
/// ```
#[inline]
pub fn orthonormal_basis(s: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let sign = 1f64.copysign(s.z);
    let a = -1.0 / (sign + s.z);
    let b = s.x * s.y * a;
    [
        Vector3::new(1.0 + sign * s.x * s.x * a, sign * b, -sign * s.x),
        Vector3::new(b, sign + s.y * s.y * a, -s.y),
    ]
}
