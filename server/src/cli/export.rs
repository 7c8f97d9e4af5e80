//! `triad export`: what the workbench serves, as files; a lesson for the autograder of another system.

use std::fs;
use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use clap::Subcommand;
use serde_json::json;
use triad_lessons::Course;

use super::course::autograder::{self, Autograder};
use super::output::{not_standard, unwritable, write};
use super::terminal::{Outcome, counted, print_json, print_line};
use crate::api;
use crate::docs::Site;
use crate::problem::Problem;
use crate::site;

#[derive(Debug, Subcommand)]
pub(super) enum Export {
    /// The documentation: pages with a search, read without a server.
    #[command(after_help = "Example:\n  triad export docs site/docs      (then open site/docs/index.html)")]
    Docs {
        /// The folder; made if it is not there. Files of the same names are replaced.
        dir: PathBuf,
    },
    /// Write lessons, scenes, page and engine as files that any host of files serves, without a server.
    ///
    /// Lessons can be read, mechanisms run in the page and can be changed, questions are shown; answers are not checked, as
    /// that needs what the files do not hold. Once opened, the site works without a network.
    #[command(
        after_help = "Examples:\n  triad export site public\n  triad --course my-course export site public\n  \
        python3 -m http.server --directory public      (then open http://localhost:8000)"
    )]
    Site {
        /// The folder, which is made, or is empty.
        dir: PathBuf,
    },
    #[command(flatten)]
    Autograder(Autograder),
}

/// Writes what is asked for.
pub(super) fn export(
    what: &Export,
    course: impl FnOnce() -> Result<Course, Problem>,
    json: bool,
) -> Result<Outcome, Problem> {
    match what {
        Export::Docs { dir } => docs(dir, json),
        Export::Site { dir } => site(dir, course()?, json),
        Export::Autograder(what) => autograder::export(what, &course()?, json),
    }
}

/// Writes the documentation into a folder.
fn docs(dir: &Path, json: bool) -> Result<Outcome, Problem> {
    not_standard("DIR", dir)?;
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
fn site(dir: &Path, course: Course, json: bool) -> Result<Outcome, Problem> {
    not_standard("DIR", dir)?;
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
