//! `triad export`: what the workbench serves, as files.

use std::path::Path;

use serde_json::json;

use super::output::write;
use super::terminal::{Outcome, counted, print_json, print_line};
use crate::api;
use crate::docs::Site;
use crate::problem::Problem;

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
