//! A verdict as it is sent and kept: one for a submission, one for each of its questions.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The outcome of grading a submission. The same submission always gives the same verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Verdict {
    /// Slug of the lesson.
    pub lesson: String,
    /// The student, if the submission names one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub student: Option<String>,
    /// Points earned.
    pub earned: f64,
    /// Points that can be earned.
    pub possible: f64,
    /// Whether the lesson counts as passed: enough points, and nothing left that could not be read.
    pub passed: bool,
    /// False if an answer could not be read or needs more digits: fix it and send again, no attempt is used.
    pub gradable: bool,
    /// The questions in the lesson's order.
    pub questions: Vec<QuestionVerdict>,
    /// What graded it.
    pub provenance: Provenance,
}

impl Verdict {
    /// Adds up the points of the questions and tells whether they pass.
    pub(crate) fn sum(&mut self, pass_mark: f64) {
        self.earned = self.questions.iter().map(|q| q.earned).sum();
        self.possible = self.questions.iter().map(|q| q.possible).sum();
        // The last digits of a sum of points are rounding.
        self.passed = self.gradable && self.earned >= pass_mark * self.possible * (1.0 - 1e-12);
    }
}

/// The outcome for one question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuestionVerdict {
    /// The question's id.
    pub id: String,
    /// Points earned.
    pub earned: f64,
    /// Points that can be earned here: none where people give them.
    pub possible: f64,
    /// Right, wrong, blank, invalid, kept for people to judge, or waiting for an answer that is invalid.
    pub verdict: Mark,
    /// Feedback for the student, as safe HTML.
    pub message_html: String,
    /// The misconception that was recognised; for statistics and for the checks of authors.
    #[serde(rename = "slip", default, skip_serializing_if = "Option::is_none")]
    pub misconception: Option<String>,
    /// A picture of what was computed, as SVG that the grader drew.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure_svg: Option<String>,
    /// What earlier submissions decide, where they are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standing: Option<QuestionStanding>,
    /// The right answer and its source, as safe HTML, where it is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_html: Option<String>,
}

/// Where a student stands with one question after all submissions so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct QuestionStanding {
    /// Answers that said something else than all before.
    pub attempts: usize,
    /// The best points so far; where the answer is open, the best before it opened.
    pub best: f64,
    /// Whether the right answer is shown. The points stay as they were before.
    pub open: bool,
    /// Different answers that are left until the right one is shown, where it opens by their number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<usize>,
}

/// How one answer was judged.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mark {
    /// Full points.
    Right,
    /// Not right; the message says what it can.
    Wrong,
    /// Nothing was filled in.
    #[default]
    Blank,
    /// Could not be judged (unreadable, wrong form, too few digits); no attempt is used.
    Invalid,
    /// Words that are kept for people to judge.
    Kept,
    /// Not judged, since another answer of the submission could not be: a verdict is given on the whole or not at all.
    Waiting,
}

/// What graded a submission, so that a grade can be traced and repeated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of the engine and of the grader.
    pub engine: String,
    /// Fingerprint of every file of the lesson (64-bit FNV-1a, hexadecimal).
    pub lesson_hash: String,
    /// Seed of the numbers and states; empty for those that everybody sees.
    #[serde(default)]
    pub seed: String,
    /// The numbers that were drawn.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
}
