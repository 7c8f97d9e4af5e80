//! `course.toml` and `lesson.toml`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prediction::PredictionFile;

/// `course.toml`: the course as a whole.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CourseFile {
    /// Version of this file format; 1.
    pub format_version: u32,
    /// Title of the course.
    pub title: String,
    /// Slugs of the lessons that are taken, in the order in which they are taught. Without it all lessons are, by the
    /// numbers of their folders. What is left out can still be opened by its address.
    pub lessons: Option<Vec<String>>,
    /// Whether the lessons that are built into the program can be taken too. A folder of the same slug replaces one.
    #[serde(default)]
    pub built_in: bool,
    /// Notions that students bring along, so that no lesson has to introduce them.
    #[serde(default)]
    pub assumes: Vec<String>,
    /// When the right answer to a question is shown. Without it, never.
    #[serde(default)]
    pub opens: OpensFile,
    /// The parts of the course, in order: headings over its lessons.
    #[serde(default)]
    pub parts: Vec<PartFile>,
}

/// A part of a course: the lessons from one on, to where the next part begins.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartFile {
    /// Title of the part.
    pub title: String,
    /// Slug of its first lesson.
    pub from: String,
}

/// When the right answer to a question and its source are shown to a student, whichever comes first. From then on the points
/// of the question are what they were before.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpensFile {
    /// When it has been answered right.
    #[serde(default)]
    pub right: bool,
    /// After so many different answers to it, right or wrong.
    #[serde(default)]
    pub attempts: Option<usize>,
    /// The same for a choice; it opens at the latest when one option is left.
    #[serde(default)]
    pub choices: Option<usize>,
}

/// `NN-slug/lesson.toml`: what a lesson is about.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LessonFile {
    /// Title.
    pub title: String,
    /// One sentence for the list of lessons.
    pub summary: String,
    /// How long a student needs, in minutes (10 to 180): text, scenario and questions, programs included.
    pub minutes: u32,
    /// What the student can do afterwards; each begins with a verb.
    pub objectives: Vec<String>,
    /// Slugs of the lessons that come before.
    #[serde(default)]
    pub prerequisites: Vec<String>,
    /// Notions that the lesson introduces, each with the words by which a text uses it.
    #[serde(default)]
    pub introduces: BTreeMap<String, Vec<String>>,
    /// Notions of earlier lessons that it builds on.
    #[serde(default)]
    pub needs: Vec<String>,
    /// Predict, run, check, explain.
    #[serde(default, rename = "step")]
    pub steps: Vec<StepFile>,
    /// What has to be predicted before the scenario runs.
    #[serde(default, rename = "prediction")]
    pub predictions: Vec<PredictionFile>,
    /// Why nothing has to be predicted, where that is so.
    #[serde(default)]
    pub unpredicted: String,
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
