//! Follow-through: a right step from a wrong earlier answer.

use super::quantity;
use crate::answers::tolerance::norm;
use crate::answers::{Answer, Submission};
use crate::exercise::{QuantityQuestion, QuestionBody, numbers};
use crate::files::earlier_value;
use crate::lesson::Lesson;
use crate::verdict::Mark;
use crate::verdict::feedback::{Feedback, Judgement};

/// Factor from which on an earlier answer is no number to calculate with, but one that makes what follows simple: more than units are
/// mistaken by.
const FARTHEST: f64 = 1e4;

/// Judges a wrong answer again with the student's own earlier values; `None` if these were right, do not lead to it, or lead
/// to it without a step: nothing follows from zero and the like, and what a misconception of this question leads to has words of its own.
pub(super) fn judge(
    lesson: &Lesson,
    question: &QuantityQuestion,
    earlier: &[Judgement],
    submission: &Submission,
    answer: &Answer,
) -> Option<Judgement> {
    let follows = question.follows.as_ref()?;
    let mut parameters = lesson.parameters.clone();
    let mut wrong: Vec<usize> = Vec::new();
    for (symbol, name) in &follows.from {
        let (id, component) = earlier_value(name);
        let place = lesson.exercise.questions.iter().position(|q| q.id == *id)?;
        let QuestionBody::Quantity(own) = &lesson.question(id)?.body else { return None };
        let values = match earlier.get(place)?.mark {
            // Of a wrong unit, which costs its share there, the number is carried on.
            Mark::Wrong => {
                wrong.push(place + 1);
                quantity::magnitudes(own, submission.answers.get(id)?)?
            }
            Mark::Right => own.reference.clone(),
            Mark::Blank | Mark::Invalid | Mark::Waiting | Mark::Kept => return None,
        };
        let (size, right) = (norm(&values), norm(&own.reference));
        let far = right > 0.0 && (size > FARTHEST * right || FARTHEST * size < right);
        if size == 0.0 || far {
            return None;
        }
        parameters.add(symbol, *values.get(component.unwrap_or(0))?);
    }
    if wrong.is_empty() {
        return None;
    }
    let given = quantity::values(question, answer)?;
    let is = |wanted: &[f64]| question.tolerance.accepts(&given, wanted);
    let carried = numbers(&follows.value, question.shape, &parameters).ok()?.values;
    if norm(&carried) == 0.0 || !is(&carried) || question.misconceptions.iter().any(|m| is(&m.value)) {
        return None;
    }
    wrong.sort_unstable();
    wrong.dedup();
    let mark = if follows.share >= 1.0 { Mark::Right } else { Mark::Wrong };
    let feedback = Feedback::FollowThrough { questions: wrong };
    Some(Judgement { mark, ..Judgement::wrong(follows.share, Some("follow-through"), feedback) })
}
