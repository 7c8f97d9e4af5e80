//! `triad export`: what the workbench serves, as files.

use std::fs;
use std::path::Path;

use axum::http::StatusCode;
use serde_json::json;
use triad_lessons::Course;

use super::output::{unwritable, write};
use super::terminal::{Outcome, counted, print_json, print_line};
use crate::api;
use crate::docs::Site;
use crate::problem::Problem;
use crate::site;

/// Writes the documentation into a folder.
pub(super) fn docs(dir: &Path, json: bool) -> Result<Outcome, Problem> {
    let site = Site::new(&api::openapi(), None);
    let (mut count, mut bytes) = (0, 0);
    for (name, text) in site.files() {
        write(&dir.join(name), text)?;
        count += 1;
        bytes += text.len();
    }
    let index = dir.join("index.html");
    if json {
        print_json(&json!({ "files": count, "bytes": bytes, "index": index }));
    } else {
        let size = bytes as f64 / 1e6;
        print_line(&format!("{} with {size:.1} MB; open {}", counted(count, "file"), index.display()));
    }
    Ok(Outcome::Done)
}

/// Writes the course into an empty folder.
pub(super) fn site(dir: &Path, course: Course, json: bool) -> Result<Outcome, Problem> {
    if fs::read_dir(dir).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "not-empty",
            format!("{} holds something already", dir.display()),
            "give a new folder, or an empty one: a file of an earlier site would stay among the new ones",
        ));
    }
    let runtime =
        tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Problem::internal)?;
    let files = runtime.block_on(site::files(course))?;
    fs::create_dir_all(dir).map_err(|error| unwritable(dir, &error))?;
    for (path, bytes) in &files {
        write(&dir.join(path), bytes)?;
    }
    let bytes: usize = files.values().map(Vec::len).sum();
    if json {
        print_json(&json!({ "files": files.len(), "bytes": bytes, "index": dir.join("index.html") }));
    } else {
        let size = bytes as f64 / 1e6;
        print_line(&format!(
            "{} with {size:.1} MB in {}. Any host of files serves them; README.txt there says how to look at them here.",
            counted(files.len(), "file"),
            dir.display()
        ));
    }
    Ok(Outcome::Done)
}
