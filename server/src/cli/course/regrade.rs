//! `triad regrade`.

use std::sync::Arc;
use std::time::Duration;

use axum::http::StatusCode;
use clap::{ArgGroup, Args, ValueEnum};
use tokio::runtime::Builder;
use tokio::time::sleep;
use triad_lessons::Course;

use super::grades::{existing, kept_course};
use crate::aside::step_back;
use crate::cli::terminal::{Outcome, counted, print_json, print_line};
use crate::grader::{Grader, LEASE};
use crate::problem::Problem;
use crate::regrade::{self, Preview, Rebuilt};
use crate::store::{Location, Role, Store, identifier};

/// The pause between two looks for what is to be judged.
const LOOK: Duration = Duration::from_millis(50);

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("what").required(true).args(["check", "lesson", "undo"]))]
pub(in crate::cli) struct Regrade {
    /// The gradebook: a file, or postgres://user@host/name.
    #[arg(long, default_value = "triad.db", value_name = "PLACE", env = "TRIAD_DATABASE")]
    pub(in crate::cli) database: Location,
    /// Grade everything again with the lesson that graded it, compare byte for byte, and write nothing.
    #[arg(long)]
    pub(in crate::cli) check: bool,
    /// Grade what was handed in to this lesson with the lesson as it is now, and say what would change.
    #[arg(long, value_name = "SLUG")]
    pub(in crate::cli) lesson: Option<String>,
    /// Let the new verdicts count: for everybody, or for those who do not lose by them.
    #[arg(long, value_enum, requires_all = ["lesson", "reason"])]
    pub(in crate::cli) apply: Option<Choice>,
    /// Why: students see it.
    #[arg(long, value_name = "TEXT", requires = "apply")]
    pub(in crate::cli) reason: Option<String>,
    /// Take a regrade back: the verdicts of before hold again.
    #[arg(long, value_name = "ID")]
    pub(in crate::cli) undo: Option<String>,
}

/// What counts of a regrade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Choice {
    /// The new verdicts, for everybody.
    Replace,
    /// The new verdicts for those who do not lose by them.
    Better,
}

/// Rebuilds every verdict, or judges a lesson anew, or takes that back.
pub(in crate::cli) fn regrade(options: &Regrade, course: &Course, json: bool) -> Result<Outcome, Problem> {
    // Whatever server runs on this machine goes first.
    step_back();
    let runtime = Builder::new_current_thread().enable_all().build().map_err(Problem::internal)?;
    runtime.block_on(async {
        let store = Arc::new(Store::at(existing(&options.database)?).await?);
        let (id, _) = kept_course(&store).await;
        if let Some(slug) = &options.lesson {
            return of_lesson(&store, id, course, slug, options, json).await;
        }
        if let Some(undone) = &options.undo {
            store.undo_regrade(id, &owner(&store, id).await?, undone).await?;
            print_line("The verdicts of before hold again.");
            return Ok(Outcome::Done);
        }
        let rebuilt = regrade::check(&store, id).await?;
        if json {
            print_json(&rebuilt);
        } else {
            print_rebuilt(&rebuilt);
        }
        Ok(if rebuilt.changed.is_empty() { Outcome::Done } else { Outcome::No })
    })
}

async fn of_lesson(
    store: &Arc<Store>,
    id: &str,
    course: &Course,
    slug: &str,
    options: &Regrade,
    json: bool,
) -> Result<Outcome, Problem> {
    let lesson = course.lesson(slug).ok_or_else(|| crate::api::unknown_lesson(course, slug))?;
    let computed = tokio::select! {
        computed = regrade::preview(store, identifier(), id, lesson, Arc::default()) => computed?,
        failed = help(store) => return Err(failed),
    };
    if json {
        print_json(&computed.shown);
    } else {
        print_preview(&computed.shown);
    }
    if let (Some(choice), Some(reason)) = (options.apply, &options.reason) {
        let actor = owner(store, id).await?;
        let applied =
            store.regrade(&computed.applied(id, &actor, choice == Choice::Better, reason.trim())).await?;
        if !json {
            print_line(&format!("Applied. To take it back: triad regrade --undo {applied}"));
        }
    }
    Ok(Outcome::Done)
}

/// Judges what the regrade asks for, beside the graders that there may be; ends only by a failure.
async fn help(store: &Arc<Store>) -> Problem {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let grader = Grader::new(Arc::clone(store), Arc::default(), Arc::default(), processors, LEASE);
    loop {
        if let Err(problem) = grader.judge_again().await {
            return problem;
        }
        sleep(LOOK).await;
    }
}

/// In whose name the command line acts: an owner of the class, or at home anybody.
async fn owner(store: &Store, id: &str) -> Result<String, Problem> {
    let people = store.people(id).await?;
    let found = people.iter().find(|person| person.role == Role::Owner).or(people.first());
    found.map(|person| person.id.clone()).ok_or_else(|| {
        Problem::new(
            StatusCode::NOT_FOUND,
            "nobody",
            "nobody is in this gradebook",
            "hand something in first",
        )
    })
}

fn print_preview(shown: &Preview) {
    for person in &shown.people {
        print_line(&format!("{:<32} {} -> {} points", person.name, person.before, person.after));
        for (question, [before, after]) in person.submissions.iter().flat_map(|one| &one.misconceptions) {
            let word = |id: &str| if id.is_empty() { "none".to_owned() } else { id.to_owned() };
            print_line(&format!("        {question}: {} -> {}", word(before), word(after)));
        }
    }
    let counts = &shown.counts;
    print_line(&format!(
        "{}: {} the same, {} in other words, {} up, {} down, {} in what can be judged, {} not gradable by the new lesson",
        counted(shown.submissions, "submission"),
        counts.same,
        counts.words,
        counts.up,
        counts.down,
        counts.gradable,
        counts.failed
    ));
    if counts.program > 0 {
        print_line(&format!(
            "{} differ with the same lesson: by this program, not by the lesson",
            counted(counts.program, "verdict")
        ));
    }
}

fn print_rebuilt(rebuilt: &Rebuilt) {
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
