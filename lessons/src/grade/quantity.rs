//! Numbers, vectors and matrices: unit and magnitude are judged apart, slips are recognised.

use super::Outcome;
use crate::exercise::Quantity;
use crate::markdown::{escape, render_short};
use crate::number::{self, Written};
use crate::submission::{Answer, Entry};
use crate::tolerance::{Shape, norm};
use crate::units::{Dimension, Unit, is_millinewton_for_newton_metre};
use crate::verdict::Mark;

/// Share of the points that belongs to the unit.
const UNIT_SHARE: f64 = 0.25;

/// Judges an answer; `note` is said when it is right.
pub(super) fn judge(question: &Quantity, note: &str, answer: &Answer) -> Outcome {
    let (written, unit) = match read(question, answer) {
        Ok(read) => read,
        Err(problem) => return Outcome::invalid(&problem),
    };
    if is_millinewton_for_newton_metre(&unit, &question.unit) {
        return Outcome::invalid("mN is millinewton, a force. For newton metre write N m.");
    }
    let same_dimension = unit.dimension == question.unit.dimension;
    // With a wrong unit the bare magnitude is still compared, in the question's own unit.
    let scale = if same_dimension { unit.factor / question.unit.factor } else { 1.0 };
    let values: Vec<f64> = written.iter().map(|w| w.value * scale).collect();
    if question.rule.accepts(&values, &question.reference) {
        if same_dimension {
            return Outcome::right(note);
        }
        let html = format!(
            "<p>The {} right, the unit is not.</p>{}",
            if question.shape == Shape::Number { "number is" } else { "numbers are" },
            mismatch(&unit, &question.unit)
        );
        let slip = Some("unit".to_owned());
        return Outcome { mark: Mark::Wrong, share: 1.0 - UNIT_SHARE, html, slip, ..Outcome::default() };
    }
    let mut outcome = match slip(question, &values) {
        Some((id, feedback)) => Outcome::wrong(Some(id), format!("<p>Not right.</p>{feedback}")),
        None if question.rule.too_coarse(&written, scale) => {
            let enough = question.rule.digits().map_or_else(
                || "more decimals".to_owned(),
                |digits| format!("at least {digits} significant digits"),
            );
            return Outcome::invalid(&format!(
                "With so few digits rounding alone can make an answer wrong; give {enough}, with zeros where the value is round."
            ));
        }
        None => Outcome::wrong(None, "<p>Not right.</p>".to_owned()),
    };
    if !same_dimension {
        outcome.html += "<p>The unit does not fit either.</p>";
        outcome.html += &mismatch(&unit, &question.unit);
    } else if question.asks_unit {
        outcome.share = UNIT_SHARE;
        outcome.html.push_str("<p>The unit fits.</p>");
    }
    outcome
}

/// The numbers of an answer in the question's unit, if they can be read and their dimension is right.
pub(super) fn values(question: &Quantity, answer: &Answer) -> Option<Vec<f64>> {
    let (written, unit) = read(question, answer).ok()?;
    let factor = unit.factor / question.unit.factor;
    (unit.dimension == question.unit.dimension).then(|| written.iter().map(|w| w.value * factor).collect())
}

fn mismatch(unit: &Unit, wanted: &Unit) -> String {
    let (is, wanted) = (unit.dimension.to_string(), wanted.dimension.to_string());
    format!("<p>{} is {}; what is asked for is {}.</p>", name(unit), escape(&is), escape(&wanted))
}

fn name(unit: &Unit) -> String {
    if unit.text().is_empty() { "No unit".to_owned() } else { escape(unit.text()) }
}

