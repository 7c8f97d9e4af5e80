//! How long a lesson takes: what it states, against what its text, its run and its exercise need. Nobody plans with wishes.
//!
//! The rule is plain: so many words and formulas to read, a run to watch, so many questions to answer. Its numbers are set so that
//! lessons that were worked through by hand come out: 28 to 36 minutes for a page and five small questions, 73 to 151 with a program
//! to write, 106 with a scene to write.

use super::findings::Findings;
use crate::exercise::{Question, QuestionBody};
use crate::lesson::Lesson;
use crate::text::words;

/// Words of technical prose read in a minute: half of what is read of a novel.
const WORDS_A_MINUTE: f64 = 130.0;
/// Minutes to follow a displayed equation.
const EQUATION: f64 = 1.2;
/// Minutes for a figure.
const FIGURE: f64 = 0.7;
/// Minutes for predicting, running, checking and explaining the scene, beside what is predicted with buttons.
const RUN: f64 = 6.0;
/// Minutes for a prediction.
const PREDICTION: f64 = 1.0;
/// Share of the minutes by the rule that a lesson states at least.
const STATED: f64 = 0.9;

/// Whether the lesson states too few minutes.
pub(super) fn honest(found: &mut Findings) {
    let (needed, stated) = (needed(found.lesson), f64::from(found.lesson.about.minutes));
    if stated < STATED * needed {
        let what = format!("it states {stated} minutes, and about {needed:.0} are needed");
        found.add("lesson.toml", 0, what, "state what it takes, or shorten text and exercise");
    }
}

/// Minutes for the whole lesson.
pub(crate) fn needed(lesson: &Lesson) -> f64 {
    let [words, equations, figures] = text(lesson);
    let reading = words / WORDS_A_MINUTE + EQUATION * equations + FIGURE * figures;
    reading + RUN + PREDICTION * lesson.about.predictions.len() as f64 + exercise(lesson)
}

/// Minutes for a question.
fn answering(question: &Question) -> f64 {
    let read = words(&question.prompt) as f64 / WORDS_A_MINUTE;
    let worked_out = 2.0 + 0.4 * question.points;
    read + match &question.body {
        QuestionBody::Choice { .. } => 1.5,
        QuestionBody::Quantity(_) => worked_out,
        QuestionBody::Formula(_) => worked_out + 1.0,
        QuestionBody::Diagram(_) | QuestionBody::Explanation(_) => 7.0,
        QuestionBody::Implement(task) => 27.0 + 18.0 * task.asks.len() as f64,
        QuestionBody::Trajectory(_) => 35.0,
        QuestionBody::Model(_) => 60.0,
        QuestionBody::Tuning(_) => 8.0,
    }
}

/// Minutes for the questions that a student is dealt: of a pool, as many average ones as are drawn.
fn exercise(lesson: &Lesson) -> f64 {
    let all = &lesson.exercise.questions;
    let common: f64 = all.iter().filter(|q| q.pool.is_none()).map(answering).sum();
    let dealt = lesson.exercise.draw.iter().map(|(pool, drawn)| {
        let of_pool: Vec<f64> =
            all.iter().filter(|q| q.pool.as_deref() == Some(pool)).map(answering).collect();
        *drawn as f64 * of_pool.iter().sum::<f64>() / of_pool.len().max(1) as f64
    });
    common + dealt.sum::<f64>()
}

/// Words, displayed equations and figures of a lesson's text.
pub(crate) fn text(lesson: &Lesson) -> [f64; 3] {
    let text = lesson.files.get("lesson.md").map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
    let mut prose = String::new();
    for (at, part) in text.split("$$").enumerate() {
        if at % 2 == 0 {
            prose.push_str(part);
        }
    }
    let equations = text.matches("$$").count() / 2;
    [words(&prose), equations, prose.matches("](figures/").count()].map(|n| n as f64)
}
