//! Follow-through: a right step from a wrong earlier answer.

use super::{Outcome, quantity};
use crate::exercise::{Body, Quantity, numbers};
use crate::lesson::Lesson;
use crate::markdown::render_short;
use crate::submission::{Answer, Submission};
use crate::verdict::{Mark, QuestionVerdict};

/// Judges a wrong answer again with the student's own earlier values; `None` if these were right, or do not lead to it.
pub(super) fn judge(
    lesson: &Lesson,
    question: &Quantity,
    earlier: &[QuestionVerdict],
    submission: &Submission,
    answer: &Answer,
) -> Option<Outcome> {
    let follows = question.follows.as_ref()?;
    let mut parameters = lesson.parameters.clone();
    let mut wrong: Vec<usize> = Vec::new();
    for (symbol, id) in &follows.from {
        let place = earlier.iter().position(|v| v.id == *id)?;
        let Body::Quantity(own) = &lesson.question(id)?.body else { return None };
        let given = submission.answers.get(id).and_then(|a| quantity::values(own, a));
        let value = match (earlier[place].verdict, given) {
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
    let (carried, _) = numbers(&follows.value, question.shape, &parameters).ok()?;
    // What follows from the wrong value by the right step must not be a slip that has its own name.
    if !question.rule.accepts(&quantity::values(question, answer)?, &carried) {
        return None;
    }
    let list = wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join(" and ");
    let note = format!(
        "Right with your own answer to question {list}, which is not right: this step is good. When you correct that \
         one, correct this one too."
    );
    Some(Outcome {
        mark: if follows.share >= 1.0 { Mark::Right } else { Mark::Wrong },
        share: follows.share,
        html: render_short(&note),
        slip: Some("follow-through".to_owned()),
        ..Outcome::default()
    })
}
