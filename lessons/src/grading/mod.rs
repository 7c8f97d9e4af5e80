//! Grading: a submission against a lesson, always with the same result. What is said is data; the verdict's HTML is made
//! of it in one place.

pub(crate) mod closed;
mod diagram;
mod explanation;
mod follow;
pub(crate) mod formula;
mod known;
mod model;
mod picture;
mod program;
pub(crate) mod quantity;
mod reading;
pub(crate) mod same;
mod trajectory;
mod tuning;

use schemars::JsonSchema;
use serde::Serialize;
use thiserror::Error;
use triad_engine::analysis::Wanted;

use self::known::Asked;
pub use self::known::{Computed, Known};
pub use self::trajectory::AskedTable;
use crate::answers::{Answer, Submission};
use crate::exercise::{Question, QuestionBody};
use crate::lesson::Lesson;
use crate::tasks::instances;
use crate::text::shorten;
use crate::verdict::feedback::Judgement;
use crate::verdict::{Mark, Provenance, QuestionVerdict, Verdict, html};

/// How a typed answer is understood.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Understood {
    /// The answer as it is read: `29.4 N`, `(1, 2, 3) kg m/s`, `m·g·cos(alpha)`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// What to change so that it can be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// The entries of a vector or a matrix that stood in one text, row by row.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cells: Vec<String>,
}

/// Why a submission cannot be graded as a whole.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GradeError {
    /// An answer to a question that the lesson does not ask.
    #[error("answers.{id}: lesson {lesson} has no question {id}; its questions are {known}")]
    UnknownQuestion {
        /// Slug of the lesson.
        lesson: String,
        /// The id as sent.
        id: String,
        /// The ids of the lesson.
        known: String,
    },
    /// Nobody waits for the verdict any more.
    #[error("nobody waits for the verdict any more")]
    NoLongerWanted,
}

impl GradeError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnknownQuestion { .. } => "unknown-question",
            Self::NoLongerWanted => "no-longer-wanted",
        }
    }
}

/// Grades a submission.
///
/// Errors if it answers a question that does not exist.
pub fn grade(lesson: &Lesson, submission: &Submission) -> Result<Verdict, GradeError> {
    grade_while(lesson, submission, &Known::default(), &Wanted::default())
}

/// As [`grade`], by what is known, as long as the verdict is wanted.
///
/// Errors as [`grade`] does, and where it is no longer wanted.
pub fn grade_while(
    lesson: &Lesson,
    submission: &Submission,
    known: &Known,
    wanted: &Wanted,
) -> Result<Verdict, GradeError> {
    let mut judgements = judge_while(lesson, submission, known, wanted)?;
    hide(lesson, submission, &mut judgements);
    let questions: Vec<QuestionVerdict> =
        lesson.exercise.questions.iter().zip(judgements).map(|(q, j)| sent(q, j)).collect();
    let gradable = questions.iter().all(|q| q.verdict != Mark::Invalid);
    let mut verdict = Verdict {
        lesson: lesson.slug.clone(),
        student: submission.student.clone(),
        earned: 0.0,
        possible: 0.0,
        passed: false,
        gradable,
        questions,
        provenance: Provenance {
            engine: triad_engine::VERSION.to_owned(),
            lesson_hash: lesson.hash.clone(),
            seed: lesson.seed.clone(),
            parameters: lesson.parameters.iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        },
    };
    verdict.sum(lesson.exercise.pass_mark);
    Ok(verdict)
}

/// Takes out of what is no attempt all that tells what is right: nobody tries answers one by one beside a field that cannot be
/// read, nor beside a number that needs more digits.
fn hide(lesson: &Lesson, submission: &Submission, judgements: &mut [Judgement]) {
    if judgements.iter().all(|judgement| judgement.mark != Mark::Invalid) {
        return;
    }
    let reads = judgements.iter().all(|j| j.mark != Mark::Invalid || j.asks_for_digits());
    let told = lesson.exercise.questions.iter().zip(judgements);
    for (question, judgement) in told.filter(|(_, judgement)| judgement.mark != Mark::Blank) {
        if judgement.mark == Mark::Invalid && (reads || !judgement.asks_for_digits()) {
            continue;
        }
        let short = match (&question.body, submission.answers.get(&question.id)) {
            (QuestionBody::Quantity(body), Some(answer)) if reads => quantity::more_digits(body, answer),
            _ => None,
        };
        *judgement = short.map_or_else(Judgement::waiting, |why| Judgement::invalid(why.into()));
    }
}

/// Whether a submission answers only what the lesson asks: it can be graded.
///
/// Errors if it answers a question that does not exist.
pub fn asked(lesson: &Lesson, submission: &Submission) -> Result<(), GradeError> {
    match submission.answers.keys().find(|id| lesson.question(id).is_none()) {
        None => Ok(()),
        Some(id) => Err(GradeError::UnknownQuestion {
            lesson: lesson.slug.clone(),
            id: shorten(id),
            known: lesson.exercise.questions.iter().map(|q| q.id.as_str()).collect::<Vec<_>>().join(", "),
        }),
    }
}

