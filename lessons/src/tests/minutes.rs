//! The minutes that a lesson states, against what its text, its run and its exercise take: nobody plans with wishes.
//!
//! The model is plain: so many words and formulas to read, a run to watch, so many questions to answer. Its numbers are set so that
//! lessons that were worked through by hand come out: 28 to 36 minutes for a page and five small questions, 73 to 151 with a program
//! to write, 106 with a scene to write.

use super::course;
use crate::Lesson;
use crate::exercise::{Question, QuestionBody};
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
/// A lesson takes at least and at most so many times what it states: to find a mistake takes longer than to answer a question.
const HONEST: [f64; 2] = [0.55, 1.3];

/// Minutes for a question.
fn answering(question: &Question) -> f64 {
    let read = f64::from(u32::try_from(words(&question.prompt)).unwrap()) / WORDS_A_MINUTE;
    let worked_out = 2.0 + 0.4 * question.points;
    read + match &question.body {
        QuestionBody::Choice { .. } => 1.5,
        QuestionBody::Quantity(_) => worked_out,
        QuestionBody::Formula(_) => worked_out + 1.0,
        QuestionBody::Diagram(_) | QuestionBody::Explanation(_) => 7.0,
        QuestionBody::Implement(task) => 27.0 + 18.0 * f64::from(u32::try_from(task.asks.len()).unwrap()),
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
        let count = |n: usize| f64::from(u32::try_from(n).unwrap());
        count(*drawn) * of_pool.iter().sum::<f64>() / count(of_pool.len())
    });
    common + dealt.sum::<f64>()
}

/// Words, displayed equations and figures of a lesson's text.
fn text(lesson: &Lesson) -> [f64; 3] {
    let text = String::from_utf8_lossy(&lesson.files["lesson.md"]).into_owned();
    let mut prose = String::new();
    for (at, part) in text.split("$$").enumerate() {
        if at % 2 == 0 {
            prose.push_str(part);
        }
    }
    let count = |n: usize| f64::from(u32::try_from(n).unwrap());
    [count(words(&prose)), count(text.matches("$$").count() / 2), count(prose.matches("](figures/").count())]
}

#[test]
fn the_minutes_that_lessons_state_are_honest() {
    let mut dishonest = Vec::new();
    let [mut stated, mut estimated] = [0.0; 2];
    println!("lesson                     words  equations  questions  text  exercise  estimated  stated");
    for lesson in course().lessons() {
        let [words, equations, figures] = text(lesson);
        let reading = words / WORDS_A_MINUTE + EQUATION * equations + FIGURE * figures;
        let predictions = f64::from(u32::try_from(lesson.about.predictions.len()).unwrap());
        let answering = exercise(lesson);
        let minutes = reading + RUN + PREDICTION * predictions + answering;
        let says = f64::from(lesson.about.minutes);
        println!(
            "{:26} {words:5.0} {equations:10.0} {:10} {reading:5.0} {answering:9.0} {minutes:10.0} {says:7.0}",
            lesson.folder,
            lesson.exercise.questions.len()
        );
        if !(HONEST[0]..=HONEST[1]).contains(&(minutes / says)) {
            dishonest.push(format!("{} states {says} minutes, about {minutes:.0} are needed", lesson.folder));
        }
        stated += says;
        estimated += minutes;
    }
    println!("together {:.1} h estimated, {:.1} h stated", estimated / 60.0, stated / 60.0);
    assert!(dishonest.is_empty(), "{dishonest:#?}");
    assert!((0.85..=1.15).contains(&(estimated / stated)), "{estimated} minutes against {stated}");
}
