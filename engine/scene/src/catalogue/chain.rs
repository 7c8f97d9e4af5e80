//! A chain of rods in three-dimensional motion: the scene on which the cost per body is measured.

use crate::{Body, Coordinates, GROUND, Inertia, Joint, JointKind, Scene, Settings, Shape, Triple};

/// Radius of a rod, m.
const RADIUS: f64 = 0.05;

/// Uniform cylinders of 1 m and 1 kg, joined end to end by spherical joints, the first to the origin, all along +x
/// at the start. Rod i = 1 … n turns at (1, 0.4 cos i, 0.8 sin i) rad/s, and velocities follow from the root on.
pub fn scene(rods: usize) -> Scene {
    let axial = 0.5 * RADIUS * RADIUS;
    let across = (3.0 * RADIUS * RADIUS + 1.0) / 12.0;
    let mut bodies = Vec::with_capacity(rods);
    let mut joints = Vec::with_capacity(rods);
    let mut end_velocity = [0.0; 3];
    for i in 1..=rods {
        let (sine, cosine) = (i as f64).sin_cos();
        let omega = [1.0, 0.4 * cosine, 0.8 * sine];
        // ω × (0.5, 0, 0): the velocity of the middle relative to the inner end.
        let half: Triple = [0.0, omega[2] * 0.5, -(omega[1] * 0.5)];
        let x = i as f64;
        bodies.push(Body {
            name: format!("rod-{i}"),
            mass: 1.0,
            inertia: Some(Inertia::Principal([axial, across, across])),
            center_of_mass: [0.0; 3],
            position: [x - 0.5, 0.0, 0.0],
            orientation: None,
            velocity: std::array::from_fn(|k| end_velocity[k] + half[k]),
            angular_velocity: omega,
            coordinates: None,
            shape: vec![Shape::Rod { from: [-0.5, 0.0, 0.0], to: [0.5, 0.0, 0.0], radius: RADIUS }],
        });
        end_velocity = std::array::from_fn(|k| end_velocity[k] + 2.0 * half[k]);
        let previous = if i == 1 { GROUND.to_owned() } else { format!("rod-{}", i - 1) };
        joints.push(ball(&format!("ball-{i}"), &previous, &format!("rod-{i}"), [x - 1.0, 0.0, 0.0]));
    }
    Scene {
        name: format!("spatial-chain-{rods}"),
        title: format!("Chain of {rods} rods"),
        description: "Uniform cylinders of 1 m and 1 kg on spherical joints, swinging in space.".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        coordinates: Coordinates::Full,
        bodies,
        joints,
        drivers: Vec::new(),
        loads: Vec::new(),
        simulation: Settings { duration: 2.0, ..Settings::default() },
        events: Vec::new(),
        parameters: Vec::new(),
    }
}

fn ball(name: &str, body_i: &str, body_j: &str, point: [f64; 3]) -> Joint {
    let mut joint = Joint::between(name, JointKind::Spherical, body_i, body_j);
    joint.point = Some(point);
    joint
}
