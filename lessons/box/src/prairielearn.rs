//! PrairieLearn's external grading: `student/` and `data/data.json` are given, `results/results.json` is expected.
//!
//! The score is the share of the points. What cannot be graded is said to be so, and costs no attempt there.

use std::path::Path;

use serde_json::{Value, json};
use triad_lessons::{Mark, QuestionVerdict, Verdict};

use crate::handed_in;
use crate::outcome::{self, OWN_FAULT, Outcome, UNFINISHED, said, summary};
use crate::places::{Broken, Results, lesson, told};

/// Bytes that a result may have.
const MOST: usize = 1_000_000;

/// Grades what was handed in, with the numbers that the question was shown with.
///
/// Errors if the result cannot be written, or the lesson not be read; the latter is a result as well.
pub fn run(root: &Path) -> Result<(), Broken> {
    let results = Results::below(root)?;
    results.write(&ungraded(&[UNFINISHED.to_owned()]))?;
    let lesson = match lesson(&root.join("tests/lesson.json")) {
        Ok(lesson) => lesson,
        Err(broken) => {
            results.write(&ungraded(&[OWN_FAULT.to_owned()]))?;
            return Err(broken);
        }
    };
    let data = told(&root.join("data/data.json"));
    let shown = data["params"]["triad_seed"].as_str().unwrap_or_default();
    let outcome = outcome::of(|| {
        let text = handed_in::text(&handed_in::file_in(&root.join("student"))?)?;
        handed_in::grade(&lesson, &text, Some(shown))
    });
    results.write(&match outcome {
        Outcome::Graded(verdict) => fitting(graded(&verdict)),
        Outcome::Unclear(verdict) => {
            let unclear = verdict.questions.iter().filter(|question| question.verdict == Mark::Invalid);
            let each = unclear.map(|question| format!("{}: {}", question.id, said(&question.message_html)));
            ungraded(&std::iter::once(summary(&verdict)).chain(each).collect::<Vec<_>>())
        }
        Outcome::Refused(why) => ungraded(&[why]),
    })
}

fn ungraded(why: &[String]) -> Value {
    json!({"gradable": false, "format_errors": why})
}

fn graded(verdict: &Verdict) -> Value {
    // A lesson has points; a score that is no number would be refused as a whole.
    let score =
        if verdict.possible > 0.0 { (verdict.earned / verdict.possible).clamp(0.0, 1.0) } else { 0.0 };
    let test = |(number, question): (usize, &QuestionVerdict)| {
        json!({
            "name": format!("{number}. {}", question.id),
            "points": question.earned,
            "max_points": question.possible,
            "message": said(&question.message_html),
        })
    };
    json!({
        "gradable": true,
        "score": score,
        "message": summary(verdict),
        "tests": (1..).zip(&verdict.questions).map(test).collect::<Vec<_>>(),
        "triad": {"verdict": verdict},
    })
}

/// The result, without the verdict that goes along with it where both are too large.
fn fitting(mut result: Value) -> Value {
    if result.to_string().len() > MOST
        && let Some(members) = result.as_object_mut()
    {
        members.remove("triad");
    }
    result
}
