//! `triad check` and `triad scenes`.

use serde_json::json;
use triad_engine::analysis::check::CheckReport;
use triad_engine::catalogue;

use super::source::Source;
use crate::cli::clock::{Clock, Timed};
use crate::cli::terminal::{Outcome, print_json, print_line};
use crate::docs::GUIDE;
use crate::problem::Problem;
use crate::scenes;

/// Counts what a scene amounts to.
pub(in crate::cli) fn check(source: &Source, json: bool) -> Result<Outcome, Problem> {
    let mut clock = Clock::start();
    let scene = source.read()?;
    clock.lap("read");
    let report = triad_engine::analysis::check::check(&scene)?;
    clock.lap("check");
    if json {
        print_json(&Timed { answer: &report, seconds: &clock });
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

/// Prints a built-in scene as its author would write it.
pub(in crate::cli) fn show(name: &str) -> Result<Outcome, Problem> {
    print_line(&scenes::builtin(name)?.to_json());
    Ok(Outcome::Done)
}

/// Prints how a scene is written.
pub(in crate::cli) fn guide(json: bool) -> Outcome {
    if json {
        print_json(&json!({ "guide": GUIDE }));
    } else {
        print_line(GUIDE.trim_end());
    }
    Outcome::Done
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
