//! Predictions that an author writes wrongly are found: by the run, and by their form.

use crate::answers::TypedValue;
use crate::check::faults_of_predictions;
use crate::files::PredictionFile;
use crate::{Course, Lesson, check_lesson};

use super::course;

/// Students in whose run, too, what is said to happen does.
const STUDENTS: usize = 40;

/// The check runs two of them.
#[test]
fn what_is_said_to_happen_does_for_everybody() {
    let mut faults = Vec::new();
    for lesson in course().lessons() {
        for k in 0..STUDENTS {
            let own = lesson.variant_in(&format!("student-{k}"), "secret").unwrap();
            faults
                .extend(faults_of_predictions(&own).into_iter().map(|fault| format!("student {k}: {fault}")));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Nothing is run that was not predicted: a lesson that asks for nothing says why.
#[test]
fn a_lesson_without_a_prediction_says_why() {
    let course = course();
    let without: Vec<&str> =
        course.lessons().iter().filter(|l| l.about.predictions.is_empty()).map(|l| l.slug.as_str()).collect();
    assert_eq!(without, ["capstone", "exam"]);
    let about = |change: fn(&mut Lesson)| {
        let mut lesson = course.lesson("exam").unwrap().clone();
        change(&mut lesson);
        let found = check_lesson(&course, &lesson).into_iter().map(|fault| fault.to_string());
        found.filter(|fault| fault.contains("predict")).collect::<Vec<_>>()
    };
    assert_eq!(about(|_| {}), [""; 0]);
    let silent = about(|lesson| lesson.about.unpredicted = " ".to_owned());
    assert!(silent.len() == 1 && silent[0].contains("nothing is predicted"), "{silent:?}");
}

/// What the check says of the pendulum's prediction after a change of it.
fn faults(change: impl Fn(&mut PredictionFile)) -> Vec<String> {
    let course = Course::embedded().unwrap();
    let mut lesson: Lesson = course.lesson("simple-pendulum").unwrap().clone();
    change(&mut lesson.about.predictions[0]);
    let found = check_lesson(&course, &lesson).into_iter().map(|fault| fault.to_string());
    found.filter(|fault| fault.contains("prediction")).collect()
}

#[test]
fn what_does_not_come_true_is_found_by_the_run() {
    assert_eq!(faults(|_| {}), Vec::<String>::new());
    let wrong = faults(|one| one.happens = "two".to_owned());
    // With the lesson's numbers and with those of two students.
    assert!(wrong.len() == 3 && wrong[0].contains("the run shows 29.4"), "{wrong:?}");
    let loose = faults(|one| {
        one.options[1].range = Some([TypedValue::Number(0.0), TypedValue::Text("99*m*9.81".to_owned())]);
    });
    assert!(loose[0].contains("[\"two\", \"three\"]"), "{loose:?}");
}

#[test]
fn what_cannot_be_given_is_found() {
    for (change, expected) in [
        ((|one| one.options.truncate(1)) as fn(&mut PredictionFile), "2 to 6 options"),
        (|one| one.options[1].id = "one".to_owned(), "ids of their own"),
        (|one| one.happens = "four".to_owned(), "no option is called four"),
        (|one| one.options[0].range = None, "measured and ranges"),
        (|one| one.shows = " ".to_owned(), "a text is empty"),
        (|one| one.with.extend([("gravity".to_owned(), 1.0)]), "the run shows"),
        (|one| one.with.extend([("gravitation".to_owned(), 1.0)]), "gravitation"),
        (|one| one.seen_at = 99.0, "ends before seen_at"),
        (|one| one.points = -1.0, "points are negative"),
        (|one| one.id = "Pull".to_owned(), "its id is"),
        (|one| one.measured.as_mut().unwrap().component = None, "a vector is measured"),
        (
            |one| one.measured.as_mut().unwrap().joint = Some("pim".to_owned()),
            "there is no joint or driver pim",
        ),
    ] {
        let found = faults(change);
        assert!(found.iter().any(|fault| fault.contains(expected)), "{expected}: {found:?}");
    }
}
