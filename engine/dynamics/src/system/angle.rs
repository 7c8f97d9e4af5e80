//! Angles of joints, of either sign and any number of turns — THEORY section 5.
//!
//! θ is the angle about the axis from the vector a₁ of body i to the vector b of body j, measured with a₂ = s × a₁ as
//! θ = atan2(a₂ · b, a₁ · b). Whole turns are counted from the last accepted step on, by the rates there and now.

use crate::system::index::FeatureId;

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
    /// The features whose motion changes the angle, in the order of the gradient of its state.
    pub fn features(&self) -> [FeatureId; 3] {
        [self.a1, self.a2, self.b]
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        for feature in [&mut self.a1, &mut self.a2, &mut self.b, &mut self.axis] {
            *feature = place[feature.index()];
        }
    }
}
