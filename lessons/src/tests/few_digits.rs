//! Asking for more digits tells that those are right: only where it costs an attempt to be told so of a wrong number.

use super::course;
use crate::answers::{Answer, TypedValue};
use crate::{Lesson, Mark, Submission, Verdict, grade};

fn lesson() -> Lesson {
    // 2 kg at 60 degrees: the pull is 39.24 N, the speed 4.429 rad/s.
    course().lesson("spherical-joint").unwrap().clone()
}

fn verdict(lesson: &Lesson, answers: &[(&str, &str)]) -> Verdict {
    let typed = |text: &str| Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() };
    let answers = answers.iter().map(|(id, text)| ((*id).to_owned(), typed(text))).collect();
    grade(lesson, &Submission { answers, ..Submission::default() }).unwrap()
}

fn of<'a>(verdict: &'a Verdict, id: &str) -> (Mark, &'a str) {
    let question = verdict.questions.iter().find(|question| question.id == id).unwrap();
    (question.verdict, &question.message_html)
}

#[test]
fn a_number_that_is_right_to_its_few_digits_is_sent_back() {
    let lesson = lesson();
    for right in ["4e1", "39"] {
        let told = verdict(&lesson, &[("pull", right)]);
        let (mark, message) = of(&told, "pull");
        assert!(mark == Mark::Invalid && !told.gradable && message.contains("so few digits"), "{message}");
        assert!(message.contains("No attempt is used."), "{message}");
    }
    // With three digits it is not the rounding that makes it wrong.
    for wrong in ["7e1", "39.5", "12"] {
        assert_eq!(of(&verdict(&lesson, &[("pull", wrong)]), "pull").0, Mark::Wrong, "{wrong}");
    }
}

#[test]
fn beside_what_is_no_attempt_nothing_follows_from_what_is_right() {
    let lesson = lesson();
    let alike = |beside: (&str, &str), id: &str, tried: &[&str]| {
        let told: Vec<Verdict> = tried.iter().map(|text| verdict(&lesson, &[beside, (id, text)])).collect();
        assert!(told.iter().all(|one| !one.gradable && *one == told[0]), "{tried:?}: {told:?}");
        told[0].clone()
    };
    let unreadable = alike(("speed", "abc"), "pull", &["4e1", "7e1", "39.24", "39.5", "12"]);
    assert_eq!((of(&unreadable, "pull").0, of(&unreadable, "speed").0), (Mark::Waiting, Mark::Invalid));
    // What needs more digits is no attempt either.
    let short = alike(("pull", "4e1"), "speed", &["4", "5", "9", "4.4"]);
    assert!(of(&short, "speed").1.contains("so few digits") && of(&short, "pull").0 == Mark::Invalid);
    alike(("speed", "4"), "pull", &["4e1", "7e1", "12"]);
    let whole = alike(("pull", "4e1"), "speed", &["4.429", "4.50", "9.999"]);
    assert_eq!(of(&whole, "speed").0, Mark::Waiting);
}

#[test]
fn where_verdicts_are_held_back_few_digits_are_wrong_and_an_attempt() {
    let held = Lesson { held: true, ..lesson() };
    let told = verdict(&held, &[("pull", "4e1")]);
    let (mark, message) = of(&told, "pull");
    assert!(told.gradable && mark == Mark::Wrong && message.contains("so few digits"), "{message}");
    assert!(!message.contains("No attempt"), "{message}");
    assert_eq!(of(&verdict(&held, &[("pull", "39.24")]), "pull").0, Mark::Right);
    let unreadable = verdict(&held, &[("pull", "4e1"), ("speed", "abc")]);
    assert!(!unreadable.gradable && of(&unreadable, "pull").0 == Mark::Waiting);
}
