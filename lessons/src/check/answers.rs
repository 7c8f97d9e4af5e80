//! Trying out the answers: blank ones, the references, the wrong ones.

use std::collections::BTreeSet;

use thiserror::Error;

use super::findings::Findings;
use super::references::{judged, quantity_answer, reference_submission};
use crate::answers::{Answer, Submission, TypedValue, number};
use crate::exercise::{Question, QuestionBody};
use crate::files::WrongFile;
use crate::grading::{grade, judge};
use crate::lesson::Lesson;
use crate::text::plain;
use crate::verdict::Mark;
use crate::verdict::feedback::Judgement;

/// A student who fills in nothing must not pass.
pub(super) fn blank_fails(found: &mut Findings) {
    match grade(found.lesson, &Submission::default()) {
        Ok(verdict) if !verdict.passed && verdict.earned == 0.0 && verdict.possible > 0.0 => {}
        Ok(_) => found.add(
            "exercise.toml",
            0,
            "a blank submission earns points or passes",
            "check points and pass_mark",
        ),
        Err(error) => found.add("exercise.toml", 0, error.to_string(), "correct it"),
    }
    if !(found.lesson.exercise.pass_mark > 0.0 && found.lesson.exercise.pass_mark <= 1.0) {
        found.add("exercise.toml", 0, "pass_mark is not above 0 and up to 1", "write pass_mark = 0.7");
    }
}

/// The references must pass.
pub(super) fn reference_passes(found: &mut Findings) {
    let Ok(verdict) = grade(found.lesson, &reference_submission(found.lesson)) else { return };
    for question in verdict.questions.iter().filter(|q| !matches!(q.verdict, Mark::Right | Mark::Kept)) {
        let what = format!("its own reference is judged {:?}", question.verdict);
        found.question(&question.id, what, "compare reference/answers.toml with the question");
    }
    if !verdict.passed {
        found.add("reference/answers.toml", 0, "the reference does not pass the lesson", "correct it");
    }
}

/// Questions and the misconceptions that a wrong answer has shown.
type Shown = BTreeSet<(String, String)>;

/// Every wrong answer must fail with its own feedback, and every misconception must be shown by one.
pub(super) fn wrong_answers_fail(found: &mut Findings) {
    let lesson = found.lesson;
    let mut shown = Shown::new();
    for (name, wrong) in &lesson.wrong {
        wrong_answer_fails(name, wrong, &mut shown, found);
    }
    for question in &lesson.exercise.questions {
        // The engine computes these answers, so the check sends them itself.
        let QuestionBody::Quantity(q) = &question.body else { continue };
        for m in q.misconceptions.iter().filter(|m| m.computed) {
            let given = judged(lesson, &question.id, quantity_answer(q, &m.value));
            if given.is_some_and(|given| recognised(question, &m.id, &given).is_ok()) {
                shown.insert((question.id.clone(), m.id.clone()));
            }
        }
    }
    for question in &lesson.exercise.questions {
        for name in misconceptions(question) {
            if !shown.contains(&(question.id.clone(), name.to_owned())) {
                let what = format!("no wrong answer shows the misconception {name}");
                found.question(&question.id, what, format!("add wrong/{name}.toml"));
            }
        }
    }
    if lesson.wrong.len() < 2 {
        let remedy = "add one file for each misconception";
        found.add("wrong", 0, "there are fewer than two wrong answers", remedy);
    }
}

/// One file of wrong answers, all other questions being answered by the reference.
fn wrong_answer_fails(name: &str, wrong: &WrongFile, shown: &mut Shown, found: &mut Findings) {
    let lesson = found.lesson;
    if wrong.about.trim().is_empty() {
        found.add(name, 0, "about is empty", "say what the student was thinking");
    }
    if wrong.answers.is_empty() || !wrong.answers.keys().eq(wrong.expect.keys()) {
        found.add(name, 0, "answers and expect do not name the same questions", "add one line for each");
        return;
    }
    let judgements = match judge(lesson, &wrong_submission(lesson, wrong)) {
        Ok(judgements) => judgements,
        Err(error) => return found.add(name, 0, error.to_string(), "correct the id"),
    };
    for (question, given) in lesson.exercise.questions.iter().zip(&judgements) {
        let Some(expected) = wrong.expect.get(&question.id) else { continue };
        match recognised(question, expected, given) {
            Ok(()) => {
                shown.insert((question.id.clone(), expected.clone()));
            }
            Err(complaint) => {
                let leads_to = leads_to(question, expected);
                let what = format!("{}: {complaint}{leads_to}", question.id);
                found.add(name, 0, what, "correct the answer or the feedback");
            }
        }
    }
}

