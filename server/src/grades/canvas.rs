//! Filling in a table that Canvas exported, so that it can be imported there again.
//!
//! Canvas knows people by the columns beside the name, and assignments by the number behind a title: `02 Simple pendulum (4711)`.
//! Both are kept as they came; only columns in which something changed are given back.

use std::collections::{HashMap, HashSet};

use axum::http::StatusCode;
use csv::{ReaderBuilder, StringRecord};
use schemars::JsonSchema;
use serde::Serialize;

use super::exports::{cell, quoted, title_of};
use super::{GradeTable, GradedLesson, StudentRow};
use crate::problem::Problem;
use crate::store::names::key;

/// The columns by which Canvas knows people; every export has the first four or all of them.
const PEOPLE: [&str; 6] = ["Student", "ID", "SIS User ID", "SIS Login ID", "Integration ID", "Section"];

/// What the row above the people begins with.
const POSSIBLE: &str = "Points Possible";

/// A table to be imported into Canvas, and what could not be filled in.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Filled {
    /// The table as CSV: the columns about people, and those in which something changed.
    pub csv: String,
    /// How many grades change.
    pub changed: usize,
    /// Columns of lessons that were found.
    pub found: Vec<String>,
    /// Lessons with grades that have no column: make an assignment of that title in Canvas, and export again.
    pub without_column: Vec<String>,
    /// Names in the table whom nobody here has, or that stand there more than once: whose grade it is nobody knows.
    pub unknown: Vec<String>,
    /// Names here that are not in the table, or more than once.
    pub missing: Vec<String>,
    /// Columns of lessons with other `Points Possible` than here: Canvas takes the points as they are, and other shares from them.
    pub other_points: Vec<OtherPoints>,
}

/// A column with other points than its lesson.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct OtherPoints {
    /// The column's title.
    pub column: String,
    /// Points that can be earned by it in Canvas.
    pub there: f64,
    /// Points that can be earned in the lesson.
    pub here: f64,
}

/// Fills what everybody has reached into a table that Canvas exported. A cell is never emptied, and who is
/// excused (`EX`) stays so.
///
/// Errors if it is no such table.
pub fn fill(exported: &str, table: &GradeTable) -> Result<Filled, Problem> {
    let (separator, mut rows) = read(exported)?;
    let head = rows.first().cloned().unwrap_or_default();
    let columns: Vec<(usize, &GradedLesson)> =
        head.iter().enumerate().filter_map(|(at, title)| Some((at, lesson_of(title, table)?))).collect();
    let students: HashMap<String, &StudentRow> =
        table.students.iter().map(|student| (key(&student.name), student)).collect();
    let mut filled = Filled {
        csv: String::new(),
        changed: 0,
        found: columns.iter().map(|(at, _)| head[*at].clone()).collect(),
        without_column: Vec::new(),
        unknown: Vec::new(),
        missing: Vec::new(),
        other_points: other_points(&rows, &columns),
    };
    let here = |row: &[String]| spellings(&row[0]).iter().find_map(|name| students.get(name)).copied();
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for student in rows.iter().skip(1).filter(|row| is_person(row)).filter_map(|row| here(row)) {
        *seen.entry(&student.id).or_default() += 1;
    }
    let is_one = |student: &StudentRow| seen.get(student.id.as_str()) == Some(&1);
    let mut touched = HashSet::new();
    for row in rows.iter_mut().skip(1).filter(|row| is_person(row)) {
        let Some(student) = here(row).filter(|student| is_one(student)) else {
            filled.unknown.push(row[0].clone());
            continue;
        };
        row.resize(row.len().max(head.len()), String::new());
        for (at, lesson) in &columns {
            let Some(reached) = student.lessons.get(&lesson.slug) else { continue };
            // Who is excused there stays so.
            let is_excused = row[*at].trim().eq_ignore_ascii_case("EX");
            let grade = cell(reached.points);
            if !is_excused && number(&row[*at]) != number(&grade) {
                row[*at] = grade;
                filled.changed += 1;
                touched.insert(*at);
            }
        }
    }
    let has_column = |lesson: &&GradedLesson| columns.iter().any(|(_, other)| other.slug == lesson.slug);
    let graded =
        |lesson: &&GradedLesson| table.students.iter().any(|one| one.lessons.contains_key(&lesson.slug));
    let without = table.lessons.iter().filter(|lesson| graded(lesson) && !has_column(lesson));
    filled.without_column = without.map(title_of).collect();
    let missing = table.students.iter().filter(|student| !is_one(student));
    filled.missing = missing.map(|student| student.name.clone()).collect();
    let stays = |at: usize| touched.contains(&at) || PEOPLE.contains(&head[at].as_str());
    let kept: Vec<usize> = (0..head.len()).filter(|at| stays(*at)).collect();
    let of_row =
        |row: &Vec<String>| kept.iter().map(|at| row.get(*at).cloned().unwrap_or_default()).collect();
    // What Canvas wrote it knows again only byte by byte.
    filled.csv = quoted(&rows.iter().map(of_row).collect::<Vec<Vec<String>>>(), separator)?;
    Ok(filled)
}

