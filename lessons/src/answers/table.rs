//! Tables of text as programs write them: CSV with a first line of names.

use thiserror::Error;

use super::units::Unit;
use crate::text::shorten;

/// Most lines that are read.
const MAX_LINES: usize = 200_000;
/// Most rows of a table of numbers.
const MAX_ROWS: usize = 20_000;
/// Most columns.
const MAX_COLUMNS: usize = 64;

/// Why a text is no table of numbers.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TableError {
    /// No line at all.
    #[error("The file is empty.")]
    Empty,
    /// More columns than a table may have.
    #[error("The first line has {count} columns; at most {MAX_COLUMNS} are read.")]
    TooManyColumns {
        /// Columns.
        count: usize,
    },
    /// No names.
    #[error("The first line is made of numbers; it must name the columns, for example t,x,y.")]
    NoNames,
    /// A line of another length.
    #[error("Line {line} has {cells} cells, the first line names {columns} columns.")]
    Uneven {
        /// Line in the file, from 1.
        line: usize,
        /// Its cells.
        cells: usize,
        /// Columns of the table.
        columns: usize,
    },
    /// More lines than are read.
    #[error("There are more than {MAX_LINES} lines.")]
    TooManyLines,
    /// More rows than a table of numbers may have.
    #[error("There are {rows} rows; at most {MAX_ROWS} are read. Write fewer.")]
    TooManyRows {
        /// Rows.
        rows: usize,
    },
    /// An infinite number.
    #[error("Line {line}, column {column}: {cell} is not a finite number.")]
    NotFinite {
        /// Line in the file, from 1.
        line: usize,
        /// Name of the column.
        column: String,
        /// The cell, shortened.
        cell: String,
    },
    /// No number.
    #[error("Line {line}, column {column}: \u{201c}{cell}\u{201d} is not a number.")]
    NotANumber {
        /// Line in the file, from 1.
        line: usize,
        /// Name of the column.
        column: String,
        /// The cell, shortened.
        cell: String,
    },
}

/// Lines cut into cells, without empty lines and comments.
pub(crate) struct Cells {
    /// The names in the first line, without units in brackets, in small letters.
    pub names: Vec<String>,
    /// What stands in these brackets.
    pub brackets: Vec<String>,
    /// Number of the line in the file, from 1, and its cells.
    pub lines: Vec<(usize, Vec<String>)>,
}

/// A table of numbers.
#[derive(Debug, PartialEq)]
pub(crate) struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

/// Cuts a text into cells. Separators are semicolons, tabulators, commas or blanks, whichever the first line has; with
/// semicolons or tabulators the decimal sign may be a comma.
pub(crate) fn cells(text: &str) -> Result<Cells, TableError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(at, line)| (at + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with(['#', '%']));
    let (_, head) = lines.next().ok_or(TableError::Empty)?;
    let separator = [';', '\t', ','].into_iter().find(|s| head.contains(*s));
    let cut = |line: &str| -> Vec<String> {
        let clean = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
        match separator {
            Some(',') => line.split(',').map(clean).collect(),
            Some(s) => line.split(s).map(|cell| clean(cell).replace(',', ".")).collect(),
            None => line.split_whitespace().map(clean).collect(),
        }
    };
    let bare = |name: &String| name.split(['[', '(']).next().unwrap_or_default().trim().to_lowercase();
    let bracket = |name: &String| {
        let (_, unit) = name.split_once(['[', '('])?;
        unit.trim_end().strip_suffix([']', ')']).map(|unit| unit.trim().to_owned())
    };
    let names: Vec<String> = cut(head).iter().map(bare).collect();
    let brackets = cut(head).iter().map(|name| bracket(name).unwrap_or_default()).collect();
    if names.len() > MAX_COLUMNS {
        return Err(TableError::TooManyColumns { count: names.len() });
    }
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(TableError::NoNames);
    }
    let mut found = Vec::new();
    for (number, line) in lines {
        let cells = cut(line);
        if cells.len() != names.len() {
            return Err(TableError::Uneven { line: number, cells: cells.len(), columns: names.len() });
        }
        if found.len() >= MAX_LINES {
            return Err(TableError::TooManyLines);
        }
        found.push((number, cells));
    }
    Ok(Cells { names, brackets, lines: found })
}

/// A number in a cell.
pub(crate) fn number(cell: &str, line: usize, name: &str) -> Result<f64, TableError> {
    let place = || (name.to_owned(), shorten(cell));
    match cell.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => {
            let (column, cell) = place();
            Err(TableError::NotFinite { line, column, cell })
        }
        Err(_) => {
            let (column, cell) = place();
            Err(TableError::NotANumber { line, column, cell })
        }
    }
}

