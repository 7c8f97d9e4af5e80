//! Words must not send a student to the wrong place: what is said of a count fits a count, what is said of components is true
//! of the components as they were typed, and of accelerations that part is named that went wrong.

use crate::answers::{Answer, TypedValue};
use crate::exercise::{QuantityQuestion, QuestionBody};
use crate::grading::quantity;
use crate::lesson::Lesson;
use crate::mistakes;
use crate::verdict::Mark;
use crate::{Submission, grade, reference_submission};

use super::course;

/// What is recognised in an answer to a question with numbers.
fn code(question: &QuantityQuestion, typed: &[&str]) -> Option<String> {
    let cells = typed.iter().map(|x| TypedValue::Text((*x).to_owned())).collect();
    let answer = Answer {
        value: Some(TypedValue::List(cells)),
        unit: Some(question.unit.text().to_owned()),
        ..Answer::default()
    };
    quantity::judge(question, "", &answer, false).unwrap().misconception
}

fn quantity_of<'a>(lesson: &'a Lesson, id: &str) -> &'a QuantityQuestion {
    match &lesson.question(id).unwrap().body {
        QuestionBody::Quantity(body) => body,
        _ => panic!("{id} asks for no number"),
    }
}

/// Halves, diameters, squares and units are no words for a number of rows.
#[test]
fn no_count_is_told_of_halves_and_units() {
    let never = [
        mistakes::FACTOR_TWO,
        mistakes::SMALL_FACTOR,
        mistakes::PART_TWICE,
        mistakes::FACTOR_MISSING,
        mistakes::POWER,
        mistakes::UPSIDE_DOWN,
    ];
    let mut told = 0;
    for lesson in course().lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Quantity(body) = &question.body else { continue };
            if body.size != [1, 1] || !body.tolerance.is_exact() {
                continue;
            }
            let own = |code: &str| body.misconceptions.iter().any(|m| m.id == code);
            for typed in 0..100 {
                let answer = Answer { value: Some(TypedValue::Text(typed.to_string())), ..Answer::default() };
                let judgement = quantity::judge(body, "", &answer, false).unwrap();
                let Some(code) = judgement.misconception.filter(|code| !own(code)) else { continue };
                told += 1;
                assert!(
                    never.iter().all(|m| m.code != code),
                    "{}.{} {typed}: {code}",
                    lesson.slug,
                    question.id
                );
            }
        }
    }
    assert!(told > 300, "{told}");
}

/// A whole number for a component says what it says; it does not stand for everything that could be rounded to it.
#[test]
fn whole_numbers_are_not_taken_for_other_components() {
    let course = course();
    let turned = quantity_of(course.lesson("reduced-body").unwrap(), "turned");
    assert_ne!(code(turned, &["1", "0", "0"]).as_deref(), Some(mistakes::COMPONENT_ORDER.code));
    let thrown = course.lesson("points-and-vectors").unwrap();
    let velocity = quantity_of(thrown, "corner-velocity");
    assert_ne!(code(velocity, &["0.7", "0.7", "2"]).as_deref(), Some(mistakes::COMPONENT_SIGN.code));
    // Still: sizes in other places are seen, and signs.
    let momentum = quantity_of(course.lesson("generic-rigid-body").unwrap(), "momentum-later");
    assert_eq!(momentum.reference, [1.0, 4.0, 9.0]);
    assert_eq!(code(momentum, &["4", "1", "-9"]).as_deref(), Some(mistakes::COMPONENT_ORDER.code));
    assert_eq!(code(momentum, &["1", "4", "-9"]).as_deref(), Some(mistakes::COMPONENT_SIGN.code));
}

type Matrix = Vec<Vec<f64>>;

/// The first `n` unknowns of a square set of equations, by elimination with row exchanges.
fn solved(mut a: Matrix, mut b: Vec<f64>, n: usize) -> Vec<f64> {
    for k in 0..b.len() {
        let pivot = (k..b.len()).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..b.len()).filter(|i| *i != k) {
            let factor = a[i][k] / a[k][k];
            let row = a[k].clone();
            a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[k];
        }
    }
    (0..n).map(|k| b[k] / a[k][k]).collect()
}

/// The verdict on a program for the reduced body whose rows and γ are changed, and with them its accelerations.
fn told_of_accelerations(spoil: impl Fn(&mut Matrix, &mut Vec<f64>)) -> String {
    let lesson = course().lesson("reduced-body").unwrap().variant("ada").unwrap();
    let mut submission = reference_submission(&lesson);
    let file = submission.answers["program"].file.clone().unwrap();
    let mut answer: serde_json::Value = serde_json::from_str(&file).unwrap();
    for state in answer["states"].as_array_mut().unwrap() {
        let numbers = |x: &serde_json::Value| serde_json::from_value::<Vec<f64>>(x.clone()).unwrap();
        let matrix = |x: &serde_json::Value| serde_json::from_value::<Matrix>(x.clone()).unwrap();
        let (mass, right) = (matrix(&state["mass"]), numbers(&state["acceleration"]));
        let (mut rows, mut gamma) = (matrix(&state["jacobian"]), numbers(&state["gamma"]));
        spoil(&mut rows, &mut gamma);
        let n = mass.len();
        let mut all = vec![vec![0.0; n + rows.len()]; n + rows.len()];
        for (k, row) in mass.iter().enumerate() {
            all[k][..n].copy_from_slice(row);
        }
        for (k, row) in rows.iter().enumerate() {
            for (c, x) in row.iter().enumerate() {
                (all[n + k][c], all[c][n + k]) = (*x, *x);
            }
        }
        // Forces that are those of the body but for forces of the rows, which change the multipliers only.
        let forces = mass.iter().map(|row| row.iter().zip(&right).map(|(m, a)| m * a).sum::<f64>());
        let accelerations = solved(all, forces.chain(gamma).collect(), n);
        state["acceleration"] = serde_json::json!(accelerations);
    }
    submission.answers.retain(|id, _| id == "program");
    let program = submission.answers.get_mut("program").unwrap();
    program.file = Some(answer.to_string());
    let verdict =
        grade(&lesson, &Submission { answers: submission.answers, ..Submission::default() }).unwrap();
    let verdict = verdict.questions.into_iter().find(|q| q.id == "program").unwrap();
    assert_eq!(verdict.verdict, Mark::Wrong);
    verdict.message_html
}

#[test]
fn accelerations_name_the_part_that_went_wrong() {
    // The last three rows are those of the joint, whose γ is the term with V̇q̇ alone.
    let sign = told_of_accelerations(|_, gamma| gamma[3..].iter_mut().for_each(|x| *x = -*x));
    assert!(sign.contains("wrong sign in γ") && !sign.contains("stands with a plus"), "{sign}");
    let missing = told_of_accelerations(|_, gamma| gamma[3..].fill(0.0));
    assert!(missing.contains("missing in γ") && !missing.contains("in the forces"), "{missing}");
    let half = told_of_accelerations(|rows, _| rows[..2].iter_mut().flatten().for_each(|x| *x *= 0.5));
    assert!(half.contains("lack their factor 2"), "{half}");
}
