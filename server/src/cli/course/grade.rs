//! `triad grade`.

use std::path::Path;

use triad_engine::analysis::Wanted;
use triad_lessons::rendering::html::words;
use triad_lessons::{Course, Mark, Verdict};

use super::lesson::find;
use crate::cli::terminal::{Outcome, print_json, print_line};
use crate::problem::Problem;
use crate::variants::Variants;
use crate::{grading, scenes};

/// Largest file with answers, in bytes.
const LARGEST: u64 = 1 << 20;

/// Grades the answers in a file.
pub(in crate::cli) fn grade(
    course: &Course,
    lesson: &str,
    file: &Path,
    json: bool,
) -> Result<Outcome, Problem> {
    let lesson = find(course, lesson)?;
    let text = scenes::read(file, LARGEST)?;
    let (_, verdict) = grading::grade(lesson, &Variants::default(), &text, None, &Wanted::default())?;
    if json {
        print_json(&verdict);
    } else {
        print(&verdict);
    }
    Ok(if verdict.passed { Outcome::Done } else { Outcome::No })
}

fn print(verdict: &Verdict) {
    for question in &verdict.questions {
        let mark = match question.verdict {
            Mark::Right => "right",
            Mark::Wrong => "wrong",
            Mark::Blank => "blank",
            Mark::Invalid => "invalid",
            Mark::Kept => "kept",
            Mark::Waiting => "waiting",
        };
        let points = if question.verdict == Mark::Kept {
            "for people to judge".to_owned()
        } else {
            format!("{} of {}", question.earned, question.possible)
        };
        print_line(&format!("{mark:<8}{points}  {}", question.id));
        print_line(&format!("        {}", words(&question.message_html)));
    }
    let end = if !verdict.gradable {
        "not graded: correct what is invalid; no attempt is used"
    } else if verdict.passed {
        "passed"
    } else {
        "not passed"
    };
    print_line(&format!("{} of {} points: {end}", verdict.earned, verdict.possible));
}
