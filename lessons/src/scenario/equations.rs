//! The equations of a mechanism at a state, right and wrong, for questions that need more than a run.

use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::scene::{Coordinates, Driver, Motion, Scene, VectorMotion};
use triad_engine::system::body::RigidBody;
use triad_engine::system::natural::NaturalCoordinates;

/// The equations as they are first written, at a state.
pub(crate) fn augmented_at(mechanism: &mut Mechanism, t: f64, y: &[f64]) -> AugmentedSystem {
    mechanism.set_state(t, y);
    AugmentedSystem::new(&mechanism.system, &mechanism.state)
}

/// γ of the natural coordinates alone and −Φ_Q V̇q̇, at the state that is in place.
pub(crate) fn gamma_parts(mechanism: &Mechanism) -> Vec<[f64; 2]> {
    equations::gamma_parts(&mechanism.system, &mechanism.state)
}

/// The equations at the state that is in place, with `part` of −M V̇q̇ of reduced bodies in the forces: 0 leaves it out, −1
/// turns its sign.
pub(crate) fn with_velocity_term(
    mechanism: &Mechanism,
    mut augmented: AugmentedSystem,
    part: f64,
) -> AugmentedSystem {
    for (body, state) in mechanism.system.bodies.iter().zip(mechanism.state.bodies()) {
        if body.coordinates == Coordinates::Reduced {
            let mut more = NaturalCoordinates::default();
            let term = state.q_dot.e[0].cross(&state.q_dot.e[1]) * (2.0 * body.ibar[2]);
            more.e[2] = term * (1.0 - part);
            body.layout.pull_back(&state.q, &more, |column, value| augmented.force[column] += value);
        }
    }
    augmented
}

/// The equations at the state that is in place, of bodies whose Ī are others.
pub(crate) fn with_ibar(mechanism: &Mechanism, other: impl Fn(&mut RigidBody)) -> AugmentedSystem {
    let mut system = mechanism.system.clone();
    system.bodies.iter_mut().for_each(other);
    AugmentedSystem::new(&system, &mechanism.state)
}

/// The scene whose angles and angular velocities were taken for degrees.
pub(crate) fn in_degrees(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let factor = 1f64.to_radians();
    for body in &mut scene.bodies {
        body.angular_velocity = body.angular_velocity.map(|w| w * factor);
    }
    for driver in &mut scene.drivers {
        match driver {
            Driver::Angle { motion, .. } | Driver::AngleCosine { motion, .. } => {
                *motion = scaled(motion, factor);
            }
            Driver::AngleToWorld { motion, reference, .. } => {
                *motion = scaled(motion, factor);
                turning(reference, factor);
            }
            Driver::Vector { motion, .. } | Driver::Point { motion, .. } => turning(motion, factor),
            Driver::Slide { .. } => {}
        }
    }
    scene
}

fn turning(motion: &mut VectorMotion, factor: f64) {
    if let VectorMotion::Turning { angle, .. } = motion {
        *angle = scaled(angle, factor);
    }
}

/// A motion whose values are multiplied.
fn scaled(motion: &Motion, k: f64) -> Motion {
    match motion.clone() {
        Motion::Constant { value } => Motion::Constant { value: value * k },
        Motion::Ramp { start, rate } => Motion::Ramp { start: start * k, rate: rate * k },
        Motion::Polynomial { coefficients } => {
            Motion::Polynomial { coefficients: coefficients.into_iter().map(|c| c * k).collect() }
        }
        Motion::Harmonic { mean, amplitude, frequency, phase } => {
            Motion::Harmonic { mean: mean * k, amplitude: amplitude * k, frequency, phase }
        }
        Motion::SmoothStep { from, to, start, end } => {
            Motion::SmoothStep { from: from * k, to: to * k, start, end }
        }
        Motion::Table { times, values } => {
            Motion::Table { times, values: values.into_iter().map(|v| v * k).collect() }
        }
        Motion::Expression { value } => Motion::expression(format!("{k:?}*({value})")),
    }
}
