//! Trying out the questions that a program answers, for many students.

use std::collections::BTreeMap;

use thiserror::Error;

use super::findings::Findings;
use super::references::{file, judged, program_file, reference_answer};
use crate::exercise::{Implement, Question, QuestionBody};
use crate::lesson::{Lesson, VariantError};
use crate::scenario::measure::MeasureError;
use crate::tasks::InstanceError;
use crate::tasks::instances::{Instances, seed};
use crate::tasks::misconceptions::{misconceptions, recognise};
use crate::tasks::starter::Language;
use crate::verdict::Mark;

/// Seeds with which each misconception is tried.
const SEEDS: usize = 200;
/// Seeds whose answers are also written as JSON and CSV and read back.
const ROUND_TRIPS: usize = 3;
/// Share of them in which a misconception must be recognised as itself.
const RECOGNISED: f64 = 0.95;

/// Why a question that is answered by work cannot be tried out, or what it does wrong.
#[derive(Debug, Error)]
pub(super) enum TaskError {
    #[error(transparent)]
    Instance(#[from] InstanceError),
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error(transparent)]
    Variant(#[from] VariantError),
    #[error("the question is gone")]
    Gone,
    #[error("its own reference is judged {mark:?} for the seed {seed}")]
    Reference { mark: Option<Mark>, seed: String },
    #[error("the misconception {name} is recognised as {got:?} with the seed {seed}")]
    Misconception { name: String, got: Option<String>, seed: String },
}

/// Every seed's reference passes, zeros do not, and every one is recognised.
pub(super) fn program(found: &mut Findings, id: &str, task: &Implement) -> Result<(), TaskError> {
    let mut recognised: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for k in 0..SEEDS {
        let lesson = found.lesson.variant(&format!("check-{k}"))?;
        let question = lesson.question(id).ok_or(TaskError::Gone)?;
        let QuestionBody::Implement(own) = &question.body else { return Ok(()) };
        let mut instances = Instances::new(own, &seed(&lesson, id))?;
        for part in &own.asks {
            let right = instances.answers(*part)?;
            let known = misconceptions(own, &mut instances, *part)?;
            for one in &known {
                let got = recognise(&one.grids, &right, &known, own.tolerance);
                let count = recognised.entry(format!("{}-{}", part.key(), one.id)).or_default();
                count[0] += usize::from(got.is_some_and(|got| got.id == one.id));
                count[1] += 1;
            }
        }
        if k < ROUND_TRIPS {
            whole_way(&lesson, question, own, &mut instances)?;
        }
    }
    for (name, [n, of]) in recognised {
        if (n as f64) < RECOGNISED * of as f64 {
            found.question(
                id,
                format!("the misconception {name} is recognised in {n} of {of} cases"),
                "take another mechanism",
            );
        }
    }
    let mut zeros = Instances::new(task, &seed(found.lesson, id))?.all_answers(&task.asks)?;
    zeros.values_mut().flatten().flat_map(|grid| &mut grid.values).for_each(|x| *x = 0.0);
    let starter = judged(found.lesson, id, file(program_file(&zeros, task.states)));
    if starter.is_none_or(|given| given.share > 0.0) {
        found.question(id, "what the starter writes earns points", "ask for something that is not zero");
    }
    if Language::ALL.iter().any(|l| found.lesson.starter(id, *l).is_none_or(|text| text.contains("{{"))) {
        found.question(id, "a starter has an open place", "correct the starters");
    }
    Ok(())
}

/// The reference and every one, sent as a program sends them.
fn whole_way(
    lesson: &Lesson,
    question: &Question,
    task: &Implement,
    instances: &mut Instances,
) -> Result<(), TaskError> {
    let id = &question.id;
    let mark = judged(lesson, id, reference_answer(lesson, question)).map(|given| given.mark);
    if mark != Some(Mark::Right) {
        return Err(TaskError::Reference { mark, seed: lesson.seed.clone() });
    }
    let right = instances.all_answers(&task.asks)?;
    for part in &task.asks {
        for one in misconceptions(task, instances, *part)? {
            let mut parts = right.clone();
            let name = format!("{}-{}", part.key(), one.id);
            parts.insert(*part, one.grids);
            let got = judged(lesson, id, file(program_file(&parts, task.states)))
                .and_then(|given| given.misconception);
            if got.as_deref() != Some(name.as_str()) {
                return Err(TaskError::Misconception { name, got, seed: lesson.seed.clone() });
            }
        }
    }
    Ok(())
}
