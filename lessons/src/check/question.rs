//! One question as it is written.

use super::findings::Findings;
use super::guessing;
use crate::answers::tolerance::norm;
use crate::exercise::{Formula, QuantityQuestion, Question, QuestionBody};
use crate::files::ProvenanceKind;
use crate::grading::formula::same;

/// Texts, source, tolerance and misconceptions of one question.
pub(super) fn itself(question: &Question, found: &mut Findings) {
    let id = &question.id;
    if question.prompt.trim().is_empty() {
        found.question(id, "its prompt is empty", "ask something");
    }
    if question.hints.is_empty() || question.hints.iter().any(|h| h.trim().is_empty()) {
        found.question(id, "a hint is missing or empty", "give at least one hint that helps without telling");
    }
    if question.source.trim().len() < 12 {
        found.question(
            id,
            "its reference has no source",
            "say in reference/answers.toml where the answer comes from",
        );
    }
    match &question.body {
        QuestionBody::Quantity(q) => quantity(question, q, found),
        QuestionBody::Choice { options, right } => {
            guessing::options(id, options, right, found);
            for option in options.iter().filter(|o| o.reason.trim().is_empty() || o.text.trim().is_empty()) {
                found.question(id, format!("option {} has no text or no reason", option.id), "write both");
            }
        }
        QuestionBody::Formula(f) => formula(id, f, found),
        QuestionBody::Explanation(e) => {
            if e.purpose.trim().is_empty() {
                found.question(
                    id,
                    "its purpose is empty",
                    "say in a sentence what the explanation is to show",
                );
            }
        }
        QuestionBody::Diagram(_)
        | QuestionBody::Implement(_)
        | QuestionBody::Trajectory(_)
        | QuestionBody::Model(_)
        | QuestionBody::Tuning(_) => {}
    }
}

/// A number, vector or matrix.
fn quantity(question: &Question, q: &QuantityQuestion, found: &mut Findings) {
    let id = &question.id;
    if question.provenance == ProvenanceKind::Argument && !q.tolerance.is_exact() {
        found.question(id, "an argument is no source for a measured number", "derive, cite or compute it");
    }
    let allowed = q.tolerance.allowed(norm(&q.reference));
    if !(q.error >= 0.0 && 10.0 * q.error <= allowed) {
        let what = format!("its tolerance is {allowed:e}, its reference error {:e}", q.error);
        found.question(id, what, "a tolerance is at least ten times the error of the reference");
    }
    if q.tolerance.digits().is_some_and(|d| d > 8) {
        found.question(id, "its tolerance asks for more than 8 digits", "widen it");
    }
    for (k, m) in q.misconceptions.iter().enumerate() {
        if q.tolerance.accepts(&m.value, &q.reference) {
            found.question(id, format!("the misconception {} is a right answer", m.id), "change its value");
        }
        for other in &q.misconceptions[..k] {
            if q.tolerance.accepts(&m.value, &other.value) {
                let what = format!("the misconceptions {} and {} cannot be distinguished", other.id, m.id);
                found.question(id, what, "join them or change the numbers");
            }
        }
        if m.feedback.trim().is_empty() {
            found.question(
                id,
                format!("the misconception {} has no feedback", m.id),
                "say where the reasoning goes wrong",
            );
        }
    }
}

/// A formula: no misconception is right, no symbol is idle.
fn formula(id: &str, f: &Formula, found: &mut Findings) {
    for (name, wrong, _) in &f.misconceptions {
        if same(wrong, &f.reference, &f.ranges, id, 1.0) {
            found.question(id, format!("the misconception {name} is a right answer"), "change its value");
        }
    }
    for (k, symbol) in f.symbols.iter().enumerate() {
        if !f.reference.uses(k) && f.misconceptions.iter().all(|(_, wrong, _)| !wrong.uses(k)) {
            found.question(id, format!("nothing uses the symbol {symbol}"), "remove it");
        }
    }
}
