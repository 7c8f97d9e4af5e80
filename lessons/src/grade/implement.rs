//! The equations from a student's own program: which block, row and column is off, and which slip it is.

use std::collections::BTreeSet;

use triad_engine::equations::{column_names, row_names};

use super::Outcome;
use crate::exercise::Implement;
use crate::files::Part;
use crate::implement::{Deal, Given, Grid, Shape, all_agree, read, recognise, slipped};
use crate::markdown::{escape, render_short};
use crate::submission::Answer;
use crate::verdict::Mark;

/// Names that a message lists.
const NAMED: usize = 4;

/// Judges what a program sent; `seed` is that of the states.
pub(super) fn judge(task: &Implement, seed: &str, note: &str, answer: &Answer) -> Outcome {
    let Some(text) = &answer.file else {
        return Outcome::invalid("This question asks for a file, JSON or CSV, that your program writes.");
    };
    let mut deal = match Deal::new(task, seed) {
        Ok(deal) => deal,
        Err(problem) => return Outcome::invalid(&format!("The states could not be dealt: {problem}.")),
    };
    let rows = row_names(&deal.mechanism.system);
    let columns = column_names(&deal.mechanism.system);
    let shape = Shape { states: task.states, asks: &task.asks, rows: rows.len(), columns: columns.len() };
    let given = match read(text, &shape) {
        Ok(given) => given,
        Err(problem) => return Outcome::invalid(&problem),
    };
    let mut parts = Vec::with_capacity(task.asks.len());
    for part in &task.asks {
        match judge_part(task, &mut deal, *part, &given, &Names { rows: &rows, columns: &columns }) {
            Ok(judged) => parts.push(judged),
            Err(problem) => {
                return Outcome::invalid(&format!("The equations could not be written: {problem}."));
            }
        }
    }
    let right = parts.iter().filter(|p| p.right).count();
    if right == parts.len() {
        return Outcome::right(note);
    }
    let lines: Vec<String> = task
        .asks
        .iter()
        .zip(&parts)
        .map(|(part, judged)| format!("<li><strong>{}</strong>: {}</li>", part.symbol(), judged.html))
        .collect();
    let slip = parts.iter().find_map(|p| p.slip.clone());
    Outcome {
        mark: Mark::Wrong,
        share: right as f64 / parts.len() as f64,
        html: format!("<p>{right} of {} parts are right.</p><ul>{}</ul>", parts.len(), lines.concat()),
        slip,
        ..Outcome::default()
    }
}

struct Names<'a> {
    rows: &'a [String],
    columns: &'a [String],
}

struct Judged {
    right: bool,
    html: String,
    slip: Option<String>,
}

fn judge_part(
    task: &Implement,
    deal: &mut Deal,
    part: Part,
    given: &Given,
    names: &Names,
) -> Result<Judged, String> {
    let Some(given) = given.get(&part) else {
        return Ok(Judged { right: false, html: "not in the file.".to_owned(), slip: None });
    };
    let right = deal.answers(part)?;
    if all_agree(given, &right, &right, task.tolerance) {
        return Ok(Judged { right: true, html: "right.".to_owned(), slip: None });
    }
    let slips = slipped(task, deal, part)?;
    if let Some(slip) = recognise(given, &right, &slips, task.tolerance) {
        let id = format!("{}-{}", part.key(), slip.id);
        return Ok(Judged { right: false, html: render_short(slip.feedback), slip: Some(id) });
    }
    let html = given.iter().zip(&right).enumerate().find_map(|(k, (a, b))| {
        let off = where_off(a, b, task.tolerance);
        (!off.is_empty()).then(|| place(k, given.len(), part, a, b, &off, names))
    });
    Ok(Judged { right: false, html: html.unwrap_or_default(), slip: None })
}

/// Places that are off, as (row, column).
fn where_off(given: &Grid, right: &Grid, tolerance: f64) -> Vec<(usize, usize)> {
    if (given.rows, given.columns) != (right.rows, right.columns) {
        return vec![(0, 0)];
    }
    let allowed = tolerance * right.scale();
    let all = (0..right.rows).flat_map(|row| (0..right.columns).map(move |column| (row, column)));
    all.filter(|(row, column)| (given.at(*row, *column) - right.at(*row, *column)).abs() > allowed).collect()
}

/// Where the first wrong state is off, in names; never the right number.
fn place(
    state: usize,
    states: usize,
    part: Part,
    given: &Grid,
    right: &Grid,
    off: &[(usize, usize)],
    names: &Names,
) -> String {
    if (given.rows, given.columns) != (right.rows, right.columns) {
        return format!(
            "it has {} rows and {} columns; {} and {} are asked for.",
            given.rows, given.columns, right.rows, right.columns
        );
    }
    let by_columns = matches!(part, Part::Mass | Part::Acceleration);
    let row_names = if by_columns { names.columns } else { names.rows };
    let matrix = right.columns > 1;
    let rows: BTreeSet<usize> = off.iter().map(|(row, _)| *row).collect();
    let columns: BTreeSet<usize> = off.iter().map(|(_, column)| *column).collect();
    let mut text = format!(
        "state {} of {states}: {} of {} entries are off, in {} {}",
        state + 1,
        off.len(),
        right.values.len(),
        if by_columns && !matrix { "coordinate" } else { "row" },
        listed(&rows, row_names)
    );
    if matrix {
        text += ", column ";
        text += &listed(&columns, names.columns);
        text += &blocks(off, row_names, names.columns);
    }
    text += match common_factor(given, right, off) {
        Some(-1) => ". They have the right size and the wrong sign",
        Some(2) => ". They are twice as large as they should be",
        Some(0) => ". They are zero where they should not be",
        _ => "",
    };
    format!("{}.", escape(&text))
}

/// Names, a few of them.
fn listed(places: &BTreeSet<usize>, names: &[String]) -> String {
    let known = |k: &usize| names.get(*k).map_or("?", String::as_str);
    let mut list: Vec<&str> = places.iter().take(NAMED).map(known).collect();
    if places.len() > NAMED {
        list.push("…");
    }
    list.join(", ")
}

/// If all that is off lies in one block, say which: rows of one joint or body, columns of one body.
fn blocks(off: &[(usize, usize)], rows: &[String], columns: &[String]) -> String {
    let owner = |name: &String| name.split([':', '.']).next().unwrap_or_default().to_owned();
    let own: BTreeSet<(String, String)> = off
        .iter()
        .filter_map(|(row, column)| Some((owner(rows.get(*row)?), owner(columns.get(*column)?))))
        .collect();
    match own.iter().next() {
        Some((row, column)) if own.len() == 1 => format!(": all in the block of {row} and body {column}"),
        _ => String::new(),
    }
}

/// −1, 2 or 0 if every wrong entry is that times the right one.
fn common_factor(given: &Grid, right: &Grid, off: &[(usize, usize)]) -> Option<i32> {
    [-1, 2, 0].into_iter().find(|k| {
        off.iter().all(|&(row, column)| {
            let (x, t) = (given.at(row, column), right.at(row, column));
            (x - f64::from(*k) * t).abs() <= 1e-6 * (1.0 + t.abs())
        })
    })
}
