//! Tables of the questions that are answered by work: a program, a trajectory, a scene, settings.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::measured::MeasuredFile;
use crate::answers::TypedValue;

/// `[question.implement]`: the student's own program evaluates the equations at given states.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImplementFile {
    /// The mechanism: a file of the lesson such as `scenes/body.json`; without it, the lesson's scenario.
    pub scene: Option<String>,
    /// What the program returns for each state.
    pub asks: Vec<EquationPart>,
    /// How many states each student is given, 1 to 20.
    #[serde(default = "default_instances")]
    pub states: usize,
    /// Draw states that satisfy the constraints; otherwise any numbers, which find more mistakes.
    #[serde(default)]
    pub consistent: bool,
    /// Largest difference of an entry, relative to the largest entry of its part (at least 1); 1e-6 if not given.
    #[serde(default = "default_program_tolerance")]
    pub tolerance: f64,
}

/// A part of the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum EquationPart {
    /// Φ, one number for each row.
    Phi,
    /// Φ_q, one line for each row.
    Jacobian,
    /// γ, the right-hand side of Φ_q q̈ = γ.
    Gamma,
    /// The mass matrix M(q).
    Mass,
    /// The accelerations q̈.
    Acceleration,
}

impl EquationPart {
    /// The key in the answer.
    pub fn key(self) -> &'static str {
        match self {
            Self::Phi => "phi",
            Self::Jacobian => "jacobian",
            Self::Gamma => "gamma",
            Self::Mass => "mass",
            Self::Acceleration => "acceleration",
        }
    }

    /// How it is written in a text.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Phi => "Φ",
            Self::Jacobian => "Φ_q",
            Self::Gamma => "γ",
            Self::Mass => "M",
            Self::Acceleration => "q̈",
        }
    }
}

/// `[question.trajectory]`: a table of times and values from any program, compared with the run of the scenario.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrajectoryFile {
    /// The mechanism: a file of the lesson; without it, the lesson's scenario.
    pub scene: Option<String>,
    /// The table covers 0 to this time, s.
    pub end: f64,
    /// The columns besides `t`, and what each is.
    pub columns: BTreeMap<String, MeasuredFile>,
    /// Error (relative, root of the mean square) up to which a share of the points is given, the best first.
    pub bands: Vec<ScoreBand>,
}

/// A share of the points for an error that is small enough.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScoreBand {
    /// Largest error.
    pub error: f64,
    /// Share of the points.
    pub share: f64,
}

/// `[question.model]`: a scene written by the student, judged by what it does.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// The author's own scene, a file below `reference/`.
    pub reference: String,
    /// Most bodies that are run.
    #[serde(default = "default_bodies")]
    pub most_bodies: usize,
    /// The degrees of freedom must be those of the author's scene.
    #[serde(default = "yes")]
    pub degrees_of_freedom: bool,
    /// No row may be redundant.
    #[serde(default)]
    pub no_redundancy: bool,
    /// Joints that must be used: how many of each type, at least.
    #[serde(default)]
    pub joints: BTreeMap<String, usize>,
    /// What is compared with the author's scene.
    #[serde(default, rename = "watch")]
    pub watches: Vec<WatchFile>,
}

/// Something that the student's scene must show as the author's does.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WatchFile {
    /// In words that fit "… is as it should be".
    pub what: String,
    /// What is measured; its `time` is ignored.
    pub measured: MeasuredFile,
    /// When, s.
    pub times: Vec<f64>,
    /// Largest difference relative to the largest value seen.
    pub tolerance: f64,
    /// What to look at if it is not so, in Markdown.
    pub feedback: String,
}

/// `[question.tuning]`: integrator, tolerance and stabilization under a budget.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TuningFile {
    /// The mechanism: a file of the lesson; without it, the lesson's scenario.
    pub scene: Option<String>,
    /// Evaluations of the accelerations that may be spent.
    pub budget: u64,
    /// The error that must be reached at the end, in the unit of what is watched.
    pub error: f64,
    /// How far the constraints may be violated at the end, in metres and unit vectors; without it, any.
    pub violation: Option<f64>,
    /// What is watched, at the end of the run; its `time` is ignored.
    pub watch: MeasuredFile,
    /// End of the run, s.
    pub end: f64,
    /// Integrators to choose from.
    pub integrators: Vec<triad_engine::scene::IntegratorKind>,
    /// Whether Baumgarte's stabilization may be chosen.
    #[serde(default)]
    pub baumgarte: bool,
}

/// The question and the component, from 0, that `force.y` or `speed` names.
pub fn earlier_value(name: &str) -> (&str, Option<usize>) {
    let component = |letter: &str| ["x", "y", "z"].iter().position(|known| *known == letter);
    match name.split_once('.') {
        Some((id, letter)) => (id, component(letter)),
        None => (name, None),
    }
}

/// `[question.follows]`: a wrong earlier answer is carried through.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FollowFile {
    /// Symbols and the earlier questions that they stand for: a number by its id, a component of a vector as `force.y`.
    pub from: BTreeMap<String, String>,
    /// The answer as an expression in these symbols and the parameters: number, list or list of rows.
    pub value: TypedValue,
    /// Share of the points for a right step from a wrong value.
    #[serde(default = "follow_share")]
    pub share: f64,
}

/// A systematically wrong model, run by the same engine; its answer is that of the misconception.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WrongModelFile {
    /// What is wrong in it.
    #[serde(rename = "slip")]
    pub kind: WrongModel,
    /// For `wrong-end`: the other joint whose reaction is taken, or none to take the opposite point of the body.
    pub joint: Option<String>,
}

/// What is wrong in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WrongModel {
    /// The force or moment on the other body; of a motion, the other sign.
    OtherSide,
    /// Components in the frame of the body in the place of the ground's.
    OtherFrame,
    /// Angles and angular velocities of the scene taken for degrees.
    Degrees,
    /// Gravity left out.
    NoGravity,
    /// Mass in the place of weight: gravity of 1 m/s².
    MassForWeight,
    /// The same position at rest, drivers stopped.
    Static,
    /// Reduced bodies with the wrong sign of their velocity term.
    ReducedSign,
    /// The other end of the body.
    WrongEnd,
}

/// Instances where the author gives no number.
fn default_instances() -> usize {
    5
}

/// Bodies of a student's scene where the author gives no bound.
fn default_bodies() -> usize {
    10
}

/// Relative difference of a student's program where the author gives none: six digits are enough.
fn default_program_tolerance() -> f64 {
    1e-5
}

/// The degrees of freedom are compared unless the author says otherwise.
fn yes() -> bool {
    true
}

/// Share for a right step from a wrong value, unless the author says otherwise: less than for the right answer, which no
/// earlier mistake may make easier to reach.
fn follow_share() -> f64 {
    0.8
}
