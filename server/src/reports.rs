//! Reports that commands wrote, shown at addresses of their own: `/bench` and `/stress`.

use std::path::Path;

use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::app::{App, REPORTS};

/// File of the report of `triad bench`: run time against error.
pub const BENCH: &str = "bench.html";
/// File of the report of `triad stress`: what the engine survives.
pub const STRESS: &str = "stress.html";
/// Largest report that is shown, bytes.
const LARGEST: u64 = 32 << 20;
/// Reports are tables and drawings: nothing in them may run or load.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'self'; \
    base-uri 'none'; form-action 'none'";

/// Run time against error, as `triad bench` last measured it.
pub async fn bench(State(app): State<App>) -> Response {
    show(&app.reports, BENCH, "Run time against error", "triad bench --quick").await
}

/// The outcome of each attempt to break the engine, as `triad stress` last found it.
pub async fn stress(State(app): State<App>) -> Response {
    let command = format!("triad stress --quick --html {REPORTS}/{STRESS}");
    show(&app.reports, STRESS, "Stress report", &command).await
}

async fn show(folder: &Path, name: &str, title: &str, command: &str) -> Response {
    let path = folder.join(name);
    let small = tokio::fs::metadata(&path).await.is_ok_and(|meta| meta.is_file() && meta.len() <= LARGEST);
    let found = if small { tokio::fs::read_to_string(&path).await.ok() } else { None };
    let status = if found.is_some() { StatusCode::OK } else { StatusCode::NOT_FOUND };
    let headers = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::CACHE_CONTROL, "no-cache"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ];
    (status, headers, found.unwrap_or_else(|| nothing_yet(title, command))).into_response()
}

/// What to do when nothing was measured yet.
fn nothing_yet(title: &str, command: &str) -> String {
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Triad: {title}</title><style>:root{{color-scheme:light dark}}\
         body{{font:16px/1.6 system-ui,sans-serif;max-width:40rem;margin:3rem auto;padding:0 1rem}}\
         code{{font-size:1rem}}pre{{white-space:pre-wrap;overflow-wrap:anywhere}}</style><h1>{title}</h1><p>Nothing has been measured on this machine yet. It takes \
         about a minute; run this where the workbench was started, and reload the page:</p>\
         <pre><code>{command}</code></pre><p><a href=\"/\">Back to the lessons</a></p></html>"
    )
}
