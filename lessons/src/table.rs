//! Tables of text as programs write them: CSV with a first line of names.

use crate::number::shorten;

/// Most lines that are read.
const MOST_LINES: usize = 200_000;
/// Most rows of a table of numbers.
const MOST_ROWS: usize = 20_000;
/// Most columns.
const MOST_COLUMNS: usize = 64;

/// Lines cut into cells, without empty lines and comments.
pub(crate) struct Cells {
    /// The names in the first line, without units in brackets, in small letters.
    pub names: Vec<String>,
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
pub(crate) fn cells(text: &str) -> Result<Cells, String> {
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(at, line)| (at + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with(['#', '%']));
    let (_, head) = lines.next().ok_or("The file is empty.")?;
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
    let names: Vec<String> = cut(head).iter().map(bare).collect();
    if names.len() > MOST_COLUMNS {
        return Err(format!("The first line has {} columns; at most {MOST_COLUMNS} are read.", names.len()));
    }
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(
            "The first line is made of numbers; it must name the columns, for example t,x,y.".to_owned()
        );
    }
    let mut found = Vec::new();
    for (number, line) in lines {
        let cells = cut(line);
        if cells.len() != names.len() {
            return Err(format!(
                "Line {number} has {} cells, the first line names {} columns.",
                cells.len(),
                names.len()
            ));
        }
        if found.len() >= MOST_LINES {
            return Err(format!("There are more than {MOST_LINES} lines."));
        }
        found.push((number, cells));
    }
    Ok(Cells { names, lines: found })
}

/// A number in a cell.
pub(crate) fn number(cell: &str, line: usize, name: &str) -> Result<f64, String> {
    match cell.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(format!("Line {line}, column {name}: {} is not a finite number.", shorten(cell))),
        Err(_) => {
            Err(format!("Line {line}, column {name}: \u{201c}{}\u{201d} is not a number.", shorten(cell)))
        }
    }
}

/// Reads a table of numbers.
pub(crate) fn read(text: &str) -> Result<Table, String> {
    let Cells { names, lines } = cells(text)?;
    if lines.len() > MOST_ROWS {
        return Err(format!("There are {} rows; at most {MOST_ROWS} are read. Write fewer.", lines.len()));
    }
    let mut rows = Vec::with_capacity(lines.len());
    for (line, cells) in lines {
        let row = cells.iter().zip(&names).map(|(cell, name)| number(cell, line, name));
        rows.push(row.collect::<Result<Vec<f64>, String>>()?);
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
        ] {
            let table = read(text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
            assert_eq!(
                (table.names, table.rows),
                (vec!["t".into(), "x".into()], vec![vec![0.0, 1.5], vec![1.0, 2.0]])
            );
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, says) in [
            ("", "empty"),
            ("0,1\n1,2", "must name the columns"),
            ("t,x\n0,1\n1", "Line 3 has 1 cells"),
            ("t,x\n0,one", "Line 2, column x: \u{201c}one\u{201d}"),
            ("t,x\n0,NaN", "not a finite number"),
        ] {
            assert!(read(text).unwrap_err().contains(says), "{text:?}: {}", read(text).unwrap_err());
        }
        let long = format!("t,x\n{}", "0,1\n".repeat(MOST_ROWS + 1));
        assert!(read(&long).unwrap_err().contains("Write fewer"));
    }
}
