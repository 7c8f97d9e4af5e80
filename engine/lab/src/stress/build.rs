//! Short ways to write scenes.

use nalgebra::Vector3;
use triad_scene::{Body, Inertia, Joint, JointKind, Load, Orientation, Scene, Settings, Triple};

pub use triad_scene::GROUND;

/// Gravity along −y, m/s².
pub const DOWN: Triple = [0.0, -9.81, 0.0];

/// An empty scene.
pub fn scene(name: &str, gravity: Triple, duration: f64, tolerance: f64) -> Scene {
    Scene {
        name: name.to_owned(),
        title: String::new(),
        description: String::new(),
        gravity,
        coordinates: triad_scene::Coordinates::Full,
        bodies: Vec::new(),
        joints: Vec::new(),
        drivers: Vec::new(),
        events: Vec::new(),
        parameters: Vec::new(),
        loads: Vec::new(),
        simulation: Settings { duration, tolerance, ..Settings::default() },
    }
}

/// A body at rest, its frame along the world's.
pub fn body(name: &str, mass: f64, principal: Triple, position: Triple) -> Body {
    Body {
        name: name.to_owned(),
        mass,
        inertia: Some(Inertia::Principal(principal)),
        center_of_mass: [0.0; 3],
        position,
        orientation: None,
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
        coordinates: None,
        shape: Vec::new(),
    }
}

/// A uniform rod in the plane z = 0 from `from` to `to`, turning with the plane at `spin` about `from`, which moves at
/// `velocity`. Its own frame has u along it.
pub fn rod(name: &str, mass: f64, from: [f64; 2], to: [f64; 2], velocity: [f64; 2], spin: f64) -> Body {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    let moment = mass * length * length / 12.0;
    let center = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0.0];
    let mut rod = body(name, mass, [moment; 3], center);
    rod.orientation = Some(directors([dx / length, dy / length, 0.0], [-dy / length, dx / length, 0.0]));
    rod.velocity = [velocity[0] - spin * 0.5 * dy, velocity[1] + spin * 0.5 * dx, 0.0];
    rod.angular_velocity = [0.0, 0.0, spin];
    rod
}

/// An orientation by u and v.
pub fn directors(u: Triple, v: Triple) -> Orientation {
    Orientation { u: Some(u), v: Some(v), w: None, quaternion: None, axis: None, angle: None }
}

/// A joint at a point of the world.
pub fn joint(name: &str, kind: JointKind, i: &str, j: &str, point: Triple) -> Joint {
    let mut joint = Joint::between(name, kind, i, j);
    joint.point = Some(point);
    joint
}

/// A joint at a point of the world with an axis.
pub fn hinged(name: &str, kind: JointKind, i: &str, j: &str, point: Triple, axis: Triple) -> Joint {
    let mut joint = joint(name, kind, i, j, point);
    joint.axis = Some(axis);
    joint
}

/// A hinge about z.
pub fn pin(name: &str, i: &str, j: &str, point: [f64; 2]) -> Joint {
    hinged(name, JointKind::Revolute, i, j, [point[0], point[1], 0.0], [0.0, 0.0, 1.0])
}

/// A spring from a point of the world to a body's reference point.
pub fn spring(name: &str, from: Triple, body: &str, stiffness: f64, free: f64, damping: f64) -> Load {
    Load::Spring {
        name: name.to_owned(),
        body_i: GROUND.to_owned(),
        point_i: from,
        body_j: body.to_owned(),
        point_j: [0.0; 3],
        stiffness,
        free_length: Some(free),
        damping,
        force: None,
    }
}

/// Distance of a body's centre of mass from a point.
pub fn distance(frame: &triad_engine::simulation::Frame, body: usize, point: [f64; 3]) -> f64 {
    (Vector3::from(frame.bodies[body].position) - Vector3::from(point)).norm()
}
