//! Trying out the numbers that students will be given.

use std::collections::BTreeMap;

use super::copied::{self, Hand};
use super::findings::Findings;
use super::references::{judged, quantity_answer, reference_answer};
use super::{diagram, measured, predictions};
use crate::answers::Submission;
use crate::exercise::{Question, QuestionBody};
use crate::grading::grade;
use crate::lesson::Lesson;
use crate::verdict::Mark;

/// Variants that are graded.
const GRADED: usize = 200;
/// Variants whose scenario is run.
const RUN: usize = 2;
/// Share of the variants in which a misconception must be recognised as itself.
const RECOGNISED: f64 = 0.95;
/// How often a misconception was recognised as itself, of the variants that ask its question.
#[derive(Default)]
struct Recognised {
    as_itself: usize,
    of: usize,
}

/// Every variant must be answerable, and its wrong answers must be recognised.
pub(super) fn all_fit(found: &mut Findings) {
    if found.lesson.parameters.is_empty() && found.lesson.exercise.draw.is_empty() {
        return;
    }
    no_strange_file(found);
    let mut recognised: BTreeMap<(String, String), Recognised> = BTreeMap::new();
    let mut hands = Vec::new();
    for k in 0..GRADED {
        let lesson = match found.lesson.variant(&format!("check-{k}")) {
            Ok(lesson) => lesson,
            Err(error) => return found.add("exercise.toml", 0, error.to_string(), "correct the parameters"),
        };
        let numbers: Vec<String> = lesson.parameters.iter().map(|(n, v)| format!("{n} = {v}")).collect();
        let numbers = numbers.join(", ");
        let reference = reference(&lesson, k < RUN);
        let Ok(verdict) = grade(&lesson, &reference) else { return };
        let answered = |id: &String| reference.answers.contains_key(id);
        if let Some(question) = verdict
            .questions
            .iter()
            .find(|q| answered(&q.id) && !matches!(q.verdict, Mark::Right | Mark::Kept))
        {
            let what = format!("its reference is judged {:?} for {numbers}", question.verdict);
            return found.question(
                &question.id,
                what,
                "write the reference as an expression in the parameters",
            );
        }
        count(&lesson, &mut recognised);
        if k < RUN {
            let mut own = Findings::new(&lesson);
            measured::scene(&mut own);
            predictions::happen(&mut own);
            for question in &lesson.exercise.questions {
                diagram::agrees(question, &mut own);
            }
            for mut fault in own.faults {
                fault.what = format!("{} (with {numbers})", fault.what);
                found.faults.push(fault);
            }
        }
        hands.push(Hand::of(lesson));
    }
    copied::pass_nothing(&hands, found);
    for ((id, name), Recognised { as_itself, of }) in recognised {
        if (as_itself as f64) < RECOGNISED * of as f64 {
            let what = format!("the misconception {name} is recognised in {as_itself} of {of} variants");
            found.question(&id, what, "change its value or the ranges of the parameters");
        }
    }
}

/// Numbers that are drawn for a scene which is not there would be nobody's.
fn no_strange_file(found: &mut Findings) {
    let lesson = found.lesson;
    let files = lesson.sources.exercise.scene.iter().filter_map(|patch| patch.file.as_deref());
    for file in files.filter(|file| !lesson.files.contains_key(*file)) {
        let what = format!("[[scene]] names {file}, which is not there");
        found.add("exercise.toml", 0, what, "correct the name, or leave file away for scene.json");
    }
}

/// The right answers of a variant; those of work, which take seconds, only where they are asked for.
fn reference(lesson: &Lesson, with_work: bool) -> Submission {
    let typed = |q: &&Question| {
        matches!(q.body, QuestionBody::Quantity(_) | QuestionBody::Choice { .. } | QuestionBody::Formula(_))
    };
    let questions = lesson.exercise.questions.iter().filter(|q| with_work || typed(q));
    let answers = questions.map(|q| (q.id.clone(), reference_answer(lesson, q))).collect();
    Submission { answers, ..Submission::default() }
}

/// Sends every misconception's own answer and counts which are recognised as themselves.
fn count(lesson: &Lesson, recognised: &mut BTreeMap<(String, String), Recognised>) {
    for question in &lesson.exercise.questions {
        let QuestionBody::Quantity(q) = &question.body else { continue };
        for m in &q.misconceptions {
            let given = judged(lesson, &question.id, quantity_answer(q, &m.value));
            let same = given.is_some_and(|given| given.misconception.as_ref() == Some(&m.id));
            let key = (question.id.clone(), m.id.clone());
            let count = recognised.entry(key).or_default();
            (count.as_itself, count.of) = (count.as_itself + usize::from(same), count.of + 1);
        }
    }
}
