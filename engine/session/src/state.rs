//! What a session tells about itself.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::run::Simulation;

use crate::accuracy::{Accuracy, Since};
use crate::change::Drag;
use crate::drawing::{Arrows, Camera};
use crate::happened::Happened;
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
    /// Energy less that of the start and the work of drivers and of loads without potential since, J.
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
    /// What has happened so far.
    #[serde(flatten)]
    pub happened: Happened,
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
    /// Since when errors count.
    pub since: Since,
    /// What happened before the simulation was started, with other numbers.
    pub happened: Happened,
    pub error: Option<ProblemDocument>,
}

impl SessionState {
    /// The state of a simulation.
    pub(crate) fn of(simulation: &Simulation, facts: SessionFacts) -> Self {
        let summary = simulation.summary();
        let frame = simulation.frame();
        let accelerations = simulation.mass_accelerations();
        let known = facts.since.known(simulation, &summary, tells_forces(simulation));
        let notes = [known.notes.as_slice(), &facts.since.notes(&known)].concat();
        let happened = facts.happened.and(simulation, &summary.singularities, facts.since.is_start());
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
            energy_drift: known.energy_drift.unwrap_or(summary.energy_drift),
            position_violation: summary.position_violation,
            velocity_violation: summary.velocity_violation,
            accuracy: known.accuracy,
            error_unknown_from: known.error_unknown_from,
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
            happened,
            notes,
            error: facts.error,
            bodies: bodies.collect(),
            forces: forces(simulation),
            gravity: simulation.model().gravity.into(),
        }
    }
}

/// Whether its state tells forces.
pub(crate) fn tells_forces(simulation: &Simulation) -> bool {
    (1..=MAX_FORCES).contains(&simulation.system().constraints.len())
}

fn forces(simulation: &Simulation) -> Vec<JointForce> {
    if !tells_forces(simulation) {
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
