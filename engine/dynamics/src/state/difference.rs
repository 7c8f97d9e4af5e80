//! What lies between two states near each other, as a small motion of its own.

use super::{Stage, State};
use crate::system::System;
use nalgebra::Vector3;

/// What lies between positions and velocities of bodies, and between what springs and dampers act along.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Of each body that of r and its directors, and of their rates.
    bodies: Vec<[[Vector3<f64>; 4]; 2]>,
    /// Of each load with a law that of x and of ẋ, and the damping −∂f/∂ẋ.
    loads: Vec<[f64; 3]>,
}

/// How far two of them are apart, in sums of squares.
#[derive(Clone, Copy, Debug)]
pub struct Apart {
    /// Of positions: Σ m |δr|² + Σ Ī |δe|², kg m².
    pub positions: f64,
    /// Twice the kinetic energy of what lies between their velocities, J.
    pub kinetic: f64,
    /// Twice the energy of springs that are stretched by what lies between theirs, J.
    pub springs: f64,
    /// The power that dampers take from that, W.
    pub damping: f64,
}

impl Difference {
    /// None.
    pub fn none(system: &System) -> Self {
        Self {
            bodies: vec![[[Vector3::zeros(); 4]; 2]; system.bodies.len()],
            loads: vec![[0.0; 3]; system.loads.len()],
        }
    }

    /// Takes over that of two states of a system at the same time, whose angles have been counted alike.
    pub fn set(&mut self, system: &System, [a, b]: [&State; 2]) {
        a.require(Stage::Velocities);
        b.require(Stage::Velocities);
        for (own, (a, b)) in self.bodies.iter_mut().zip(a.bodies.iter().zip(&b.bodies)) {
            *own = [(&a.q, &b.q), (&a.q_dot, &b.q_dot)]
                .map(|(a, b)| [a.r - b.r, a.e[0] - b.e[0], a.e[1] - b.e[1], a.e[2] - b.e[2]]);
        }
        for (own, load) in self.loads.iter_mut().zip(&system.loads) {
            let between = load.law().zip(load.coordinate(a).zip(load.coordinate(b)));
            *own = between.map_or([0.0; 3], |(law, ((xa, ra), (xb, rb)))| [xa - xb, ra - rb, law.slope(rb)]);
        }
    }

    /// How far it is from another one.
    pub fn apart(&self, system: &System, other: &Self) -> Apart {
        let mut of_bodies = [0.0; 2];
        for (body, (a, b)) in system.bodies.iter().zip(self.bodies.iter().zip(&other.bodies)) {
            let worth = [body.mass, body.ibar[0], body.ibar[1], body.ibar[2]];
            for (sum, (a, b)) in of_bodies.iter_mut().zip(a.iter().zip(b)) {
                let squares = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared());
                *sum += worth.iter().zip(squares).map(|(worth, square)| worth * square).sum::<f64>();
            }
        }
        let [positions, kinetic] = of_bodies;
        let mut apart = Apart { positions, kinetic, springs: 0.0, damping: 0.0 };
        for (load, (a, b)) in system.loads.iter().zip(self.loads.iter().zip(&other.loads)) {
            let stiffness = load.law().map_or(0.0, |law| law.stiffness);
            let [x, rate] = [a[0] - b[0], a[1] - b[1]];
            apart.springs += stiffness * x * x;
            apart.damping += a[2] * rate * rate;
        }
        apart
    }
}
