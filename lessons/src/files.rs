//! The files of a course exactly as an author writes them. Unknown keys are refused.

use std::collections::BTreeMap;

mod tasks;

use schemars::JsonSchema;
use serde::Deserialize;

pub use tasks::{
    Band, FollowFile, ImplementFile, ModelFile, Part, Slip, TrajectoryFile, TuningFile, WatchFile,
    WrongModelFile,
};

use crate::submission::{Answer, Entry, Settings};

/// `course.toml`: the course as a whole.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CourseFile {
    /// Version of this file format; 1.
    pub format_version: u32,
    /// Title of the course.
    pub title: String,
}

/// `NN-slug/lesson.toml`: what a lesson is about.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LessonFile {
    /// Title.
    pub title: String,
    /// One sentence for the list of lessons.
    pub summary: String,
    /// How long a student needs, in minutes (10 to 40).
    pub minutes: u32,
    /// What the student can do afterwards; each begins with a verb.
    pub objectives: Vec<String>,
    /// Slugs of the lessons that come before.
    #[serde(default)]
    pub prerequisites: Vec<String>,
    /// Predict, run, check, explain.
    #[serde(default, rename = "step")]
    pub steps: Vec<StepFile>,
}

/// One step of working with the scenario.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepFile {
    /// What the student does here.
    pub kind: StepKind,
    /// What to do, in Markdown.
    pub text: String,
}

/// The four steps of a lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StepKind {
    /// Commit to an expectation before the run.
    Predict,
    /// Run the scenario.
    Run,
    /// Compare with the expectation.
    Check,
    /// Say why.
    Explain,
}

/// `exercise.toml`: the questions. Never leaves the server.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExerciseFile {
    /// Share of the points that passes the lesson, above 0 and up to 1.
    pub pass_mark: f64,
    /// Numbers that are drawn for each student. Texts show one as `{{name}}`, values use it as a symbol.
    #[serde(default)]
    pub parameters: BTreeMap<String, ParameterFile>,
    /// Where the drawn numbers enter the scenario.
    #[serde(default)]
    pub scene: Vec<PatchFile>,
    /// When the right answers and their sources are told. Without it, never.
    #[serde(default)]
    pub opens: OpensFile,
    /// The questions, in order.
    #[serde(rename = "question")]
    pub questions: Vec<QuestionFile>,
}

/// When the right answers are told, with the verdict: whichever comes first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpensFile {
    /// To a student who has passed the lesson.
    #[serde(default)]
    pub passed: bool,
    /// To a student who has handed in so often, passed or not.
    #[serde(default)]
    pub attempts: Option<usize>,
}

/// A number that is drawn for each student from `from`, `from + step`, … up to `to`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterFile {
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// Distance between values.
    pub step: f64,
    /// The value where no student is known, and in the text of the lesson.
    pub default: f64,
}

/// A place of the scenario that takes a drawn number.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchFile {
    /// JSON pointer of a number in scene.json, such as `/bodies/0/mass`.
    pub pointer: String,
    /// Expression in the parameters.
    pub value: String,
}

/// Kind of a question.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum QuestionKind {
    /// One number with a unit.
    Number,
    /// A list of components in a stated frame, judged by its norm.
    Vector,
    /// Rows of numbers, judged by the norm of all entries.
    Matrix,
    /// One of several options.
    Choice,
    /// An expression in named symbols, compared at random points.
    Formula,
    /// The equations at dealt states, from the student's own program.
    Implement,
    /// A table of a motion, from any program.
    Trajectory,
    /// A scene that the student writes.
    Model,
    /// Settings of a run under a budget.
    Tuning,
}

/// One question. Which keys it needs depends on its kind.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuestionFile {
    /// Name of the question, unique in the lesson: small letters, digits and dashes.
    pub id: String,
    /// Kind.
    pub kind: QuestionKind,
    /// What is asked, in Markdown.
    pub prompt: String,
    /// Points.
    pub points: f64,
    /// Hints, given one at a time.
    pub hints: Vec<String>,
    /// Said when the answer is right: why it is so.
    #[serde(default)]
    pub right: String,
    /// Unit of the reference (number, vector, matrix); empty for a pure number.
    pub unit: Option<String>,
    /// The student has to find the unit: it is not shown, and a part of the points is for it.
    #[serde(default)]
    pub asks_unit: bool,
    /// Frame of the components, as words that fit "Components in …" (vector, matrix).
    pub frame: Option<String>,
    /// How close is close enough (number, vector, matrix).
    pub tolerance: Option<ToleranceFile>,
    /// Wrong answers that are recognised.
    #[serde(default, rename = "misconception")]
    pub misconceptions: Vec<MisconceptionFile>,
    /// Options (choice).
    #[serde(default, rename = "option")]
    pub options: Vec<OptionFile>,
    /// Symbols of the formula and the range from which each is drawn for the comparison (formula).
    #[serde(default)]
    pub symbols: BTreeMap<String, [f64; 2]>,
    /// A wrong earlier answer is carried through (number, vector, matrix).
    pub follows: Option<FollowFile>,
    /// What the student's program evaluates (implement).
    pub implement: Option<ImplementFile>,
    /// What the table holds (trajectory).
    pub trajectory: Option<TrajectoryFile>,
    /// What the scene must do (model).
    pub model: Option<ModelFile>,
    /// What may be chosen, and the budget (tuning).
    pub tuning: Option<TuningFile>,
}

