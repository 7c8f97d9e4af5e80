//! Trying out the numbers that students will be given.

use std::collections::BTreeMap;

use super::answers::{entry, reference_submission};
use super::{Found, measured};
use crate::exercise::Body;
use crate::grade::grade;
use crate::lesson::Lesson;
use crate::submission::{Answer, Submission};
use crate::verdict::Mark;

/// Variants that are graded.
const GRADED: usize = 200;
/// Variants whose scenario is run.
const RUN: usize = 2;
/// Share of the variants in which a misconception must be recognised as itself.
const RECOGNISED: f64 = 0.95;

/// Every variant must be answerable, and its wrong answers must be recognised.
pub(super) fn all_fit(found: &mut Found) {
    if found.lesson.parameters.is_empty() {
        return;
    }
    let mut recognised: BTreeMap<(String, String), usize> = BTreeMap::new();
    for k in 0..GRADED {
        let lesson = match found.lesson.variant(&format!("check-{k}")) {
            Ok(lesson) => lesson,
            Err(error) => return found.add("exercise.toml", 0, error.to_string(), "correct the parameters"),
        };
        let numbers: Vec<String> = lesson.parameters.iter().map(|(n, v)| format!("{n} = {v}")).collect();
        let numbers = numbers.join(", ");
        let Ok(verdict) = grade(&lesson, &reference_submission(&lesson)) else { return };
        if let Some(question) = verdict.questions.iter().find(|q| q.verdict != Mark::Right) {
            let what = format!("its reference is judged {:?} for {numbers}", question.verdict);
            return found.question(
                &question.id,
                what,
                "write the reference as an expression in the parameters",
            );
        }
        count(&lesson, &mut recognised);
        if k < RUN {
            let mut own = Found { lesson: &lesson, problems: Vec::new() };
            measured::scene(&mut own);
            for mut problem in own.problems {
                problem.what = format!("{} (with {numbers})", problem.what);
                found.problems.push(problem);
            }
        }
    }
    for ((id, name), n) in recognised {
        if (n as f64) < RECOGNISED * GRADED as f64 {
            let what = format!("the misconception {name} is recognised in {n} of {GRADED} variants");
            found.question(&id, what, "change its value or the ranges of the parameters");
        }
    }
}

/// Sends every misconception's own answer and counts which are recognised as themselves.
fn count(lesson: &Lesson, recognised: &mut BTreeMap<(String, String), usize>) {
    for question in &lesson.exercise.questions {
        let Body::Quantity(q) = &question.body else { continue };
        for m in &q.misconceptions {
            let unit = Some(q.unit.text().to_owned());
            let answer = Answer { value: Some(entry(q, &m.value)), unit, ..Answer::default() };
            let answers = BTreeMap::from([(question.id.clone(), answer)]);
            let verdict = grade(lesson, &Submission { answers, ..Submission::default() });
            let slip = verdict.ok().and_then(|v| v.questions.into_iter().find(|v| v.id == question.id)?.slip);
            let key = (question.id.clone(), m.id.clone());
            *recognised.entry(key).or_default() += usize::from(slip.as_deref() == Some(m.id.as_str()));
        }
    }
}
