//! Explanations: too short is sent back, what is long enough is kept, and no program judges it.

use std::collections::BTreeMap;

use crate::answers::TypedValue;
use crate::text::words;
use crate::{
    Answer, Attempt, Course, Lesson, Mark, Submission, Verdict, grade, reference_submission, standing,
};

const LESSON: &str = "virtual-work";
const ID: &str = "in-words";

fn lesson() -> Lesson {
    Course::embedded().unwrap().lesson(LESSON).unwrap().clone()
}

fn explaining(text: &str) -> Submission {
    let answer = Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() };
    Submission { answers: BTreeMap::from([(ID.to_owned(), answer)]), ..Submission::default() }
}

fn of_it(verdict: &Verdict) -> (Mark, f64) {
    verdict.questions.iter().find(|q| q.id == ID).map(|q| (q.verdict, q.earned)).unwrap()
}

#[test]
fn what_is_too_short_is_sent_back_and_what_is_long_enough_is_kept() {
    let lesson = lesson();
    let short = grade(&lesson, &explaining(&"word ".repeat(39))).unwrap();
    assert_eq!((of_it(&short), short.gradable), ((Mark::Invalid, 0.0), false));
    // Numbers and signs are no words.
    let numbers = grade(&lesson, &explaining(&("word ".repeat(39) + "1 + 2 = 3 … "))).unwrap();
    assert_eq!(of_it(&numbers).0, Mark::Invalid);
    let kept = grade(&lesson, &explaining(&"word ".repeat(40))).unwrap();
    assert_eq!((of_it(&kept), kept.gradable, kept.passed), ((Mark::Kept, 0.0), true, false));
    let long = grade(&lesson, &explaining(&"word ".repeat(2001))).unwrap();
    assert_eq!(of_it(&long).0, Mark::Invalid);
    // Nobody reads the answers of others off a short explanation.
    let mut beside = reference_submission(&lesson);
    beside.answers.extend(explaining("too short").answers);
    let beside = grade(&lesson, &beside).unwrap();
    assert!(beside.questions.iter().all(|q| matches!(q.verdict, Mark::Invalid | Mark::Waiting)));
}

#[test]
fn no_number_of_explanations_opens_anything_and_none_is_lost() {
    let lesson = lesson();
    let tries: Vec<(Submission, Verdict)> = (0..8)
        .map(|k| {
            let submission = explaining(&format!("try{} ", "x".repeat(k)).repeat(40));
            let verdict = grade(&lesson, &submission).unwrap();
            (submission, verdict)
        })
        .collect();
    let attempts: Vec<Attempt> =
        tries.iter().map(|(submission, verdict)| Attempt { answers: &submission.answers, verdict }).collect();
    let place = lesson.exercise.questions.iter().position(|q| q.id == ID).unwrap();
    let stands = standing(&lesson, &attempts)[place];
    assert_eq!((stands.attempts, stands.open, stands.left, stands.best), (8, false, None, 0.0));
}

/// As the page counts them: web/src/exercise/explanation.test.ts has the same.
#[test]
fn words_are_counted_also_where_no_spaces_are_written() {
    assert_eq!(words("  The bar\ndoes no work: 1 + 1 = 2 … "), 5);
    assert_eq!(words("λ größer z. B."), 4);
    assert_eq!(words("因为约束力不做功，所以能量守恒。"), 7);
    assert_eq!(words("ไม่ทำงาน λ ของ Φ 2"), 7);
}
