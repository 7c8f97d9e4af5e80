//! Trying out the answers: blank ones, the references, the wrong ones.

use std::collections::BTreeSet;

use super::{Found, tasks};
use crate::exercise::{Body, Quantity, Question};
use crate::grade::grade;
use crate::implement::{Deal, seed};
use crate::lesson::Lesson;
use crate::markdown::render_short;
use crate::submission::{Answer, Entry, Submission};
use crate::tolerance::Shape;
use crate::trajectory::reference_csv;
use crate::verdict::{Mark, QuestionVerdict};

/// A student who fills in nothing must not pass.
pub(super) fn starter_fails(found: &mut Found) {
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

/// The answers that must pass.
pub fn reference_submission(lesson: &Lesson) -> Submission {
    let questions = &lesson.exercise.questions;
    let answers = questions.iter().map(|q| (q.id.clone(), reference_answer(lesson, q))).collect();
    Submission { answers, ..Submission::default() }
}

/// The right answer to one question, as a student would send it.
pub(super) fn reference_answer(lesson: &Lesson, question: &Question) -> Answer {
    let file = |text: String| Answer { file: Some(text), ..Answer::default() };
    match &question.body {
        Body::Quantity(q) => Answer {
            value: Some(entry(q, &q.reference)),
            unit: Some(q.unit.text().to_owned()),
            ..Answer::default()
        },
        Body::Choice { right, .. } => Answer { choice: Some(right.clone()), ..Answer::default() },
        Body::Formula(f) => {
            Answer { value: Some(Entry::Text(f.reference_text.clone())), ..Answer::default() }
        }
        Body::Implement(task) => {
            let deal = Deal::new(task, &seed(lesson, &question.id));
            let parts = deal.and_then(|deal| {
                task.asks.iter().map(|part| Ok((*part, deal.answers(*part)?))).collect::<Result<_, String>>()
            });
            // What cannot be dealt is told by the check of the question itself.
            parts.map(|parts| file(tasks::written(&parts, task.states))).unwrap_or_default()
        }
        Body::Trajectory(task) => reference_csv(task, 1000).map(file).unwrap_or_default(),
        Body::Model(task) => file(task.reference.to_json()),
        Body::Tuning(task) => Answer { settings: Some(task.reference.clone()), ..Answer::default() },
    }
}

/// Values of a question's size as a student would send them, with all their digits.
pub(super) fn entry(question: &Quantity, values: &[f64]) -> Entry {
    let number = |x: &f64| Entry::Text(format!("{x:.15e}"));
    let list = |values: &[f64]| Entry::List(values.iter().map(number).collect());
    match question.shape {
        Shape::Number => number(values.first().unwrap_or(&f64::NAN)),
        Shape::Vector => list(values),
        Shape::Matrix => Entry::List(values.chunks(question.size[1].max(1)).map(list).collect()),
    }
}

/// The references must pass.
pub(super) fn reference_passes(found: &mut Found) {
    let Ok(verdict) = grade(found.lesson, &reference_submission(found.lesson)) else { return };
    for question in verdict.questions.iter().filter(|q| q.verdict != Mark::Right) {
        let what = format!("its own reference is judged {:?}", question.verdict);
        found.question(&question.id, what, "compare reference/answers.toml with the question");
    }
    if !verdict.passed {
        found.add("reference/answers.toml", 0, "the reference does not pass the lesson", "correct it");
    }
}

/// Every wrong answer must fail with its own feedback, and every misconception must be shown by one.
pub(super) fn wrong_answers_fail(found: &mut Found) {
    let lesson = found.lesson;
    let mut shown: BTreeSet<(String, String)> = BTreeSet::new();
    for (name, wrong) in &lesson.wrong {
        if wrong.about.trim().is_empty() {
            found.add(name, 0, "about is empty", "say what the student was thinking");
        }
        if wrong.answers.is_empty() || !wrong.answers.keys().eq(wrong.expect.keys()) {
            found.add(name, 0, "answers and expect do not name the same questions", "add one line for each");
            continue;
        }
        let mut submission = reference_submission(lesson);
        submission.answers.extend(wrong.answers.clone());
        let verdict = match grade(lesson, &submission) {
            Ok(verdict) => verdict,
            Err(error) => {
                found.add(name, 0, error.to_string(), "correct the id");
                continue;
            }
        };
        for (id, slip) in &wrong.expect {
            let Some(given) = verdict.questions.iter().find(|q| q.id == *id) else { continue };
            match recognised(lesson.question(id), slip, given) {
                Ok(()) => {
                    shown.insert((id.clone(), slip.clone()));
                }
                Err(what) => {
                    found.add(name, 0, format!("{id}: {what}"), "correct the answer or the feedback");
                }
            }
        }
    }
    for question in &lesson.exercise.questions {
        // The engine computes these answers, so the check sends them itself.
        let Body::Quantity(q) = &question.body else { continue };
        for m in q.misconceptions.iter().filter(|m| m.computed) {
            let unit = Some(q.unit.text().to_owned());
            let answer = Answer { value: Some(entry(q, &m.value)), unit, ..Answer::default() };
            let given = tasks::judged(lesson, &question.id, answer);
            if given.is_some_and(|given| recognised(Some(question), &m.id, &given).is_ok()) {
                shown.insert((question.id.clone(), m.id.clone()));
            }
        }
    }
    for question in &lesson.exercise.questions {
        let names: Vec<&String> = match &question.body {
            Body::Quantity(q) => q.misconceptions.iter().map(|m| &m.id).collect(),
            Body::Formula(f) => f.misconceptions.iter().map(|(id, ..)| id).collect(),
            // Options have reasons; the slips of work are made up and tried out by the check itself.
            Body::Choice { .. }
            | Body::Implement(_)
            | Body::Trajectory(_)
            | Body::Model(_)
            | Body::Tuning(_) => Vec::new(),
        };
        for name in names.into_iter().filter(|n| !shown.contains(&(question.id.clone(), (*n).clone()))) {
            let what = format!("no wrong answer shows the misconception {name}");
            found.question(&question.id, what, format!("add wrong/{name}.toml"));
        }
    }
    if lesson.wrong.len() < 2 {
        found.add(
            "wrong",
            0,
            "there are fewer than two wrong answers",
            "add one file for each misconception",
        );
    }
}

/// Whether an answer was judged wrong with the feedback of this slip.
fn recognised(question: Option<&Question>, slip: &str, given: &QuestionVerdict) -> Result<(), String> {
    if given.verdict != Mark::Wrong {
        return Err(format!("the wrong answer is judged {:?}", given.verdict));
    }
    if given.slip.as_deref() != Some(slip) {
        let got = given.slip.as_deref().unwrap_or("nothing");
        return Err(format!("expected the feedback of {slip}, recognised {got}"));
    }
    let feedback = match question.map(|q| &q.body) {
        Some(Body::Quantity(q)) => q.misconceptions.iter().find(|m| m.id == slip).map(|m| &m.feedback),
        Some(Body::Choice { options, .. }) => options.iter().find(|o| o.id == slip).map(|o| &o.reason),
        Some(Body::Formula(f)) => f.misconceptions.iter().find(|(id, ..)| id == slip).map(|(.., text)| text),
        _ => None,
    };
    match feedback {
        Some(text) if !given.message_html.contains(&render_short(text)) => {
            Err(format!("the feedback of {slip} does not come"))
        }
        _ => Ok(()),
    }
}