/// How close is close enough.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToleranceFile {
    /// Share of the reference's size.
    #[serde(default)]
    pub relative: f64,
    /// Fixed part, in the question's unit.
    #[serde(default)]
    pub absolute: f64,
    /// Only the exact number counts.
    #[serde(default)]
    pub exact: bool,
}

/// A slip of thought and the answer it leads to.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MisconceptionFile {
    /// Name, unique in the question.
    pub id: String,
    /// The answer it leads to, in the question's unit.
    pub value: Option<Entry>,
    /// In its place: a wrong model that the engine runs. The question must be `measured`.
    pub model: Option<WrongModelFile>,
    /// What to tell the student, in Markdown: the slip, not the answer.
    pub feedback: String,
}

/// One option of a choice.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OptionFile {
    /// Letter or name.
    pub id: String,
    /// The option, in Markdown.
    pub text: String,
    /// Why it is right or wrong, shown to who chose it, in Markdown.
    pub reason: String,
}

/// `reference/answers.toml`: the answer to one question and where it comes from. Never leaves the server.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceFile {
    /// Number or expression, list of these, formula, or the id of the right option. Not for `engine`, nor where the
    /// question is answered by work.
    pub value: Option<Entry>,
    /// Settings that meet the demand (tuning).
    pub settings: Option<Settings>,
    /// Bound on the reference's own error, in the question's unit. Needed for numbers.
    #[serde(default)]
    pub error: f64,
    /// What kind of source it is.
    pub provenance: ProvenanceKind,
    /// The source in words: the derivation, the publication, the independent program.
    pub source: String,
    /// Where the scenario shows the same value; the check runs the scene and compares.
    #[serde(default)]
    pub measured: Option<MeasuredFile>,
}

/// Where the scenario shows a value: a count, the energy, a body's motion or a joint's reaction.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredFile {
    /// Time, s.
    #[serde(default)]
    pub time: f64,
    /// A count of the whole scene.
    pub count: Option<CountKind>,
    /// The energy of the whole scene, J.
    #[serde(default)]
    pub energy: bool,
    /// A body, with `motion`.
    pub body: Option<String>,
    /// What of the body, in the ground frame.
    pub motion: Option<MotionKind>,
    /// With position or velocity: a point other than the centre of mass, by its lengths along u, v, w from there, m.
    pub point: Option<[f64; 3]>,
    /// A joint, with `force_on` or `moment_on`.
    pub joint: Option<String>,
    /// The body, or `ground`, on which the joint's force acts.
    pub force_on: Option<String>,
    /// The body, or `ground`, on which the joint's moment about its point acts.
    pub moment_on: Option<String>,
    /// One component or the size instead of the whole vector.
    pub component: Option<Component>,
}

/// A count of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CountKind {
    /// Coordinates less rank.
    DegreesOfFreedom,
    /// Independent rows.
    Rank,
    /// All rows.
    Rows,
    /// All coordinates.
    Coordinates,
    /// Entries in the pattern of the Jacobian.
    JacobianEntries,
}

/// What of a body's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MotionKind {
    /// Position of the centre of mass.
    Position,
    /// Velocity of the centre of mass.
    Velocity,
    /// Angular velocity.
    AngularVelocity,
    /// Director u.
    U,
    /// Director v.
    V,
    /// Director w.
    W,
}

/// A component of a vector, or its size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// The length of the vector.
    Size,
}

/// Where a reference comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProvenanceKind {
    /// Derived on paper; the derivation is in the source.
    ClosedForm,
    /// Printed or published by somebody else.
    Published,
    /// Computed by a program that shares no code with this engine.
    Independent,
    /// Computed by this engine from `measured`, with an error estimate from a second run; for what has no closed form.
    Engine,
    /// A definition or an argument (for choices).
    Argument,
}

/// `wrong/NAME.toml`: what a student with a misconception sends, and what must be recognised.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WrongFile {
    /// The thought behind it.
    pub about: String,
    /// The answers that are wrong; all other questions are answered by the reference.
    pub answers: BTreeMap<String, Answer>,
    /// For each of these answers the misconception, or the option, whose feedback must come.
    pub expect: BTreeMap<String, String>,
}
