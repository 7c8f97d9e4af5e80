//! What a student's program sends: JSON or CSV, read with clear errors.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Grid;
use crate::files::Part;
use crate::number::shorten;
use crate::table;

/// What was sent, part by part, one grid for each state.
pub(crate) type Given = BTreeMap<Part, Vec<Grid>>;

/// Rows and columns that each part must have, and the number of states.
pub(crate) struct Shape<'a> {
    pub states: usize,
    pub asks: &'a [Part],
    pub rows: usize,
    pub columns: usize,
}

impl Shape<'_> {
    fn of(&self, part: Part) -> (usize, usize) {
        match part {
            Part::Phi | Part::Gamma => (self.rows, 1),
            Part::Jacobian => (self.rows, self.columns),
            Part::Mass => (self.columns, self.columns),
            Part::Acceleration => (self.columns, 1),
        }
    }
}

/// Reads JSON or CSV. A part of which nothing was sent is left out.
pub(crate) fn read(text: &str, shape: &Shape) -> Result<Given, String> {
    if text.trim_start().starts_with(['{', '[']) { from_json(text, shape) } else { from_csv(text, shape) }
}

fn from_json(text: &str, shape: &Shape) -> Result<Given, String> {
    let value: Value = serde_json::from_str(text)
        .map_err(|e| format!("The file is not JSON: {e}. NaN is no JSON number."))?;
    let states = match value.get("states").unwrap_or(&value) {
        Value::Array(list) => list.iter().collect::<Vec<_>>(),
        // A single state that a program has not written as a list.
        one @ Value::Object(_) if shape.states == 1 => vec![one],
        _ => {
            return Err(
                "The file has no list \u{201c}states\u{201d} with one entry for each state.".to_owned()
            );
        }
    };
    if states.len() != shape.states {
        return Err(format!("There are {} states in the file, {} were dealt.", states.len(), shape.states));
    }
    let mut given = Given::new();
    for part in shape.asks {
        let present: Vec<Option<&Value>> = states.iter().map(|s| s.get(part.key())).collect();
        if present.iter().all(Option::is_none) {
            continue;
        }
        let mut grids = Vec::with_capacity(states.len());
        for (k, value) in present.into_iter().enumerate() {
            let place = format!("State {}, {}", k + 1, part.key());
            let value = value.ok_or_else(|| format!("{place} is missing."))?;
            grids.push(grid(value, shape.of(*part), &place)?);
        }
        given.insert(*part, grids);
    }
    Ok(given)
}

/// A grid of the wanted size, or of the transposed size: that is a slip with feedback of its own.
fn grid(value: &Value, (rows, columns): (usize, usize), place: &str) -> Result<Grid, String> {
    let number = |v: &Value| v.as_f64().filter(|x| x.is_finite());
    let wanted =
        if columns == 1 { format!("{rows} numbers") } else { format!("{rows} rows of {columns} numbers") };
    let fail = |what: String| Err(format!("{place} has {what}; {wanted} are asked for."));
    let Value::Array(list) = value else {
        return match number(value) {
            Some(x) if rows * columns == 1 => Ok(Grid::column(vec![x])),
            _ => fail("no list".to_owned()),
        };
    };
    if list.iter().any(Value::is_array) {
        let mut values = Vec::with_capacity(rows * columns);
        let width = list.first().and_then(Value::as_array).map_or(0, Vec::len);
        for (at, row) in list.iter().enumerate() {
            let row = row.as_array().filter(|r| r.len() == width);
            let Some(row) = row else { return fail(format!("rows of different lengths (row {})", at + 1)) };
            for cell in row {
                let Some(x) = number(cell) else {
                    return fail(format!("an entry that is no number in row {}", at + 1));
                };
                values.push(x);
            }
        }
        let found = Grid { rows: list.len(), columns: width, values };
        let fits =
            (found.rows, found.columns) == (rows, columns) || (found.rows, found.columns) == (columns, rows);
        if !fits {
            return fail(format!("{} rows of {width} numbers", found.rows));
        }
        // A column that was written as a row.
        return Ok(if columns == 1 { Grid { rows, columns, values: found.values } } else { found });
    }
    let numbers: Option<Vec<f64>> = list.iter().map(number).collect();
    match numbers {
        None => fail("an entry that is no number".to_owned()),
        // A matrix of one row or column may have lost its inner brackets.
        Some(values) if values.len() == rows * columns && (rows == 1 || columns == 1) => {
            Ok(Grid { rows, columns, values })
        }
        Some(values) => fail(format!("{} numbers in one list", values.len())),
    }
}

/// Lines `state,part,row,column,value`, counted from 1. Entries of matrices that are left out are zero.
fn from_csv(text: &str, shape: &Shape) -> Result<Given, String> {
    let table = table::cells(text)?;
    let wanted = ["state", "part", "row", "column", "value"];
    let mut places = [0; 5];
    for (place, name) in places.iter_mut().zip(wanted) {
        let found = table.names.iter().position(|n| n == name);
        *place = found
            .ok_or_else(|| format!("The first line must be {}; {name} is missing.", wanted.join(",")))?;
    }
    let mut given = Given::new();
    let mut filled: BTreeMap<Part, usize> = BTreeMap::new();
    for (line, cells) in &table.lines {
        let key = cells[places[1]].to_lowercase();
        let part = shape.asks.iter().copied().find(|p| p.key() == key).ok_or_else(|| {
            let known = shape.asks.iter().map(|p| p.key()).collect::<Vec<_>>().join(", ");
            format!("Line {line}: there is no part {}; known are {known}.", shorten(&key))
        })?;
        let (rows, columns) = shape.of(part);
        let count = |place: usize, most: usize| -> Result<usize, String> {
            let found: Option<usize> = cells[places[place]].parse().ok();
            found.filter(|n| (1..=most).contains(n)).map(|n| n - 1).ok_or_else(|| {
                let cell = shorten(&cells[places[place]]);
                format!("Line {line}: {} is \u{201c}{cell}\u{201d}; it goes from 1 to {most}.", wanted[place])
            })
        };
        let (state, row, column) = (count(0, shape.states)?, count(2, rows)?, count(3, columns)?);
        let value = table::number(&cells[places[4]], *line, "value")?;
        let grids =
            given.entry(part).or_insert_with(|| vec![Grid::make(rows, columns, |_, _| 0.0); shape.states]);
        grids[state].values[row * columns + column] = value;
        *filled.entry(part).or_default() += 1;
    }
    for (part, count) in filled {
        let (rows, columns) = shape.of(part);
        if columns == 1 && count < rows * shape.states {
            return Err(format!(
                "There are {count} lines of {}; {rows} for each of {} states are asked for.",
                part.key(),
                shape.states
            ));
        }
    }
    if given.is_empty() { Err("The file has no line with a value.".to_owned()) } else { Ok(given) }
}
