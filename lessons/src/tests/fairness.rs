//! Nothing for nothing: what can be guessed, left undone or copied passes no lesson.

use std::collections::BTreeMap;

use super::course;
use crate::answers::tolerance::ValueShape;
use crate::answers::{Answer, RunSettings, TypedValue};
use crate::check::guessing::{can_be_guessed, lengths};
use crate::exercise::{Question, QuestionBody, numbers};
use crate::files::earlier_value;
use crate::random::SeededRandom;
use crate::{Lesson, Mark, Submission, grade, reference_submission};

/// Submissions that are guessed for each lesson.
const GUESSERS: usize = 300;

/// An answer of somebody who knows nothing: any option, or a whole number of the size that such answers have.
fn guess(question: &Question, random: &mut SeededRandom) -> Option<Answer> {
    let below = |n: usize, random: &mut SeededRandom| (random.unit() * n as f64).floor();
    match &question.body {
        QuestionBody::Choice { options, .. } => {
            let place = below(options.len(), random);
            let option = options.iter().enumerate().find(|(k, _)| *k as f64 == place)?.1;
            Some(Answer { choice: Some(option.id.clone()), ..Answer::default() })
        }
        QuestionBody::Quantity(q) if q.tolerance.is_exact() => {
            let number = TypedValue::Text(below(30, random).to_string());
            Some(Answer { value: Some(number), ..Answer::default() })
        }
        _ => None,
    }
}

fn share(lesson: &Lesson, answers: BTreeMap<String, Answer>) -> (f64, bool) {
    let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).unwrap();
    (verdict.earned / verdict.possible, verdict.passed)
}

#[test]
fn guessing_passes_no_lesson_not_even_with_luck_in_everything() {
    for lesson in course().lessons() {
        let questions = &lesson.exercise.questions;
        let mut best = 0.0f64;
        let mut mean = 0.0;
        for seed in 0..GUESSERS {
            let mut random = SeededRandom::new(&format!("{}/guess/{seed}", lesson.slug));
            let guessed = questions.iter().filter_map(|q| Some((q.id.clone(), guess(q, &mut random)?)));
            let (share, passed) = share(lesson, guessed.collect());
            assert!(!passed, "{}: a guess passes with {share}", lesson.slug);
            best = best.max(share);
            mean += share / GUESSERS as f64;
        }
        let mut luck = reference_submission(lesson).answers;
        luck.retain(|id, _| lesson.question(id).is_some_and(can_be_guessed));
        let (all, passed) = share(lesson, luck);
        assert!(!passed && best <= all + 1e-9, "{}: {all}", lesson.slug);
        assert!(mean < 0.2, "{}: guessing earns {mean} on average", lesson.slug);
    }
}

/// Whoever writes zero first and what follows from it, zero, has not made a step.
#[test]
fn nothing_is_carried_forward_from_zero() {
    let typed = |values: &[f64], shape: ValueShape| match shape {
        ValueShape::Number => TypedValue::Text(format!("{:e}", values[0])),
        _ => TypedValue::List(values.iter().map(|x| TypedValue::Text(format!("{x:e}"))).collect()),
    };
    let mut seen = 0;
    for lesson in course().lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Quantity(q) = &question.body else { continue };
            let Some(follows) = &q.follows else { continue };
            let mut own = lesson.parameters.clone();
            let mut answers = BTreeMap::new();
            for (symbol, from) in &follows.from {
                let (id, _) = earlier_value(from);
                let QuestionBody::Quantity(earlier) = &lesson.question(id).unwrap().body else { continue };
                let value = typed(&vec![0.0; earlier.reference.len()], earlier.shape);
                let unit = Some(earlier.unit.text().to_owned());
                answers.insert(id.to_owned(), Answer { value: Some(value), unit, ..Answer::default() });
                own.add(symbol, 0.0);
            }
            // Also what does not vanish with it, as a weight that is added.
            let Ok(carried) = numbers(&follows.value, q.shape, &own) else { continue };
            let unit = Some(q.unit.text().to_owned());
            let answer = Answer { value: Some(typed(&carried.values, q.shape)), unit, ..Answer::default() };
            answers.insert(question.id.clone(), answer);
            let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).unwrap();
            let judged = verdict.questions.iter().find(|one| one.id == question.id).unwrap();
            assert_eq!(judged.earned, 0.0, "{} {}: {judged:?}", lesson.slug, question.id);
            seen += 1;
        }
    }
    assert!(seen >= 5, "{seen} questions carry something on");
}

