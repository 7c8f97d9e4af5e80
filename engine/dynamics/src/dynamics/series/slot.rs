//! A feature of each of L bodies.

use super::lanes::{Lane, LaneVector};

/// A feature of each of L bodies (or of none: all zero).
#[derive(Clone, Copy, Debug)]
pub struct FeatureSlot<const L: usize> {
    /// Local coordinates (ξ, η, ζ); of a planar body those along its director, across it and along the normal.
    pub local: LaneVector<L>,
    /// 1 for a point, 0 for a vector.
    pub point: Lane<L>,
}
