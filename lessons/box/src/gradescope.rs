//! Gradescope: `submission/` and `submission_metadata.json` are given, `results/results.json` is expected.
//!
//! Points are those of the lesson. Gradescope counts no attempts; what cannot be graded leaves the points of the last
//! submission that could, which are found in the result that it hands back.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use triad_lessons::{Mark, Verdict};

use crate::handed_in;
use crate::outcome::{self, OWN_FAULT, Outcome, UNFINISHED, said, summary};
use crate::places::{Broken, Results, lesson, told};

/// Grades what was handed in. With `numbers_of_email` it has to be about the numbers of who handed it in.
///
/// Errors if the result cannot be written, or the lesson not be read; the latter is a result as well.
pub fn run(root: &Path, numbers_of_email: bool) -> Result<(), Broken> {
    let results = Results::below(root)?;
    let about = told(&root.join("submission_metadata.json"));
    let kept = Kept::of(&about);
    results.write(&kept.ungraded(UNFINISHED, &[]))?;
    let lesson = match lesson(&root.join("source/lesson.json")) {
        Ok(lesson) => lesson,
        Err(broken) => {
            results.write(&kept.ungraded(OWN_FAULT, &[]))?;
            return Err(broken);
        }
    };
    let outcome = outcome::of(|| {
        let text = handed_in::text(&handed_in::file_in(&root.join("submission"))?)?;
        if numbers_of_email {
            handed_in::grade_of(&lesson, &text, &addresses(&about))
        } else {
            handed_in::grade(&lesson, &text, None)
        }
    });
    results.write(&match outcome {
        Outcome::Graded(verdict) => graded(&verdict),
        Outcome::Unclear(verdict) => kept.ungraded(&summary(&verdict), &tests(&verdict, false)),
        Outcome::Refused(why) => kept.ungraded(&why, &[]),
    })
}

/// The addresses of those who handed in.
fn addresses(about: &Value) -> Vec<String> {
    let users = about["users"].as_array().into_iter().flatten();
    users.filter_map(|user| user["email"].as_str()).map(str::to_owned).collect()
}

/// What the last submission that could be graded has reached.
#[derive(Debug, Default)]
struct Kept {
    earned: f64,
    extra: Value,
}

impl Kept {
    /// From what Gradescope tells of earlier submissions: of the latest alone it hands back the result, which carries on what
    /// was before.
    fn of(about: &Value) -> Self {
        let earlier = about["previous_submissions"].as_array().into_iter().flatten().rev();
        let extra = earlier.map(|one| &one["results"]["extra_data"]).find(|extra| extra["triad"].is_object());
        extra.map_or_else(Self::default, |extra| Self {
            earned: extra["triad"]["earned"].as_f64().unwrap_or_default(),
            extra: extra.clone(),
        })
    }

    /// The result where nothing was graded.
    fn ungraded(&self, why: &str, tests: &[Value]) -> Value {
        let mut output = why.to_owned();
        if let Some(possible) = self.extra["triad"]["possible"].as_f64() {
            let _ =
                write!(output, "\nYour last graded submission counts: {} of {possible} points.", self.earned);
        }
        let mut result =
            json!({"score": self.earned, "output": output, "output_format": "text", "visibility": "visible"});
        if !tests.is_empty() {
            result["tests"] = json!(tests);
        }
        if self.extra.is_object() {
            result["extra_data"] = self.extra.clone();
        }
        result
    }
}

/// The result of a verdict.
fn graded(verdict: &Verdict) -> Value {
    json!({
        "score": verdict.earned,
        "output": summary(verdict),
        "output_format": "text",
        "visibility": "visible",
        "tests": tests(verdict, true),
        "extra_data": {"triad": {"earned": verdict.earned, "possible": verdict.possible, "verdict": verdict}},
    })
}

/// Each question as a test; without points where nothing was judged.
fn tests(verdict: &Verdict, with_points: bool) -> Vec<Value> {
    let test = |(number, question): (usize, &triad_lessons::QuestionVerdict)| {
        let mut test = json!({
            "number": number.to_string(),
            "name": question.id,
            "output": said(&question.message_html),
            "output_format": "text",
        });
        // Explanations are judged by people, there as here.
        if with_points && question.verdict != Mark::Kept {
            test["score"] = json!(question.earned);
            test["max_score"] = json!(question.possible);
            test["status"] = json!(if question.verdict == Mark::Right { "passed" } else { "failed" });
        } else if question.verdict == Mark::Invalid {
            test["status"] = json!("failed");
        }
        test
    };
    (1..).zip(&verdict.questions).map(test).collect()
}
