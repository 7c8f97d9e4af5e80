//! Reading a value off a scene: how the check, computed misconceptions, models, trajectories and tuning measure.

use std::collections::BTreeMap;

use thiserror::Error;
use triad_engine::EngineError;
use triad_engine::analysis::check::check as engine_check;
use triad_engine::reactions::JointMultipliers;
use triad_engine::run::{ReactionErrors, Simulation};
use triad_engine::scene::{ConstraintMethod, GROUND, IntegratorKind, Scene, Settings};
use triad_engine::state::BodyFrame;

use crate::answers::tolerance::{distance, norm};
use crate::files::{Component, CountKind, MeasuredFile, MotionKind};

/// Why a scene does not show a value.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MeasureError {
    /// The measurement names nothing.
    #[error("measured names neither a count, the energy, a joint nor a body")]
    Nothing,
    /// A joint or driver that the scene does not have.
    #[error("there is no joint or driver {0}")]
    NoJoint(String),
    /// A body that the scene does not have.
    #[error("there is no body {0}")]
    NoBody(String),
    /// A joint without the body on which it acts.
    #[error("a joint is measured by force_on or by moment_on")]
    NoSide,
    /// A body that the joint does not connect.
    #[error("{body} is not a body of the joint {joint}")]
    NotOfJoint {
        /// The body.
        body: String,
        /// The joint.
        joint: String,
    },
    /// A body without what is measured of it.
    #[error("a body is measured by its motion: position, velocity, angular-velocity, u, v or w")]
    NoMotion,
    /// The scene does not start, or does not come to the time.
    #[error(transparent)]
    Engine(Box<EngineError>),
}

impl From<EngineError> for MeasureError {
    fn from(error: EngineError) -> Self {
        Self::Engine(Box::new(error))
    }
}

/// Steps after which a run that an author or a student asks for ends with an error.
pub(crate) const MAX_STEPS: u64 = 200_000;
/// Tolerance of a run whose values are taken as references.
const TIGHT: f64 = 1e-12;
/// Tolerance of the run by another method, which estimates their error.
const LESS_TIGHT: f64 = 1e-10;

/// What is seen of a mechanism at one moment.
pub(crate) struct Observation {
    /// Bodies in the scene's order.
    pub bodies: Vec<BodyFrame>,
    /// Reactions of joints and drivers.
    pub reactions: Vec<JointMultipliers>,
}

impl Observation {
    /// What a run shows.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        Self { bodies: simulation.frame().bodies, reactions: simulation.multipliers() }
    }

    /// A vector of the measurement, before a component is taken.
    pub(crate) fn vector(&self, scene: &Scene, measured: &MeasuredFile) -> Result<[f64; 3], MeasureError> {
        if let Some(joint) = &measured.joint {
            self.reaction(joint, measured)
        } else if let Some(body) = &measured.body {
            self.motion(scene, body, measured)
        } else {
            Err(MeasureError::Nothing)
        }
    }

    /// Force or moment of a joint on the side that is asked for.
    fn reaction(&self, joint: &str, measured: &MeasuredFile) -> Result<[f64; 3], MeasureError> {
        let found = self.reactions.iter().find(|m| m.joint == joint);
        let reaction = found.ok_or_else(|| MeasureError::NoJoint(joint.to_owned()))?;
        let (side, vector) = match (&measured.force_on, &measured.moment_on) {
            (Some(side), None) => (side, reaction.force),
            (None, Some(side)) => (side, reaction.moment),
            _ => return Err(MeasureError::NoSide),
        };
        if *side == reaction.on {
            Ok(vector)
        } else if *side == reaction.by || *side == GROUND && reaction.by == GROUND {
            Ok(vector.map(|x| -x))
        } else {
            Err(MeasureError::NotOfJoint { body: side.clone(), joint: joint.to_owned() })
        }
    }

    fn motion(&self, scene: &Scene, body: &str, measured: &MeasuredFile) -> Result<[f64; 3], MeasureError> {
        let state = self.body(scene, body)?;
        let [xi, eta, zeta] = measured.point.unwrap_or_default();
        let arm: [f64; 3] = std::array::from_fn(|k| xi * state.u[k] + eta * state.v[k] + zeta * state.w[k]);
        let [a, b, c] = state.angular_velocity;
        let turning = [b * arm[2] - c * arm[1], c * arm[0] - a * arm[2], a * arm[1] - b * arm[0]];
        match measured.motion {
            Some(MotionKind::Position) => Ok(std::array::from_fn(|k| state.position[k] + arm[k])),
            Some(MotionKind::Velocity) => Ok(std::array::from_fn(|k| state.velocity[k] + turning[k])),
            Some(MotionKind::AngularVelocity) => Ok(state.angular_velocity),
            Some(MotionKind::U) => Ok(state.u),
            Some(MotionKind::V) => Ok(state.v),
            Some(MotionKind::W) => Ok(state.w),
            None => Err(MeasureError::NoMotion),
        }
    }

    /// A body by name.
    pub(crate) fn body(&self, scene: &Scene, body: &str) -> Result<&BodyFrame, MeasureError> {
        let index = scene.bodies.iter().position(|b| b.name == body);
        index.and_then(|k| self.bodies.get(k)).ok_or_else(|| MeasureError::NoBody(body.to_owned()))
    }
}

/// The component that is asked for, or all three.
pub(crate) fn component(vector: [f64; 3], component: Option<Component>) -> Vec<f64> {
    match component {
        None => vector.to_vec(),
        Some(Component::X) => vec![vector[0]],
        Some(Component::Y) => vec![vector[1]],
        Some(Component::Z) => vec![vector[2]],
        Some(Component::Size) => vec![norm(&vector)],
    }
}

