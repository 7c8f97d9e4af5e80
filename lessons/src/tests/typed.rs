//! What is typed, judged by what it means: formulas, vectors and matrices, settings, counts.

use super::tasks::{judgement, lesson, value};
use crate::answers::{Answer, RunSettings, TypedValue};
use crate::exercise::QuestionBody;
use crate::lesson::Lesson;
use crate::{Course, Mark};

#[test]
fn a_formula_that_is_infinite_is_right_nowhere() {
    let course = Course::embedded().unwrap_or_else(|e| panic!("{e}"));
    let mut asked = 0;
    for lesson in course.lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Formula(body) = &question.body else { continue };
            let symbol = &body.symbols[0];
            for text in [
                "1/0",
                "-1/0",
                "0/0",
                "1e400",
                &format!("exp(1e6*{symbol}/{symbol})"),
                &format!("10^400*{symbol}"),
            ] {
                let judged = judgement(lesson, &question.id, value(text));
                assert_ne!(judged.mark, Mark::Right, "{} {}: {text}", lesson.slug, question.id);
            }
            asked += 1;
        }
    }
    assert!(asked >= 10, "{asked} formulas");
}

#[test]
fn a_vector_has_its_factor_and_a_matrix_its_transposition() {
    let force = lesson("simple-pendulum");
    let mark = |lesson: &Lesson, id: &str, text: &str| judgement(lesson, id, value(text)).mark;
    assert_eq!(mark(&force, "force-on-ground", "-(14.2109311, 10.8965368, 0)"), Mark::Right);
    assert_eq!(mark(&force, "force-on-ground", "0.5*(-28.4218622, -10.8965368, 0)"), Mark::Wrong);
    assert_eq!(mark(&force, "force-on-ground", "y=-10.8965368, x=-14.2109311, z=0"), Mark::Right);
    let screw = lesson("screw");
    assert_eq!(mark(&screw, "orientation", "[0 1 0; -1 0 0; 0 0 1]^T"), Mark::Right);
    assert_eq!(mark(&screw, "orientation", "[0 -1 0; 1 0 0; 0 0 1].T"), Mark::Wrong);
    let array = |behind: &str| format!("np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]{behind}");
    for behind in [").T", ", dtype=float).T", ", dtype=float).transpose()", ", dtype=np.dtype(float)).T"] {
        assert_eq!(mark(&screw, "orientation", &array(behind)), Mark::Right, "{behind}");
    }
    assert_eq!(mark(&screw, "orientation", &array(", dtype=float)")), Mark::Wrong);
}

#[test]
fn words_behind_settings_are_no_unit_of_theirs() {
    let lesson = lesson("work-and-precision");
    let settings = |tolerance: &str| {
        let integrator = serde_json::from_value(serde_json::json!("dop853")).unwrap();
        let tolerance = TypedValue::Text(tolerance.to_owned());
        let settings = Some(RunSettings { integrator, tolerance, baumgarte: None });
        judgement(&lesson, "tune", Answer { settings, ..Answer::default() }).mark
    };
    assert_eq!(settings("1e-3"), settings("0.001"));
    assert_ne!(settings("1e-3"), Mark::Invalid);
    for text in ["1e-6 %", "1e-8 apples", "1e-8 to 1e-9", "1e-5 mm"] {
        assert_eq!(settings(text), Mark::Invalid, "{text}");
    }
}

#[test]
fn words_behind_a_count_say_what_is_counted_and_not_how_many() {
    let lesson = lesson("slider-crank");
    let mark = |text: &str| judgement(&lesson, "universal-rows", value(text)).mark;
    for text in ["4", "4 rows", "four", "four rows of the joint", "=> 4"] {
        assert_eq!(mark(text), Mark::Right, "{text}");
    }
    for text in [
        "4 or five",
        "4 minus one",
        "4 / two",
        "4 * two",
        "4 hundred",
        "4 out of six",
        "four or five",
        "4i",
        ">4",
        ">= 4",
        "<= 4",
        "!= 4",
        "0x04",
    ] {
        assert_eq!(mark(text), Mark::Invalid, "{text}");
    }
}
