//! Follow-through: a right step from a wrong earlier answer.

use super::quantity;
use crate::answers::{Answer, Submission};
use crate::exercise::{QuantityQuestion, QuestionBody, numbers};
use crate::lesson::Lesson;
use crate::verdict::Mark;
use crate::verdict::feedback::{Feedback, Judgement};

/// Judges a wrong answer again with the student's own earlier values; `None` if these were right, or do not lead to it.
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
    for (symbol, id) in &follows.from {
        let place = lesson.exercise.questions.iter().position(|q| q.id == *id)?;
        let QuestionBody::Quantity(own) = &lesson.question(id)?.body else { return None };
        let given = submission.answers.get(id).and_then(|a| quantity::values(own, a));
        let value = match (earlier.get(place)?.mark, given) {
            (Mark::Wrong, Some(given)) => {
                wrong.push(place + 1);
                *given.first()?
            }
            (Mark::Right, _) => *own.reference.first()?,
            _ => return None,
        };
        parameters.add(symbol, value);
    }
    if wrong.is_empty() {
        return None;
    }
    let carried = numbers(&follows.value, question.shape, &parameters).ok()?.values;
    // What follows from the wrong value by the right step must not be a misconception that has its own name.
    if !question.tolerance.accepts(&quantity::values(question, answer)?, &carried) {
        return None;
    }
    let mark = if follows.share >= 1.0 { Mark::Right } else { Mark::Wrong };
    let feedback = Feedback::FollowThrough { questions: wrong };
    Some(Judgement { mark, ..Judgement::wrong(follows.share, Some("follow-through"), feedback) })
}