/// Judges every question of the lesson, in order.
pub(crate) fn judge(lesson: &Lesson, submission: &Submission) -> Result<Vec<Judgement>, GradeError> {
    judge_while(lesson, submission, &Known::default(), &Wanted::default())
}

/// As [`judge`], by what is known, as long as that is wanted.
fn judge_while(
    lesson: &Lesson,
    submission: &Submission,
    known: &Known,
    wanted: &Wanted,
) -> Result<Vec<Judgement>, GradeError> {
    let all = &lesson.exercise.questions;
    asked(lesson, submission)?;
    let mut judgements: Vec<Judgement> = Vec::with_capacity(all.len());
    for question in all {
        let answer = submission.answers.get(&question.id).filter(|answer| !answer.is_blank());
        let mut judgement =
            answer.map_or_else(Judgement::blank, |a| judge_answer(lesson, question, a, known, wanted));
        // What ended early is no judgement.
        if !wanted.is_still() {
            return Err(GradeError::NoLongerWanted);
        }
        if judgement.mark == Mark::Wrong
            && let (QuestionBody::Quantity(body), Some(answer)) = (&question.body, answer)
            && let Some(carried) = follow::judge(lesson, body, &judgements, submission, answer)
        {
            judgement = carried;
        }
        judgements.push(judgement);
    }
    Ok(judgements)
}

/// How many tolerances an answer lies from the right one: at most 1 where it is right. None where it cannot be read, or the
/// question is answered by no numbers, or only by exact ones.
pub fn near(lesson: &Lesson, question: &str, answer: &Answer) -> Option<f64> {
    match &lesson.question(question)?.body {
        QuestionBody::Quantity(body) => quantity::tolerances(body, answer),
        _ => None,
    }
}

/// How a typed answer is understood, before anything is compared; `None` for a question whose answer is not typed.
pub fn understand(question: &Question, answer: &Answer) -> Option<Understood> {
    reading::understood(question, answer).map(|read| match read {
        Ok(text) => Understood { text: Some(text), problem: None, cells: reading::cells(question, answer) },
        Err(why) => Understood { text: None, problem: Some(why.to_string()), cells: Vec::new() },
    })
}

/// Judges an answer; whatever comes first, where it is not wanted any more.
fn judge_answer(
    lesson: &Lesson,
    question: &Question,
    answer: &Answer,
    known: &Known,
    wanted: &Wanted,
) -> Judgement {
    let note = &question.right;
    let judged = match &question.body {
        QuestionBody::Quantity(body) => quantity::judge(body, note, answer, lesson.held).map_err(Into::into),
        QuestionBody::Choice { options, right } => closed::choice(options, right, answer).map_err(Into::into),
        QuestionBody::Formula(body) => formula::judge(body, &question.id, note, answer).map_err(Into::into),
        QuestionBody::Diagram(task) => diagram::judge(task, note, answer).map_err(Into::into),
        QuestionBody::Explanation(task) => explanation::judge(task, answer).map_err(Into::into),
        QuestionBody::Implement(_) => {
            let seed = instances::seed(lesson, &question.id);
            return judge_work(question, seed, answer, known, wanted);
        }
        QuestionBody::Trajectory(_) | QuestionBody::Model(_) | QuestionBody::Tuning(_) => {
            return judge_work(question, String::new(), answer, known, wanted);
        }
    };
    judged.unwrap_or_else(Judgement::invalid)
}

/// Judges what takes a computation, unless it was judged before; `seed` is that of a program's instances.
fn judge_work(
    question: &Question,
    seed: String,
    answer: &Answer,
    known: &Known,
    wanted: &Wanted,
) -> Judgement {
    let (answer, body) = (answer.clone(), question.body.clone());
    let judge = |Asked { answer, seed, body }: &Asked| {
        let judged = match body {
            QuestionBody::Implement(task) => program::judge(task, seed, answer).map_err(Into::into),
            QuestionBody::Trajectory(task) => {
                trajectory::judge(task, answer, known, wanted).map_err(Into::into)
            }
            QuestionBody::Model(task) => model::judge(task, answer, known, wanted).map_err(Into::into),
            QuestionBody::Tuning(task) => tuning::judge(task, answer, known, wanted).map_err(Into::into),
            _ => Ok(Judgement::blank()),
        };
        judged.unwrap_or_else(Judgement::invalid)
    };
    // An author's other words change no judgement.
    known.judgements.of(Asked { answer, seed, body }, wanted, judge).with_note(&question.right)
}

/// A judgement as it is sent and kept.
fn sent(question: &Question, judgement: Judgement) -> QuestionVerdict {
    QuestionVerdict {
        id: question.id.clone(),
        earned: judgement.share * question.points,
        possible: if question.is_judged_by_people() { 0.0 } else { question.points },
        verdict: judgement.mark,
        message_html: html::message(&judgement.feedback),
        misconception: judgement.misconception,
        figure_svg: judgement.figure,
        standing: None,
        reference_html: None,
    }
}
