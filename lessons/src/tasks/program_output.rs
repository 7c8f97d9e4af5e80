//! What a student's program sends: JSON or CSV, read with clear errors.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use thiserror::Error;

use super::grid::Grid;
use crate::answers::table::{self, TableError};
use crate::files::EquationPart;
use crate::text::shorten;

/// What was sent, part by part, one grid for each state.
pub(crate) type ProgramOutput = BTreeMap<EquationPart, Vec<Grid>>;

/// Rows and columns that each part must have, and the number of states.
pub(crate) struct OutputSize<'a> {
    pub states: usize,
    pub asks: &'a [EquationPart],
    pub rows: usize,
    pub columns: usize,
}

impl OutputSize<'_> {
    fn of(&self, part: EquationPart) -> (usize, usize) {
        match part {
            EquationPart::Phi | EquationPart::Gamma => (self.rows, 1),
            EquationPart::Jacobian => (self.rows, self.columns),
            EquationPart::Mass => (self.columns, self.columns),
            EquationPart::Acceleration => (self.columns, 1),
        }
    }
}

/// Columns of a CSV file.
const CSV_COLUMNS: [&str; 5] = ["state", "part", "row", "column", "value"];

/// Why what a program sent cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OutputError {
    /// Not JSON.
    #[error("The file is not JSON: {problem}. NaN is no JSON number.")]
    Json {
        /// What the reader says.
        problem: String,
    },
    /// No list of states.
    #[error("The file has no list \u{201c}states\u{201d} with one entry for each state.")]
    NoStates,
    /// Another number of states.
    #[error("There are {found} states in the file; {given} were given.")]
    StateCount {
        /// States in the file.
        found: usize,
        /// States that were given.
        given: usize,
    },
    /// A part that other states have.
    #[error("{place} is missing.")]
    Missing {
        /// State and part.
        place: String,
    },
    /// A part of another form.
    #[error("{place} has {found}; {wanted} are asked for.")]
    Form {
        /// State and part.
        place: String,
        /// What was found there.
        found: String,
        /// What is asked for.
        wanted: String,
    },
    /// Not a table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A column that is not there.
    #[error("The first line must be {}; {name} is missing.", CSV_COLUMNS.join(","))]
    MissingColumn {
        /// Its name.
        name: &'static str,
    },
    /// A part that is not asked for.
    #[error("Line {line}: there is no part {part}; known are {known}.")]
    UnknownPart {
        /// Line in the file, from 1.
        line: usize,
        /// The part, shortened.
        part: String,
        /// Parts that are asked for.
        known: String,
    },
    /// A state, row or column that does not exist.
    #[error("Line {line}: {name} is \u{201c}{cell}\u{201d}; it goes from 1 to {most}.")]
    OutOfRange {
        /// Line in the file, from 1.
        line: usize,
        /// Name of the column.
        name: &'static str,
        /// The cell, shortened.
        cell: String,
        /// Largest value.
        most: usize,
    },
    /// An entry that stands there twice.
    #[error("Line {line} gives an entry again: state {state}, {part}, row {row}, column {column}.")]
    Twice {
        /// Line in the file, from 1.
        line: usize,
        /// The state, from 1.
        state: usize,
        /// The part.
        part: &'static str,
        /// Its row, from 1.
        row: usize,
        /// Its column, from 1.
        column: usize,
    },
    /// Entries of a vector that are left out.
    #[error("There are {found} lines of {part}; {rows} for each of {states} states are asked for.")]
    LineCount {
        /// Lines found.
        found: usize,
        /// The part.
        part: &'static str,
        /// Lines for each state.
        rows: usize,
        /// States.
        states: usize,
    },
    /// No value at all.
    #[error("The file has no line with a value.")]
    NoValue,
}

/// Reads JSON or CSV. A part of which nothing was sent is left out.
pub(crate) fn read(text: &str, size: &OutputSize) -> Result<ProgramOutput, OutputError> {
    // Some editors put a byte order mark before everything.
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with(['{', '[']) { from_json(text, size) } else { from_csv(text, size) }
}

fn from_json(text: &str, size: &OutputSize) -> Result<ProgramOutput, OutputError> {
    let value: Value =
        serde_json::from_str(text).map_err(|e| OutputError::Json { problem: e.to_string() })?;
    let states = match value.get("states").unwrap_or(&value) {
        Value::Array(list) => list.iter().collect::<Vec<_>>(),
        // A single state that a program has not written as a list.
        one @ Value::Object(_) if size.states == 1 => vec![one],
        _ => return Err(OutputError::NoStates),
    };
    if states.len() != size.states {
        return Err(OutputError::StateCount { found: states.len(), given: size.states });
    }
    let mut output = ProgramOutput::new();
    for part in size.asks {
        let present: Vec<Option<&Value>> = states.iter().map(|s| s.get(part.key())).collect();
        if present.iter().all(Option::is_none) {
            continue;
        }
        let mut grids = Vec::with_capacity(states.len());
        for (k, value) in present.into_iter().enumerate() {
            let place = format!("State {}, {}", k + 1, part.key());
            let value = value.ok_or_else(|| OutputError::Missing { place: place.clone() })?;
            grids.push(grid(value, size.of(*part), &place)?);
        }
        output.insert(*part, grids);
    }
    Ok(output)
}

