//! The questions of the course by what grading them takes.

use std::collections::BTreeMap;

use triad_lessons::answers::Answer;
use triad_lessons::exercise::QuestionBody;
use triad_lessons::{Lesson, reference_submission};

/// The kinds, the quickest first.
pub const KINDS: [&str; 7] = [
    "number, vector, choice, formula",
    "diagram",
    "program's file",
    "scene",
    "settings of a run",
    "table, right",
    "table, wrong",
];

/// The answers of one submission.
pub type Answers = BTreeMap<String, Answer>;

/// The kind of a question.
fn kind(body: &QuestionBody) -> &'static str {
    match body {
        QuestionBody::Quantity(_)
        | QuestionBody::Choice { .. }
        | QuestionBody::Formula(_)
        | QuestionBody::Explanation(_) => KINDS[0],
        QuestionBody::Diagram(_) => KINDS[1],
        QuestionBody::Implement(_) => KINDS[2],
        QuestionBody::Model(_) => KINDS[3],
        QuestionBody::Tuning(_) => KINDS[4],
        QuestionBody::Trajectory(_) => KINDS[5],
    }
}

/// Whether a question is of this kind.
#[allow(dead_code)] // one of the two measurements asks
pub fn is_of(kind_name: &str, body: &QuestionBody) -> bool {
    kind(body) == if kind_name == KINDS[6] { KINDS[5] } else { kind_name }
}

/// Each question of a lesson by itself, answered rightly, and tables wrongly besides.
pub fn answered(lesson: &Lesson) -> Vec<(&'static str, Answers)> {
    let right = reference_submission(lesson);
    let mut all = Vec::new();
    for question in &lesson.exercise.questions {
        let Some(answer) = right.answers.get(&question.id) else { continue };
        let one = |answer| [(question.id.clone(), answer)].into();
        all.push((kind(&question.body), one(answer.clone())));
        if let (QuestionBody::Trajectory(_), Some(file)) = (&question.body, &answer.file) {
            all.push((KINDS[6], one(Answer { file: Some(shifted(file)), ..answer.clone() })));
        }
    }
    all
}

/// A table whose values, but for the times, are a few parts in a hundred too large.
fn shifted(table: &str) -> String {
    let row = |line: &str| {
        let cell = |(k, cell): (usize, &str)| match cell.trim().parse::<f64>() {
            Ok(value) if k > 0 => (value * 1.03).to_string(),
            _ => cell.to_owned(),
        };
        line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",")
    };
    table.lines().map(row).collect::<Vec<_>>().join("\n")
}
