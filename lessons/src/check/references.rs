//! The right answers as a student would send them, and single answers judged.

use std::collections::BTreeMap;

use serde_json::json;

use crate::answers::tolerance::ValueShape;
use crate::answers::{Answer, Submission, TypedValue};
use crate::exercise::{QuantityQuestion, Question, QuestionBody};
use crate::files::EquationPart;
use crate::grading::judge;
use crate::lesson::Lesson;
use crate::tasks::grid::Grid;
use crate::tasks::instances::{Instances, seed};
use crate::tasks::trajectory::reference_csv;
use crate::verdict::feedback::Judgement;

/// The answers that must pass.
pub fn reference_submission(lesson: &Lesson) -> Submission {
    let questions = &lesson.exercise.questions;
    let answers = questions.iter().map(|q| (q.id.clone(), reference_answer(lesson, q))).collect();
    Submission { answers, ..Submission::default() }
}

/// The right answer to one question, as a student would send it.
pub(super) fn reference_answer(lesson: &Lesson, question: &Question) -> Answer {
    match &question.body {
        QuestionBody::Quantity(q) => quantity_answer(q, &q.reference),
        QuestionBody::Choice { right, .. } => Answer { choice: Some(right.clone()), ..Answer::default() },
        QuestionBody::Formula(f) => {
            Answer { value: Some(TypedValue::Text(f.reference_text.clone())), ..Answer::default() }
        }
        QuestionBody::Diagram(task) => Answer { diagram: Some(task.reference.clone()), ..Answer::default() },
        QuestionBody::Implement(task) => {
            let instances = Instances::new(task, &seed(lesson, &question.id));
            let parts = instances.and_then(|instances| instances.all_answers(&task.asks));
            // Why there are no instances is reported by the check of the question itself.
            parts.map(|parts| file(program_file(&parts, task.states))).unwrap_or_default()
        }
        QuestionBody::Trajectory(task) => reference_csv(task, 1000).map(file).unwrap_or_default(),
        QuestionBody::Model(task) => file(task.reference.to_json()),
        QuestionBody::Explanation(task) => {
            Answer { value: Some(TypedValue::Text(task.example.clone())), ..Answer::default() }
        }
        QuestionBody::Tuning(task) => Answer { settings: Some(task.reference.clone()), ..Answer::default() },
    }
}

/// Values of a question's size as a student would send them, with all their digits.
fn typed_values(question: &QuantityQuestion, values: &[f64]) -> TypedValue {
    let number = |x: &f64| TypedValue::Text(format!("{x:.15e}"));
    let list = |values: &[f64]| TypedValue::List(values.iter().map(number).collect());
    match question.shape {
        ValueShape::Number => number(values.first().unwrap_or(&f64::NAN)),
        ValueShape::Vector => list(values),
        ValueShape::Matrix => TypedValue::List(values.chunks(question.size[1].max(1)).map(list).collect()),
    }
}

/// Values in the question's unit as an answer.
pub(super) fn quantity_answer(question: &QuantityQuestion, values: &[f64]) -> Answer {
    let unit = Some(question.unit.text().to_owned());
    Answer { value: Some(typed_values(question, values)), unit, ..Answer::default() }
}

/// A file as an answer.
pub(super) fn file(text: String) -> Answer {
    Answer { file: Some(text), ..Answer::default() }
}

/// Grids as a program writes them.
pub(super) fn program_file(parts: &BTreeMap<EquationPart, Vec<Grid>>, states: usize) -> String {
    let state = |k: usize| {
        let entry = |(part, grids): (&EquationPart, &Vec<Grid>)| {
            let grid = &grids[k];
            let lines: Vec<&[f64]> = grid.values.chunks(grid.columns.max(1)).collect();
            let value = if grid.columns == 1 { json!(grid.values) } else { json!(lines) };
            (part.key().to_owned(), value)
        };
        parts.iter().map(entry).collect::<serde_json::Map<_, _>>()
    };
    json!({ "states": (0..states).map(state).collect::<Vec<_>>() }).to_string()
}

/// Judges one answer of a lesson, all others being blank.
pub(super) fn judged(lesson: &Lesson, id: &str, answer: Answer) -> Option<Judgement> {
    let answers = BTreeMap::from([(id.to_owned(), answer)]);
    let judgements = judge(lesson, &Submission { answers, ..Submission::default() }).ok()?;
    let place = lesson.exercise.questions.iter().position(|q| q.id == id)?;
    judgements.into_iter().nth(place)
}
