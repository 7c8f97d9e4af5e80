//! Energies of a state — eq. (6.1).

use super::{Stage, State};
use crate::system::System;

impl State {
    /// Kinetic plus potential energy, springs included, J — eq. (6.10).
    pub fn energy(&self, system: &System) -> f64 {
        let gravity = system.model.gravity;
        let springs: f64 = system.loads.iter().map(|load| load.potential(self)).sum();
        let bodies = self.bodies.iter().zip(&system.bodies);
        let weights: f64 = bodies.map(|(state, body)| body.mass * gravity.dot(&state.q.r)).sum();
        self.kinetic_energy(system) - weights + springs
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, system: &System) -> f64 {
        self.require(Stage::Velocities);
        let bodies = self.bodies.iter().zip(&system.bodies);
        let twice = bodies.map(|(state, body)| {
            let turning: f64 = (0..3).map(|k| body.ibar[k] * state.q_dot.e[k].norm_squared()).sum();
            body.mass * state.q_dot.r.norm_squared() + turning
        });
        0.5 * twice.sum::<f64>()
    }
}
