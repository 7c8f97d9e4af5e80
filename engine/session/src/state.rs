//! What a session tells about itself.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::run::{ErrorEstimate, Simulation};

use crate::change::Drag;
use crate::drawing::{Arrows, Camera};
use crate::picture::Samples;
use crate::refusal::ProblemDocument;

/// Where a session's scene came from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SceneSource {
    /// A lesson, by its slug.
    Lesson(String),
    /// A built-in scene, by its name.
    Builtin(String),
    /// A scene sent with the request, by the name it states.
    Scene(String),
}

/// A body at the session's time.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "BodyState")]
pub struct SessionBody {
    /// Name.
    pub name: String,
    /// Centre of mass in the world, m.
    pub position: [f64; 3],
    /// First principal axis in the world.
    pub u: [f64; 3],
    /// Second principal axis in the world.
    pub v: [f64; 3],
    /// Third principal axis in the world.
    pub w: [f64; 3],
    /// Velocity of the centre of mass in the world, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity in the world, rad/s.
    pub angular_velocity: [f64; 3],
    /// Acceleration of the centre of mass in the world, m/s².
    pub acceleration: [f64; 3],
    /// Mass, kg.
    pub mass: f64,
}

/// What a joint or driver does to a body, in the world.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct JointForce {
    /// The joint or driver.
    pub joint: String,
    /// The body that it acts on: body j, or body i if j is the ground.
    pub on: String,
    /// The body at the other side, which feels both reversed.
    pub by: String,
    /// The joint's point, m.
    pub at: [f64; 3],
    /// Force, N.
    pub force: [f64; 3],
    /// Moment about the joint's point, N m.
    pub moment: [f64; 3],
}

/// Estimated errors of a state, each the largest over all bodies or joints: what the run has collected since its start, or since
/// its numbers were changed.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Accuracy {
    /// Of centres of mass, m.
    pub position: f64,
    /// Of directions, rad.
    pub turn: f64,
    /// Of velocities of centres of mass, m/s.
    pub velocity: f64,
    /// Of angular velocities, rad/s.
    pub angular_velocity: f64,
    /// Of the energy, J.
    pub energy: f64,
    /// Of forces in joints and drivers, N; absent where the state tells no forces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Of their moments, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
}

impl Accuracy {
    /// That of the run's current state, with that of its forces if these are told.
    fn of(simulation: &Simulation, error: ErrorEstimate, forces: bool) -> Self {
        let reactions = if forces { simulation.reaction_errors() } else { None };
        Self {
            position: error.position,
            turn: error.turn,
            velocity: error.velocity,
            angular_velocity: error.angular_velocity,
            energy: error.energy,
            force: reactions.map(|found| found.force),
            moment: reactions.map(|found| found.moment),
        }
    }
}

/// How forces are drawn in the viewer, for the page to do alike.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Drawing {
    /// Which, and by which convention.
    #[serde(flatten)]
    pub arrows: Arrows,
    /// Length of a force's arrow, m/N.
    pub force_scale: f64,
    /// Length of a moment's arrow, m/(N m).
    pub moment_scale: f64,
    /// The longest arrow, m; what would be longer is drawn as two in a row.
    pub longest: f64,
    /// From where the mechanism is looked at.
    pub camera: Camera,
}

impl Drawing {
    pub(crate) fn of(samples: &Samples) -> Self {
        let scale = samples.description().scale;
        Self {
            arrows: samples.arrows().clone(),
            force_scale: scale.force,
            moment_scale: scale.moment,
            longest: scale.longest,
            camera: samples.camera(),
        }
    }
}

/// Scenes of more joints tell their forces only where they are asked for.
const MAX_FORCES: usize = 64;

/// Where to go from here.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Links {
    /// This session.
    #[serde(rename = "self")]
    pub this: String,
    /// Its stream: a WebSocket.
    pub stream: String,
    /// Its Jacobian.
    pub jacobian: String,
    /// Its multipliers.
    pub multipliers: String,
    /// Its scene as it is now.
    pub scene: String,
}

impl Links {
    /// The links of session `id`.
    pub fn new(id: &str) -> Self {
        Self::below(format!("/api/v1/sessions/{id}"))
    }

    /// The links of a session that is seen at the address `this`.
    pub fn below(this: String) -> Self {
        Self {
            stream: format!("{this}/stream"),
            jacobian: format!("{this}/jacobian"),
            multipliers: format!("{this}/multipliers"),
            scene: format!("{this}/scene"),
            this,
        }
    }
}

