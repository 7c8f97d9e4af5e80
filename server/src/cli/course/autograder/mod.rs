//! `triad export`: a lesson with the program that grades it, for systems that run autograders of their own.

mod gradescope;
mod prairielearn;
mod program;

use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use clap::{Args, Subcommand};
use serde_json::json;
use triad_lessons::{Course, Lesson};

use super::lesson::find;
use crate::cli::output::not_standard;
use crate::cli::terminal::{Outcome, counted, print_json, print_line};
use crate::problem::Problem;
use prairielearn::PrairieLearn;

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum Autograder {
    /// Write a lesson as the zip that a programming assignment of Gradescope takes as its autograder.
    ///
    /// Students hand in one file, answers.json: the page of a lesson saves it. What cannot be read costs them nothing: they are
    /// told what to correct, and their last graded submission counts.
    #[command(after_help = "Examples:\n  triad export gradescope simple-pendulum\n  \
        triad --course my-course export gradescope my-lesson --numbers-of-email -o my-lesson.zip")]
    Gradescope {
        #[command(flatten)]
        what: What,
        /// Grade only answers to the numbers of who hands in: students type their e-mail address as their name in Triad.
        #[arg(long)]
        numbers_of_email: bool,
    },
    /// Write a lesson as the folder of a question for PrairieLearn, graded externally in any image of Linux.
    ///
    /// The question shows what is asked and takes one file, answers.json. What cannot be read is not gradable there: it costs no
    /// attempt.
    #[command(
        name = "prairielearn",
        after_help = "Examples:\n  triad export prairielearn simple-pendulum -o my-pl-course/questions/simplePendulum\n  \
        triad export prairielearn screw --variants 50"
    )]
    PrairieLearn {
        #[command(flatten)]
        what: What,
        #[command(flatten)]
        options: PrairieLearn,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct What {
    /// The lesson's slug; see `triad lesson list`.
    lesson: String,
    /// What to make; SLUG-gradescope.zip or SLUG-prairielearn if it is not given.
    #[arg(short, long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// The program that grades, triad-grade for Linux without shared libraries; found beside this one if it is not given.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
}

/// Packs a lesson.
pub(in crate::cli) fn export(what: &Autograder, course: &Course, json: bool) -> Result<Outcome, Problem> {
    let (Autograder::Gradescope { what: common, .. } | Autograder::PrairieLearn { what: common, .. }) = what;
    let lesson = find(course, &common.lesson)?;
    let name = match what {
        Autograder::Gradescope { .. } => format!("{}-gradescope.zip", lesson.slug),
        Autograder::PrairieLearn { .. } => format!("{}-prairielearn", lesson.slug),
    };
    let out = common.out.clone().unwrap_or_else(|| name.into());
    not_standard("-o", &out)?;
    if out.symlink_metadata().is_ok() {
        return Err(Problem::new(
            StatusCode::CONFLICT,
            "file-exists",
            format!("{} is there already", out.display()),
            "nothing is overwritten: remove it, or choose another place with -o",
        ));
    }
    let program = program::find(common.program.as_deref())?;
    let points = points(lesson)?;
    let next = match what {
        Autograder::Gradescope { numbers_of_email, .. } => {
            gradescope::write(lesson, &program, *numbers_of_email, &out)?;
            format!(
                "In Gradescope make a programming assignment with {}, and upload this file as its autograder.",
                counted_points(points)
            )
        }
        Autograder::PrairieLearn { options, .. } => {
            let variants = prairielearn::write(lesson, &program, options, &out)?;
            format!(
                "Put it below questions/ of a course ({}); graded in the image {}.",
                counted(variants, "variant"),
                options.image
            )
        }
    };
    tell(lesson, &out, program.len(), points, &next, json);
    Ok(Outcome::Done)
}

/// What the lesson's questions are worth, for everybody the same.
fn points(lesson: &Lesson) -> Result<f64, Problem> {
    Ok(lesson.of_seed("")?.exercise.questions.iter().map(|question| question.points).sum())
}

fn counted_points(points: f64) -> String {
    if points == 1.0 { "1 point".to_owned() } else { format!("{points} points") }
}

fn tell(lesson: &Lesson, out: &Path, program: usize, points: f64, next: &str, json: bool) {
    if json {
        print_json(
            &json!({"lesson": lesson.slug, "lesson_hash": lesson.hash, "written": out, "points": points, "program_bytes": program}),
        );
        return;
    }
    print_line(&format!(
        "{} holds {} and triad-grade ({:.1} MB).",
        out.display(),
        lesson.slug,
        program as f64 / 1e6
    ));
    print_line(next);
    print_line("It holds the right answers: keep it where students cannot read it.");
}
