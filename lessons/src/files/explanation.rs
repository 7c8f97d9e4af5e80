//! `[question.explanation]`: something to be explained in words.

use schemars::JsonSchema;
use serde::Deserialize;

/// An explanation to hand in: kept for people who judge it, never judged by a program.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExplanationFile {
    /// What it is to show, in a sentence for the student, in Markdown: by it people judge.
    pub purpose: String,
    /// Words from which it is taken.
    pub min_words: usize,
}