/// A grid of the wanted size, or of the transposed size: that is a misconception with feedback of its own.
fn grid(value: &Value, (rows, columns): (usize, usize), place: &str) -> Result<Grid, OutputError> {
    let fail = |found: String| {
        let wanted = if columns == 1 {
            format!("{rows} numbers")
        } else {
            format!("{rows} rows of {columns} numbers")
        };
        OutputError::Form { place: place.to_owned(), found, wanted }
    };
    let Value::Array(list) = value else {
        return match number(value) {
            Some(x) if rows * columns == 1 => Ok(Grid::column(vec![x])),
            _ => Err(fail("no list".to_owned())),
        };
    };
    if list.iter().any(Value::is_array) {
        let found = rows_of(list).map_err(fail)?;
        let size = (found.rows, found.columns);
        if size != (rows, columns) && size != (columns, rows) {
            return Err(fail(format!("{} rows of {} numbers", found.rows, found.columns)));
        }
        // A column that was written as a row.
        return Ok(if columns == 1 { Grid { rows, columns, values: found.values } } else { found });
    }
    match list.iter().map(number).collect::<Option<Vec<f64>>>() {
        None => Err(fail("an entry that is no number".to_owned())),
        // A matrix of one row or column may have lost its inner brackets.
        Some(values) if values.len() == rows * columns && (rows == 1 || columns == 1) => {
            Ok(Grid { rows, columns, values })
        }
        Some(values) => Err(fail(format!("{} numbers in one list", values.len()))),
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64().filter(|x| x.is_finite())
}

/// Rows of equally many numbers, or what was found in their place.
fn rows_of(list: &[Value]) -> Result<Grid, String> {
    let mut values = Vec::new();
    let width = list.first().and_then(Value::as_array).map_or(0, Vec::len);
    for (at, row) in list.iter().enumerate() {
        let row = row.as_array().filter(|r| r.len() == width);
        let row = row.ok_or_else(|| format!("rows of different lengths (row {})", at + 1))?;
        for cell in row {
            values.push(number(cell).ok_or_else(|| format!("an entry that is no number in row {}", at + 1))?);
        }
    }
    Ok(Grid { rows: list.len(), columns: width, values })
}

/// Lines `state,part,row,column,value`, counted from 1. Entries of matrices that are left out are zero.
fn from_csv(text: &str, size: &OutputSize) -> Result<ProgramOutput, OutputError> {
    let table = table::cells(text)?;
    let mut places = [0; 5];
    for (place, name) in places.iter_mut().zip(CSV_COLUMNS) {
        let found = table.names.iter().position(|n| n == name);
        *place = found.ok_or(OutputError::MissingColumn { name })?;
    }
    let mut output = ProgramOutput::new();
    let mut filled: BTreeMap<EquationPart, usize> = BTreeMap::new();
    let mut known = BTreeSet::new();
    for (line, cells) in &table.lines {
        let cell = places.map(|place| cells[place].as_str());
        let part = part_of(cell[1], *line, size)?;
        let (rows, columns) = size.of(part);
        let count = |k: usize, most: usize| count(cell[k], most, *line, CSV_COLUMNS[k]);
        let (state, row, column) = (count(0, size.states)?, count(2, rows)?, count(3, columns)?);
        let value = table::number(cell[4], *line, "value")?;
        if !known.insert((part, state, row, column)) {
            let [state, row, column] = [state, row, column].map(|counted| counted + 1);
            return Err(OutputError::Twice { line: *line, state, part: part.key(), row, column });
        }
        let grids =
            output.entry(part).or_insert_with(|| vec![Grid::make(rows, columns, |_, _| 0.0); size.states]);
        grids[state].values[row * columns + column] = value;
        *filled.entry(part).or_default() += 1;
    }
    for (part, found) in filled {
        let (rows, columns) = size.of(part);
        if columns == 1 && found < rows * size.states {
            return Err(OutputError::LineCount { found, part: part.key(), rows, states: size.states });
        }
    }
    if output.is_empty() { Err(OutputError::NoValue) } else { Ok(output) }
}

/// The part of the equations that a cell names.
fn part_of(cell: &str, line: usize, size: &OutputSize) -> Result<EquationPart, OutputError> {
    let key = cell.to_lowercase();
    size.asks.iter().copied().find(|p| p.key() == key).ok_or_else(|| {
        let known = size.asks.iter().map(|p| p.key()).collect::<Vec<_>>().join(", ");
        OutputError::UnknownPart { line, part: shorten(&key), known }
    })
}

/// A place that is counted from 1, from 0.
fn count(cell: &str, most: usize, line: usize, name: &'static str) -> Result<usize, OutputError> {
    let found: Option<usize> = cell.parse().ok();
    found.filter(|n| (1..=most).contains(n)).map(|n| n - 1).ok_or_else(|| OutputError::OutOfRange {
        line,
        name,
        cell: shorten(cell),
        most,
    })
}
