//! What was typed, as it is understood: the numbers of an answer in the question's unit. Nothing is compared here, so the
//! page may show it while somebody types.

use triad_engine::scene::expression::Expression;

use crate::answers::array;
use crate::answers::number::{self, ParsedNumber};
use crate::answers::tolerance::ValueShape;
use crate::answers::units::{Dimension, Unit, UnitError, is_millinewton_for_newton_metre};
use crate::answers::{Answer, TypedValue};
use crate::exercise::{QuantityQuestion, Question, QuestionBody};
use crate::text::{plain, shorten};
use crate::verdict::invalid::{InvalidAnswer, InvalidClosed, InvalidQuantity};

/// The numbers of an answer, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// In the question's unit; where the dimension is another one, as they were written.
    pub values: Vec<f64>,
    /// What rounding may have changed, alike.
    pub rounding: Vec<f64>,
    /// The first unit that has not the question's dimension.
    pub mismatch: Option<Unit>,
    entries: Vec<Entry>,
}

/// A number and the unit it was written in.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    number: ParsedNumber,
    unit: Unit,
}

/// Reads an answer to a question for numbers.
pub(super) fn read(question: &QuantityQuestion, answer: &Answer) -> Result<Reading, InvalidQuantity> {
    let value = answer.value.as_ref().ok_or(InvalidQuantity::NoValue)?;
    let (numbers, shared) = entries(question, value)?;
    let field = answer.unit.as_deref().map_or("", str::trim);
    let behind_all = match (shared.is_empty(), field.is_empty()) {
        (false, false) if !same_unit(question, &shared, field) => return Err(two_units(&shared, field)),
        (true, _) => field,
        (false, _) => &shared,
    };
    of_some_only(question, &numbers, behind_all)?;
    let unit_of_others = numbers.iter().map(|(_, own)| own.as_str()).find(|own| !own.is_empty());
    let mut entries = Vec::with_capacity(numbers.len());
    for (number, own) in &numbers {
        if !own.is_empty() && !behind_all.is_empty() && !same_unit(question, own, behind_all) {
            return Err(two_units(own, behind_all));
        }
        // Zero is zero in every unit: `(3 N, 0, 4 N)`.
        let text = match (own.is_empty(), behind_all.is_empty(), number.value == 0.0) {
            (true, true, true) => unit_of_others.unwrap_or(behind_all),
            (true, ..) => behind_all,
            (false, ..) => own,
        };
        entries.push(Entry { number: *number, unit: unit(question, text)? });
    }
    let factor = |entry: &Entry| {
        if entry.unit.dimension == question.unit.dimension {
            entry.unit.factor / question.unit.factor
        } else {
            1.0
        }
    };
    let values: Vec<f64> = entries.iter().map(|e| e.number.value * factor(e)).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(InvalidQuantity::NotFinite);
    }
    Ok(Reading {
        values,
        rounding: entries.iter().map(|e| e.number.half_ulp_decimal * factor(e)).collect(),
        mismatch: entries
            .iter()
            .find(|e| e.unit.dimension != question.unit.dimension)
            .map(|e| e.unit.clone()),
        entries,
    })
}

fn two_units(behind: &str, field: &str) -> InvalidQuantity {
    InvalidQuantity::TwoUnits { behind: shorten(behind), field: shorten(field) }
}

fn same_unit(question: &QuantityQuestion, a: &str, b: &str) -> bool {
    let read = |text: &str| Unit::parse_as(text, question.unit.dimension).map(|u| (u.factor, u.dimension));
    read(a).is_ok_and(|a| read(b) == Ok(a))
}

/// A unit behind some components only is the question's own, or nobody knows whether it was meant for all.
fn of_some_only(
    question: &QuantityQuestion,
    numbers: &[(ParsedNumber, String)],
    behind_all: &str,
) -> Result<(), InvalidQuantity> {
    let without = numbers.iter().position(|(number, own)| own.is_empty() && number.value != 0.0);
    let with = numbers.iter().position(|(_, own)| !own.is_empty());
    match (without, with) {
        (Some(_), Some(with)) if behind_all.is_empty() => {
            let unit = &numbers[with].1;
            if !question.asks_unit && same_unit(question, unit, question.unit.text()) {
                return Ok(());
            }
            Err(InvalidQuantity::UnitOfOne { entry: with + 1, unit: shorten(unit) })
        }
        _ => Ok(()),
    }
}

/// The numbers with the texts behind them, and the text behind all.
type Entries = (Vec<(ParsedNumber, String)>, String);

