//! Grading: a submission against a lesson, always with the same result.

mod follow;
mod formula;
mod implement;
mod model;
mod picture;
mod quantity;
mod trajectory;
mod tuning;

use thiserror::Error;

use crate::exercise::{Body, Choice, Question};
use crate::lesson::Lesson;
use crate::markdown::{escape, render_short};
use crate::submission::{Answer, Submission};
use crate::verdict::{Mark, Provenance, QuestionVerdict, Verdict};

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
}

impl GradeError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnknownQuestion { .. } => "unknown-question",
        }
    }
}

/// What is said about one answer before it is put into a verdict.
#[derive(Default)]
pub(crate) struct Outcome {
    mark: Mark,
    /// Share of the points, from 0 to 1.
    share: f64,
    html: String,
    slip: Option<String>,
    /// A picture, as SVG of our own making.
    figure: Option<String>,
}

impl Outcome {
    fn right(note: &str) -> Self {
        Self {
            mark: Mark::Right,
            share: 1.0,
            html: format!("<p>Right.</p>{}", render_short(note)),
            ..Self::default()
        }
    }

    fn wrong(slip: Option<&str>, html: String) -> Self {
        Self { mark: Mark::Wrong, html, slip: slip.map(str::to_owned), ..Self::default() }
    }

    fn invalid(text: &str) -> Self {
        let html = format!("<p>{} No attempt is used.</p>", escape(text));
        Self { mark: Mark::Invalid, html, ..Self::default() }
    }
}

/// Grades a submission.
pub fn grade(lesson: &Lesson, submission: &Submission) -> Result<Verdict, GradeError> {
    let all = &lesson.exercise.questions;
    if let Some(id) = submission.answers.keys().find(|id| lesson.question(id).is_none()) {
        return Err(GradeError::UnknownQuestion {
            lesson: lesson.slug.clone(),
            id: crate::number::shorten(id),
            known: all.iter().map(|q| q.id.as_str()).collect::<Vec<_>>().join(", "),
        });
    }
    let mut questions: Vec<QuestionVerdict> = Vec::with_capacity(all.len());
    for question in all {
        let answer = submission.answers.get(&question.id);
        let mut verdict = judge(lesson, question, answer);
        if verdict.verdict == Mark::Wrong
            && let (Body::Quantity(body), Some(answer)) = (&question.body, answer)
            && let Some(outcome) = follow::judge(lesson, body, &questions, submission, answer)
        {
            verdict = told(question, outcome);
        }
        questions.push(verdict);
    }
    let earned: f64 = questions.iter().map(|q| q.earned).sum();
    let possible: f64 = questions.iter().map(|q| q.possible).sum();
    let gradable = questions.iter().all(|q| q.verdict != Mark::Invalid);
    Ok(Verdict {
        lesson: lesson.slug.clone(),
        student: submission.student.clone(),
        earned,
        possible,
        passed: gradable && earned >= lesson.exercise.pass_mark * possible * (1.0 - 1e-12),
        gradable,
        questions,
        provenance: Provenance {
            engine: triad_engine::VERSION.to_owned(),
            lesson_hash: lesson.hash.clone(),
            seed: lesson.seed.clone(),
            parameters: lesson.parameters.iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        },
    })
}

fn judge(lesson: &Lesson, question: &Question, answer: Option<&Answer>) -> QuestionVerdict {
    let note = &question.right;
    let outcome = match answer {
        None => blank(),
        Some(answer) if answer.is_blank() => blank(),
        Some(answer) => match &question.body {
            Body::Quantity(body) => quantity::judge(body, note, answer),
            Body::Choice { options, right } => choice(options, right, answer),
            Body::Formula(body) => formula::judge(body, &question.id, note, answer),
            Body::Implement(task) => {
                let seed = crate::implement::seed(lesson, &question.id);
                implement::judge(task, &seed, note, answer)
            }
            Body::Trajectory(task) => trajectory::judge(task, note, answer),
            Body::Model(task) => model::judge(task, note, answer),
            Body::Tuning(task) => tuning::judge(task, note, answer),
        },
    };
    told(question, outcome)
}

fn told(question: &Question, outcome: Outcome) -> QuestionVerdict {
    QuestionVerdict {
        id: question.id.clone(),
        earned: outcome.share * question.points,
        possible: question.points,
        verdict: outcome.mark,
        message_html: outcome.html,
        slip: outcome.slip,
        figure_svg: outcome.figure,
        reference_html: None,
    }
}

fn blank() -> Outcome {
    Outcome { mark: Mark::Blank, html: "<p>Not answered.</p>".to_owned(), ..Outcome::default() }
}

fn choice(options: &[Choice], right: &str, answer: &Answer) -> Outcome {
    let Some(id) = answer.choice.as_deref().map(str::trim) else {
        return Outcome::invalid("This question asks for one of its options, not for a value.");
    };
    let Some(option) = options.iter().find(|o| o.id == id) else {
        let known = options.iter().map(|o| o.id.as_str()).collect::<Vec<_>>().join(", ");
        let id = crate::number::shorten(id);
        return Outcome::invalid(&format!("There is no option \u{201c}{id}\u{201d}; choose one of {known}."));
    };
    if option.id == right {
        Outcome::right(&option.reason)
    } else {
        Outcome::wrong(Some(&option.id), format!("<p>Not right.</p>{}", render_short(&option.reason)))
    }
}

/// Whether two formulas are the same, as the grading of this question sees it.
pub(crate) fn same_formula(
    a: &crate::expression::Expression,
    b: &crate::expression::Expression,
    ranges: &[[f64; 2]],
    seed: &str,
) -> bool {
    formula::same(a, b, ranges, seed, 1.0)
}
