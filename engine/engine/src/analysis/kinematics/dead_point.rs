//! Dead points, where a driver asks for more than the joints allow, from how fast the motion becomes before them.

use nalgebra::{Matrix3, Vector3};

/// The slowness 1/|q̇| falls by at least this factor between the steps that a dead point is found from.
const FALLS: f64 = 0.8;
/// What is left to a dead point, as a part of the time in which the motion at its speed would go by 1 m or turn by 1 rad, from
/// which a motion that cannot go on has come to it.
const THERE: f64 = 1e-3;

/// The last steps of a motion: their ends, s, with the slowness there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Approach {
    ends: [Option<[f64; 2]>; 3],
}

impl Approach {
    /// Notes the end of a step and q̇ there.
    pub(super) fn note(&mut self, time: f64, velocity: &[f64]) {
        let slowness = velocity.iter().map(|v| v * v).sum::<f64>().sqrt().recip();
        let [_, before, last] = self.ends;
        match (before, last) {
            // The newest end replaces one that is too near the one before it.
            (Some([_, before]), Some([_, last])) if last > FALLS * before => {}
            _ => self.ends = [before, last, None],
        }
        self.ends[2] = Some([time, slowness]);
    }

    /// When the motion comes to a dead point, if it is next to one: t = t* + a u² + b u³ with u = 1/|q̇| — eq. (10.12).
    pub(super) fn dead_point(&self) -> Option<f64> {
        let [first, second, last] = self.ends;
        let [first, second, last] = [first?, second?, last?];
        if !(last[1] < second[1] && second[1] < first[1]) {
            return None;
        }
        // Relative to the last end, and in its slowness, so that nothing is lost to rounding.
        let row = |[_, u]: [f64; 2]| {
            [1.0, (u / last[1]) * (u / last[1]), (u / last[1]) * (u / last[1]) * (u / last[1])]
        };
        let rows = [first, second, last].map(row);
        let matrix = Matrix3::from_fn(|i, k| rows[i][k]);
        let times = Vector3::new(first[0] - last[0], second[0] - last[0], 0.0);
        let left = (matrix.try_inverse()? * times)[0];
        (left >= 0.0 && left < THERE * last[1]).then_some(last[0] + left)
    }
}
