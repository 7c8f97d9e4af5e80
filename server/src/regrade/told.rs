//! What a preview tells of a regrade.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use crate::policy::Moment;

/// What a regrade would change.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Preview {
    /// Its name, to apply it by.
    pub id: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Submissions that were graded again.
    pub submissions: usize,
    /// How many of them another version of the lesson had graded.
    pub of_other_versions: usize,
    /// How many came out how.
    pub counts: Counts,
    /// People for whom something changes, by name.
    pub people: Vec<PersonChange>,
    /// How many people reach which tenth of the points, before.
    pub histogram_before: Vec<u32>,
    /// The same after.
    pub histogram_after: Vec<u32>,
    /// How long it took, in seconds.
    pub seconds: f64,
}

/// How many submissions came out how.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Counts {
    /// The same in every word.
    pub same: usize,
    /// The same points in other words.
    pub words: usize,
    /// More points.
    pub up: usize,
    /// Fewer points.
    pub down: usize,
    /// Could be judged before or can be now, and not both.
    pub gradable: usize,
    /// Cannot be graded by the new lesson: the verdict of before stays.
    pub failed: usize,
    /// This program differs from the one that graded them, with the same lesson.
    pub program: usize,
}

/// What changes for a person.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PersonChange {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// Points that count, before.
    pub before: f64,
    /// Points that count, after: attempts and lateness counted anew.
    pub after: f64,
    /// Whether the lesson is passed, before and after: with the mark of the lesson that graded, and with the new one.
    pub passed: [bool; 2],
    /// Attempts before and after.
    pub attempts: [u32; 2],
    /// What changes for each submission; those that stay the same are left out.
    pub submissions: Vec<SubmissionChange>,
}

impl PersonChange {
    /// Whether the person loses nothing by it: neither points nor having passed.
    pub fn keeps(&self) -> bool {
        self.after >= self.before && (self.passed[1] || !self.passed[0])
    }
}

/// How a submission comes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Changed {
    /// The same in every word.
    Same,
    /// The same points in other words.
    Words,
    /// More points.
    Up,
    /// Fewer points.
    Down,
    /// Could be judged before or can be now, and not both.
    Gradable,
    /// Cannot be graded by the new lesson.
    Failed,
}

/// What changes for a submission.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SubmissionChange {
    /// The submission.
    pub id: String,
    /// When it came.
    pub at: Moment,
    /// How it comes out.
    pub changed: Changed,
    /// Points of its verdict before.
    pub before: f64,
    /// Points after; left out where it cannot be graded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after: Option<f64>,
    /// Misconceptions by question, where another one is recognised: before and after, empty for none.
    pub misconceptions: BTreeMap<String, [String; 2]>,
    /// What this program says otherwise with the lesson of before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
}