#[test]
fn neither_the_length_nor_the_place_of_an_option_tells_that_it_is_right() {
    let course = course();
    let (mut choices, mut longest, mut first) = (0, 0, 0);
    for lesson in course.lessons() {
        for seed in 0..20 {
            let lesson = lesson.variant_in(&format!("student-{seed}"), "secret").unwrap();
            for question in &lesson.exercise.questions {
                let QuestionBody::Choice { options, right } = &question.body else { continue };
                let (own, other) = lengths(options, right);
                choices += 1;
                longest += usize::from(own > other);
                first += usize::from(options[0].id == *right);
            }
        }
    }
    let share = |n: usize| n as f64 / f64::from(choices);
    // By chance one in three or four is right.
    assert!(share(longest) < 0.4, "the longest is right in {}", share(longest));
    assert!((0.2..0.4).contains(&share(first)), "the first is right in {}", share(first));
}

#[test]
fn options_come_in_an_order_of_ones_own_with_ids_that_stay() {
    let course = course();
    let lesson = course.lesson("singular-positions").unwrap();
    let order = |seed: &str| {
        let lesson = lesson.variant(seed).unwrap();
        let QuestionBody::Choice { options, right } = &lesson.question("which-way").unwrap().body else {
            panic!("a choice")
        };
        assert_eq!(right, "a");
        options.iter().map(|o| o.id.clone()).collect::<Vec<_>>()
    };
    let orders: std::collections::BTreeSet<Vec<String>> =
        (0..60).map(|k| order(&format!("student-{k}"))).collect();
    assert!(orders.len() > 15, "of 24 orders: {}", orders.len());
    assert_eq!(order("ada"), order("ada"));
    assert!(orders.iter().all(|o| o.contains(&"a".to_owned()) && o.len() == 4));
}

/// Right numbers in units of another kind: sent back where the unit is shown, half where it is asked; never passed.
#[test]
fn right_numbers_in_wrong_units_pass_nothing() {
    for lesson in course().lessons() {
        let mut submission = reference_submission(lesson);
        let mut changed = 0;
        for (id, answer) in &mut submission.answers {
            let QuestionBody::Quantity(q) = &lesson.question(id).unwrap().body else { continue };
            // Kelvin is the unit of nothing that is asked.
            answer.unit = Some("K".to_owned());
            changed += usize::from(!q.asks_unit);
        }
        let verdict = grade(lesson, &submission).unwrap();
        assert!(!verdict.passed, "{}", lesson.slug);
        assert!(changed == 0 || !verdict.gradable && verdict.earned == 0.0, "{}", lesson.slug);
    }
}

/// A run without any stabilization holds nothing, whatever it costs.
#[test]
fn the_lesson_on_drift_needs_stabilization() {
    let course = course();
    let lesson = course.lesson("drift").unwrap();
    let judged = |tolerance: f64, baumgarte: Option<[f64; 2]>| {
        let integrator = serde_json::from_value(serde_json::json!("dop853")).unwrap();
        let baumgarte = baumgarte.map(|ab| ab.map(TypedValue::Number));
        let settings = RunSettings { integrator, tolerance: TypedValue::Number(tolerance), baumgarte };
        let answer = Answer { settings: Some(settings), ..Answer::default() };
        let answers = BTreeMap::from([("hold-it".to_owned(), answer)]);
        let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).unwrap();
        verdict.questions.into_iter().find(|q| q.id == "hold-it").unwrap()
    };
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let none = judged(tolerance, Some([0.0, 0.0]));
        assert_eq!((none.verdict, none.earned), (Mark::Wrong, 0.0), "{}", none.message_html);
    }
    let drifted = judged(1e-8, Some([0.0, 0.0]));
    assert_eq!(drifted.misconception.as_deref(), Some("drifted"));
    // The bob is where it belongs, and the message says so: it is the joint that has come apart.
    let says = ["not more than the 0.001 that is allowed", "more than the 1e-8 that is allowed"];
    assert!(says.iter().all(|part| drifted.message_html.contains(part)), "{}", drifted.message_html);
    assert_eq!(judged(1e-8, Some([2.0, 2.0])).verdict, Mark::Right);
    assert_eq!(judged(1e-8, None).verdict, Mark::Right);
}
