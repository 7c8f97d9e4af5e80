//! What comes of grading, whichever system is told.

use std::panic::{AssertUnwindSafe, catch_unwind};

use triad_lessons::rendering::html::words;
use triad_lessons::{Mark, Verdict};

use crate::handed_in::HandInError;

/// What is said while nothing else is known: it stays if the grader is stopped.
pub const UNFINISHED: &str = "The grader was stopped before it had a verdict, at the limit of time or memory. Nothing was \
                              graded and no attempt is used; hand in again, and tell your instructor if it comes back.";
/// What is said where the grader itself is at fault.
pub const OWN_FAULT: &str = "The grader failed. This is not your mistake: nothing was graded and no attempt is used. Tell your \
                             instructor.";

/// What comes of grading.
#[derive(Debug)]
pub enum Outcome {
    /// Every answer could be judged.
    Graded(Verdict),
    /// An answer could not be read: the verdict says which.
    Unclear(Verdict),
    /// There is no verdict.
    Refused(String),
}

/// Grades, and takes every end of it for an outcome.
pub fn of(grading: impl FnOnce() -> Result<Verdict, HandInError>) -> Outcome {
    match catch_unwind(AssertUnwindSafe(grading)) {
        Ok(Ok(verdict)) if verdict.gradable => Outcome::Graded(verdict),
        Ok(Ok(verdict)) => Outcome::Unclear(verdict),
        Ok(Err(error)) => Outcome::Refused(format!("Not graded, and no attempt is used: {error}")),
        Err(_) => Outcome::Refused(OWN_FAULT.to_owned()),
    }
}

/// The verdict in a sentence.
pub fn summary(verdict: &Verdict) -> String {
    let points = format!("{} of {} points", verdict.earned, verdict.possible);
    if !verdict.gradable {
        let unclear = verdict.questions.iter().filter(|question| question.verdict == Mark::Invalid);
        let ids = unclear.map(|question| question.id.as_str()).collect::<Vec<_>>().join(", ");
        return format!(
            "Not graded, and no attempt is used. Correct what cannot be read ({ids}) and hand in again."
        );
    }
    format!("{points}: {}.", if verdict.passed { "passed" } else { "not passed" })
}

/// What is said about a question, as text: a line for each paragraph, formulas in TeX between dollars.
pub fn said(message_html: &str) -> String {
    let formulas = message_html
        .replace("<span class=\"math inline\">", "$")
        .replace("</span>", "$")
        .replace("<div class=\"math display\"", " $<div")
        .replace("</div>", "$</p>");
    let lines = formulas.replace("</li>", "</p>");
    lines.split("</p>").map(words).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::said;

    #[test]
    fn a_message_is_read_without_markup() {
        assert_eq!(
            said(
                "<p>Not right.</p><p>With <span class=\"math inline\">g &lt; 10</span>:</p>\n<div class=\"math display\" \
                  id=\"eq-1\">T = m g</div><ul><li>one</li><li>two</li></ul>"
            ),
            "Not right.\nWith $g < 10$:\n$T = m g$\none\ntwo"
        );
    }
}
