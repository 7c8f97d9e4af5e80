//! Kinematic analysis of driven mechanisms, and the forces that drive them.
//!
//! With a driver for each degree of freedom, positions, velocities and accelerations follow from Φ(q, t) = 0 and its
//! derivatives. Positions alone do not say which branch of the mechanism is meant: the motion is therefore followed from its
//! start by power series, in steps of its own between the outputs, and Newton-Raphson only puts the last digits right. Rows
//! that repeat others are met in the sense of least squares. The multipliers of the equations of motion are then those of
//! inverse dynamics: what joints and drivers have to exert.

mod inverse;

mod idle;

mod dead_point;

mod path;

use super::{AnalysisError, Stage, Wanted};
use crate::error::EngineError;
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::run::{EventOccurrence, SingularConfiguration};
use crate::scene::Scene;
use idle::Idle;
use inverse::Masses;
use nalgebra::Vector3;
use path::Path;
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::state::BodyFrame;

/// Greatest number of positions of one analysis.
const MAX_POSITIONS: f64 = 100_000.0;

/// A driven mechanism at one moment.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct KinematicState {
    /// Time, s.
    pub time: f64,
    /// Positions and velocities of the bodies.
    pub bodies: Vec<BodyFrame>,
    /// Accelerations of their centres of mass, m/s².
    pub accelerations: Vec<[f64; 3]>,
    /// Angular accelerations, rad/s².
    pub angular_accelerations: Vec<[f64; 3]>,
    /// What joints and drivers have to exert.
    pub reactions: ReactionReport,
}

/// A driven motion.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Kinematics {
    /// The positions, in the order of time.
    pub states: Vec<KinematicState>,
    /// Newton-Raphson steps at the outputs in all.
    pub iterations: usize,
    /// Steps of the power series from the start to the end.
    pub steps: u64,
    /// The largest number by which Newton-Raphson has moved an output from where the series lead, m or, of directors, without
    /// a unit: their error. Another branch would be far beyond it.
    pub correction: f64,
    /// Singular positions passed, where other branches begin: the smooth one was taken.
    #[serde(rename = "passages")]
    pub singularities: Vec<SingularConfiguration>,
    /// Events of the scene, in the order of time; one that stops a run ends the motion.
    pub events: Vec<EventOccurrence>,
    /// What was corrected at the start, or has to be known of the result.
    pub notes: Vec<String>,
}

/// Follows the drivers of a scene over its duration, or to an event that stops it, with a state at each interval of its settings.
///
/// # Errors
///
/// [`AnalysisError`]: a scene that is free to move, or drivers that ask for what the joints do not allow, with the time.
///
/// ```
/// use triad_engine::{analysis::kinematics, prelude::*};
///
/// let mut scene = Scene::new("crank").duration(1.0);
/// let crank = scene.add(Body::rod("crank", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
/// let hinge = scene.add(Joint::revolute("hinge", Ground, &crank).at([0.0; 3]).about([0.0, 0.0, 1.0]));
/// scene.add(Driver::angle("motor", &hinge, Motion::ramp(0.0, 3.0)));
/// let motion = kinematics(&scene, triad_engine::reactions::report::Convention::default())?;
/// assert!((motion.states[0].bodies[0].angular_velocity[2] - 3.0).abs() < 1e-9);
/// # Ok::<(), triad_engine::analysis::AnalysisError>(())
/// ```
pub fn kinematics(scene: &Scene, convention: Convention) -> Result<Kinematics, AnalysisError> {
    kinematics_while(scene, convention, &Wanted::default())
}