/// The rows of what Canvas exported, and what separates their cells: a semicolon for those whose numbers have decimal commas. Canvas
/// reads both again.
///
/// Errors if it is no such table.
fn read(exported: &str) -> Result<(u8, Vec<Vec<String>>), Problem> {
    let text = exported.trim_start_matches('\u{feff}');
    for separator in [b',', b';'] {
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .flexible(true)
            .has_headers(false)
            .from_reader(text.as_bytes());
        let cells = |row: StringRecord| row.iter().map(str::to_owned).collect();
        let rows: Result<Vec<Vec<String>>, csv::Error> =
            reader.into_records().map(|row| row.map(cells)).collect();
        let rows = rows.map_err(|error| no_export(&format!("it cannot be read as CSV: {error}")))?;
        let head = rows.first().map(Vec::as_slice).unwrap_or_default();
        if head.first().is_some_and(|title| title == "Student") && head.iter().any(|title| title == "ID") {
            return Ok((separator, rows));
        }
    }
    Err(no_export("its first line does not begin with Student and ID"))
}

/// Columns in which Canvas has other points than their lessons.
fn other_points(rows: &[Vec<String>], columns: &[(usize, &GradedLesson)]) -> Vec<OtherPoints> {
    let is_possible = |row: &&Vec<String>| row.first().is_some_and(|name| name.trim() == POSSIBLE);
    let (Some(head), Some(possible)) = (rows.first(), rows.iter().find(is_possible)) else {
        return Vec::new();
    };
    let other = |(at, lesson): &(usize, &GradedLesson)| {
        let there = number(possible.get(*at)?)?;
        // Canvas has two decimals.
        (cell(there) != cell(lesson.possible)).then(|| OtherPoints {
            column: head[*at].clone(),
            there,
            here: lesson.possible,
        })
    };
    columns.iter().filter_map(other).collect()
}

/// The number of a cell, with a decimal point or a comma.
fn number(cell: &str) -> Option<f64> {
    cell.trim().replace(',', ".").parse().ok()
}

/// The lesson of a column such as `02 Simple pendulum (4711)`, with or without its number.
fn lesson_of<'a>(column: &str, table: &'a GradeTable) -> Option<&'a GradedLesson> {
    let (title, id) = column.trim().strip_suffix(')')?.rsplit_once(" (")?;
    if id.is_empty() || !id.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    // Its place in the course may have been another when the column was made.
    let plain = key(title.trim_start_matches(|c: char| c.is_ascii_digit()));
    table.lessons.iter().find(|lesson| [key(title), plain.clone()].contains(&key(&lesson.title)))
}

/// Whether a row is about somebody: what stands above the people has no name, or `Points Possible`.
fn is_person(row: &[String]) -> bool {
    row.first().is_some_and(|name| !name.trim().is_empty() && name.trim() != POSSIBLE)
}

/// `Lovelace, Ada` as Canvas writes it, and as people write it.
fn spellings(name: &str) -> Vec<String> {
    let mut all = vec![key(name)];
    all.extend(name.split_once(',').map(|(last, first)| key(&format!("{first} {last}"))));
    all
}

fn no_export(why: &str) -> Problem {
    let detail = format!("this is no gradebook that Canvas exported: {why}");
    let hint = "in Canvas choose Grades, Export, Export Entire Gradebook, and send that file as it is";
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "no-canvas-export", detail.clone(), hint)
        .at("/file", detail)
}

#[cfg(test)]
mod tests {
    use super::super::Reached;
    use super::*;

    fn reached(points: f64) -> Reached {
        Reached {
            points,
            earned: points,
            predicted: 0.0,
            explained: 0.0,
            attempts: 1,
            passed: false,
            late: false,
            last: None,
            extended: false,
            asked: false,
            decided: None,
        }
    }

    fn table() -> GradeTable {
        let lesson = |number, slug: &str, title: &str| GradedLesson {
            slug: slug.into(),
            number,
            title: title.into(),
            possible: 12.0,
        };
        let student = |id: &str, name: &str, lessons: &[(&str, f64)]| StudentRow {
            id: id.into(),
            name: name.into(),
            lessons: lessons.iter().map(|(slug, points)| ((*slug).to_owned(), reached(*points))).collect(),
        };
        GradeTable {
            lessons: vec![lesson(1, "a", "Bodies"), lesson(2, "b", "Pendulum"), lesson(3, "c", "Screw")],
            students: vec![
                student("1", "Ada Lovelace", &[("a", 12.0), ("b", 7.5)]),
                student("2", "Zoë B", &[("a", 3.0), ("c", 1.0)]),
                student("3", "Not There", &[]),
            ],
        }
    }

    const EXPORTED: &str = "\u{feff}Student,ID,SIS User ID,SIS Login ID,Section,07 Bodies (81),Essay (82),Pendulum (83)\r\n\
        \"    Points Possible\",,,,,12,10,12\r\n\
        \"Lovelace, Ada\",501,u1,ada,Mechanics,12.0,9,\r\n\
        Zoe\u{308} B,502,u2,zoe,Mechanics,3,8,5\r\n\
        Stranger,503,u3,str,Mechanics,1,7,1\r\n";