fn entries(question: &QuantityQuestion, value: &TypedValue) -> Result<Entries, InvalidQuantity> {
    let [rows, columns] = question.size;
    match (question.shape, value) {
        (ValueShape::Number, TypedValue::List(list)) => match list.as_slice() {
            [one] => Ok((vec![entry(0, one)?], String::new())),
            _ => Err(InvalidQuantity::List),
        },
        (ValueShape::Number, one) => Ok((vec![entry(0, one)?], String::new())),
        (_, TypedValue::Text(text)) => in_one_text(question, text),
        (_, TypedValue::List(list)) => {
            if let [TypedValue::Text(text)] = list.as_slice() {
                return in_one_text(question, text);
            }
            let cells = match question.shape {
                ValueShape::Matrix => of_rows(list, rows, columns)?,
                _ if list.len() == rows => in_order(list.iter().map(alone).collect())?,
                _ => return Err(InvalidQuantity::Components { rows }),
            };
            let read = cells.iter().enumerate().map(|(k, cell)| entry(k, cell));
            Ok((read.collect::<Result<_, _>>()?, String::new()))
        }
        (ValueShape::Matrix, _) => Err(InvalidQuantity::Rows { rows, columns }),
        (_, _) => Err(InvalidQuantity::Components { rows }),
    }
}

/// A row `[x]` of a column is x.
fn alone(cell: &TypedValue) -> TypedValue {
    match cell {
        TypedValue::List(list) if list.len() == 1 => list[0].clone(),
        other => other.clone(),
    }
}

/// Cells in the order of their labels, if they are texts that have such.
fn in_order(cells: Vec<TypedValue>) -> Result<Vec<TypedValue>, InvalidQuantity> {
    let texts =
        cells.iter().map(|cell| if let TypedValue::Text(text) = cell { Some(text.clone()) } else { None });
    let Some(texts) = texts.collect::<Option<Vec<_>>>() else { return Ok(cells) };
    let order = array::order(&texts).ok_or(InvalidQuantity::Components { rows: cells.len() })?;
    Ok(order.into_iter().map(|k| cells[k].clone()).collect())
}

/// The cells of rows, each a list or a text.
fn of_rows(list: &[TypedValue], rows: usize, columns: usize) -> Result<Vec<TypedValue>, InvalidQuantity> {
    if list.len() != rows {
        return Err(InvalidQuantity::Rows { rows, columns });
    }
    let mut cells = Vec::new();
    for row in list {
        match row {
            TypedValue::List(row) if row.len() == columns => cells.extend(row.iter().cloned()),
            TypedValue::Text(text) => {
                let row = array::cells(text, columns, 1).ok_or(InvalidQuantity::RowLength { columns })?;
                cells.extend(row.texts.into_iter().map(TypedValue::Text));
            }
            _ => return Err(InvalidQuantity::RowLength { columns }),
        }
    }
    Ok(cells)
}

fn in_one_text(question: &QuantityQuestion, text: &str) -> Result<Entries, InvalidQuantity> {
    let [rows, columns] = question.size;
    let cells = array::cells(text, rows, columns).ok_or(match question.shape {
        ValueShape::Matrix => InvalidQuantity::Rows { rows, columns },
        _ => InvalidQuantity::Components { rows },
    })?;
    let read = cells.texts.iter().map(|text| number::read(text)).collect::<Result<_, _>>()?;
    Ok((read, cells.unit))
}

fn entry(place: usize, cell: &TypedValue) -> Result<(ParsedNumber, String), InvalidQuantity> {
    match cell {
        TypedValue::Text(text) if text.trim().is_empty() => Err(InvalidQuantity::Empty { entry: place + 1 }),
        TypedValue::Text(text) => Ok(number::read(text)?),
        // A number that a program sent stands for itself; nobody chose its digits.
        TypedValue::Number(x) if x.is_finite() => {
            Ok((ParsedNumber { value: *x, half_ulp_decimal: 0.0 }, String::new()))
        }
        TypedValue::Number(_) => Err(InvalidQuantity::NotFinite),
        TypedValue::List(_) => Err(InvalidQuantity::Nested),
    }
}

