//! `triad backup`, `triad restore`, `triad class`.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use clap::{Args, Subcommand};
use serde_json::json;
use tokio::runtime::Builder;
use tokio::sync::mpsc;

use super::grades::{existing, file as present, kept_course};
use crate::cli::output::{not_standard, unwritable};
use crate::cli::terminal::{Outcome, counted, print_json, print_line};
use crate::problem::Problem;
use crate::store::{Copied, Location, Pieces, Query, Store, StoreError};

/// Where the gradebook is.
#[derive(Debug, Args)]
pub(in crate::cli) struct Database {
    /// The gradebook: a file, or postgres://user@host/name.
    #[arg(long, default_value = "triad.db", value_name = "PLACE", env = "TRIAD_DATABASE")]
    pub(super) database: Location,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct Backup {
    /// The file to make.
    file: PathBuf,
    #[command(flatten)]
    of: Database,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct Restore {
    /// The backup.
    file: PathBuf,
    #[command(flatten)]
    to: Database,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum Class {
    /// Write the whole class into one file: people, lessons, submissions, verdicts, decisions, the log.
    ///
    /// A line of JSON for each row, for any program to read; the last line says that all is there. People keep their words and
    /// links; sessions are left behind. The file holds names, grades and the class's secret: keep it as the gradebook itself.
    #[command(after_help = "Example:\n  triad class export mechanics.triad\n  \
        triad class import mechanics.triad --database /srv/triad/grades.db")]
    Export {
        /// The file to make.
        file: PathBuf,
        #[command(flatten)]
        of: Database,
    },
    /// Bring a class that was exported into a gradebook that has none; the gradebook is made if it is not there.
    ///
    /// All of it comes in, or nothing; a class that is there already is not taken twice. A file that is not whole, that was
    /// changed, or that a later version wrote is refused.
    #[command(after_help = "Example:\n  triad class import mechanics.triad --database new.db")]
    Import {
        /// The file.
        file: PathBuf,
        #[command(flatten)]
        to: Database,
    },
    /// Write everything that is kept of one person into a file: a copy for themselves.
    #[command(after_help = "Example:\n  triad class copy \"Ada L.\" ada.json\n\n\
        In a class everybody takes their own at /api/v1/me/data.")]
    Copy {
        /// Name of the person.
        name: String,
        /// The file to make.
        file: PathBuf,
        #[command(flatten)]
        of: Database,
    },
    /// Erase a person: name, words, link, sessions, and what they handed in.
    ///
    /// What a grade is proved with stays, under a number: points, dates, decisions, and the log, which says that it was done
    /// and why. Backups and exports from before still have everything: remove them when their time is over.
    #[command(
        after_help = "Examples:\n  triad class erase \"Ada L.\" --reason \"asked for it on 3 May\"\n  \
        triad class erase \"Ada L.\" --reason \"left\" --answers-stay   (where law wants examinations kept)"
    )]
    Erase {
        /// Name of the person.
        name: String,
        /// Why: who asked, or which rule says so.
        #[arg(long, value_name = "TEXT")]
        reason: String,
        /// Keep what was handed in, without the name.
        #[arg(long)]
        answers_stay: bool,
        #[command(flatten)]
        of: Database,
    },
}

/// Copies the gradebook.
pub(in crate::cli) fn backup(options: &Backup, json: bool) -> Result<Outcome, Problem> {
    not_standard("FILE", &options.file)?;
    run(async {
        let store = Store::at(existing(&options.of.database)?).await?;
        tell(&options.file, store.backup(&options.file).await?, json);
        Ok(Outcome::Done)
    })
}

/// Brings a copy back.
pub(in crate::cli) fn restore(options: &Restore, json: bool) -> Result<Outcome, Problem> {
    run(async {
        let Location::File(to) = &options.to.database else {
            return Err(StoreError::FileOnly("made of a backup").into());
        };
        let copied = crate::store::restore(present(&options.file)?, to).await?;
        tell(to, copied, json);
        Ok(Outcome::Done)
    })
}

fn tell(file: &Path, copied: Copied, json: bool) {
    if json {
        return print_json(&copied);
    }
    let submissions = counted(usize::try_from(copied.submissions).unwrap_or_default(), "submission");
    print_line(&format!(
        "{}: {submissions}, {} entries of the log, {} kB, every record as it was written",
        file.display(),
        copied.events,
        copied.bytes.div_ceil(1024)
    ));
}

/// Exports, imports, copies or erases.
pub(in crate::cli) fn class(command: Class, json: bool) -> Result<Outcome, Problem> {
    if let Class::Export { file, .. } | Class::Copy { file, .. } = &command {
        not_standard("FILE", file)?;
    }
    run(async {
        match command {
            Class::Export { file, of } => {
                let store = Store::at(existing(&of.database)?).await?;
                export(&store, &file, json).await
            }
            Class::Import { file, to } => {
                let imported = Store::at(&to.database).await?.import(present(&file)?).await?;
                if json {
                    print_json(&imported);
                } else if imported.rows == 0 {
                    print_line("All of it is there already: nothing was changed");
                } else {
                    print_line(&format!("{} rows came in, every record as it was written", imported.rows));
                }
                Ok(Outcome::Done)
            }
            Class::Copy { name, file, of } => {
                let store = Store::at(existing(&of.database)?).await?;
                let text = data_of(&store, &name).await?;
                new_file(&file)?.write_all(text.as_bytes()).map_err(|error| unwritable(&file, &error))?;
                Ok(said(&format!("{}: {} kB", file.display(), text.len().div_ceil(1024)), json))
            }
            Class::Erase { name, reason, answers_stay, of } => {
                let store = Store::at(existing(&of.database)?).await?;
                let (course, _) = kept_course(&store).await;
                let person = person(&store, course, &name).await?;
                store.erase(course, "triad", &person, &reason, answers_stay).await?;
                Ok(said(&format!("{name} is erased; points, dates and decisions stay under a number"), json))
            }
        }
    })
}

pub(super) fn run(work: impl Future<Output = Result<Outcome, Problem>>) -> Result<Outcome, Problem> {
    Builder::new_current_thread().enable_all().build().map_err(Problem::internal)?.block_on(work)
}

pub(super) fn said(line: &str, json: bool) -> Outcome {
    if json {
        print_json(&json!({"done": line}));
    } else {
        print_line(line);
    }
    Outcome::Done
}

async fn export(store: &Store, file: &Path, json: bool) -> Result<Outcome, Problem> {
    let (course, _) = kept_course(store).await;
    let mut written = new_file(file)?;
    let (pieces, mut received): (Pieces, _) = mpsc::channel(4);
    let write = async {
        let mut bytes = 0_usize;
        while let Some(piece) = received.recv().await {
            let piece = piece?;
            bytes += piece.len();
            written.write_all(&piece).map_err(|error| unwritable(file, &error))?;
        }
        written.sync_all().map_err(|error| unwritable(file, &error))?;
        Ok::<_, Problem>(bytes)
    };
    let send = async {
        let pieces = pieces;
        store.export(course, &pieces).await
    };
    let (sent, bytes) = tokio::join!(send, write);
    if let Err(problem) = sent.map_err(Problem::from).and(bytes.clone()) {
        drop(std::fs::remove_file(file));
        return Err(problem);
    }
    Ok(said(&format!("{}: {} kB", file.display(), bytes?.div_ceil(1024)), json))
}

/// A file that its owner alone can read.
///
/// Errors if there is one.
fn new_file(path: &Path) -> Result<std::fs::File, Problem> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => StoreError::Exists(path.to_owned()).into(),
        _ => unwritable(path, &error),
    })
}

