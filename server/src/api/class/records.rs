//! What leaves the gradebook: the whole course for who runs it, everybody's own data, and erasing them.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::Json as Answer;
use axum::body::{Body, Bytes, HttpBody};
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use hyper::body::Frame;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tokio::sync::mpsc;
use tokio::time::timeout;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::sign_in::Somebody;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::api::guard::Caller;
use crate::api::lessons::told::hold;
use crate::app::App;
use crate::grades::Book;
use crate::policy::{Moment, Revealed};
use crate::problem::Problem;
use crate::store::{CLASS, Decision, DecisionKind, KeptPrediction, OwnEvent, Query, StoreError};

/// Longest reason, in characters.
const LONGEST_REASON: usize = 2000;
/// How long a course may take to be received: it is read as of one moment, which keeps the log of changes from shrinking.
const EXPORT_TIME: Duration = Duration::from_mins(10);

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<OwnData>();
    schemas.request::<Erasure>();
    OpenApiRouter::new().routes(routes!(export)).routes(routes!(own)).routes(routes!(erase))
}

/// The whole class as one file: people, lessons, submissions, verdicts, decisions and the log. `triad class import` brings it
/// into another gradebook.
#[utoipa::path(get, path = "/course/export", operation_id = "export_class", tag = "class", responses(
    (status = 200, description = "A line of JSON for each row; the last line says that all is there", body = String,
        content_type = "application/jsonl")))]
async fn export(State(app): State<App>, caller: Caller) -> Result<impl IntoResponse, Problem> {
    app.store.note(CLASS, &caller.member()?.id, "exported", "course").await?;
    let (pieces, received) = mpsc::channel(4);
    tokio::spawn(async move {
        let written = timeout(EXPORT_TIME, app.store.export(CLASS, &pieces));
        let written = written.await.unwrap_or(Err(StoreError::Busy));
        if let Err(error) = written {
            // The file ends without its last line, and the connection with an error.
            drop(pieces.send(Err(error)).await);
        }
    });
    let headers = [
        (header::CONTENT_TYPE, "application/jsonl"),
        (header::CONTENT_DISPOSITION, "attachment; filename=\"class.triad\""),
    ];
    Ok((headers, Body::new(Sent(received))))
}

/// A body that is sent as it is made.
struct Sent(mpsc::Receiver<Result<Bytes, StoreError>>);

impl HttpBody for Sent {
    type Data = Bytes;
    type Error = StoreError;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, StoreError>>> {
        self.0.poll_recv(context).map(|piece| piece.map(|piece| piece.map(Frame::data)))
    }
}

/// Everything that is kept of who asks.
#[derive(Debug, Serialize, JsonSchema)]
struct OwnData {
    /// Who.
    person: Somebody,
    /// When they joined, in milliseconds since 1970.
    joined_at: i64,
    /// The class.
    course: String,
    /// What they handed in, files included, with the verdicts, newest first.
    #[schemars(with = "Vec<OwnSubmission>")]
    submissions: Vec<Value>,
    /// What they predicted before runs.
    predictions: Vec<OwnPrediction>,
    /// What was decided about their grades, and why.
    decisions: Vec<OwnDecision>,
    /// What the log knows of them.
    log: Vec<OwnEvent>,
}

/// A submission with its verdict.
#[derive(Serialize, JsonSchema)]
#[allow(dead_code, reason = "described; written as JSON that is kept")]
struct OwnSubmission {
    /// What was handed in.
    answers: Value,
    /// What was told of it.
    verdict: Value,
}

/// A prediction.
#[derive(Debug, Serialize, JsonSchema)]
struct OwnPrediction {
    /// Slug of the lesson.
    lesson: String,
    /// Id of the prediction.
    prediction: String,
    /// Id of the option; null: it was skipped.
    choice: Option<String>,
    /// Why, in their words.
    why: String,
    /// When, in milliseconds since 1970.
    at: i64,
}

/// A decision about a grade.
#[derive(Debug, Serialize, JsonSchema)]
struct OwnDecision {
    /// Slug of the lesson.
    lesson: String,
    /// The explanation that it is about; null: the whole lesson.
    question: Option<String>,
    /// The points that count; null: those that were earned.
    points: Option<f64>,
    /// Why.
    reason: String,
    /// When.
    at: Moment,
}

