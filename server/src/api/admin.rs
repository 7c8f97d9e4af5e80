//! What those who run the server ask, at an address of its own.

use axum::Router;
use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use axum::routing::get;

use super::health;
use crate::app::App;
use crate::metrics::Living;
use crate::problem::Problem;

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
        lectures: app.lectures.len(),
        waiting: app.work.waiting(),
        ready: health::ready(State(app.clone())).await.is_ok(),
    };
    let text = app.metrics.text(living).map_err(Problem::internal)?;
    Ok(([(header::CONTENT_TYPE, "application/openmetrics-text; version=1.0.0; charset=utf-8")], text))
}
