//! Every request has a name, a line in the log and a place in the counters: what was asked by the template of its address, and
//! what became of it. Who asked, with which answers and secrets, is in neither.

use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::http::Method;
use axum::middleware::Next;
use axum::response::Response;
use tracing::Instrument;

use crate::app::App;
use crate::problem::ProblemCode;
use crate::request::{HEADER, RequestId};

/// Answers a request under its name, and tells of it.
pub(super) async fn observe(State(app): State<App>, request: Request, next: Next) -> Response {
    let began = Instant::now();
    let id = RequestId::of(request.headers());
    let matched = request.extensions().get::<MatchedPath>();
    // Addresses that nobody knows are one: others would be as many as somebody likes to ask for.
    let route = matched.map_or("other", MatchedPath::as_str).to_owned();
    let method = known(request.method());
    let span =
        tracing::error_span!(target: "triad", "request", id = id.as_str(), method, route = route.as_str());
    let name = id.header();
    let mut response = id.name(next.run(request)).instrument(span.clone()).await;
    let code = response.extensions().get::<ProblemCode>().map_or("", |code| code.0);
    let (status, took) = (response.status().as_u16(), began.elapsed());
    span.in_scope(|| {
        let ms = took.as_secs_f64() * 1e3;
        tracing::info!(target: "triad", status, code, ms, "answered");
    });
    app.metrics.answered(method, &route, status, code, took);
    if let Some(name) = name {
        response.headers_mut().insert(HEADER, name);
    }
    response
}

/// Methods may be any word; those that nothing answers to are one.
fn known(method: &Method) -> &'static str {
    match *method {
        Method::GET => "GET",
        Method::HEAD => "HEAD",
        Method::POST => "POST",
        Method::PUT => "PUT",
        Method::PATCH => "PATCH",
        Method::DELETE => "DELETE",
        Method::OPTIONS => "OPTIONS",
        _ => "other",
    }
}
