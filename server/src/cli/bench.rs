//! `triad bench`: run time against error of the built-in scenes.

use std::path::Path;

use axum::http::StatusCode;

use super::Outcome;
use super::terminal::{print_line, progress};
use crate::bench::{Plan, csv, html, measure, table};
use crate::problem::Problem;

/// Measures, prints the times to reach three errors, and writes `bench.csv` and `bench.html` into `folder`.
pub(super) fn bench(quick: bool, folder: &Path, hidden: bool) -> Result<Outcome, Problem> {
    let plan = if quick { Plan::quick() } else { Plan::full() };
    std::fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
    let bar = progress("bench", 1.0, hidden);
    let runs = measure(&plan, |part, _| bar.reached(part))?;
    drop(bar);
    print_line(&table(&runs));
    for (name, text) in [("bench.csv", csv(&runs)), ("bench.html", html(&runs))] {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| unwritable(&path, &error))?;
        print_line(&format!("written: {}", path.display()));
    }
    Ok(Outcome::Done)
}

fn unwritable(path: &Path, error: &std::io::Error) -> Problem {
    Problem::new(
        StatusCode::INTERNAL_SERVER_ERROR,
        "unwritable-file",
        format!("{} cannot be written: {error}", path.display()),
        "check that the folder exists and is writable",
    )
}
