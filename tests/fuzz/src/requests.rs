//! Requests to the server: the real router, called in process, with a gradebook in memory.

use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes, to_bytes};
use axum::http::{HeaderValue, Method, Request, StatusCode, header};
use serde_json::Value;
use tokio::runtime::{Builder, Runtime};
use tower::ServiceExt;
use triad::app::App;
use triad::limits::Limits;
use triad::store::Store;
use triad_lessons::Course;

/// Requests of one case.
const MOST: usize = 8;
/// Cases after which the server is a fresh one: its gradebook grows with every submission.
const CASES: usize = 500;
/// Bytes of an answer that is looked at.
const ANSWER: usize = 64 << 20;

/// A server and how many cases it has answered.
struct Served {
    runtime: Runtime,
    first: App,
    router: Router,
    cases: usize,
}

static SERVER: LazyLock<Mutex<Option<Served>>> = LazyLock::new(|| Mutex::new(served()));

/// A small server: what is fuzzed is how requests are read and answered, not how large a run may be.
fn served() -> Option<Served> {
    let runtime = Builder::new_current_thread().enable_all().build().ok()?;
    let limits = Limits {
        sessions: 4,
        bodies: 6,
        connections: 12,
        command_time: Duration::from_millis(300),
        recording_bytes: 8 << 20,
        ..Limits::default()
    };
    let first = App::new(Course::embedded().ok()?, Store::in_memory(), limits);
    let router = triad::app(first.clone());
    Some(Served { runtime, first, router, cases: 0 })
}

/// What answers have told so far, for requests that need it.
#[derive(Default)]
struct Told {
    sessions: Vec<String>,
    code: String,
    key: String,
}

/// Requests, parted by lines of `---8<---`, each a line `METHOD /path` and a body. `{id}` in a path or body is the
/// session that was started last, `{code}` the room that was opened last.
///
/// # Panics
///
/// If the server fails, or refuses without saying why: that is how a target reports.
pub fn requests(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let mut served = SERVER.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(served) = served.as_mut() else { return };
    served.cases += 1;
    if served.cases.is_multiple_of(CASES) {
        let App { course, variants, limits, .. } = served.first.clone();
        let fresh = App::new((*course).clone(), Store::in_memory(), (*limits).clone());
        served.router = triad::app(App { course, variants, ..fresh });
    }
    let mut told = Told::default();
    for part in text.split("---8<---\n").take(MOST) {
        let (line, body) = part.split_once('\n').unwrap_or((part, ""));
        let Some((method, path)) = line.split_once(' ') else { continue };
        let (path, body) = (told.filled_in(path), told.filled_in(body));
        let Some((status, answer)) = served.ask(method, &path, body, &told.key) else { continue };
        judge(status, &answer, line);
        told.listen(&path, status, &answer);
    }
    for session in &told.sessions {
        served.ask("DELETE", &format!("/api/v1/sessions/{session}"), String::new(), "");
    }
    if !told.code.is_empty() {
        served.ask("DELETE", &format!("/api/v1/rooms/{}", told.code), String::new(), &told.key);
    }
}

impl Served {
    fn ask(&self, method: &str, path: &str, body: String, key: &str) -> Option<(StatusCode, Bytes)> {
        let mut request = Request::builder()
            .method(Method::from_bytes(method.as_bytes()).ok()?)
            .uri(path)
            .header(header::CONTENT_TYPE, "application/json");
        if let Ok(value) = HeaderValue::from_str(&format!("Bearer {key}")) {
            request = request.header(header::AUTHORIZATION, value);
        }
        let request = request.body(Body::from(body)).ok()?;
        self.runtime.block_on(async {
            let response = self.router.clone().oneshot(request).await.ok()?;
            let status = response.status();
            Some((status, to_bytes(response.into_body(), ANSWER).await.ok()?))
        })
    }
}

impl Told {
    fn filled_in(&self, text: &str) -> String {
        let session = self.sessions.last().map_or("none", String::as_str);
        text.replace("{id}", session).replace("{code}", &self.code)
    }

    fn listen(&mut self, path: &str, status: StatusCode, answer: &[u8]) {
        if status != StatusCode::CREATED {
            return;
        }
        let answer: Value = serde_json::from_slice(answer).unwrap_or_default();
        let word = |name: &str| answer[name].as_str().map(str::to_owned);
        if path.starts_with("/api/v1/sessions") {
            self.sessions.extend(word("id"));
        } else if path.starts_with("/api/v1/rooms") {
            self.code = word("code").unwrap_or_default();
            self.key = word("key").unwrap_or_default();
        }
    }
}

/// No failure of the server, and every refusal says what is wrong and what to try.
fn judge(status: StatusCode, answer: &[u8], line: &str) {
    let busy = status == StatusCode::SERVICE_UNAVAILABLE;
    assert!(busy || !status.is_server_error(), "{line}: {status}: {}", String::from_utf8_lossy(answer));
    if !status.is_client_error() || !line.contains("/api/") {
        return;
    }
    let problem: Value = serde_json::from_slice(answer).unwrap_or_default();
    for member in ["code", "detail", "hint"] {
        let told = problem[member].as_str().is_some_and(|text| !text.is_empty());
        assert!(told, "{line}: {status} without {member}: {}", String::from_utf8_lossy(answer));
    }
}