async fn person(store: &Store, course: &str, name: &str) -> Result<String, Problem> {
    store.person_named(course, name).await?.ok_or_else(|| {
        let wrong = format!("there is nobody called {name} in this gradebook");
        Problem::new(StatusCode::NOT_FOUND, "unknown-person", wrong, "triad grades lists everybody")
    })
}

/// Everything that is kept of a person.
async fn data_of(store: &Store, name: &str) -> Result<String, Problem> {
    let (course, title) = kept_course(store).await;
    let id = person(store, course, name).await?;
    let query = Query { course: course.into(), person: Some(id.clone()), lesson: None, limit: usize::MAX };
    let submissions = store.list(&query).await?.into_iter();
    let decisions = store.decisions(course, Some(&id), None).await?.into_iter();
    let decision = |one: crate::store::Decision| json!({"lesson": one.lesson, "points": one.points, "reason": one.reason, "at": one.at});
    let data = json!({
        "person": {"id": id, "name": name}, "course": title,
        "submissions": submissions.map(|one| json!({"answers": one.answers, "verdict": one.verdict})).collect::<Vec<_>>(),
        "decisions": decisions.map(decision).collect::<Vec<_>>(),
        "log": store.events_of(course, &id).await?,
        "learning_platforms": store.subjects(&id).await?,
    });
    store.note(course, "triad", "took a copy of the data of", &id).await?;
    serde_json::to_string_pretty(&data).map_err(Problem::internal)
}