/// Whether the cells are units and not numbers alone: 1 may be either.
fn are_units(cells: &[String]) -> bool {
    let is_unit = |cell: &String| cell == "1" || (Unit::parse(cell).is_ok() && cell.parse::<f64>().is_err());
    cells.iter().all(is_unit) && cells.iter().any(|cell| cell != "1")
}

/// How many of the unit that the table is read in one of a column's is: of lengths, times, angles and their rates. One letter may be a
/// name as well, as in `x(t)`, and changes nothing.
fn factor(unit: &str) -> f64 {
    let read = Unit::parse(unit).ok().filter(|_| unit.chars().count() > 1 || unit == "°");
    // Not of `x (in m)`, which is no inch metre.
    let [length, time, mass_and_others] = read.as_ref().map_or([0; 3], |unit| {
        let [length, mass, time, rest @ ..] = unit.dimension.0;
        [length, time, mass.abs() + rest.iter().map(|of| of.abs()).sum::<i32>()]
    });
    let moves = mass_and_others == 0 && matches!((length, time), (0..=1, -2..=0) | (0, 1));
    read.filter(|_| moves).map_or(1.0, |unit| unit.factor)
}

/// Reads a table of numbers, in SI units where columns say theirs: in brackets behind their names, or in a row of units below them, as
/// `triad run` writes it.
pub(crate) fn read(text: &str) -> Result<Table, TableError> {
    let Cells { names, brackets: mut units, mut lines } = cells(text)?;
    if lines.first().is_some_and(|(_, cells)| are_units(cells)) {
        units = lines.remove(0).1;
    }
    let factors: Vec<f64> = units.iter().map(|unit| factor(unit)).collect();
    if lines.len() > MAX_ROWS {
        return Err(TableError::TooManyRows { rows: lines.len() });
    }
    let mut rows = Vec::with_capacity(lines.len());
    for (line, cells) in lines {
        let row = cells.iter().zip(&names).zip(&factors);
        let row = row.map(|((cell, name), factor)| Ok(number(cell, line, name)? * factor));
        rows.push(row.collect::<Result<Vec<f64>, TableError>>()?);
    }
    Ok(Table { names, rows })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_units_and_comments_are_understood() {
        for text in [
            "t,x\n0,1.5\n1,2\n",
            "\u{feff}t [s]; X (m)\n# comment\n0;1,5\n\n1;2\n",
            "t\tx\r\n0\t1.5\r\n1\t2",
            "t x\n 0   1.5\n1 2e0",
            "\"t\",\"x\"\n0,1.5\n1,2",
            "# conventions\nt,x\ns,N m\n0,1.5\n1,2",
            "t,x\ns,1\n0,1.5\n1,2",
        ] {
            let table = read(text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
            assert_eq!(
                (table.names, table.rows),
                (vec!["t".into(), "x".into()], vec![vec![0.0, 1.5], vec![1.0, 2.0]])
            );
        }
    }

    #[test]
    fn columns_that_say_their_units_are_read_in_those() {
        for text in [
            "t [s],x [mm]\n0,1500\n1,2000",
            "t,x\ns,mm\n0,1500\n1,2000",
            "t (ms);x (cm)\n0;150\n1000;200",
            "t [s],x [m]\n0,1.5\n1,2",
            "t,x(t)\n0,1.5\n1,2",
            "t (in s),x (in m)\n0,1.5\n1,2",
            "t,x (of the bob)\n0,1.5\n1,2",
        ] {
            assert_eq!(read(text).unwrap().rows, [[0.0, 1.5], [1.0, 2.0]], "{text}");
        }
        let turned = read("t,phi [deg]\n0,90").unwrap().rows[0][1];
        assert!((turned - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn errors_of_tables_name_the_line() {
        for (text, says) in [
            ("", "empty"),
            ("0,1\n1,2", "must name the columns"),
            ("t,x\n0,1\n1", "Line 3 has 1 cells"),
            ("t,x\n0,one", "Line 2, column x: \u{201c}one\u{201d}"),
            ("t,x\n0,NaN", "not a finite number"),
            ("t,x\nNaN,m\n0,1", "Line 2, column t"),
            ("t,x\ns,m\ns,m\n0,1", "Line 3, column t"),
        ] {
            assert!(
                read(text).unwrap_err().to_string().contains(says),
                "{text:?}: {}",
                read(text).unwrap_err()
            );
        }
        let long = format!("t,x\n{}", "0,1\n".repeat(MAX_ROWS + 1));
        assert!(read(&long).unwrap_err().to_string().contains("Write fewer"));
    }
}
