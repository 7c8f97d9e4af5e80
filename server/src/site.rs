//! The course as files: lessons, scenes, page and engine for any host of files, without a server.
//!
//! What the files of lessons say is what the server answers to somebody it knows nothing of: asked of the server itself, so
//! that nothing is in them that it would not tell everybody.

use std::collections::BTreeMap;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::{Request, StatusCode};
use serde_json::Value;
use sha2::{Digest, Sha256};
use tower::ServiceExt;
use triad_engine::catalogue;
use triad_lessons::Course;
use triad_lessons::exercise::QuestionBody;

use crate::api;
use crate::app::App;
use crate::docs;
use crate::limits::Limits;
use crate::page;
use crate::problem::Problem;
use crate::store::Store;
use crate::store::hash::hexadecimal;

/// The files of a site by their paths, with `/` between folders.
pub type Files = BTreeMap<String, Vec<u8>>;

/// The most that one answer has, bytes.
const LARGEST_ANSWER: usize = 16 << 20;
/// The languages of starters.
const LANGUAGES: [&str; 3] = ["python", "octave", "julia"];
/// Where answers lie; `web/src/api/files.ts` asks for them there.
const DATA: &str = "data";
/// The script that keeps the site in the browser.
const KEEPER: &str = include_str!("site/keep.js");
/// What somebody finds who looks into the folder.
const README: &str = include_str!("site/README.txt");
/// Parts of the page that show recordings, which only a server makes.
const VIEWER: &str = "re_viewer";

/// All files of the site of a course.
///
/// Errors if the program was built without the engine for the page, or the course cannot be shown.
pub async fn files(course: Course) -> Result<Files, Problem> {
    let mut files = Files::new();
    for (path, bytes) in page::files().await? {
        if !path.contains(VIEWER) {
            files.insert(path.to_owned(), bytes.to_vec());
        }
    }
    if !files.keys().any(|path| path.starts_with("assets/engine-")) {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "no-engine",
            "this program was built without the engine that computes in the page, which a site without a server needs",
            "rustup target add wasm32-unknown-unknown, then build again: cargo build --release",
        ));
    }
    let page = files.remove("index.html").unwrap_or_default();
    files.insert("index.html".to_owned(), standing_alone(&String::from_utf8_lossy(&page)).into_bytes());
    files.extend(data(course).await?);
    let docs = docs::Site::new(&api::openapi(), Some("../index.html"));
    files.extend(docs.files().map(|(name, text)| (format!("docs/{name}"), text.as_bytes().to_vec())));
    files.insert("README.txt".to_owned(), README.as_bytes().to_vec());
    let keeper = keeper(&files);
    files.insert("keep.js".to_owned(), keeper.into_bytes());
    Ok(files)
}

/// The page as it stands in a folder of any name: it says so, and finds its files beside it.
fn standing_alone(page: &str) -> String {
    page.replacen("<html ", "<html data-site ", 1).replace("=\"/assets/", "=\"./assets/")
}

/// The script that keeps the site in the browser: it knows all files, and is another one when any of them is.
fn keeper(files: &Files) -> String {
    let mut hash = Sha256::new();
    for (path, bytes) in files {
        hash.update(path);
        hash.update(bytes);
    }
    let version = hexadecimal(&hash.finalize()[..8]);
    let kept: Vec<&String> = files.keys().filter(|path| *path != "README.txt").collect();
    KEEPER
        .replace("\"VERSION\"", &Value::from(version).to_string())
        .replace("[\"FILES\"]", &serde_json::json!(kept).to_string())
}

/// What the server answers to everybody, as files.
///
/// Errors if the course cannot be shown.
pub async fn data(course: Course) -> Result<Files, Problem> {
    let mut paths: Vec<String> = ["/me", "/lessons", "/schema/scene", "/pictures"].map(str::to_owned).into();
    // A family of scenes is shown by its second.
    let scenes = catalogue::ENTRIES.iter().map(|entry| entry.name.replace(":N", ":2"));
    paths.extend(scenes.map(|name| format!("/scenes/{name}/motion")));
    let mut starters = Vec::new();
    for lesson in course.lessons() {
        let base = format!("/lessons/{}", lesson.slug);
        for question in &lesson.exercise.questions {
            let question_path = format!("{base}/questions/{}", question.id);
            paths.extend((1..=question.hints.len()).map(|k| format!("{question_path}/hints/{k}")));
            if matches!(question.body, QuestionBody::Implement(_)) {
                paths.push(format!("{question_path}/states"));
                starters
                    .extend(LANGUAGES.iter().map(|language| format!("{question_path}/starters/{language}")));
            }
        }
        paths.push(format!("{base}/motion"));
        paths.push(base);
    }
    let server = crate::app(App::new(course, Store::in_memory(), Limits::default()));
    let mut files = Files::new();
    for path in paths {
        let bytes = answer(&server, &format!("/api/v1{path}")).await?;
        let is_lesson = path.starts_with("/lessons/") && path.matches('/').count() == 2;
        let bytes = if is_lesson { without_predictions(&bytes)? } else { bytes };
        // A memory stick takes no colons in names.
        files.insert(format!("{DATA}{}.json", path.replace(':', "-")), bytes);
    }
    for path in starters {
        let bytes = answer(&server, &format!("/api/v1{path}")).await?;
        files.insert(format!("{DATA}{path}.txt"), bytes);
    }
    Ok(files)
}

/// A lesson without what is asked before its run: what comes true is told by a server, in its answer to a prediction.
fn without_predictions(lesson: &[u8]) -> Result<Vec<u8>, Problem> {
    let mut lesson: Value = serde_json::from_slice(lesson).map_err(Problem::internal)?;
    if let Some(predictions) = lesson.get_mut("predictions") {
        *predictions = Value::Array(Vec::new());
    }
    serde_json::to_vec(&lesson).map_err(Problem::internal)
}

async fn answer(server: &Router, path: &str) -> Result<Vec<u8>, Problem> {
    let request = Request::get(path).body(Body::empty()).map_err(Problem::internal)?;
    let response = server.clone().oneshot(request).await.map_err(Problem::internal)?;
    let status = response.status();
    let body = to_bytes(response.into_body(), LARGEST_ANSWER).await.map_err(Problem::internal)?;
    if status != StatusCode::OK {
        return Err(Problem::internal(format!("{path}: {status} {}", String::from_utf8_lossy(&body))));
    }
    Ok(body.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_finds_its_files_beside_it_and_knows_that_there_is_no_server() {
        let page = r#"<html lang="en"><link href="/assets/a.css"><script src="/assets/b.js">"#;
        let alone = r#"<html data-site lang="en"><link href="./assets/a.css"><script src="./assets/b.js">"#;
        assert_eq!(standing_alone(page), alone);
    }

    #[test]
    fn the_keeper_is_another_one_when_any_file_is() {
        let files = |text: &str| Files::from([("a.js".to_owned(), text.as_bytes().to_vec())]);
        let (one, other) = (keeper(&files("1")), keeper(&files("2")));
        assert!(one.contains(r#"["a.js"]"#) && !one.contains("VERSION") && !one.contains("FILES"), "{one}");
        assert_ne!(one, other);
    }
}
