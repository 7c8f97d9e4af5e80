//! What those who run the server ask, at an address of its own.

use std::sync::Arc;

use axum::Router;
use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use axum::routing::get;

use super::health;
use crate::app::App;
use crate::metrics::{Living, Metrics};
use crate::problem::Problem;
use crate::store::Store;

/// Counters and probes.
pub fn admin(app: App) -> Router {
    Router::new()
        .route("/metrics", get(metrics))
        .route("/livez", get(health::alive))
        .route("/readyz", get(health::ready))
        .with_state(app)
}

async fn metrics(State(app): State<App>) -> Result<impl IntoResponse, Problem> {
    let living = Living {
        sessions: app.sessions.len(),
        sessions_waiting: app.sessions.waiting(),
        sessions_bytes: app.sessions.bytes(),
        lectures: app.lectures.len(),
        waiting: app.work.waiting(),
        queue: app.store.gradings().await.unwrap_or_default(),
        ready: health::ready(State(app.clone())).await.is_ok(),
    };
    told(&app.metrics, living)
}

/// Counters and probes of a program that only grades.
pub fn admin_of_grader(store: Arc<Store>, metrics: Arc<Metrics>) -> Router {
    Router::new()
        .route("/metrics", get(grader_metrics))
        .route("/livez", get(health::alive))
        .route("/readyz", get(grader_ready))
        .with_state((store, metrics))
}

async fn grader_ready(State((store, _)): State<(Arc<Store>, Arc<Metrics>)>) -> Result<&'static str, Problem> {
    health::writable(&store).await
}

async fn grader_metrics(
    State((store, metrics)): State<(Arc<Store>, Arc<Metrics>)>,
) -> Result<impl IntoResponse, Problem> {
    let queue = store.gradings().await.unwrap_or_default();
    let ready = health::writable(&store).await.is_ok();
    told(&metrics, Living { queue, ready, ..Living::default() })
}

fn told(metrics: &Metrics, living: Living) -> Result<impl IntoResponse + use<>, Problem> {
    let text = metrics.text(living).map_err(Problem::internal)?;
    Ok(([(header::CONTENT_TYPE, "application/openmetrics-text; version=1.0.0; charset=utf-8")], text))
}