/// The unit that a number is in: as written, or the question's.
fn unit(question: &QuantityQuestion, text: &str) -> Result<Unit, InvalidQuantity> {
    let wanted = &question.unit;
    let is_count = question.tolerance.is_exact() && wanted.dimension == Dimension::default();
    if text.is_empty() {
        if question.asks_unit && wanted.dimension != Dimension::default() {
            return Err(InvalidQuantity::NoUnit);
        }
        return Ok(wanted.clone());
    }
    let unit = match Unit::parse_as(text, wanted.dimension) {
        // `11 rows`
        Err(UnitError::Unknown { .. }) if is_count && names_what_is_counted(text) => {
            return Ok(wanted.clone());
        }
        read => read?,
    };
    if is_count && (unit.dimension != wanted.dimension || unit.factor != 1.0) {
        return Err(InvalidQuantity::Count { unit: shorten(text) });
    }
    if is_millinewton_for_newton_metre(&unit, wanted) {
        return Err(InvalidQuantity::Millinewton);
    }
    if unit.dimension == wanted.dimension && unit.counts_turns() != wanted.counts_turns() {
        return Err(InvalidQuantity::Hertz { wanted: wanted.text().to_owned() });
    }
    if unit.dimension != wanted.dimension && !question.asks_unit {
        let wanted =
            if wanted.text().is_empty() { "a pure number".to_owned() } else { wanted.text().to_owned() };
        return Err(InvalidQuantity::OtherUnit { given: shorten(text), wanted });
    }
    Ok(unit)
}

/// Whether the words behind a count say what is counted, and nothing of how many.
fn names_what_is_counted(text: &str) -> bool {
    const OF_NUMBERS: [&str; 14] = [
        "or", "to", "through", "plus", "minus", "times", "over", "hundred", "thousand", "million", "dozen",
        "half", "i", "e",
    ];
    let plain = text.chars().all(|c| c.is_alphabetic() || " -'.,()".contains(c));
    let mut words = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    plain
        && words
            .all(|word| !OF_NUMBERS.contains(&word.to_lowercase().as_str()) && number::read(word).is_err())
}

/// How an answer is understood, in words for its author: `29.4 N`, `(1, 2, 3) kg m/s`, `m·g·cos(alpha)`. `None` for a kind of
/// question whose answer is not typed.
pub(crate) fn understood(question: &Question, answer: &Answer) -> Option<Result<String, InvalidAnswer>> {
    match &question.body {
        QuestionBody::Quantity(body) => {
            Some(read(body, answer).map(|reading| in_words(body, &reading)).map_err(Into::into))
        }
        QuestionBody::Formula(body) => {
            let Some(TypedValue::Text(text)) = &answer.value else {
                return Some(Err(InvalidClosed::NoFormula.into()));
            };
            let names: Vec<&str> = body.symbols.iter().map(String::as_str).collect();
            let read = Expression::parse(text, &names).map(|formula| formula.written(&names));
            Some(read.map_err(|error| InvalidClosed::from(error).into()))
        }
        _ => None,
    }
}

/// The entries of a vector or a matrix that stands in one text, each with the unit that is behind all of them.
pub(super) fn cells(question: &Question, answer: &Answer) -> Vec<String> {
    let QuestionBody::Quantity(body) = &question.body else { return Vec::new() };
    let Some(TypedValue::Text(text)) = &answer.value else { return Vec::new() };
    let [rows, columns] = body.size;
    let Some(cells) = array::cells(text, rows, columns).filter(|_| body.shape != ValueShape::Number) else {
        return Vec::new();
    };
    cells.texts.iter().map(|entry| format!("{entry} {}", cells.unit).trim().to_owned()).collect()
}

fn in_words(question: &QuantityQuestion, reading: &Reading) -> String {
    let with_unit = |numbers: String, unit: &str| match unit {
        "" | "1" => numbers,
        "°" | "%" => format!("{numbers}{unit}"),
        unit => format!("{numbers} {unit}"),
    };
    let list = |values: &[f64]| match question.shape {
        ValueShape::Number => values.first().copied().map(plain).unwrap_or_default(),
        ValueShape::Vector => {
            format!("({})", values.iter().copied().map(plain).collect::<Vec<_>>().join(", "))
        }
        ValueShape::Matrix => {
            let row = |row: &[f64]| row.iter().copied().map(plain).collect::<Vec<_>>().join(" ");
            format!("[{}]", values.chunks(question.size[1].max(1)).map(row).collect::<Vec<_>>().join("; "))
        }
    };
    let in_question = || with_unit(list(&reading.values), question.unit.text());
    let Some(first) = reading.entries.first() else { return String::new() };
    if reading.entries.iter().any(|entry| entry.unit.text() != first.unit.text()) {
        return in_question();
    }
    let written: Vec<f64> = reading.entries.iter().map(|entry| entry.number.value).collect();
    let as_written = with_unit(list(&written), first.unit.text());
    // A joule is a newton metre, and yet no moment: it is taken, and said.
    let is_energy = first.unit.text().ends_with('J') && !question.unit.text().contains('J');
    if is_energy && reading.mismatch.is_none() && !question.asks_unit {
        return format!("{}: a moment; joules are for work and energy", in_question());
    }
    if reading.mismatch.is_some() || written == reading.values {
        return as_written;
    }
    format!("{as_written} = {}", in_question())
}
