//! Short ways to write scenes.

use nalgebra::Vector3;
use triad_scene::{Body, Ground, Inertia, Joint, JointKind, Load, Orientation, Scene, Triple};

pub use triad_scene::GROUND;

/// Gravity along −y, m/s².
pub const DOWN: Triple = [0.0, -9.81, 0.0];

/// An empty scene.
pub fn scene(name: &str, gravity: Triple, duration: f64, tolerance: f64) -> Scene {
    Scene::new(name).gravity(gravity).duration(duration).tolerance(tolerance)
}

/// A body at rest, its frame along the world's.
pub fn body(name: &str, mass: f64, principal: Triple, position: Triple) -> Body {
    Body::new(name, mass).inertia(Inertia::Principal(principal)).position(position)
}

/// A uniform rod in the plane z = 0 from `from` to `to`, turning with the plane at `spin` about `from`, which moves at
/// `velocity`. Its own frame has u along it.
pub fn rod(name: &str, mass: f64, from: [f64; 2], to: [f64; 2], velocity: [f64; 2], spin: f64) -> Body {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = libm::hypot(dx, dy);
    let moment = mass * length * length / 12.0;
    let center = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0.0];
    let along = [dx / length, dy / length, 0.0];
    body(name, mass, [moment; 3], center)
        .orientation(Orientation::directors(along, [-dy / length, dx / length, 0.0]))
        .velocity([velocity[0] - spin * 0.5 * dy, velocity[1] + spin * 0.5 * dx, 0.0])
        .angular_velocity([0.0, 0.0, spin])
}

/// A joint at a point of the world.
pub fn joint(name: &str, kind: JointKind, i: &str, j: &str, point: Triple) -> Joint {
    Joint::new(name, kind, i, j).at(point)
}

/// A joint at a point of the world with an axis.
pub fn hinged(name: &str, kind: JointKind, i: &str, j: &str, point: Triple, axis: Triple) -> Joint {
    joint(name, kind, i, j, point).about(axis)
}

/// A hinge about z.
pub fn pin(name: &str, i: &str, j: &str, point: [f64; 2]) -> Joint {
    Joint::revolute(name, i, j).at([point[0], point[1], 0.0]).about([0.0, 0.0, 1.0])
}

/// A spring from a point of the world to a body's reference point.
pub fn spring(name: &str, from: Triple, body: &str, stiffness: f64, free: f64, damping: f64) -> Load {
    Load::spring(name, (Ground, from), (body, [0.0; 3]), stiffness, damping).free_length(free)
}

/// Distance of a body's centre of mass from a point.
pub fn distance(frame: &triad_engine::run::Frame, body: usize, point: [f64; 3]) -> f64 {
    (Vector3::from(frame.bodies[body].position) - Vector3::from(point)).norm()
}
