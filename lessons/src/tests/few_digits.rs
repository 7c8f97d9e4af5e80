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

/// A usual mistake is named only if no other number that may have been rounded to these digits comes from another one, or is near.
#[test]
fn of_few_digits_no_mistake_is_read_that_more_would_not_show() {
    // A rod of 0.98 m: 2.344 s, and four digits are asked for.
    let lesson = course().lesson("simple-pendulum").unwrap().variant("Ada").unwrap();
    let told = |text: &str| {
        let told = verdict(&lesson, &[("period", text)]);
        let question = told.questions.into_iter().find(|question| question.id == "period").unwrap();
        assert_eq!((question.verdict, told.gradable), (Mark::Wrong, true), "{text}");
        (question.misconception, question.message_html)
    };
    for short in ["2.2", "2.7", "2.5", "2", "3"] {
        let (named, message) = told(short);
        assert_eq!(named, None, "{short}: {message}");
        assert!(
            message.contains("so few digits") && message.contains("give at least 4 significant digits"),
            "{message}"
        );
    }
    // The same numbers with all digits are none of these mistakes.
    for whole in ["2.200", "2.500"] {
        assert_eq!(told(whole).0, None, "{whole}");
    }
    // A number of the question, or of the author, stands for itself.
    assert_eq!(told("9.81").0.as_deref(), Some("given-number"));
    // What more digits say is named, with three as well where it is the only one.
    for (text, code) in
        [("4.688", "factor-two"), ("4.69", "factor-two"), ("1.986", "small-swing"), ("1.172", "half-period")]
    {
        assert_eq!(told(text).0.as_deref(), Some(code), "{text}");
    }
}
