//! `triad regrade`.

use std::path::PathBuf;

use clap::Args;
use tokio::runtime::Builder;

use super::grades::{existing, kept_course};
use crate::cli::terminal::{Outcome, counted, print_json, print_line};
use crate::problem::Problem;
use crate::regrade;
use crate::store::Store;

#[derive(Debug, Args)]
pub(in crate::cli) struct Regrade {
    /// The gradebook.
    #[arg(long, default_value = "triad.db", value_name = "PATH", env = "TRIAD_DATABASE")]
    pub(in crate::cli) database: PathBuf,
    /// Grade everything again with the lesson that graded it, compare byte for byte, and write nothing.
    #[arg(long, required = true)]
    pub(in crate::cli) check: bool,
}

/// Rebuilds every verdict.
pub(in crate::cli) fn regrade(options: &Regrade, json: bool) -> Result<Outcome, Problem> {
    let runtime = Builder::new_current_thread().enable_all().build().map_err(Problem::internal)?;
    let rebuilt = runtime.block_on(async {
        let store = Store::open(existing(&options.database)?).await?;
        let (course, _) = kept_course(&store).await;
        regrade::check(&store, course).await
    })?;
    if json {
        print_json(&rebuilt);
    } else {
        for one in &rebuilt.changed {
            let now = one.now.map_or("not gradable".to_owned(), |points| points.to_string());
            print_line(&format!("{} {}: {} -> {now} points", one.submission, one.lesson, one.before));
            print_line(&format!("        {}  (made by {})", one.difference, one.build));
        }
        print_line(&format!(
            "{} rebuilt byte for byte, {} otherwise",
            counted(rebuilt.same, "verdict"),
            rebuilt.changed.len()
        ));
        if rebuilt.without_lesson > 0 {
            let old = counted(rebuilt.without_lesson, "verdict");
            print_line(&format!("{old} of a gradebook that did not keep lessons cannot be rebuilt"));
        }
    }
    Ok(if rebuilt.changed.is_empty() { Outcome::Done } else { Outcome::No })
}