/// The submission that a file of wrong answers stands for: all other questions are answered by the reference.
pub fn wrong_submission(lesson: &Lesson, wrong: &WrongFile) -> Submission {
    let mut submission = reference_submission(lesson);
    for (id, answer) in &wrong.answers {
        let is_number = lesson.question(id).is_some_and(|q| matches!(q.body, QuestionBody::Quantity(_)));
        let answer = if is_number { calculated(lesson, answer) } else { answer.clone() };
        submission.answers.insert(id.clone(), answer);
    }
    submission
}

/// The answer with its expressions in the lesson's parameters evaluated, so that it need not be calculated by hand.
fn calculated(lesson: &Lesson, answer: &Answer) -> Answer {
    fn with_numbers(lesson: &Lesson, value: &TypedValue) -> TypedValue {
        match value {
            // `29.4 m` is in metres, `29.4*m` is a product with the mass.
            TypedValue::Text(text) if text.contains('*') || number::read(text).is_err() => {
                let value = lesson.parameters.eval(text).ok().filter(|value| value.is_finite());
                TypedValue::Text(value.map_or_else(|| text.clone(), |value| format!("{value:.15e}")))
            }
            TypedValue::List(list) => {
                TypedValue::List(list.iter().map(|one| with_numbers(lesson, one)).collect())
            }
            other => other.clone(),
        }
    }
    Answer { value: answer.value.as_ref().map(|value| with_numbers(lesson, value)), ..answer.clone() }
}

/// What a misconception leads to with the numbers of the text, for an author who expected something else.
fn leads_to(question: &Question, misconception: &str) -> String {
    let QuestionBody::Quantity(q) = &question.body else { return String::new() };
    let Some(known) = q.misconceptions.iter().find(|m| m.id == misconception) else { return String::new() };
    let numbers: Vec<String> = known.value.iter().copied().map(plain).collect();
    let unit = q.unit.text();
    match numbers.as_slice() {
        [one] => format!("; {misconception} leads to {one} {unit}"),
        all => format!("; {misconception} leads to ({}) {unit}", all.join(", ")),
    }
}

/// The misconceptions that an author names. Options have reasons; those of work are tried out by the check itself.
fn misconceptions(question: &Question) -> Vec<&str> {
    match &question.body {
        QuestionBody::Quantity(q) => q.misconceptions.iter().map(|m| m.id.as_str()).collect(),
        QuestionBody::Formula(f) => f.misconceptions.iter().map(|(id, ..)| id.as_str()).collect(),
        QuestionBody::Choice { .. }
        | QuestionBody::Diagram(_)
        | QuestionBody::Explanation(_)
        | QuestionBody::Implement(_)
        | QuestionBody::Trajectory(_)
        | QuestionBody::Model(_)
        | QuestionBody::Tuning(_) => Vec::new(),
    }
}

/// Why a wrong answer is not judged as its author expects.
#[derive(Debug, Error)]
enum NotRecognised {
    #[error("the wrong answer is judged {0:?}")]
    Mark(Mark),
    #[error("expected the feedback of {expected}, recognised {got}")]
    Other { expected: String, got: String },
    #[error("the feedback of {0} does not come")]
    NoFeedback(String),
}

/// Whether an answer was judged wrong with the feedback of this misconception.
fn recognised(question: &Question, expected: &str, given: &Judgement) -> Result<(), NotRecognised> {
    if given.mark != Mark::Wrong {
        return Err(NotRecognised::Mark(given.mark));
    }
    if given.misconception.as_deref() != Some(expected) {
        let got = given.misconception.clone().unwrap_or_else(|| "nothing".to_owned());
        return Err(NotRecognised::Other { expected: expected.to_owned(), got });
    }
    let feedback = match &question.body {
        QuestionBody::Quantity(q) => {
            q.misconceptions.iter().find(|m| m.id == expected).map(|m| m.feedback.as_str())
        }
        QuestionBody::Choice { options, .. } => {
            options.iter().find(|o| o.id == expected).map(|o| o.reason.as_str())
        }
        QuestionBody::Formula(f) => {
            f.misconceptions.iter().find(|(id, ..)| id == expected).map(|(.., text)| text.as_str())
        }
        _ => None,
    };
    match feedback {
        Some(_) if given.feedback.authored() != feedback => {
            Err(NotRecognised::NoFeedback(expected.to_owned()))
        }
        _ => Ok(()),
    }
}
