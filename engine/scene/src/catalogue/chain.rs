//! A chain of rods in three-dimensional motion: the scene on which the cost per body is measured.

use crate::elements::{Body, Inertia, Joint};
use crate::handle::{BodyHandle, Ground};
use crate::scene::Scene;
use crate::value::Triple;

/// Radius of a rod, m.
const RADIUS: f64 = 0.05;

/// Uniform cylinders of 1 m and 1 kg, joined end to end by spherical joints, the first to the origin, all along +x
/// at the start. Rod i = 1 … n turns at (1, 0.4 cos i, 0.8 sin i) rad/s, and velocities follow from the root on.
pub fn scene(rods: usize) -> Scene {
    let axial = 0.5 * RADIUS * RADIUS;
    let across = (3.0 * RADIUS * RADIUS + 1.0) / 12.0;
    let mut scene = Scene::new(format!("spatial-chain-{rods}"))
        .title(format!("Chain of {rods} rods"))
        .description("Uniform cylinders of 1 m and 1 kg on spherical joints, swinging in space.")
        .duration(2.0);
    let mut previous = BodyHandle::from(Ground);
    let mut end_velocity = [0.0; 3];
    for i in 1..=rods {
        let (sine, cosine) = libm::sincos(i as f64);
        let omega = [1.0, 0.4 * cosine, 0.8 * sine];
        // ω × (0.5, 0, 0): the velocity of the middle relative to the inner end.
        let half: Triple = [0.0, omega[2] * 0.5, -(omega[1] * 0.5)];
        let x = i as f64;
        let rod = scene.add(
            Body::cylinder(format!("rod-{i}"), 1.0, RADIUS, [x - 1.0, 0.0, 0.0], [x, 0.0, 0.0])
                .inertia(Inertia::Principal([axial, across, across]))
                .velocity(std::array::from_fn(|k| end_velocity[k] + half[k]))
                .angular_velocity(omega),
        );
        end_velocity = std::array::from_fn(|k| end_velocity[k] + 2.0 * half[k]);
        scene.add(Joint::spherical(format!("ball-{i}"), &previous, &rod).at([x - 1.0, 0.0, 0.0]));
        previous = rod;
    }
    scene
}
