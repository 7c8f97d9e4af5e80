//! What of a verdict its student is told.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use triad_lessons::{Lesson, Mark, Verdict};

use crate::app::App;
use crate::blocking;
use crate::grades::{Book, Entry, Marked};
use crate::policy::{Moment, Policy, Revealed, When};
use crate::problem::Problem;
use crate::store::CLASS;

/// The verdict of a submission, without what is held back.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(in crate::api) struct GradedSubmission {
    /// Its name.
    id: String,
    /// When it came, RFC 3339 in UTC.
    submitted_at: String,
    /// Slug of the lesson.
    lesson: String,
    /// The student.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    student: Option<String>,
    /// Points earned; left out while they are held back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    earned: Option<f64>,
    /// Points that can be earned.
    possible: f64,
    /// Whether the lesson counts as passed: enough points, and nothing left that could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    passed: Option<bool>,
    /// False if an answer could not be read or needs more digits: fix it and send again, no attempt is used.
    gradable: bool,
    /// The questions in the lesson's order.
    questions: Vec<ToldQuestion>,
    /// What graded it.
    provenance: triad_lessons::verdict::Provenance,
    /// What is held back: `points`, `messages`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    held: Vec<String>,
}

/// The outcome for one question, without what is held back.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
struct ToldQuestion {
    /// The question's id.
    id: String,
    /// Points earned; left out while they are held back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    earned: Option<f64>,
    /// Points that can be earned here: none where people give them.
    possible: f64,
    /// Right, wrong, blank, invalid, kept for people to judge, or waiting for an answer that is invalid; left out while it is held back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    verdict: Option<Mark>,
    /// Feedback for the student, as safe HTML.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    message_html: Option<String>,
    /// The misconception that was recognised; for statistics and for the checks of authors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    slip: Option<String>,
    /// A picture of what was computed, as SVG that the grader drew.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    figure_svg: Option<String>,
    /// What earlier submissions decide, where they are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    standing: Option<triad_lessons::verdict::QuestionStanding>,
    /// The right answer and its source, as safe HTML, where it is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reference_html: Option<String>,
    /// What somebody who teaches gave an explanation; left out where it waits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mark: Option<Marked>,
}

/// Takes out of a verdict what is not told.
pub(in crate::api) fn hold(verdict: &mut Value, revealed: Revealed) {
    let Some(whole) = verdict.as_object_mut() else { return };
    let mut held = Vec::new();
    if !revealed.points {
        held.push("points");
        remove(whole, &["earned", "passed"]);
    }
    if !revealed.messages {
        held.push("messages");
    }
    for question in questions(whole) {
        // What is to be corrected before anything is judged is told: it says nothing of what is right.
        let is_judged = matches!(question["verdict"].as_str(), Some("right" | "wrong"));
        if !revealed.points {
            remove(question, &["earned", "standing"]);
        }
        if !revealed.messages && is_judged {
            remove(question, &["message_html", "slip", "figure_svg"]);
        }
        if !revealed.points && is_judged {
            remove(question, &["verdict"]);
        }
        if !revealed.reference {
            remove(question, &["reference_html"]);
        }
    }
    if !held.is_empty() {
        whole.insert("held".to_owned(), held.into());
    }
}

fn questions(verdict: &mut Map<String, Value>) -> impl Iterator<Item = &mut Map<String, Value>> {
    let list = verdict.get_mut("questions").and_then(Value::as_array_mut).into_iter().flatten();
    list.filter_map(Value::as_object_mut)
}

fn remove(from: &mut Map<String, Value>, keys: &[&str]) {
    for key in keys {
        from.remove(*key);
    }
}

/// Adds to a verdict, as it is kept, the right answers that are open, and takes out what is not told. `lesson` has the numbers
/// that the verdict is about.
///
/// Errors if the verdict cannot be read.
pub(in crate::api) fn tell(
    lesson: &Lesson,
    policy: &Policy,
    revealed: Revealed,
    verdict: &mut Value,
) -> Result<(), Problem> {
    if revealed.reference && policy.reveal.reference != When::AtOnce {
        for question in verdict.as_object_mut().into_iter().flat_map(questions) {
            let right = question["id"].as_str().and_then(|id| triad_lessons::right_answer(lesson, id));
            question.extend(right.map(|right| ("reference_html".to_owned(), right.into())));
        }
    } else if revealed.reference && verdict["gradable"] == true {
        let mut read: Verdict = serde_json::from_value(verdict.clone()).map_err(Problem::internal)?;
        triad_lessons::open(lesson, &mut read);
        let opened = read.questions.into_iter().map(|question| question.reference_html);
        for (question, right) in verdict.as_object_mut().into_iter().flat_map(questions).zip(opened) {
            question.extend(right.map(|right| ("reference_html".to_owned(), right.into())));
        }
    }
    hold(verdict, revealed);
    Ok(())
}

/// Adds to the explanations of a verdict what they were given.
pub(in crate::api) fn mark(verdict: &mut Value, entry: &Entry) {
    let came = verdict["submitted_at"].as_str().and_then(|at| Moment::try_from(at.to_owned()).ok());
    let all = verdict.as_object_mut().into_iter().flat_map(questions);
    for question in all.filter(|one| one["verdict"] == "kept") {
        let mark = question["id"].as_str().and_then(|id| entry.mark(id));
        // What was written after it was not read by whoever gave it.
        let mark = mark.filter(|mark| came.is_some_and(|came| came <= mark.at));
        let mark = mark.and_then(|mark| serde_json::to_value(mark).ok());
        question.extend(mark.map(|mark| ("mark".to_owned(), mark)));
    }
}

/// Adds a good explanation to each that is kept, where the course opens right answers: for who works alone, and has nobody
/// else to judge it.
pub(in crate::api) fn compare(lesson: &Lesson, verdict: &mut Value) {
    let all = verdict.as_object_mut().filter(|_| lesson.opens.right);
    for question in all.into_iter().flat_map(questions).filter(|one| one["verdict"] == "kept") {
        let good = question["id"].as_str().and_then(|id| triad_lessons::right_answer(lesson, id));
        question.extend(good.map(|good| ("reference_html".to_owned(), good.into())));
    }
}

/// What a student is told in a lesson now: at home everything.
///
/// Errors if the gradebook cannot be read.
pub(in crate::api) async fn revealed(
    app: &App,
    person: Option<&str>,
    lesson: &Lesson,
) -> Result<Revealed, Problem> {
    let Some(person) = person.filter(|_| app.access.is_class()) else { return Ok(Revealed::ALL) };
    let book = Book::open(&app.store, CLASS, Some(person), Some(&lesson.slug)).await?;
    Ok(book.standing(person, lesson, Moment::now()).turn.revealed)
}

/// What a student is told of a verdict, with the seed of its numbers.
pub(super) async fn graded(
    app: &App,
    lesson: Lesson,
    policy: Policy,
    person: Option<String>,
    (seed, mut verdict): (String, Value),
) -> Result<GradedSubmission, Problem> {
    let revealed = revealed(app, person.as_deref(), &lesson).await?;
    let (variants, is_alone) = (Arc::clone(&app.variants), !app.access.is_class());
    blocking(move || {
        let own = variants.of(&lesson, &seed)?;
        tell(&own, &policy, revealed, &mut verdict)?;
        if is_alone {
            compare(&own, &mut verdict);
        }
        serde_json::from_value(verdict).map_err(Problem::internal)
    })
    .await
}
