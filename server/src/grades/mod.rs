//! The table of a class: students and what each has reached in every lesson, for the page and for other programs.

mod book;
mod record;

use std::collections::HashMap;

use csv::{QuoteStyle, WriterBuilder};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_lessons::{Course, Lesson};

use crate::policy::{Decided, Moment};
use crate::problem::Problem;
use crate::store::{DecisionKind, Member, Role, Store};

pub use book::{Book, Entry, assigned, case, pass_points, possible};
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

/// For which program a table is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// A spreadsheet.
    #[default]
    Plain,
    /// Canvas: Grades, Import.
    Canvas,
    /// Moodle: Grades, Import, CSV file.
    Moodle,
}

/// The table of a course, as it is at a moment.
///
/// Errors if the gradebook cannot be read.
pub async fn table(store: &Store, id: &str, course: &Course, now: Moment) -> Result<GradeTable, Problem> {
    let people = store.people(id).await?;
    let book = Book::open(store, id, None).await?;
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
    let predicted = book.predicted(person, lesson);
    if stands.last.is_none() && stands.score.decided.is_none() && predicted == 0.0 {
        return None;
    }
    let one = Reached {
        points: stands.score.points,
        earned: stands.score.earned,
        predicted,
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
    let last_decided = entry.decided.last().map(|one| one.at);
    let last_said = entry.said.last();
    last_said
        .is_some_and(|said| said.kind == DecisionKind::Request && last_decided.is_none_or(|at| at < said.at))
}

/// The table as CSV. A cell without an entry is left empty, which other programs take as "leave it"; 0 is a grade.
///
/// Errors if it cannot be written, which memory does not do.
pub fn csv(table: &GradeTable, format: Format, title: &str) -> Result<String, Problem> {
    let lead: &[&str] = match format {
        Format::Plain => &["Student", "Id"],
        Format::Canvas => &["Student", "ID", "SIS User ID", "SIS Login ID", "Section"],
        Format::Moodle => &["Full name", "ID number"],
    };
    let named = |lesson: &GradedLesson| format!("{:02} {}", lesson.number, lesson.title);
    let mut rows: Vec<Vec<String>> = Vec::with_capacity(table.students.len() + 2);
    rows.push(lead.iter().map(|text| (*text).to_owned()).chain(table.lessons.iter().map(named)).collect());
    if format == Format::Canvas {
        let empty = std::iter::repeat_n(String::new(), lead.len() - 1);
        let points = table.lessons.iter().map(|lesson| lesson.possible.to_string());
        rows.push(std::iter::once("    Points Possible".to_owned()).chain(empty).chain(points).collect());
    }
    for student in &table.students {
        let mut row = vec![student.name.clone()];
        match format {
            Format::Plain => row.push(student.id.clone()),
            // The columns that these programs know people by: the teacher fills in one of them.
            Format::Canvas => row.extend([String::new(), String::new(), String::new(), title.to_owned()]),
            Format::Moodle => row.push(String::new()),
        }
        let points =
            |lesson: &GradedLesson| student.lessons.get(&lesson.slug).map(|one| one.points.to_string());
        row.extend(table.lessons.iter().map(|lesson| points(lesson).unwrap_or_default()));
        rows.push(row);
    }
    sheet(&rows)
}

/// Rows as CSV: every cell quoted, none taken for a formula.
///
/// Errors if it cannot be written, which memory does not do.
pub fn sheet(rows: &[Vec<String>]) -> Result<String, Problem> {
    let mut writer = WriterBuilder::new().quote_style(QuoteStyle::Always).from_writer(Vec::new());
    for row in rows {
        writer.write_record(row.iter().map(|cell| harmless(cell))).map_err(Problem::internal)?;
    }
    let bytes = writer.into_inner().map_err(Problem::internal)?;
    String::from_utf8(bytes).map_err(Problem::internal)
}

/// A cell that no spreadsheet takes for a formula.
fn harmless(cell: &str) -> String {
    if cell.starts_with(['=', '+', '-', '@', '\t', '\r']) { format!("'{cell}") } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small() -> GradeTable {
        let lesson =
            GradedLesson { slug: "a".into(), number: 1, title: "A, \"quoted\"".into(), possible: 12.0 };
        let reached = Reached {
            points: 0.0,
            earned: 0.0,
            predicted: 0.0,
            attempts: 1,
            passed: false,
            late: false,
            last: None,
            extended: false,
            asked: false,
            decided: None,
        };
        let row = |name: &str, lessons| StudentRow { id: "1".into(), name: name.into(), lessons };
        GradeTable {
            lessons: vec![lesson],
            students: vec![
                row("=cmd()", HashMap::from([("a".to_owned(), reached)])),
                row("Zoë", HashMap::new()),
            ],
        }
    }

    #[test]
    fn tables_are_written_for_other_programs_and_run_no_formula() {
        let plain = csv(&small(), Format::Plain, "").unwrap();
        assert_eq!(
            plain,
            "\"Student\",\"Id\",\"01 A, \"\"quoted\"\"\"\n\"'=cmd()\",\"1\",\"0\"\n\"Zoë\",\"1\",\"\"\n"
        );
        let canvas = csv(&small(), Format::Canvas, "Mechanics").unwrap();
        assert_eq!(canvas.lines().nth(1), Some(r#""    Points Possible","","","","","12""#));
        assert_eq!(canvas.lines().nth(3), Some(r#""Zoë","","","","Mechanics","""#));
        assert!(csv(&small(), Format::Moodle, "").unwrap().starts_with("\"Full name\",\"ID number\","));
    }
}
