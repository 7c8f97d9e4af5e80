//! Energies of a state — eq. (6.1).

use super::{BodyState, Stage, State};
use crate::system::System;
use crate::system::body::RigidBody;

impl State {
    /// Kinetic plus potential energy, springs included, J — eq. (6.10).
    pub fn energy(&self, system: &System) -> f64 {
        let gravity = system.model.gravity;
        let springs: f64 = system.loads.iter().map(|load| load.potential(self)).sum();
        let bodies = self.bodies.iter().zip(&system.bodies);
        let weights: f64 = bodies.map(|(state, body)| body.mass * gravity.dot(&state.q.r)).sum();
        self.kinetic_energy(system) - weights + springs
    }

    /// The summands of [`State::energy`]: of each body the kinetic one and that of its weight, and of each spring.
    pub fn energies<'a>(&'a self, system: &'a System) -> impl Iterator<Item = f64> + 'a {
        let gravity = system.model.gravity;
        let bodies = self.bodies.iter().zip(&system.bodies);
        let bodies = bodies.flat_map(move |(state, body)| {
            [0.5 * twice_kinetic(state, body), -body.mass * gravity.dot(&state.q.r)]
        });
        bodies.chain(system.loads.iter().map(|load| load.potential(self)))
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, system: &System) -> f64 {
        self.require(Stage::Velocities);
        let bodies = self.bodies.iter().zip(&system.bodies);
        0.5 * bodies.map(|(state, body)| twice_kinetic(state, body)).sum::<f64>()
    }
}

fn twice_kinetic(state: &BodyState, body: &RigidBody) -> f64 {
    let turning: f64 = (0..3).map(|k| body.ibar[k] * state.q_dot.e[k].norm_squared()).sum();
    body.mass * state.q_dot.r.norm_squared() + turning
}
