//! Whether the server is well.

use std::sync::atomic::Ordering;
use std::time::Duration;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::time::timeout;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::describe::{Schemas, of};
use crate::app::App;
use crate::problem::Problem;
use crate::store::{Store, StoreError};

/// How long the gradebook may take to say that it is ready.
const PATIENCE: Duration = Duration::from_secs(2);

pub(super) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Health>();
    OpenApiRouter::new().routes(routes!(health))
}

/// How the server is.
#[derive(Debug, Serialize, JsonSchema)]
struct Health {
    /// `ok`.
    status: &'static str,
    /// Version of the program.
    version: &'static str,
    /// Live sessions.
    sessions: usize,
    /// Live sessions that there may be.
    most_sessions: usize,
    /// Lessons in the course.
    lessons: usize,
}

/// How the server is.
#[utoipa::path(get, path = "/health", operation_id = "get_health", tag = "server", responses(
    (status = 200, description = "It is well", body = ref(of::<Health>()))))]
async fn health(State(app): State<App>) -> Answer<Health> {
    Answer(Health {
        status: "ok",
        version: env!("CARGO_PKG_VERSION"),
        sessions: app.sessions.len(),
        most_sessions: app.limits.sessions,
        lessons: app.course.lessons().len(),
    })
}

/// For whoever watches over the process: it answers.
pub(super) async fn alive() -> &'static str {
    "alive\n"
}

/// For whoever sends requests here: something could be handed in now.
///
/// Errors with what is in the way.
pub(super) async fn ready(State(app): State<App>) -> Result<&'static str, Problem> {
    if app.draining.load(Ordering::Relaxed) {
        return Err(Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "draining",
            "the server is about to stop: it answers what comes, and takes no new callers",
            "ask another server, or this one when it is back",
        ));
    }
    if app.course.lessons().is_empty() {
        return Err(Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "no-lessons",
            "the course has no lesson",
            "name a folder with lessons: triad --course DIR serve",
        ));
    }
    writable(&app.store).await
}

/// Whether the gradebook takes something now.
///
/// Errors with what is in the way.
pub(super) async fn writable(store: &Store) -> Result<&'static str, Problem> {
    let waiting = timeout(PATIENCE, store.ready()).await.unwrap_or(Err(StoreError::Busy));
    // Whatever it is: others are to ask elsewhere, or later.
    waiting.map(|()| "ready\n").map_err(|error| Problem::from(error).unavailable())
}
