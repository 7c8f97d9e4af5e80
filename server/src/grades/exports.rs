//! The table of a class for other programs: CSV, and lines of JSON.

use csv::{QuoteStyle, WriterBuilder};
use serde::{Deserialize, Serialize};

use super::{GradeTable, GradedLesson, Reached};
use crate::problem::Problem;

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

/// The table as CSV. A cell without an entry is left empty, which other programs take as "leave it"; 0 is a grade.
///
/// Errors if it cannot be written, which memory does not do.
pub fn csv(table: &GradeTable, format: Format, title: &str) -> Result<String, Problem> {
    let lead: &[&str] = match format {
        Format::Plain => &["Student", "Id"],
        Format::Canvas => &["Student", "ID", "SIS User ID", "SIS Login ID", "Section"],
        Format::Moodle => &["Full name", "ID number"],
    };
    let mut rows: Vec<Vec<String>> = Vec::with_capacity(table.students.len() + 2);
    rows.push(lead.iter().map(|text| (*text).to_owned()).chain(table.lessons.iter().map(title_of)).collect());
    if format == Format::Canvas {
        let empty = std::iter::repeat_n(String::new(), lead.len() - 1);
        let points = table.lessons.iter().map(|lesson| cell(lesson.possible));
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
        let points = |lesson: &GradedLesson| student.lessons.get(&lesson.slug).map(|one| cell(one.points));
        row.extend(table.lessons.iter().map(|lesson| points(lesson).unwrap_or_default()));
        rows.push(row);
    }
    sheet(&rows)
}

/// The table as lines of JSON, one for each student and lesson in which there is something.
///
/// Errors if it cannot be written, which memory does not do.
pub fn lines(table: &GradeTable) -> Result<String, Problem> {
    let mut text = String::new();
    for student in &table.students {
        for lesson in &table.lessons {
            let Some(reached) = student.lessons.get(&lesson.slug) else { continue };
            let line = Line {
                student: &student.name,
                id: &student.id,
                lesson: &lesson.slug,
                number: lesson.number,
                title: &lesson.title,
                possible: lesson.possible,
                reached,
            };
            text.push_str(&serde_json::to_string(&line).map_err(Problem::internal)?);
            text.push('\n');
        }
    }
    Ok(text)
}

/// What a student has reached in a lesson, on a line of its own.
#[derive(Debug, Serialize)]
struct Line<'a> {
    student: &'a str,
    id: &'a str,
    lesson: &'a str,
    number: u32,
    title: &'a str,
    possible: f64,
    #[serde(flatten)]
    reached: &'a Reached,
}

/// Rows as CSV: every cell quoted, none taken for a formula.
///
/// Errors if it cannot be written, which memory does not do.
pub fn sheet(rows: &[Vec<String>]) -> Result<String, Problem> {
    quoted(&rows.iter().map(|row| row.iter().map(|cell| harmless(cell)).collect()).collect::<Vec<_>>(), b',')
}

/// Rows as CSV: every cell quoted, and as it is.
///
/// Errors if it cannot be written, which memory does not do.
pub(super) fn quoted(rows: &[Vec<String>], separator: u8) -> Result<String, Problem> {
    let mut writer =
        WriterBuilder::new().delimiter(separator).quote_style(QuoteStyle::Always).from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(Problem::internal)?;
    }
    let bytes = writer.into_inner().map_err(Problem::internal)?;
    String::from_utf8(bytes).map_err(Problem::internal)
}

/// Points as the page shows them, with two decimals at most: sums and shares have digits of rounding.
pub(super) fn cell(points: f64) -> String {
    // Half a hundredth, which only odd eighths are, is rounded up, as the page rounds it, not to the even digit.
    let is_half = (8.0 * points).fract() == 0.0 && (4.0 * points).fract() != 0.0;
    let shown = format!("{:.2}", if is_half { points.next_up() } else { points });
    // Without zeros at the end, and without a sign before one.
    shown.parse::<f64>().map_or(shown, |points| (points + 0.0).to_string())
}

/// The title under which a lesson stands in tables for other programs.
pub(super) fn title_of(lesson: &GradedLesson) -> String {
    format!("{:02} {}", lesson.number, lesson.title)
}

/// A cell that no spreadsheet takes for a formula.
fn harmless(cell: &str) -> String {
    if cell.starts_with(['=', '+', '-', '@', '\t', '\r']) { format!("'{cell}") } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::super::StudentRow;
    use super::*;

    fn small() -> GradeTable {
        let lesson =
            GradedLesson { slug: "a".into(), number: 1, title: "A, \"quoted\"".into(), possible: 12.0 };
        let reached = Reached {
            points: 0.0,
            earned: 0.0,
            predicted: 0.0,
            explained: 0.0,
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

    #[test]
    fn points_are_written_as_they_are_shown() {
        for (points, shown) in [
            (0.3 * 3.0, "0.9"),
            (-0.0, "0"),
            (-0.001, "0"),
            (7.5, "7.5"),
            (2.0 / 3.0, "0.67"),
            (1.125, "1.13"),
            (7.375, "7.38"),
            (1.115, "1.11"),
        ] {
            assert_eq!(cell(points), shown);
        }
        let mut table = small();
        table.students[0].lessons.get_mut("a").unwrap().points = 0.3 * 3.0;
        assert!(csv(&table, Format::Plain, "").unwrap().contains("\"0.9\""));
    }

    #[test]
    fn a_line_is_what_one_student_reached_in_one_lesson() {
        let text = lines(&small()).unwrap();
        let all: Vec<serde_json::Value> =
            text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(all.len(), 1, "nothing where nothing was handed in");
        assert_eq!((&all[0]["student"], &all[0]["lesson"]), (&"=cmd()".into(), &"a".into()));
        assert_eq!((&all[0]["points"], &all[0]["attempts"]), (&0.0.into(), &1.into()));
    }
}
