//! Energies of a state — eq. (6.1).

use super::{Stage, State};
use crate::system::System;
use crate::system::body::RigidBody;
use crate::system::natural::NaturalCoordinates;

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
            [0.5 * twice_kinetic(&state.q_dot, body), -body.mass * gravity.dot(&state.q.r)]
        });
        bodies.chain(system.loads.iter().map(|load| load.potential(self)))
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, system: &System) -> f64 {
        self.require(Stage::Velocities);
        let bodies = self.bodies.iter().zip(&system.bodies);
        0.5 * bodies.map(|(state, body)| twice_kinetic(&state.q_dot, body)).sum::<f64>()
    }
}

/// Kinetic energy at the end of a step from y = (q, q̇) to another, and that of its mean velocity, J. The largest one within the step
/// is not below it, since the mean of squares is never below the square of the mean.
pub fn kinetic_of_step(system: &System, from: &[f64], to: &[f64], h: f64) -> [f64; 2] {
    let n = system.coordinates;
    let mut twice = [0.0; 2];
    for body in &system.bodies {
        let [end, velocity] = body.motion(&to[..n], &to[n..]);
        let start = body.position(&from[..n]);
        let mean = NaturalCoordinates {
            r: (end.r - start.r) / h,
            e: std::array::from_fn(|k| (end.e[k] - start.e[k]) / h),
        };
        twice[0] += twice_kinetic(&velocity, body);
        twice[1] += twice_kinetic(&mean, body);
    }
    twice.map(|twice| 0.5 * twice)
}

fn twice_kinetic(q_dot: &NaturalCoordinates, body: &RigidBody) -> f64 {
    let turning: f64 = (0..3).map(|k| body.ibar[k] * q_dot.e[k].norm_squared()).sum();
    body.mass * q_dot.r.norm_squared() + turning
}