/// The value of a measurement at the run's moment.
pub(crate) fn measure(
    scene: &Scene,
    simulation: &Simulation,
    measured: &MeasuredFile,
) -> Result<Vec<f64>, MeasureError> {
    if let Some(count) = measured.count {
        let report = engine_check(scene)?;
        let n = match count {
            CountKind::DegreesOfFreedom => report.degrees_of_freedom,
            CountKind::Rank => report.rank,
            CountKind::Rows => report.rows,
            CountKind::Coordinates => report.coordinates,
            CountKind::JacobianEntries => simulation.jacobian().entries.len(),
            CountKind::Evaluations => return Ok(vec![simulation.summary().evaluations as f64]),
        };
        return Ok(vec![n as f64]);
    }
    if measured.energy {
        return Ok(vec![simulation.summary().energy]);
    }
    // Reactions cost an evaluation: only where they are asked for.
    let reactions = if measured.joint.is_some() { simulation.multipliers() } else { Vec::new() };
    let seen = Observation { bodies: simulation.frame().bodies, reactions };
    Ok(component(seen.vector(scene, measured)?, measured.component))
}

/// One number of each measurement at the run's moment, seen at one look.
pub(crate) fn row(
    scene: &Scene,
    simulation: &Simulation,
    columns: &BTreeMap<String, MeasuredFile>,
) -> Result<Vec<f64>, MeasureError> {
    let reactions =
        if columns.values().any(|one| one.joint.is_some()) { simulation.multipliers() } else { Vec::new() };
    let seen = Observation { bodies: simulation.frame().bodies, reactions };
    let number = |measured: &MeasuredFile| {
        let values = if measured.count.is_some() || measured.energy {
            measure(scene, simulation, measured)?
        } else {
            component(seen.vector(scene, measured)?, measured.component)
        };
        Ok(values.first().copied().unwrap_or(f64::NAN))
    };
    columns.values().map(number).collect()
}

/// About how far a measurement at the run's moment may be off, by the run's own estimate; infinite where that is not known.
pub(crate) fn estimated_error(simulation: &Simulation, measured: &MeasuredFile) -> f64 {
    if measured.count.is_some() {
        return 0.0;
    }
    let found = if measured.joint.is_some() {
        let of = |error: ReactionErrors| if measured.force_on.is_some() { error.force } else { error.moment };
        simulation.reaction_errors().map(of)
    } else {
        let arm = norm(&measured.point.unwrap_or_default());
        simulation.error_estimate().map(|error| match measured.motion {
            _ if measured.energy => error.energy,
            Some(MotionKind::Position) => error.position + arm * error.turn,
            Some(MotionKind::Velocity) => error.velocity + arm * error.angular_velocity,
            Some(MotionKind::AngularVelocity) => error.angular_velocity,
            Some(MotionKind::U | MotionKind::V | MotionKind::W) | None => error.turn,
        })
    };
    found.unwrap_or(f64::INFINITY)
}

/// A run at time `t`, given up after a bounded number of steps.
pub(crate) fn run_to(scene: &Scene, t: f64) -> Result<Simulation, MeasureError> {
    let mut simulation = start(scene)?;
    simulation.advance_to(t)?;
    Ok(simulation)
}

/// A run at its start that will be given up after a bounded number of steps.
pub(crate) fn start(scene: &Scene) -> Result<Simulation, MeasureError> {
    let mut simulation = Simulation::new(scene)?;
    simulation.set_step_limit(MAX_STEPS);
    Ok(simulation)
}

/// The scene to be run as tightly as a reference needs; the second by another method, to estimate the error of the first.
pub(crate) fn reference_scenes(scene: &Scene, end: f64) -> [Scene; 2] {
    let with = |integrator, tolerance| {
        let mut scene = scene.clone();
        let constraint_method = ConstraintMethod::Projection;
        let duration = scene.simulation.duration.max(end);
        // What a reader may change belongs to the settings as they were.
        scene.parameters.clear();
        // The second run is an estimate itself.
        let error_estimate = integrator == IntegratorKind::Auto;
        scene.simulation = Settings {
            integrator,
            tolerance,
            constraint_method,
            duration,
            error_estimate,
            ..scene.simulation
        };
        scene
    };
    [with(IntegratorKind::Auto, TIGHT), with(IntegratorKind::Dop853, LESS_TIGHT)]
}

/// The value of a measurement in SI units, by the tight run alone.
pub(crate) fn tight(scene: &Scene, measured: &MeasuredFile) -> Result<Vec<f64>, MeasureError> {
    let [scene, _] = reference_scenes(scene, measured.time);
    measure(&scene, &run_to(&scene, measured.time)?, measured)
}

/// The value of a measurement in SI units, and a bound on its error: from two runs by different methods, and from the estimate that
/// the first makes itself.
pub(crate) fn with_error(scene: &Scene, measured: &MeasuredFile) -> Result<(Vec<f64>, f64), MeasureError> {
    let [first, second] = reference_scenes(scene, measured.time);
    let run = run_to(&first, measured.time)?;
    let value = measure(&first, &run, measured)?;
    let other = measure(&second, &run_to(&second, measured.time)?, measured)?;
    let rounding = 1e-14 * norm(&value);
    let error = (2.0 * distance(&value, &other)).max(estimated_error(&run, measured)) + rounding;
    Ok((value, error))
}
