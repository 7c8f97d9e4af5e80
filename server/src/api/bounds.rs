//! Middleware that bounds the size of requests and answers larger ones with a problem.

use std::time::Duration;

use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use http_body_util::BodyExt;

use super::extract::too_large;
use crate::app::App;

/// The longest body that is read to its end only to be refused.
const DRAINED: u64 = 1 << 30;
/// How long such a body is read.
const PATIENCE: Duration = Duration::from_secs(20);

/// Refuses a body that announces itself as too large. The body is read and forgotten, piece by piece: a client
/// that is still sending would otherwise see a broken connection instead of the answer.
pub(super) async fn refuse_large_bodies(State(app): State<App>, request: Request, next: Next) -> Response {
    let announced = request
        .headers()
        .get(header::CONTENT_LENGTH)
        .and_then(|value| value.to_str().ok()?.parse::<u64>().ok())
        .unwrap_or(0);
    if announced <= app.limits.request_bytes as u64 {
        return next.run(request).await;
    }
    if announced <= DRAINED {
        // Whether the client sends all of it or gives up, the answer is the same.
        drop(tokio::time::timeout(PATIENCE, drain(request.into_body())).await);
    }
    too_large(Some(app.limits.request_bytes)).into_response()
}

async fn drain(mut body: Body) {
    while let Some(Ok(_)) = body.frame().await {}
}
