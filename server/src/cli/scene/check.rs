//! `triad check` and `triad scenes`.

use serde_json::json;
use triad_engine::analysis::check::CheckReport;
use triad_engine::catalogue;

use crate::cli::terminal::{Outcome, print_json, print_line};
use crate::problem::Problem;
use crate::scenes;

/// Counts what a scene amounts to.
pub(in crate::cli) fn check(spec: &str, json: bool) -> Result<Outcome, Problem> {
    let scene = scenes::named_or_in_file(spec)?;
    let report = triad_engine::analysis::check::check(&scene)?;
    if json {
        print_json(&report);
    } else {
        print(&report);
    }
    Ok(Outcome::Done)
}

fn print(report: &CheckReport) {
    print_line(&format!("{}: the scene can be assembled", report.name));
    for (what, count) in [
        ("moving bodies", report.bodies),
        ("coordinates", report.coordinates),
        ("constraint rows", report.rows),
        ("rank", report.rank),
        ("degrees of freedom", report.degrees_of_freedom),
    ] {
        print_line(&format!("  {what:<20}{count:>8}"));
    }
    if report.redundant.is_empty() {
        print_line("  no redundant rows: every reaction is unique");
    }
    for joint in &report.redundant {
        print_line(&format!("  redundant in {}: {}", joint.joint, joint.rows.join(", ")));
    }
    for note in &report.notes {
        print_line(&format!("  note: {note}"));
    }
}

/// Lists the built-in scenes.
pub(in crate::cli) fn list(json: bool) -> Outcome {
    if json {
        let entries = catalogue::ENTRIES.iter().map(|e| json!({"name": e.name, "summary": e.summary}));
        print_json(&entries.collect::<Vec<_>>());
    } else {
        let width = catalogue::ENTRIES.iter().map(|e| e.name.len()).max().unwrap_or(0);
        for entry in catalogue::ENTRIES {
            print_line(&format!("{:width$}  {}", entry.name, entry.summary));
        }
    }
    Outcome::Done
}
