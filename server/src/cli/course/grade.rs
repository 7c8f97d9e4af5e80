//! `triad grade`.

use std::path::Path;

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
    let (_, verdict) = grading::grade(lesson, &Variants::default(), &text, None)?;
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
            Mark::Waiting => "waiting",
        };
        print_line(&format!("{mark:<8}{} of {}  {}", question.earned, question.possible, question.id));
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

/// The words of a message, without its markup.
fn words(html: &str) -> String {
    let mut text = String::with_capacity(html.len());
    let mut inside_tag = false;
    // Paragraphs and items of a list end a word, other marks do not.
    for letter in html.replace("</p>", " ").replace("</li>", " ").replace("<br>", " ").chars() {
        match letter {
            '<' => inside_tag = true,
            '>' => inside_tag = false,
            _ if !inside_tag => text.push(letter),
            _ => {}
        }
    }
    let plain = text
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&#39;", "'")
        .replace("&amp;", "&");
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    #[test]
    fn markup_is_left_out_and_signs_are_kept() {
        assert_eq!(
            super::words("<p>g &lt; 10, so\n <em>T</em> &amp; mg.</p><p>No.</p>"),
            "g < 10, so T & mg. No."
        );
    }
}
