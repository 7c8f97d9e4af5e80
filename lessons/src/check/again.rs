//! Comparing a reference that no scenario shows with what another computation gave.

use std::collections::BTreeMap;

use super::findings::Findings;
use crate::answers::TypedValue;
use crate::answers::tolerance::{ValueShape, distance, norm};
use crate::exercise::{Formula, Parameters, QuantityQuestion, Question, QuestionBody, numbers};
use crate::files::{AgainFile, ProvenanceKind};

/// Part of a question's tolerance within which another computation of its reference agrees.
pub(super) const OF_TOLERANCE: f64 = 0.1;
/// How well a formula and the number that another computation gave for it agree, relative.
const AGREEMENT: f64 = 1e-5;

/// Every number with a tolerance and every formula is measured, or was computed twice.
pub(super) fn all(found: &mut Findings) {
    let lesson = found.lesson;
    for question in &lesson.exercise.questions {
        if question.measured.is_some() || question.provenance == ProvenanceKind::Engine {
            continue;
        }
        match &question.body {
            QuestionBody::Quantity(q) if !q.tolerance.is_exact() => {
                if let Some(again) = second(question, found) {
                    quantity(&question.id, q, again, found);
                }
            }
            QuestionBody::Formula(f) => {
                if let Some(again) = second(question, found) {
                    formula(&question.id, f, again, found);
                }
            }
            _ => {}
        }
    }
}

/// The second computation of a question, with a fault where there is none.
fn second<'a>(question: &Question, found: &mut Findings<'a>) -> Option<&'a AgainFile> {
    let lesson = found.lesson;
    let again = lesson.sources.references.get(&question.id).and_then(|reference| reference.again.as_ref());
    let Some(again) = again else {
        let remedy = "measure it in the scene, or compute it in another way and write again = { value = …, by = \"…\" }";
        found.question(
            &question.id,
            "nothing but its own expression says that its reference is right",
            remedy,
        );
        return None;
    };
    if again.by.trim().len() < 4 {
        found.question(&question.id, "its second computation has no name", "say by what it was computed");
    }
    Some(again)
}

fn quantity(id: &str, q: &QuantityQuestion, again: &AgainFile, found: &mut Findings) {
    match numbers(&again.value, q.shape, &Parameters::default()) {
        Ok(second) if second.values.len() == q.reference.len() => {
            let difference = distance(&second.values, &q.reference);
            if difference > OF_TOLERANCE * q.tolerance.allowed(norm(&q.reference)) {
                let what = format!(
                    "its reference is {:?} with the default numbers, again {:?}",
                    q.reference, second.values
                );
                found.question(id, what, "one of them is wrong: compute both once more");
            }
        }
        _ => found.question(id, "its second value cannot be read", "write numbers, without parameters"),
    }
}

fn formula(id: &str, f: &Formula, again: &AgainFile, found: &mut Findings) {
    let second = numbers(&again.value, ValueShape::Number, &Parameters::default()).ok();
    let second = second.and_then(|second| second.values.first().copied());
    let (Some(first), Some(second)) = (value_at(f, &again.at), second) else {
        let symbols = f.symbols.join(", ");
        let remedy =
            format!("write again = {{ at = {{ … }}, value = …, by = \"…\" }} with numbers for {symbols}");
        return found.question(
            id,
            "its second computation does not say for which numbers it was made",
            remedy,
        );
    };
    if (first - second).abs() > AGREEMENT * second.abs() || matches!(again.value, TypedValue::List(_)) {
        let what = format!("its reference gives {first} for these numbers, again {second}");
        found.question(id, what, "one of them is wrong: compute both once more");
    }
}

/// The value of a formula for numbers of its symbols; none where one is missing or another is named.
pub(super) fn value_at(f: &Formula, at: &BTreeMap<String, f64>) -> Option<f64> {
    let values: Option<Vec<f64>> = f.symbols.iter().map(|symbol| at.get(symbol).copied()).collect();
    (at.len() == f.symbols.len()).then(|| values.map(|values| f.reference.eval(&values)))?
}
