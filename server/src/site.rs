//! The course as files: lessons, scenes, page and engine for any host of files, without a server.
//!
//! What the files of lessons say is what the server answers to somebody it knows nothing of: asked of the server itself, so
//! that nothing is in them that it would not tell everybody.

use std::collections::BTreeMap;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::{Request, StatusCode};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use tower::ServiceExt;
use triad_engine::catalogue;
use triad_lessons::exercise::QuestionBody;
use triad_lessons::{Course, Lesson};

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
    let lessons = course.lessons().to_vec();
    let server = crate::app(App::new(course, Store::in_memory(), Limits::default()));
    let mut files = Files::new();
    for path in ["/me", "/lessons", "/notions", "/schema/scene"] {
        add(&mut files, &server, path, "json").await?;
    }
    // A family of scenes is shown by its second.
    for entry in catalogue::ENTRIES {
        add(&mut files, &server, &format!("/scenes/{}/motion", entry.name.replace(":N", ":2")), "json")
            .await?;
    }
    for lesson in &lessons {
        add_lesson(&mut files, &server, lesson).await?;
    }
    let pictures = scenes_alone(&answer(&server, "/api/v1/pictures").await?)?;
    files.insert(format!("{DATA}/pictures.json"), pictures);
    Ok(files)
}

/// Adds a lesson, with the questions that everybody sees: of a pool some are drawn, and the others are not told.
async fn add_lesson(files: &mut Files, server: &Router, lesson: &Lesson) -> Result<(), Problem> {
    let base = format!("/lessons/{}", lesson.slug);
    let mut view: Value = serde_json::from_slice(&answer(server, &format!("/api/v1{base}")).await?)
        .map_err(Problem::internal)?;
    // What comes true is told by a server, in its answer to a prediction.
    view["predictions"] = Value::Array(Vec::new());
    let shown = view["exercise"]["questions"].as_array().into_iter().flatten();
    let shown: Vec<&str> = shown.filter_map(|question| question["id"].as_str()).collect();
    for question in lesson.exercise.questions.iter().filter(|question| shown.contains(&question.id.as_str()))
    {
        let own = format!("{base}/questions/{}", question.id);
        for k in 1..=question.hints.len() {
            add(files, server, &format!("{own}/hints/{k}"), "json").await?;
        }
        if matches!(question.body, QuestionBody::Implement(_)) {
            add(files, server, &format!("{own}/states"), "json").await?;
            for language in LANGUAGES {
                add(files, server, &format!("{own}/starters/{language}"), "txt").await?;
            }
        }
    }
    files.insert(format!("{DATA}{base}.json"), serde_json::to_vec(&view).map_err(Problem::internal)?);
    Ok(())
}

/// Adds what the server answers at a path. A memory stick takes no colons in names.
async fn add(files: &mut Files, server: &Router, path: &str, ending: &str) -> Result<(), Problem> {
    let bytes = answer(server, &format!("/api/v1{path}")).await?;
    files.insert(format!("{DATA}{}.{ending}", path.replace(':', "-")), bytes);
    Ok(())
}

/// The pictures of the built-in scenes: those of lessons hold numbers that some lessons ask for.
fn scenes_alone(pictures: &[u8]) -> Result<Vec<u8>, Problem> {
    let mut pictures: Value = serde_json::from_slice(pictures).map_err(Problem::internal)?;
    pictures["lessons"] = Value::Object(Map::new());
    serde_json::to_vec(&pictures).map_err(Problem::internal)
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
        assert!(
            one.contains(r#"["a.js"]"#) && !one.contains("\"VERSION\"") && !one.contains("\"FILES\""),
            "{one}"
        );
        assert_ne!(one, other);
    }
}
