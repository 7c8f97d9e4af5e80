//! The table of a class: students and what each has reached in every lesson, for the page and for other programs.

use std::collections::HashMap;

use csv::{QuoteStyle, WriterBuilder};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_lessons::Course;

use crate::problem::Problem;
use crate::store::{Decision, Role, Standing, Store};

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
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Reached {
    /// The points that count: those that were decided, else the most of an attempt.
    pub points: f64,
    /// Most points of an attempt.
    pub earned: f64,
    /// Attempts; 0 where nothing could be judged yet.
    pub attempts: i64,
    /// Whether it is enough to pass.
    pub passed: bool,
    /// When the last submission came, RFC 3339; left out where nothing was handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last: Option<String>,
    /// What somebody decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided: Option<Decided>,
}

/// A decision about a grade.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Decided {
    /// The points that count.
    pub points: f64,
    /// Why.
    pub reason: String,
    /// Who decided.
    pub by: String,
    /// When, RFC 3339.
    pub at: String,
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

/// A moment as text.
fn moment(milliseconds: i64) -> String {
    jiff::Timestamp::from_millisecond(milliseconds).map(|at| format!("{at:.3}")).unwrap_or_default()
}

/// The table of a course.
///
/// Errors if the gradebook cannot be read.
pub async fn table(store: &Store, id: &str, course: &Course) -> Result<GradeTable, Problem> {
    let people = store.people(id).await?;
    let lessons: Vec<GradedLesson> = course
        .lessons()
        .iter()
        .map(|lesson| GradedLesson {
            slug: lesson.slug.clone(),
            number: lesson.number,
            title: lesson.about.title.clone(),
            possible: lesson.exercise.possible(),
        })
        .collect();
    let mut reached: HashMap<String, HashMap<String, Reached>> = HashMap::new();
    for standing in store.standings(id).await? {
        let Standing { person, lesson, attempts, best, passed, last, .. } = standing;
        let one =
            Reached { points: best, earned: best, attempts, passed, last: Some(moment(last)), decided: None };
        reached.entry(person).or_default().insert(lesson, one);
    }
    for decision in store.decisions(id).await? {
        let pass = course
            .lesson(&decision.lesson)
            .map(|lesson| lesson.exercise.pass_mark * lesson.exercise.possible() * (1.0 - 1e-12));
        apply(&mut reached, decision, pass.unwrap_or(f64::INFINITY));
    }
    let students =
        people.into_iter().filter(|person| person.role == Role::Student).map(|person| StudentRow {
            lessons: reached.remove(&person.id).unwrap_or_default(),
            id: person.id,
            name: person.name,
        });
    Ok(GradeTable { students: students.collect(), lessons })
}

/// Puts a decision into the table; `pass` points are enough to pass.
fn apply(reached: &mut HashMap<String, HashMap<String, Reached>>, decision: Decision, pass: f64) {
    let Decision { person, lesson, points, reason, by, at } = decision;
    let of_person = reached.entry(person).or_default();
    let Some(points) = points else {
        if let Some(one) = of_person.get_mut(&lesson) {
            (one.points, one.passed, one.decided) = (one.earned, one.earned >= pass, None);
        }
        of_person.retain(|_, one| one.last.is_some() || one.decided.is_some());
        return;
    };
    let none = Reached { points: 0.0, earned: 0.0, attempts: 0, passed: false, last: None, decided: None };
    let one = of_person.entry(lesson).or_insert(none);
    one.points = points;
    one.passed = points >= pass;
    one.decided = Some(Decided { points, reason, by, at: moment(at) });
}

/// The table as CSV. A cell without an entry is left empty, which other programs take as "leave it"; 0 is a grade.
///
/// Errors if it cannot be written, which memory does not do.
pub fn csv(table: &GradeTable, format: Format, title: &str) -> Result<String, Problem> {
    let mut writer = WriterBuilder::new().quote_style(QuoteStyle::Always).from_writer(Vec::new());
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
        let reached =
            Reached { points: 0.0, earned: 0.0, attempts: 1, passed: false, last: None, decided: None };
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

    #[test]
    fn the_last_decision_counts_and_can_be_taken_back() {
        let mut reached = HashMap::new();
        let decide = |points| Decision {
            person: "p".into(),
            lesson: "a".into(),
            points,
            reason: "why".into(),
            by: "T".into(),
            at: 0,
        };
        let earned = Reached {
            points: 5.0,
            earned: 5.0,
            attempts: 2,
            passed: false,
            last: Some("t".into()),
            decided: None,
        };
        reached.insert("p".to_owned(), HashMap::from([("a".to_owned(), earned.clone())]));
        apply(&mut reached, decide(Some(3.0)), 8.0);
        apply(&mut reached, decide(Some(9.0)), 8.0);
        let now = &reached["p"]["a"];
        assert_eq!((now.points, now.earned, now.passed, now.attempts), (9.0, 5.0, true, 2));
        apply(&mut reached, decide(None), 8.0);
        assert_eq!(reached["p"]["a"], earned);
    }
}
