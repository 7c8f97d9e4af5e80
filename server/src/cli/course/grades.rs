//! `triad grades`.

use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use clap::Args;
use tokio::runtime::Builder;
use triad_lessons::Course;

use crate::cli::terminal::{Outcome, counted, print_json, print_line, tell};
use crate::grades::{Format, GradeTable, OtherPoints, csv, fill, lines, table};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{CLASS, HOME, Location, Store};

#[derive(Debug, Args)]
pub(in crate::cli) struct Grades {
    /// The gradebook: a file, or postgres://user@host/name.
    #[arg(long, default_value = "triad.db", value_name = "PLACE", env = "TRIAD_DATABASE")]
    pub(in crate::cli) database: Location,
    /// Print the table as CSV.
    #[arg(long)]
    pub(in crate::cli) csv: bool,
    /// For which program the CSV is.
    #[arg(long = "for", value_enum, default_value_t, requires = "csv")]
    pub(in crate::cli) format: Format,
    /// Print a line of JSON for each student and lesson in which there is something.
    #[arg(long, conflicts_with = "csv")]
    pub(in crate::cli) jsonl: bool,
    /// Fill in a gradebook that Canvas exported, and print what to import there again: only columns that change.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["csv", "jsonl"])]
    pub(in crate::cli) canvas: Option<PathBuf>,
    /// Look whether every record is as it was written, instead.
    #[arg(long, conflicts_with_all = ["csv", "jsonl", "canvas"])]
    pub(in crate::cli) check: bool,
}

/// Prints what everybody has reached, while a server runs or not.
pub(in crate::cli) fn grades(options: &Grades, course: &Course, json: bool) -> Result<Outcome, Problem> {
    let runtime = Builder::new_current_thread().enable_all().build().map_err(Problem::internal)?;
    runtime.block_on(async {
        let store = Store::at(existing(&options.database)?).await?;
        if options.check {
            return check(&store, json).await;
        }
        let (id, title) = kept_course(&store).await;
        let grades = table(&store, id, course, Moment::now()).await?;
        match &options.canvas {
            Some(file) => filled(file, &grades, json)?,
            None if json => print_json(&grades),
            None if options.csv => print_line(csv(&grades, options.format, &title)?.trim_end()),
            None if options.jsonl => print_line(lines(&grades)?.trim_end()),
            None => print(&grades),
        }
        Ok(Outcome::Done)
    })
}

/// Fills in a gradebook of Canvas's; what could not be filled in is said beside it.
fn filled(file: &Path, grades: &GradeTable, json: bool) -> Result<(), Problem> {
    let exported = std::fs::read_to_string(file).map_err(|error| {
        let detail = format!("{} cannot be read: {error}", file.display());
        Problem::new(StatusCode::NOT_FOUND, "no-such-file", detail, "name the file that Canvas exported")
    })?;
    let filled = fill(&exported, grades)?;
    if json {
        print_json(&filled);
        return Ok(());
    }
    print_line(filled.csv.trim_end());
    tell(&format!("triad: {} changed", counted(filled.changed, "grade")));
    for (what, names) in [
        ("not in this class", &filled.unknown),
        ("not in the file", &filled.missing),
        ("without a column in the file", &filled.without_column),
    ] {
        if !names.is_empty() {
            tell(&format!("triad: {what}: {}", names.join("; ")));
        }
    }
    for OtherPoints { column, there, here } in &filled.other_points {
        tell(&format!("triad: {column} has {there} points in Canvas, and {here} here"));
    }
    Ok(())
}

/// A gradebook that is there: looking makes none. What is on a server is found out by opening it.
pub(in crate::cli) fn existing(location: &Location) -> Result<&Location, Problem> {
    if let Location::File(path) = location {
        file(path)?;
    }
    Ok(location)
}

/// A path at which there is something.
pub(super) fn file(path: &Path) -> Result<&Path, Problem> {
    if path.exists() {
        return Ok(path);
    }
    Err(Problem::new(
        StatusCode::NOT_FOUND,
        "no-such-file",
        format!("there is no gradebook {}", path.display()),
        "name it with --database; the server says where it keeps submissions when it starts",
    ))
}

/// The course of a gradebook and its title: the class's where there is one.
pub(super) async fn kept_course(store: &Store) -> (&'static str, String) {
    let class = store.course(CLASS).await;
    class.map_or((HOME, String::new()), |class| (CLASS, class.title))
}

async fn check(store: &Store, json: bool) -> Result<Outcome, Problem> {
    let faults = store.faults().await?;
    if json {
        print_json(&faults);
    } else {
        for fault in &faults {
            print_line(fault);
        }
        print_line(&counted(faults.len(), "fault"));
    }
    Ok(if faults.is_empty() { Outcome::Done } else { Outcome::No })
}

fn print(grades: &GradeTable) {
    for student in &grades.students {
        let passed = student.lessons.values().filter(|one| one.passed).count();
        let points: f64 = student.lessons.values().map(|one| one.points).sum();
        let begun = student.lessons.len();
        print_line(&format!("{:<32} {points:>7} points  {begun:>3} begun  {passed:>3} passed", student.name));
    }
    print_line(&counted(grades.students.len(), "student"));
}