/// The numbers row by row, and the unit they are in.
fn read(question: &Quantity, answer: &Answer) -> Result<(Vec<Written>, Unit), String> {
    let Some(value) = &answer.value else {
        return Err("This question asks for a value, not for an option.".to_owned());
    };
    let [rows, columns] = question.size;
    let cells: Vec<&Entry> = match (question.shape, value) {
        (Shape::Number, Entry::List(_)) => {
            return Err("This question asks for one number, not a list.".to_owned());
        }
        (Shape::Number, entry) => vec![entry],
        (Shape::Vector, Entry::List(list)) if list.len() == rows => list.iter().collect(),
        (Shape::Matrix, Entry::List(list)) if list.len() == rows => {
            let mut cells = Vec::new();
            for row in list {
                match row {
                    Entry::List(row) if row.len() == columns => cells.extend(row),
                    _ => return Err(format!("Each row of the matrix has {columns} entries.")),
                }
            }
            cells
        }
        (Shape::Vector, _) => return Err(format!("Give {rows} components as a list.")),
        (Shape::Matrix, _) => return Err(format!("Give {rows} rows of {columns} entries as lists.")),
    };
    let mut written = Vec::new();
    let mut behind = String::new();
    for (k, cell) in cells.into_iter().enumerate() {
        let (number, rest) = match cell {
            Entry::Text(text) if text.trim().is_empty() => {
                return Err(format!("Entry {} is empty; write 0 if it is zero.", k + 1));
            }
            Entry::Text(text) => number::read(text).map_err(|error| sentence(&error.to_string()))?,
            // A number that a program sent stands for itself; nobody chose its digits.
            Entry::Number(x) if x.is_finite() => (Written { value: *x, half_unit: 0.0 }, String::new()),
            Entry::Number(_) => return Err("A value is not a finite number.".to_owned()),
            Entry::List(_) => return Err("A list is nested too deeply.".to_owned()),
        };
        written.push(number);
        if !rest.is_empty() {
            if !behind.is_empty() && behind != rest {
                return Err("The components have different units; give them all in one.".to_owned());
            }
            behind = rest;
        }
    }
    Ok((written, unit(question, answer, &behind)?))
}

fn unit(question: &Quantity, answer: &Answer, behind: &str) -> Result<Unit, String> {
    let field = answer.unit.as_deref().map_or("", str::trim);
    if !behind.is_empty() && !field.is_empty() && behind != field {
        let (behind, field) = (number::shorten(behind), number::shorten(field));
        return Err(format!("There are two units, {behind} and {field}; keep one."));
    }
    let text = if behind.is_empty() { field } else { behind };
    if !text.is_empty() {
        return Unit::parse(text).map_err(|error| sentence(&error.to_string()));
    }
    if question.asks_unit && question.unit.dimension != Dimension::default() {
        return Err("A unit is missing; finding it is part of the question.".to_owned());
    }
    Ok(question.unit.clone())
}

/// A message as a sentence of its own.
fn sentence(message: &str) -> String {
    let mut chars = message.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", chars.as_str())
}

/// The slip that leads to these values, with its feedback as HTML: the author's own first, then those that any
/// question can have.
fn slip<'a>(question: &'a Quantity, values: &[f64]) -> Option<(&'a str, String)> {
    let own = question.misconceptions.iter().filter(|m| question.rule.accepts(values, &m.value));
    let distance = |m: &crate::exercise::Misconception| {
        norm(&values.iter().zip(&m.value).map(|(s, t)| s - t).collect::<Vec<_>>())
    };
    if let Some(m) = own.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        return Some((&m.id, render_short(&m.feedback)));
    }
    if question.rule.is_exact() || norm(&question.reference) == 0.0 {
        return None;
    }
    let scaled = |k: f64| question.reference.iter().map(|t| k * t).collect::<Vec<_>>();
    if question.rule.accepts(values, &scaled(-1.0)) {
        let text = match question.shape {
            Shape::Number => "<p>The size is right, the sign is not.</p>",
            _ => "<p>The size is right, every sign is not: this is the opposite one.</p>",
        };
        return Some(("opposite-sign", text.to_owned()));
    }
    let powers = [-6, -3, -2, -1, 1, 2, 3, 6];
    if powers.iter().any(|k| question.rule.accepts(values, &scaled(10f64.powi(*k)))) {
        return Some((
            "power-of-ten",
            "<p>The digits are right, the power of ten is not: check the units.</p>".to_owned(),
        ));
    }
    if question.shape == Shape::Vector && question.rule.accepts(&[norm(values)], &[norm(&question.reference)])
    {
        let frame = question.frame.as_deref().unwrap_or("the stated frame");
        let text =
            format!("<p>The length is right, the direction is not. Components in {}?</p>", escape(frame));
        return Some(("direction", text));
    }
    None
}