/// A copy of one's own data: everything that is kept of who asks, but for results that are held back.
#[utoipa::path(get, path = "/me/data", operation_id = "get_own_data", tag = "class", responses(
    (status = 200, description = "Submissions with files and verdicts, decisions, the log", body = ref(of::<OwnData>()))))]
async fn own(State(app): State<App>, caller: Caller) -> Result<impl IntoResponse, Problem> {
    let member = caller.member()?;
    let id = member.id.as_str();
    let query =
        Query { course: CLASS.to_owned(), person: Some(id.to_owned()), lesson: None, limit: usize::MAX };
    let book = Book::open(&app.store, CLASS, Some(id), None).await?;
    let told = |lesson: &str| {
        let standing = app.course.lesson(lesson).map(|lesson| book.standing(id, lesson, Moment::now()));
        standing.map_or(Revealed::NOTHING, |standing| standing.turn.revealed)
    };
    let mut found = app.store.list(&query).await?;
    for one in &mut found {
        hold(&mut one.verdict, told(&one.lesson));
    }
    let submissions = found.into_iter().map(|one| json!({"answers": one.answers, "verdict": one.verdict}));
    let decisions = app.store.decisions(CLASS, Some(id), None).await?.into_iter().filter(|decision| {
        let is_of_points = matches!(decision.kind, DecisionKind::Points | DecisionKind::Mark);
        !is_of_points || told(&decision.lesson).points
    });
    let decision = |Decision { lesson, question, points, reason, at, .. }| OwnDecision {
        lesson,
        question,
        points,
        reason,
        at,
    };
    let predicted = app.store.predictions(CLASS, Some(id), None).await?;
    let prediction = |KeptPrediction { lesson, prediction, choice, why, given_at: at, .. }| OwnPrediction {
        lesson,
        prediction,
        choice,
        why,
        at,
    };
    let data = OwnData {
        person: Somebody::of(&member),
        joined_at: member.joined_at,
        course: app.store.course(CLASS).await?.title,
        submissions: submissions.collect(),
        predictions: predicted.into_iter().map(prediction).collect(),
        decisions: decisions.map(decision).collect(),
        log: app.store.events_of(CLASS, id).await?,
    };
    app.store.note(CLASS, id, "took a copy of their data", id).await?;
    let name = [(header::CONTENT_DISPOSITION, "attachment; filename=\"my-data.json\"")];
    Ok((name, Answer(data)))
}

/// Whom to erase, and why.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Erasure {
    /// Why: who asked for it, or which rule says so. It stays in the log.
    reason: String,
    /// Keep what was handed in, without the name: where law wants examinations kept.
    #[serde(default)]
    answers_stay: bool,
}

/// Erase somebody's data: name, ways in, sessions, and what they handed in. What a grade is proved with stays, under a number:
/// points, dates, decisions, and the log. Backups from before still have everything.
#[utoipa::path(post, path = "/people/{person}/erase", operation_id = "erase_person", tag = "class", params(("person" = String, Path)),
    request_body(content = ref(of::<Erasure>()), example = json!({"reason": "asked for it on 3 May"})), responses(
    (status = 204, description = "They are erased"),
    (status = 404, description = "No such person", body = ref(PROBLEM)),
    (status = 409, description = "The class would be without an owner", body = ref(PROBLEM)),
    (status = 422, description = "No reason", body = ref(PROBLEM))))]
async fn erase(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    caller: Caller,
    Json(wanted): Json<Erasure>,
) -> Result<StatusCode, Problem> {
    let reason = wanted.reason.trim();
    if reason.is_empty() || reason.chars().count() > LONGEST_REASON {
        let wrong = format!("the reason is empty or has more than {LONGEST_REASON} characters");
        let hint = "say who asked for it, or which rule: it stays in the log";
        let problem = Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "no-reason", wrong.clone(), hint);
        return Err(problem.at("/reason", wrong));
    }
    app.store.erase(CLASS, &caller.member()?.id, &person, reason, wanted.answers_stay).await?;
    Ok(StatusCode::NO_CONTENT)
}