/// As [`kinematics`], as long as they are wanted.
///
/// # Errors
///
/// As [`kinematics`], and [`AnalysisError::NoLongerWanted`].
pub fn kinematics_while(
    scene: &Scene,
    convention: Convention,
    wanted: &Wanted,
) -> Result<Kinematics, AnalysisError> {
    let settings = &scene.simulation;
    let mut path = Path::new(scene)?;
    path.stage.wanted = wanted.clone();
    let times = settings.output_times();
    let positions = times.intervals();
    if positions > MAX_POSITIONS {
        return Err(AnalysisError::TooManyPositions { positions });
    }
    let idle = idle_bodies(scene, &mut path)?;
    let mut masses = Masses::new(scene)?;
    let mut notes = path.notes().to_vec();
    notes.extend(masses.without_friction());
    let mut states = Vec::new();
    loop {
        path.go_to(times.at(states.len()))?;
        let time = path.stage.time;
        masses.take(&path.stage, &path.accelerations);
        for idle in &idle {
            idle.check(&path.stage, &masses)?;
            if states.is_empty() {
                notes.push(idle.note(&path.stage));
            }
        }
        if path.singular {
            notes.push(format!(
                "t = {time:.6} s is next to a singular position: forces grow beyond all bounds there, unless what acts on the \
                 bodies happens to be in balance, and those shown are not unique"
            ));
        }
        states.push(state(&mut path, &masses, convention)?);
        if path.has_ended() {
            break;
        }
    }
    let singularities = path.singularities();
    if !singularities.is_empty() {
        notes.push(
            "singular positions were passed, where other branches begin; the smooth one was followed. Where lengths differ by \
             less than a millionth from those that make the position singular, either may be right"
                .to_owned(),
        );
    }
    notes.extend(path.doubts());
    let correction = path.correction;
    let mut events = path.events().to_vec();
    for event in &mut events {
        let error = correction.max(f64::EPSILON) / event.rate.abs();
        event.error = Some(error).filter(|error| error.is_finite());
    }
    Ok(Kinematics {
        states,
        iterations: path.iterations,
        steps: path.steps(),
        correction,
        singularities,
        events,
        notes,
    })
}

/// The state that a path is held at.
fn state(path: &mut Path, masses: &Masses, convention: Convention) -> Result<KinematicState, AnalysisError> {
    let Path { stage, accelerations, singular, .. } = path;
    let mut reactions = report(&masses.multipliers(stage), convention).map_err(EngineError::from)?;
    if *singular {
        let numbers = reactions.reactions.iter_mut().flat_map(|r| r.force.iter_mut().chain(&mut r.moment));
        numbers.for_each(|number| number.unique = false);
    }
    let bodies = stage.mechanism.state.bodies();
    // α = ½ Σ e_k × ë_k, as Σ ė_k × ė_k = 0 — eq. (6.4).
    let angular = bodies.iter().zip(&*accelerations).map(|(at, second)| {
        ((0..3).map(|k| at.q.e[k].cross(&second.e[k])).sum::<Vector3<f64>>() * 0.5).into()
    });
    Ok(KinematicState {
        time: stage.time,
        bodies: stage.frames(),
        accelerations: accelerations.iter().map(|second| second.r.into()).collect(),
        angular_accelerations: angular.collect(),
        reactions,
    })
}

/// The bodies whose spin about themselves is all that the drivers leave free.
fn idle_bodies(scene: &Scene, path: &mut Path) -> Result<Vec<Idle>, AnalysisError> {
    if let Some(joints) = path.undecided_at_start() {
        return Err(AnalysisError::SingularStart { joints });
    }
    let freedoms = path.freedoms();
    if freedoms == 0 {
        return Ok(Vec::new());
    }
    if let Some(idle) = Idle::of_all(&mut path.stage, freedoms) {
        return Ok(idle);
    }
    Err(AnalysisError::Free { freedoms, body: freest(scene) })
}

/// The body that moves most in what the drivers leave free, where the scene is small enough to tell.
fn freest(scene: &Scene) -> Option<String> {
    let mut stage = Stage::new(scene).ok()?;
    let free = stage.tangent().ok()?;
    let first = free.column_iter().next()?.into_owned();
    Some(stage.foremost(&first))
}
