//! The N-four-bar mechanism — A02 of the IFToMM library of benchmark problems.

use crate::{AxisRows, Body, GROUND, Inertia, Joint, JointKind, Orientation, Scene, Settings, Shape};

/// N windows: N + 1 uprights pinned to the ground at (i, 0), N couplers between their tips; all links are uniform
/// slender rods of 1 m and 1 kg. It starts upright, the tips moving at 1 m/s along +x.
///
/// The moment about a rod's own axis does not matter to this planar motion; it is given the value across the rod, so
/// that no axis of the rod is without inertia. Redundancy: every hinge is a spatial revolute.
pub fn scene(windows: usize) -> Scene {
    let mut bodies = Vec::with_capacity(2 * windows + 1);
    let mut joints = Vec::with_capacity(3 * windows + 1);
    for i in 0..=windows {
        let x = i as f64;
        bodies.push(link(format!("upright-{i}"), [x, 0.5, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], -1.0));
        joints.push(pin(&format!("A{i}"), GROUND, &format!("upright-{i}"), [x, 0.0, 0.0]));
    }
    for i in 0..windows {
        let x = i as f64;
        let coupler = format!("coupler-{i}");
        bodies.push(link(coupler.clone(), [x + 0.5, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0));
        let left = if i == 0 { "B0".to_owned() } else { format!("B{i}-right") };
        joints.push(pin(&left, &format!("upright-{i}"), &coupler, [x, 1.0, 0.0]));
        joints.push(pin(
            &format!("B{}", i + 1),
            &coupler,
            &format!("upright-{}", i + 1),
            [x + 1.0, 1.0, 0.0],
        ));
    }
    Scene {
        name: format!("n-four-bar-{windows}"),
        title: format!("{windows}-four-bar mechanism"),
        description:
            "Benchmark A02: passes through positions in which all links are horizontal and the mobility \
                      jumps from 1 to N + 1."
                .to_owned(),
        gravity: [0.0, -9.81, 0.0],
        coordinates: crate::Coordinates::Full,
        bodies,
        joints,
        drivers: Vec::new(),
        loads: Vec::new(),
        simulation: Settings { duration: 10.0, ..Settings::default() },
        events: Vec::new(),
        parameters: Vec::new(),
    }
}

/// A rod along `along` (its u), centred at `position`, moving with the given velocity and spin about z.
fn link(name: String, position: [f64; 3], along: [f64; 3], velocity: [f64; 3], spin: f64) -> Body {
    let across = [-along[1], along[0], 0.0];
    Body {
        name,
        mass: 1.0,
        inertia: Some(Inertia::Principal([1.0 / 12.0; 3])),
        center_of_mass: [0.0; 3],
        position,
        orientation: Some(Orientation {
            u: Some(along),
            v: Some(across),
            w: None,
            quaternion: None,
            axis: None,
            angle: None,
        }),
        velocity,
        angular_velocity: [0.0, 0.0, spin],
        coordinates: None,
        shape: vec![Shape::Rod { from: [-0.5, 0.0, 0.0], to: [0.5, 0.0, 0.0], radius: 0.03 }],
    }
}

fn pin(name: &str, body_i: &str, body_j: &str, point: [f64; 3]) -> Joint {
    let mut joint = Joint::between(name, JointKind::Revolute, body_i, body_j);
    joint.point = Some(point);
    joint.axis = Some([0.0, 0.0, 1.0]);
    joint.rows = Some(AxisRows::Cv);
    joint
}
