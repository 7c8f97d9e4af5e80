//! A body at one state as pictures and tables show it.

use super::BodyState;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

/// A body at one moment, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodyFrame {
    /// Centre of mass, m.
    pub position: [f64; 3],
    /// Director u, a principal axis.
    pub u: [f64; 3],
    /// Director v.
    pub v: [f64; 3],
    /// Director w.
    pub w: [f64; 3],
    /// Velocity of the centre of mass, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [f64; 3],
}

impl BodyFrame {
    /// Of the natural coordinates Q and Q̇.
    pub fn new(q: &NaturalCoordinates, q_dot: &NaturalCoordinates) -> Self {
        let e = q.e;
        // ω = ½ Σ e_k × ė_k — eq. (6.4).
        let omega: Vector3<f64> = (0..3).map(|k| e[k].cross(&q_dot.e[k])).sum::<Vector3<f64>>() * 0.5;
        Self {
            position: q.r.into(),
            u: e[0].into(),
            v: e[1].into(),
            w: e[2].into(),
            velocity: q_dot.r.into(),
            angular_velocity: omega.into(),
        }
    }
}

impl From<&BodyState> for BodyFrame {
    fn from(body: &BodyState) -> Self {
        Self::new(&body.q, &body.q_dot)
    }
}
