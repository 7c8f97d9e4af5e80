//! A body at one state as pictures and tables show it.

use super::{BodyState, Stage, State};
use crate::model::{BodyMotion, Motions};
use crate::scene::Triple;
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
        let [u, v, w] = q.e.map(Triple::from);
        let angular_velocity = angular_velocity(q, q_dot).into();
        Self { position: q.r.into(), u, v, w, velocity: q_dot.r.into(), angular_velocity }
    }
}

/// ω = ½ Σ e_k × ė_k — eq. (6.4).
fn angular_velocity(q: &NaturalCoordinates, q_dot: &NaturalCoordinates) -> Vector3<f64> {
    (0..3).map(|k| q.e[k].cross(&q_dot.e[k])).sum::<Vector3<f64>>() * 0.5
}

impl Motions for State {
    fn motion(&self, body: usize) -> BodyMotion {
        self.require(Stage::Velocities);
        let BodyState { q, q_dot } = &self.bodies[body];
        BodyMotion {
            position: q.r,
            directors: q.e,
            velocity: q_dot.r,
            angular_velocity: angular_velocity(q, q_dot),
        }
    }
}

impl From<&BodyState> for BodyFrame {
    fn from(body: &BodyState) -> Self {
        Self::new(&body.q, &body.q_dot)
    }
}
