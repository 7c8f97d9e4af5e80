//! Angles of joints, of either sign and any number of turns — THEORY section 5.
//!
//! θ is the angle about the axis from the vector a₁ of body i to the vector b of body j, measured with a₂ = s × a₁ as
//! θ = atan2(a₂ · b, a₁ · b). Whole turns are counted from the last accepted step.

use crate::feature::FeatureId;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The features that make an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Angle {
    /// First vector across the axis, on body i.
    pub a1: FeatureId,
    /// Second vector across the axis, on body i.
    pub a2: FeatureId,
    /// Vector across the axis, on body j.
    pub b: FeatureId,
    /// The axis, on body i.
    pub axis: FeatureId,
}

impl Angle {
    /// The features whose motion changes the angle, in the order of [`AngleState::gradient`].
    pub fn features(&self) -> [FeatureId; 3] {
        [self.a1, self.a2, self.b]
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        for feature in [&mut self.a1, &mut self.a2, &mut self.b, &mut self.axis] {
            *feature = place[*feature];
        }
    }
}

/// An angle at one state.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngleState {
    /// θ, rad.
    pub value: f64,
    /// θ̇, rad/s.
    pub rate: f64,
    /// ∂θ/∂(a₁, a₂, b).
    pub gradient: [Vector3<f64>; 3],
    /// θ̈ without the part of second derivatives of the vectors.
    pub curvature: f64,
    /// θ at the last accepted step.
    pub reference: f64,
}

impl AngleState {
    /// Takes over positions of (a₁, a₂, b).
    pub fn place(&mut self, [a1, a2, b]: [Vector3<f64>; 3]) {
        let (x, y) = (a1.dot(&b), a2.dot(&b));
        let principal = y.atan2(x);
        self.value = principal + TAU * ((self.reference - principal) / TAU).round();
        let square = (x * x + y * y).max(f64::MIN_POSITIVE);
        self.gradient = [b * (-y / square), b * (x / square), (a2 * x - a1 * y) / square];
    }

    /// Takes over velocities of (a₁, a₂, b); positions must be in place.
    pub fn set_velocity(&mut self, at: [Vector3<f64>; 3], rate: [Vector3<f64>; 3]) {
        let [a1, a2, b] = at;
        let [a1r, a2r, br] = rate;
        let (x, y) = (a1.dot(&b), a2.dot(&b));
        let (xr, yr) = (a1r.dot(&b) + a1.dot(&br), a2r.dot(&b) + a2.dot(&br));
        let square = (x * x + y * y).max(f64::MIN_POSITIVE);
        self.rate = (x * yr - y * xr) / square;
        self.curvature =
            2.0 * ((x * a2r.dot(&br) - y * a1r.dot(&br)) / square - (x * xr + y * yr) / square * self.rate);
    }
}
