//! Comparing a reference that no scenario shows with what another computation gave.

use super::findings::Findings;
use crate::answers::tolerance::{distance, norm};
use crate::exercise::{Parameters, QuestionBody, numbers};
use crate::files::ProvenanceKind;

/// Every number with a tolerance is measured, or was computed twice.
pub(super) fn all(found: &mut Findings) {
    let lesson = found.lesson;
    for question in &lesson.exercise.questions {
        let QuestionBody::Quantity(q) = &question.body else { continue };
        let shown = question.measured.is_some() || question.provenance == ProvenanceKind::Engine;
        if shown || q.tolerance.is_exact() {
            continue;
        }
        let id = &question.id;
        let Some(again) = lesson.sources.references.get(id).and_then(|reference| reference.again.as_ref())
        else {
            let remedy = "measure it in the scene, or compute it in another way and write again = { value = …, by = \"…\" }";
            found.question(id, "nothing but its own expression says that its reference is right", remedy);
            continue;
        };
        if again.by.trim().len() < 4 {
            found.question(id, "its second computation has no name", "say by what it was computed");
        }
        match numbers(&again.value, q.shape, &Parameters::default()) {
            Ok(second) if second.values.len() == q.reference.len() => {
                let difference = distance(&second.values, &q.reference);
                if difference > 0.1 * q.tolerance.allowed(norm(&q.reference)) {
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
}
