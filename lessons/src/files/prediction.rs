//! `[[prediction]]` of `lesson.toml`: what students say before they run the scene, and what the run shows then.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::measured::MeasuredFile;
use crate::answers::TypedValue;

/// A question about the run that is answered before it. Which option comes true, and why, never leaves the server before
/// that.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictionFile {
    /// Name, unique in the lesson: small letters, digits and dashes.
    pub id: String,
    /// What will happen?, in Markdown.
    pub text: String,
    /// What may happen.
    #[serde(rename = "option")]
    pub options: Vec<PredictionOptionFile>,
    /// Whether the page also asks, in a sentence, why.
    #[serde(default)]
    pub asks_why: bool,
    /// Points for having predicted, right or wrong. Skipping earns none.
    #[serde(default)]
    pub points: f64,
    /// Parameters of the scene that are set before the run, by name: the page sets them when the prediction is given.
    #[serde(default)]
    pub with: BTreeMap<String, f64>,
    /// Id of the option that comes true.
    pub happens: String,
    /// What the run shows, and why it does, in Markdown.
    pub shows: String,
    /// When the run has shown it, s.
    pub seen_at: f64,
    /// Where the scene shows it; the check runs the scene and looks in whose option's range the value lies.
    pub measured: Option<MeasuredFile>,
}

/// Something that may happen.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictionOptionFile {
    /// Letter or name.
    pub id: String,
    /// What happens, in Markdown: a few words, as they stand on a button.
    pub text: String,
    /// From and to, in SI units, as numbers or expressions in the parameters: what is measured if this comes true.
    pub range: Option<[TypedValue; 2]>,
}