/// A session at one moment.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SessionState {
    /// Its name in addresses.
    pub id: String,
    /// Where its scene came from.
    pub source: SceneSource,
    /// Title of its scene.
    pub title: String,
    /// Time of the simulation, s.
    pub time: f64,
    /// End of the simulation, s.
    pub duration: f64,
    /// Whether time runs.
    pub playing: bool,
    /// Simulated seconds a second while it plays.
    pub speed: f64,
    /// Whether the end was reached.
    pub finished: bool,
    /// Generalized coordinates, in the order of the Jacobian's columns.
    pub q: Vec<f64>,
    /// Their rates.
    pub q_dot: Vec<f64>,
    /// Energy, J.
    pub energy: f64,
    /// Change of the energy since the start, J.
    pub energy_drift: f64,
    /// Largest violation of the position constraints.
    pub position_violation: f64,
    /// Largest violation of the velocity constraints.
    pub velocity_violation: f64,
    /// Estimated errors of this state, where they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// From when on they are not known, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_unknown_from: Option<f64>,
    /// Integrator steps accepted.
    pub steps: u64,
    /// Integrator steps rejected.
    pub rejected: u64,
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
    /// Factorizations of a matrix.
    pub factorizations: u64,
    /// Projections onto the constraints.
    pub projections: u64,
    /// Frames recorded, and how many of them were encoded because somebody watched.
    pub frames: u64,
    /// See `frames`.
    pub frames_encoded: u64,
    /// How many watch the stream.
    pub watchers: usize,
    /// How forces are drawn.
    pub drawing: Drawing,
    /// How often the scene was changed since the session began.
    pub changes: u64,
    /// The spring by which a body is dragged, while it is.
    pub pull: Option<Drag>,
    /// What the engine found or corrected in the scene, and what speaks against the result so far.
    pub notes: Vec<String>,
    /// Why the simulation stopped before its end; the last good state is kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<ProblemDocument>,
    /// The bodies, in the scene's order.
    pub bodies: Vec<SessionBody>,
    /// Forces in joints and drivers; empty for scenes of more than 64 of them.
    pub forces: Vec<JointForce>,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Where to go from here.
    pub links: Links,
}

/// What is known of a session beside its simulation.
#[derive(Debug, Clone)]
pub(crate) struct SessionFacts {
    pub id: String,
    pub source: SceneSource,
    pub title: String,
    pub playing: bool,
    pub speed: f64,
    pub frames: u64,
    pub frames_encoded: u64,
    pub watchers: usize,
    pub drawing: Drawing,
    pub changes: u64,
    pub drag: Option<Drag>,
    /// When the run went on with other numbers, s.
    pub errors_from: Option<f64>,
    pub error: Option<ProblemDocument>,
}

impl SessionState {
    /// The state of a simulation.
    pub(crate) fn of(simulation: &Simulation, facts: SessionFacts) -> Self {
        let summary = simulation.summary();
        let frame = simulation.frame();
        let accelerations = simulation.mass_accelerations();
        let forces = forces(simulation);
        let accuracy = summary.error.map(|error| Accuracy::of(simulation, error, !forces.is_empty()));
        let mut notes = [simulation.notes(), &summary.doubts].concat();
        if let (Some(time), Some(_)) = (facts.errors_from, &accuracy) {
            notes.push(format!(
                "estimated errors count from t = {time:.3} s on, when the numbers of the run were changed"
            ));
        }
        let poses = frame.bodies.iter().zip(&accelerations);
        let bodies =
            simulation.model().bodies.iter().zip(poses).map(|(body, (pose, &acceleration))| SessionBody {
                name: body.name.clone(),
                position: pose.position,
                u: pose.u,
                v: pose.v,
                w: pose.w,
                velocity: pose.velocity,
                angular_velocity: pose.angular_velocity,
                acceleration,
                mass: body.mass,
            });
        Self {
            links: Links::new(&facts.id),
            id: facts.id,
            source: facts.source,
            title: facts.title,
            time: simulation.time(),
            duration: simulation.duration(),
            playing: facts.playing,
            speed: facts.speed,
            finished: summary.finished,
            q: simulation.q().to_vec(),
            q_dot: simulation.q_dot().to_vec(),
            energy: summary.energy,
            energy_drift: summary.energy_drift,
            position_violation: summary.position_violation,
            velocity_violation: summary.velocity_violation,
            accuracy,
            error_unknown_from: summary.error_unknown_from,
            steps: summary.steps,
            rejected: summary.rejected,
            evaluations: summary.evaluations,
            factorizations: summary.factorizations,
            projections: summary.projections,
            frames: facts.frames,
            frames_encoded: facts.frames_encoded,
            watchers: facts.watchers,
            drawing: facts.drawing,
            changes: facts.changes,
            pull: facts.drag,
            notes,
            error: facts.error,
            bodies: bodies.collect(),
            forces,
            gravity: simulation.model().gravity.into(),
        }
    }
}

fn forces(simulation: &Simulation) -> Vec<JointForce> {
    if simulation.system().constraints.len() > MAX_FORCES {
        return Vec::new();
    }
    let multipliers = simulation.multipliers().into_iter();
    multipliers
        .map(|joint| JointForce {
            joint: joint.joint,
            on: joint.on,
            by: joint.by,
            at: joint.about,
            force: joint.force,
            moment: joint.moment,
        })
        .collect()
}

/// The text messages to a watcher.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum SessionMessage<'a> {
    /// The session's state.
    State(&'a SessionState),
    /// The recording begins anew: the viewer must forget the old one.
    Reset,
    /// The session is closed.
    Closed,
}
