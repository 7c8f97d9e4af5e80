//! A feature of each of L bodies, and where the numbers of one of them stand.

use crate::dynamics::series::lanes::{Lane, LaneVector};
use nalgebra::Vector3;

/// A feature of each of L bodies (or of none: all zero).
#[derive(Clone, Copy, Debug)]
pub struct FeatureSlot<const L: usize> {
    /// Local coordinates (ξ, η, ζ); of a planar body those along its director, across it and along the normal.
    pub local: LaneVector<L>,
    /// 1 for a point, 0 for a vector.
    pub point: Lane<L>,
}

impl<const L: usize> FeatureSlot<L> {
    /// Of no body.
    pub const NOTHING: Self = Self { local: [[0.0; L]; 3], point: [0.0; L] };

    /// Takes over the feature of one body from another slot, times a sign.
    pub fn take_signed(&mut self, lane: usize, sign: f64, from: &Self) {
        self.point[lane] = sign * from.point[lane];
        for (own, from) in self.local.iter_mut().zip(&from.local) {
            own[lane] = sign * from[lane];
        }
    }
}

/// Where a feature's numbers stand: a slot and a lane of it.
#[derive(Clone, Copy, Debug)]
pub struct LanePlace {
    /// Slot.
    pub slot: usize,
    /// Lane.
    pub lane: usize,
}

impl LanePlace {
    /// The numbers there.
    #[inline(always)]
    pub fn get<const L: usize>(self, values: &[LaneVector<L>]) -> [f64; 3] {
        let value = &values[self.slot];
        let lane = self.lane % L;
        [value[0][lane], value[1][lane], value[2][lane]]
    }

    /// Difference of the numbers at two places, or of those at one.
    pub fn difference<const L: usize>(
        [plus, minus]: [Option<Self>; 2],
        values: &[LaneVector<L>],
    ) -> Vector3<f64> {
        let value = |place: Option<Self>| place.map_or(Vector3::zeros(), |p| p.get(values).into());
        value(plus) - value(minus)
    }

    /// Replaces the numbers there.
    #[inline(always)]
    pub fn set<const L: usize>(self, values: &mut [LaneVector<L>], x: [f64; 3]) {
        let value = &mut values[self.slot];
        for c in 0..3 {
            value[c][self.lane % L] = x[c];
        }
    }

    /// Adds to the numbers there.
    #[inline(always)]
    pub fn add<const L: usize>(self, values: &mut [LaneVector<L>], x: [f64; 3]) {
        let value = &mut values[self.slot];
        let lane = self.lane % L;
        for c in 0..3 {
            value[c][lane] += x[c];
        }
    }
}
