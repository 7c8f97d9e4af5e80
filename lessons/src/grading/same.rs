//! Whether two answers say the same: writing a number in another way is no other attempt.

use super::{closed, formula, reading};
use crate::answers::{Answer, TypedValue};
use crate::exercise::{Question, QuestionBody};
use triad_engine::scene::expression::Expression;

/// Whether two answers to a question say the same: numbers within its tolerance, the same option, formulas of the same value,
/// the same arrows, files with the same lines, equal settings. What cannot be read is like nothing else.
pub(crate) fn same(question: &Question, a: &Answer, b: &Answer) -> bool {
    match &question.body {
        QuestionBody::Quantity(q) => match (reading::read(q, a), reading::read(q, b)) {
            (Ok(a), Ok(b)) => {
                let unit = |r: &reading::Reading| r.mismatch.as_ref().map(|unit| unit.dimension);
                unit(&a) == unit(&b) && q.tolerance.accepts(&a.values, &b.values)
            }
            _ => false,
        },
        QuestionBody::Choice { .. } => closed::chosen(a).is_some_and(|id| closed::chosen(b) == Some(id)),
        QuestionBody::Formula(f) => {
            let names: Vec<&str> = f.symbols.iter().map(String::as_str).collect();
            let read = |answer: &Answer| match &answer.value {
                Some(TypedValue::Text(text)) => Expression::parse(text, &names).ok(),
                _ => None,
            };
            read(a).zip(read(b)).is_some_and(|(a, b)| formula::same(&a, &b, &f.ranges, &question.id, 1.0))
        }
        QuestionBody::Diagram(_) => {
            let arrows = |answer: &Answer| {
                let mut arrows = answer.diagram.clone().unwrap_or_default();
                arrows.sort();
                arrows
            };
            arrows(a) == arrows(b)
        }
        QuestionBody::Tuning(_) => a.settings == b.settings,
        QuestionBody::Explanation(_) => a.value == b.value,
        QuestionBody::Implement(_) | QuestionBody::Trajectory(_) | QuestionBody::Model(_) => {
            let lines = |answer: &Answer| {
                answer.file.as_ref().map(|f| f.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
            };
            lines(a) == lines(b)
        }
    }
}
