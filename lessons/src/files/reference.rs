//! `reference/answers.toml` and `wrong/NAME.toml`: right answers with their sources, and wrong ones.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::measured::MeasuredFile;
use crate::answers::diagram::Arrow;
use crate::answers::{Answer, RunSettings, TypedValue};

/// `reference/answers.toml`: the answer to one question and where it comes from. Never leaves the server.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceFile {
    /// Number or expression, list of these, formula, the id of the right option, or a good explanation. Not for `engine`, nor where the
    /// question is answered by work.
    pub value: Option<TypedValue>,
    /// Settings that meet the demand (tuning).
    pub settings: Option<RunSettings>,
    /// Forces and moments (diagram).
    pub diagram: Option<Vec<Arrow>>,
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
    /// Numbers of the scene that the expressions of this question name, as `g = "-/gravity/1"`; of a formula, what its symbols
    /// stand for in the scene: pointers into `scene.json`, or expressions in the parameters.
    #[serde(default)]
    pub scene: BTreeMap<String, String>,
    /// Whether it speaks of another thing than the scene: its numbers may be those of the scene by chance.
    #[serde(default)]
    pub apart: bool,
    /// The same from another computation, where the scenario does not show it.
    #[serde(default)]
    pub again: Option<AgainFile>,
}

/// A number that was computed twice: a slip in an expression shows where the two do not agree.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AgainFile {
    /// With the default numbers, in the question's unit.
    pub value: TypedValue,
    /// The numbers of a formula's symbols.
    #[serde(default)]
    pub at: BTreeMap<String, f64>,
    /// By what: not the expression of `value` once more.
    pub by: String,
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
