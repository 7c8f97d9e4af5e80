//! `exercise.toml`: parameters and questions.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::diagram::DiagramFile;
use super::explanation::ExplanationFile;
use super::tasks::{FollowFile, ImplementFile, ModelFile, TrajectoryFile, TuningFile, WrongModelFile};
use crate::answers::TypedValue;

/// `exercise.toml`: the questions. Never leaves the server.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExerciseFile {
    /// Share of the points that passes the lesson, above 0 and up to 1.
    pub pass_mark: f64,
    /// Numbers that are drawn for each student. Texts show one as `{{name}}`, values use it as a symbol.
    #[serde(default)]
    pub parameters: BTreeMap<String, ParameterFile>,
    /// Where the drawn numbers enter the scenario and the other scenes of the lesson.
    #[serde(default)]
    pub scene: Vec<PatchFile>,
    /// How many questions of each pool every student gets.
    #[serde(default)]
    pub draw: BTreeMap<String, usize>,
    /// The questions, in order.
    #[serde(rename = "question")]
    pub questions: Vec<QuestionFile>,
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

/// A place of a scene that takes a drawn number.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchFile {
    /// Another scene of the lesson, such as `reference/model.json`; without it, the scenario.
    pub file: Option<String>,
    /// JSON pointer of a number in that file, such as `/bodies/0/mass`.
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
    /// Forces and moments drawn on a body that is cut free.
    Diagram,
    /// The equations at given states, from the student's own program.
    Implement,
    /// A table of a motion, from any program.
    Trajectory,
    /// A scene that the student writes.
    Model,
    /// Settings of a run under a budget.
    Tuning,
    /// An explanation in words, judged by people.
    Explanation,
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
    /// The pool that it is drawn from; without one, everybody gets it.
    pub pool: Option<String>,
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
    /// Which bodies are cut free (diagram).
    pub diagram: Option<DiagramFile>,
    /// What the student's program evaluates (implement).
    pub implement: Option<ImplementFile>,
    /// What the table holds (trajectory).
    pub trajectory: Option<TrajectoryFile>,
    /// What the scene must do (model).
    pub model: Option<ModelFile>,
    /// What may be chosen, and the budget (tuning).
    pub tuning: Option<TuningFile>,
    /// What is to be explained (explanation).
    pub explanation: Option<ExplanationFile>,
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

/// A misconception and the answer it leads to.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MisconceptionFile {
    /// Name, unique in the question.
    pub id: String,
    /// The answer it leads to, in the question's unit.
    pub value: Option<TypedValue>,
    /// In its place: a wrong model that the engine runs. The question must be `measured`.
    pub model: Option<WrongModelFile>,
    /// What to tell the student, in Markdown: where the reasoning goes wrong, not the answer.
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
    /// Why it is right or wrong, shown to those who chose it, in Markdown.
    pub reason: String,
}
