//! What was handed in and waits for its verdict.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::time::Duration;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::told::{self, GradedSubmission};
use crate::app::App;
use crate::grades::assigned;
use crate::problem::Problem;
use crate::store::{CLASS, HOME, StoreError};

/// Longest wait for a verdict in one request, s: below what a server that stops leaves to requests under way.
const LONGEST: u64 = 8;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<SubmissionState>();
    OpenApiRouter::new().routes(routes!(state))
}

/// A submission that has no verdict yet, or has one by now.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct SubmissionState {
    /// Its name.
    id: String,
    /// `waiting`, `graded`, or `failed`: it could not be graded, which is not the student's fault and uses no attempt.
    state: &'static str,
    /// How many come before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    before: Option<i64>,
    /// What it earned.
    #[serde(skip_serializing_if = "Option::is_none")]
    verdict: Option<GradedSubmission>,
}

/// The answer to what waits for its verdict.
pub(super) async fn accepted(app: &App, id: String) -> Result<Response, Problem> {
    let location = format!("/api/v1/submissions/{id}");
    let before = app.store.waiting(&id).await?.and_then(|waiting| waiting.before);
    let state = SubmissionState { id, state: "waiting", before, verdict: None };
    Ok((StatusCode::ACCEPTED, [(header::LOCATION, location)], Answer(state)).into_response())
}

/// How long to wait.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Patience {
    /// Seconds in which the verdict may come before this is answered, at most 8; 0 if it is not given.
    wait: Option<u64>,
}

/// Where a submission stands.
///
/// For what is graded later: ask until it is graded. With `wait` the answer comes with the verdict, if that comes in time.
#[utoipa::path(get, path = "/submissions/{id}", operation_id = "get_submission", tag = "submissions", params(("id" = String, Path), Patience), responses(
    (status = 200, description = "Waiting with its place, graded with its verdict, or failed", body = ref(of::<SubmissionState>())),
    (status = 404, description = "There is no such submission of whoever asks", body = ref(PROBLEM))))]
async fn state(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(patience): QueryParameters<Patience>,
    caller: Caller,
) -> Result<Answer<SubmissionState>, Problem> {
    let member = if app.access.is_class() { Some(caller.member()?) } else { None };
    let is_theirs = |person: &str| member.as_ref().is_none_or(|member| member.id == person);
    // Before it is looked at: what comes in between is heard.
    let verdict = app.store.await_verdict(&id);
    let mut waits = app.store.waiting(&id).await?.filter(|waiting| is_theirs(&waiting.person));
    let patience = Duration::from_secs(patience.wait.unwrap_or(0).min(LONGEST));
    if waits.as_ref().is_some_and(|waiting| waiting.before.is_some()) && !patience.is_zero() {
        verdict.within(patience).await;
        waits = app.store.waiting(&id).await?;
    }
    if let Some(waiting) = waits {
        let state = if waiting.before.is_some() { "waiting" } else { "failed" };
        return Ok(Answer(SubmissionState { id, state, before: waiting.before, verdict: None }));
    }
    let course = if member.is_some() { CLASS } else { HOME };
    let found = app.store.submission(course, &id).await?.filter(|(person, _)| is_theirs(person));
    let (person, kept) = found.ok_or(StoreError::Unknown("submission"))?;
    let policy = app.store.assignment(course, &kept.lesson).await?.policy;
    let lesson = assigned(lessons::find(&app, &kept.lesson)?, &policy);
    let own = kept.verdict["provenance"]["seed"].as_str().unwrap_or_default().to_owned();
    let seed = member.as_ref().map_or(own, |member| app.access.seed_of(member));
    let verdict = told::graded(&app, lesson, policy, Some(person), (seed, kept.verdict)).await?;
    Ok(Answer(SubmissionState { id, state: "graded", before: None, verdict: Some(verdict) }))
}
