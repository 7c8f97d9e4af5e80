//! Reading a value off a scene: how the check, computed misconceptions, models, trajectories and tuning measure.

use triad_engine::check::check as engine_check;
use triad_engine::reaction::JointMultipliers;
use triad_engine::scene::{GROUND, IntegratorKind, Scene, Settings, Stabilization};
use triad_engine::simulation::{BodyFrame, Simulation};

use crate::files::{Component, CountKind, MeasuredFile, MotionKind};
use crate::tolerance::norm;

/// Steps after which a run that an author or a student asks for is given up.
pub(crate) const MOST_STEPS: u64 = 200_000;
/// Tolerance of a run whose values are taken as references.
const TIGHT: f64 = 1e-12;
/// Tolerance of the run by another method that tells their error.
const LESS_TIGHT: f64 = 1e-10;

/// What is seen of a mechanism at one moment.
pub(crate) struct Seen {
    /// Bodies in the scene's order.
    pub bodies: Vec<BodyFrame>,
    /// Reactions of joints and drivers.
    pub reactions: Vec<JointMultipliers>,
}

impl Seen {
    /// What a run shows.
    pub(crate) fn of(simulation: &mut Simulation) -> Self {
        Self { bodies: simulation.frame().bodies, reactions: simulation.multipliers() }
    }

    /// A vector of the measurement, before a component is taken.
    pub(crate) fn vector(&self, scene: &Scene, measured: &MeasuredFile) -> Result<[f64; 3], String> {
        if let Some(joint) = &measured.joint {
            self.reaction(joint, measured)
        } else if let Some(body) = &measured.body {
            self.motion(scene, body, measured)
        } else {
            Err("measured names neither a count, the energy, a joint nor a body".to_owned())
        }
    }

    /// Force or moment of a joint on the side that is asked for.
    fn reaction(&self, joint: &str, measured: &MeasuredFile) -> Result<[f64; 3], String> {
        let found = self.reactions.iter().find(|m| m.joint == joint);
        let reaction = found.ok_or_else(|| format!("there is no joint {joint}"))?;
        let (side, vector) = match (&measured.force_on, &measured.moment_on) {
            (Some(side), None) => (side, reaction.force),
            (None, Some(side)) => (side, reaction.moment),
            _ => return Err("a joint is measured by force_on or by moment_on".to_owned()),
        };
        if *side == reaction.on {
            Ok(vector)
        } else if *side == reaction.by || *side == GROUND && reaction.by == GROUND {
            Ok(vector.map(|x| -x))
        } else {
            Err(format!("{side} is not a body of the joint {joint}"))
        }
    }

    fn motion(&self, scene: &Scene, body: &str, measured: &MeasuredFile) -> Result<[f64; 3], String> {
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
            None => Err("a body is measured by its motion: position, velocity, angular-velocity, u, v or w"
                .to_owned()),
        }
    }

    /// A body by name.
    pub(crate) fn body(&self, scene: &Scene, body: &str) -> Result<&BodyFrame, String> {
        let index = scene.bodies.iter().position(|b| b.name == body);
        index.and_then(|k| self.bodies.get(k)).ok_or_else(|| format!("there is no body {body}"))
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
    simulation: &mut Simulation,
    measured: &MeasuredFile,
) -> Result<Vec<f64>, String> {
    if let Some(count) = measured.count {
        let report = engine_check(scene).map_err(|e| e.to_string())?;
        let n = match count {
            CountKind::DegreesOfFreedom => report.degrees_of_freedom,
            CountKind::Rank => report.rank,
            CountKind::Rows => report.rows,
            CountKind::Coordinates => report.coordinates,
            CountKind::JacobianEntries => simulation.jacobian().entries.len(),
        };
        return Ok(vec![n as f64]);
    }
    if measured.energy {
        return Ok(vec![simulation.summary().energy]);
    }
    // Reactions cost an evaluation: only where they are asked for.
    let reactions = if measured.joint.is_some() { simulation.multipliers() } else { Vec::new() };
    let seen = Seen { bodies: simulation.frame().bodies, reactions };
    Ok(component(seen.vector(scene, measured)?, measured.component))
}

/// A run at time `t`, given up after a bounded number of steps.
pub(crate) fn run_to(scene: &Scene, t: f64) -> Result<Simulation, String> {
    let mut simulation = start(scene)?;
    simulation.advance_to(t).map_err(|e| e.to_string())?;
    Ok(simulation)
}

/// A run at its start that will be given up after a bounded number of steps.
pub(crate) fn start(scene: &Scene) -> Result<Simulation, String> {
    let mut simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    simulation.set_step_limit(MOST_STEPS);
    Ok(simulation)
}

/// The scene to be run as tightly as a reference needs; the second by another method, to tell the error of the first.
pub(crate) fn reference_scenes(scene: &Scene, end: f64) -> [Scene; 2] {
    let with = |integrator, tolerance| {
        let mut scene = scene.clone();
        let stabilization = Stabilization::Projection;
        let duration = scene.simulation.duration.max(end);
        // What a reader may change belongs to the settings as they were.
        scene.parameters.clear();
        scene.simulation = Settings { integrator, tolerance, stabilization, duration, ..scene.simulation };
        scene
    };
    [with(IntegratorKind::Auto, TIGHT), with(IntegratorKind::Dop853, LESS_TIGHT)]
}

/// The value of a measurement in SI units, and a bound on its error from two runs by different methods.
pub(crate) fn with_error(scene: &Scene, measured: &MeasuredFile) -> Result<(Vec<f64>, f64), String> {
    let mut values: Vec<Vec<f64>> = Vec::with_capacity(2);
    for scene in reference_scenes(scene, measured.time) {
        let mut simulation = run_to(&scene, measured.time)?;
        values.push(measure(&scene, &mut simulation, measured)?);
    }
    let second = values.pop().unwrap_or_default();
    let first = values.pop().unwrap_or_default();
    let difference: Vec<f64> = first.iter().zip(&second).map(|(a, b)| a - b).collect();
    let rounding = 1e-14 * norm(&first);
    Ok((first, 2.0 * norm(&difference) + rounding))
}
