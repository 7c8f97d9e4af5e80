//! `triad lesson preview`: the workbench over a course that is being written, shown anew whenever a file is saved.

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};
use std::time::{Duration, SystemTime};

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::{Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use serde_json::{Value, json};
use tokio::net::TcpListener;
use tower::ServiceExt;
use triad_lessons::Course;

use crate::app::App;
use crate::cli::terminal::{Outcome, counted, print_line};
use crate::limits::Limits;
use crate::problem::Problem;
use crate::store::Store;

/// Time between two looks at the files.
const LOOK: Duration = Duration::from_millis(400);
/// Most files that are looked at.
const MAX_FILES: usize = 5000;
/// Largest page that the script is put into, in bytes.
const LARGEST_PAGE: usize = 1 << 20;
/// What the page runs besides itself.
const SCRIPT: &str = include_str!("preview.js");

/// What is shown at the moment.
#[derive(Clone)]
struct Shown {
    /// The workbench over the last course that could be read; none before the first.
    router: Option<Router>,
    /// Goes up with every change of a file.
    version: u64,
    /// What the check says of the lesson, each with file, line and remedy.
    faults: Vec<Value>,
}

type Shared = Arc<RwLock<Shown>>;

/// Serves the lesson until it is stopped.
pub(in crate::cli) fn preview(course: Option<&Path>, lesson: &str, port: u16) -> Result<Outcome, Problem> {
    let Some(folder) = course else {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "no-course-folder",
            "the built-in course cannot be edited",
            "name the folder of yours: triad --course my-course lesson preview my-lesson",
        ));
    };
    let shown = look(folder, lesson, 1, None);
    let shared: Shared = Arc::new(RwLock::new(shown));
    let runtime =
        tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Problem::internal)?;
    runtime.block_on(listen(folder.to_owned(), lesson.to_owned(), port, shared))?;
    Ok(Outcome::Done)
}

async fn listen(folder: PathBuf, lesson: String, port: u16, shared: Shared) -> Result<(), Problem> {
    let wanted = SocketAddr::new(IpAddr::from([127, 0, 0, 1]), port);
    let listener = TcpListener::bind(wanted).await.map_err(|error| {
        let what = format!("cannot listen at {wanted}: {error}");
        Problem::new(StatusCode::INTERNAL_SERVER_ERROR, "port-unavailable", what, "choose another --port")
    })?;
    let address = listener.local_addr().map_err(Problem::internal)?;
    print_line(&format!("The lesson is at http://{address}/lessons/{lesson}  (Ctrl-C stops it)"));
    print_line(&format!("Files are looked at in {}; submissions are not kept", folder.display()));
    tell(&read(&shared).faults);
    tokio::task::spawn_blocking({
        let shared = shared.clone();
        move || watch(&folder, &lesson, &shared)
    });
    axum::serve(listener, router(shared)).await.map_err(Problem::internal)
}

fn read(shared: &Shared) -> Shown {
    shared.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Looks at the files again and again.
fn watch(folder: &Path, lesson: &str, shared: &Shared) {
    let mut before = stamp(folder);
    loop {
        std::thread::sleep(LOOK);
        let now = stamp(folder);
        if now == before {
            continue;
        }
        before = now;
        let Shown { version, router, .. } = read(shared);
        let shown = look(folder, lesson, version + 1, router);
        tell(&shown.faults);
        *shared.write().unwrap_or_else(PoisonError::into_inner) = shown;
    }
}

/// Number of files and the latest time at which one was changed.
fn stamp(folder: &Path) -> (usize, Option<SystemTime>) {
    let (mut count, mut latest) = (0, None);
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let Ok(about) = entry.metadata() else { continue };
            if count >= MAX_FILES || entry.file_name().to_string_lossy().starts_with('.') {
                continue;
            }
            count += 1;
            latest = latest.max(about.modified().ok());
            if about.is_dir() {
                open.push(entry.path());
            }
        }
    }
    (count, latest)
}

/// Reads the course and checks the lesson; a course that cannot be read leaves the last one in place.
fn look(folder: &Path, lesson: &str, version: u64, last: Option<Router>) -> Shown {
    let one = |what: String| vec![json!({"what": what})];
    let course = match Course::load(folder) {
        Ok(course) => course,
        Err(error) => return Shown { router: last, version, faults: one(error.to_string()) },
    };
    let faults = match course.lesson(lesson) {
        None => one(format!("the course has no lesson {lesson}; its folder is named NN-{lesson}")),
        Some(lesson) => triad_lessons::check_lesson(&course, lesson)
            .iter()
            .map(|fault| json!({"what": fault.to_string()}))
            .collect(),
    };
    let router = crate::app(App::new(course, Store::in_memory(), Limits::default()));
    Shown { router: Some(router), version, faults }
}

fn tell(faults: &[Value]) {
    for fault in faults {
        print_line(fault["what"].as_str().unwrap_or_default());
    }
    print_line(&counted(faults.len(), "fault"));
}

fn router(shared: Shared) -> Router {
    Router::new()
        .route("/preview/state", get(state))
        .route(
            "/preview.js",
            get(|| async { ([(header::CONTENT_TYPE, "text/javascript; charset=utf-8")], SCRIPT) }),
        )
        .fallback(pass)
        .with_state(shared)
}

async fn state(State(shared): State<Shared>) -> axum::Json<Value> {
    let shown = read(&shared);
    axum::Json(json!({"version": shown.version, "faults": shown.faults}))
}

/// Hands a request to the workbench, and puts the script into its page.
async fn pass(State(shared): State<Shared>, mut request: Request) -> Response {
    let Some(router) = read(&shared).router else {
        let page = "<!doctype html><title>Preview</title><body><script src=\"/preview.js\"></script>";
        return ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], page).into_response();
    };
    let is_page =
        request.headers().get(header::ACCEPT).is_some_and(|a| a.to_str().unwrap_or("").contains("text/html"));
    if is_page {
        request.headers_mut().remove(header::ACCEPT_ENCODING);
        request.headers_mut().remove(header::IF_NONE_MATCH);
    }
    let response = match router.oneshot(request).await {
        Ok(response) => response,
        Err(never) => match never {},
    };
    let html =
        response.headers().get(header::CONTENT_TYPE).is_some_and(|t| t.as_bytes().starts_with(b"text/html"));
    if !(is_page && html) {
        return response;
    }
    let (mut parts, body) = response.into_parts();
    let text = to_bytes(body, LARGEST_PAGE).await.unwrap_or_default();
    // After everything else; browsers take a script there into the body.
    let text = format!("{}<script src=\"/preview.js\"></script>", String::from_utf8_lossy(&text));
    parts.headers.remove(header::CONTENT_LENGTH);
    parts.headers.remove(header::ETAG);
    parts.headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    Response::from_parts(parts, Body::from(text))
}
