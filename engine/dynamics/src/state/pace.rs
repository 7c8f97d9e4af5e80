//! How fast a state turns the rows of joints.

use crate::system::System;
use crate::system::natural::NaturalCoordinates;

/// How fast a body turns the rows of its joints, 1/s: its angular velocity, or its velocity by the length of the
/// mechanism.
pub fn pace(rate: &NaturalCoordinates, length: f64) -> f64 {
    let turning: f64 = rate.e.iter().map(nalgebra::Vector3::norm_squared).sum();
    (0.5 * turning).sqrt().max(rate.r.norm() / length)
}

/// The largest pace of all bodies in the state y = (q, q̇).
pub fn fastest(system: &System, y: &[f64]) -> f64 {
    let (q, q_dot) = y.split_at(system.coordinates);
    let paces = system.bodies.iter().map(|body| {
        let rate = body.layout.velocity(&body.layout.position(q), q_dot);
        pace(&rate, system.length)
    });
    paces.fold(0.0, f64::max)
}
