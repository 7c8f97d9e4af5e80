//! The bodies as they are shown.

use super::Simulation;
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

/// All bodies at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyFrame>,
}

impl Simulation {
    /// Bodies at the shown state.
    pub fn frame(&mut self) -> Frame {
        self.mechanism.set_state(self.time, &self.shown);
        let bodies = self.mechanism.elimination.bodies.iter().map(|state| {
            let e = state.q.e;
            // ω = ½ Σ e_k × ė_k — eq. (6.4).
            let omega: Vector3<f64> =
                (0..3).map(|k| e[k].cross(&state.q_dot.e[k])).sum::<Vector3<f64>>() * 0.5;
            BodyFrame {
                position: state.q.r.into(),
                u: e[0].into(),
                v: e[1].into(),
                w: e[2].into(),
                velocity: state.q_dot.r.into(),
                angular_velocity: omega.into(),
            }
        });
        Frame { time: self.time, bodies: bodies.collect() }
    }
}
