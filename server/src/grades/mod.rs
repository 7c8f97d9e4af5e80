//! The table of a class: students and what each has reached in every lesson, for the page and for other programs.

mod book;
mod canvas;
mod exports;
mod record;

use std::collections::HashMap;

use schemars::JsonSchema;
use serde::Serialize;
use triad_lessons::{Course, Lesson};

use crate::policy::{Decided, Moment};
use crate::problem::Problem;
use crate::store::{DecisionKind, Member, Role, Store};

pub use book::{Book, Entry, Marked, assigned, pass_points, possible, stands};
pub use canvas::{Filled, OtherPoints, fill};
pub use exports::{Format, csv, lines, sheet};
pub use record::{LessonRecord, Record, record, told};

/// Students by lessons.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct GradeTable {
    /// The lessons, in the order of the course.
    pub lessons: Vec<GradedLesson>,
    /// Everybody who hands in, by name.
    pub students: Vec<StudentRow>,
}

/// A lesson of the table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct GradedLesson {
    /// Its slug.
    pub slug: String,
    /// Its place in the course.
    pub number: u32,
    /// Its title.
    pub title: String,
    /// Points that can be earned.
    pub possible: f64,
}

/// A student's row.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StudentRow {
    /// The person's id.
    pub id: String,
    /// The name.
    pub name: String,
    /// What they reached, by slug; a lesson in which nothing was handed in or decided is left out.
    pub lessons: HashMap<String, Reached>,
}

/// What a student has reached in a lesson.
#[allow(clippy::struct_excessive_bools)] // each is a fact of its own
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Reached {
    /// The points that count: those that were decided, else the most of an attempt.
    pub points: f64,
    /// Most points of an attempt.
    pub earned: f64,
    /// Points for having predicted what a run would show.
    pub predicted: f64,
    /// Points that people gave for explanations.
    pub explained: f64,
    /// Attempts; 0 where nothing could be judged yet.
    pub attempts: u32,
    /// Whether it is enough to pass.
    pub passed: bool,
    /// Whether what counts came late.
    pub late: bool,
    /// When the last submission came; left out where nothing was handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last: Option<Moment>,
    /// Whether there is an extension.
    pub extended: bool,
    /// Whether the student asks to look again.
    pub asked: bool,
    /// What somebody decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided: Option<Decided>,
}

/// The table of a course, as it is at a moment.
///
/// Errors if the gradebook cannot be read.
pub async fn table(store: &Store, id: &str, course: &Course, now: Moment) -> Result<GradeTable, Problem> {
    let people = store.people(id).await?;
    let book = Book::open(store, id, None, None).await?;
    let lessons = course.lessons().iter().map(|lesson| GradedLesson {
        slug: lesson.slug.clone(),
        number: lesson.number,
        title: lesson.about.title.clone(),
        possible: possible(lesson),
    });
    let row = |person: Member| StudentRow {
        lessons: course
            .lessons()
            .iter()
            .filter_map(|lesson| reached(&book, &person.id, lesson, now))
            .collect(),
        id: person.id,
        name: person.name,
    };
    let students = people.into_iter().filter(|person| person.role == Role::Student).map(row);
    Ok(GradeTable { students: students.collect(), lessons: lessons.collect() })
}

/// What somebody has reached in a lesson, if there is anything to tell.
fn reached(book: &Book, person: &str, lesson: &Lesson, now: Moment) -> Option<(String, Reached)> {
    let entry = book.of(person, &lesson.slug)?;
    let stands = book.standing(person, lesson, now);
    if !entry.is_graded(lesson, &stands) {
        return None;
    }
    let one = Reached {
        // A decision may have named a zero with a sign.
        points: stands.score.points + 0.0,
        earned: stands.score.earned,
        predicted: entry.predicted(lesson),
        explained: entry.explained(lesson),
        attempts: stands.turn.attempts,
        passed: stands.score.passed,
        late: stands.score.late,
        last: stands.last,
        extended: entry.extension.is_some(),
        asked: asks(entry),
        decided: stands.score.decided,
    };
    Some((lesson.slug.clone(), one))
}

/// Whether a student's request for a look again waits for an answer.
pub fn asks(entry: &Entry) -> bool {
    let marked = entry.marked.last().map(|one| one.at);
    let last_decided = entry.decided.last().map(|one| one.at).max(marked).max(entry.regraded);
    let last_said = entry.said.last();
    last_said
        .is_some_and(|said| said.kind == DecisionKind::Request && last_decided.is_none_or(|at| at < said.at))
}