    #[test]
    fn only_what_changed_is_given_back_under_the_numbers_of_canvas() {
        let filled = fill(EXPORTED, &table()).unwrap();
        let wanted = "\"Student\",\"ID\",\"SIS User ID\",\"SIS Login ID\",\"Section\",\"Pendulum (83)\"\n\
            \"    Points Possible\",\"\",\"\",\"\",\"\",\"12\"\n\
            \"Lovelace, Ada\",\"501\",\"u1\",\"ada\",\"Mechanics\",\"7.5\"\n\
            \"Zoe\u{308} B\",\"502\",\"u2\",\"zoe\",\"Mechanics\",\"5\"\n\
            \"Stranger\",\"503\",\"u3\",\"str\",\"Mechanics\",\"1\"\n";
        assert_eq!(filled.csv, wanted, "12.0 is 12, and who has reached nothing keeps what stands there");
        assert_eq!((filled.changed, filled.found.len()), (1, 2));
        assert_eq!(filled.without_column, ["03 Screw"]);
        assert_eq!(
            (filled.unknown, filled.missing),
            (vec!["Stranger".to_owned()], vec!["Not There".to_owned()])
        );
        // Imported and exported again, nothing is left to change.
        let again = fill(&filled.csv, &table()).unwrap();
        assert_eq!((again.changed, again.found), (0, vec!["Pendulum (83)".to_owned()]));
    }

    /// Canvas writes so where numbers have decimal commas, and reads both again (`gradebook_importer.rb`).
    #[test]
    fn semicolons_and_decimal_commas_are_read_and_semicolons_given_back() {
        let exported = "Student;ID;Bodies (81);Pendulum (83)\n    Points Possible;;12,00;12,00\n\
            \"Lovelace, Ada\";1;12,00;7,25\n";
        let filled = fill(exported, &table()).unwrap();
        let wanted = "\"Student\";\"ID\";\"Pendulum (83)\"\n\"    Points Possible\";\"\";\"12,00\"\n\
            \"Lovelace, Ada\";\"1\";\"7.5\"\n";
        assert_eq!((filled.csv.as_str(), filled.changed), (wanted, 1));
        assert_eq!((filled.other_points, filled.unknown), (Vec::new(), Vec::new()));
    }

    #[test]
    fn other_points_possible_are_told() {
        let filled = fill(&EXPORTED.replace(",12,10,12", ",100,10,12.0"), &table()).unwrap();
        let other = OtherPoints { column: "07 Bodies (81)".into(), there: 100.0, here: 12.0 };
        assert_eq!(filled.other_points, [other]);
        let read_only = fill(&EXPORTED.replace(",12,10,12", ",(read only),10,"), &table()).unwrap();
        assert_eq!(read_only.other_points, []);
    }

    #[test]
    fn points_have_the_digits_that_canvas_has() {
        let mut sums = table();
        sums.students[0].lessons.insert("b".into(), Reached { points: 0.3 * 3.0, ..reached(0.0) });
        let filled = fill("Student,ID,Pendulum (83)\n\"Lovelace, Ada\",1,\n", &sums).unwrap();
        assert!(filled.csv.ends_with("\"0.9\"\n"), "{}", filled.csv);
        assert_eq!(fill(&filled.csv, &sums).unwrap().changed, 0);
    }

    /// Whose grade it is, nobody here can tell apart.
    #[test]
    fn of_two_rows_of_one_name_neither_is_filled() {
        let twice = "Student,ID,Pendulum (83)\n\"Lovelace, Ada\",1,\nADA LOVELACE,2,3\nZoë B,3,\n";
        let filled = fill(twice, &table()).unwrap();
        assert_eq!(filled.changed, 0, "{}", filled.csv);
        assert_eq!(filled.unknown, ["Lovelace, Ada", "ADA LOVELACE"]);
        assert_eq!(filled.missing, ["Ada Lovelace", "Not There"]);
    }

    #[test]
    fn who_is_excused_stays_so_and_logins_stay_as_they_are() {
        let exported = "Student,ID,SIS User ID,SIS Login ID,Bodies (81),Pendulum (83)\n\
            \"Lovelace, Ada\",1,-17,@ada,EX,\n=Zoë B,2,+3,zoe,3,\n";
        let filled = fill(exported, &table()).unwrap();
        let wanted = "\"Student\",\"ID\",\"SIS User ID\",\"SIS Login ID\",\"Pendulum (83)\"\n\
            \"Lovelace, Ada\",\"1\",\"-17\",\"@ada\",\"7.5\"\n\"=Zoë B\",\"2\",\"+3\",\"zoe\",\"\"\n";
        assert_eq!((filled.csv.as_str(), filled.changed), (wanted, 1));
    }

    #[test]
    fn what_canvas_did_not_export_is_refused() {
        for wrong in ["", "Name,Points\nAda,3\n", "Student\tID\n", "Name;Student;ID\n"] {
            assert!(fill(wrong, &table()).is_err(), "{wrong:?}");
        }
    }
}
