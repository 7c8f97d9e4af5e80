//! Numbers, vectors and matrices: unit and magnitude are judged apart, misconceptions are recognised.

use crate::answers::number::{self, ParsedNumber};
use crate::answers::tolerance::{ValueShape, distance, norm};
use crate::answers::units::{Dimension, Unit, is_millinewton_for_newton_metre};
use crate::answers::{Answer, TypedValue};
use crate::exercise::QuantityQuestion;
use crate::text::shorten;
use crate::verdict::feedback::{Feedback, Judgement, NumberFinding, QuantityFeedback, UnitFinding};
use crate::verdict::invalid::InvalidQuantity;
use triad_engine::scene::expression::normalise;

/// Share of the points that belongs to the unit.
const UNIT_SHARE: f64 = 0.25;
/// Powers of ten that a wrong prefix makes.
const PREFIX_POWERS: [i32; 8] = [-6, -3, -2, -1, 1, 2, 3, 6];

/// Judges an answer; `note` is said when it is right.
pub(super) fn judge(
    question: &QuantityQuestion,
    note: &str,
    answer: &Answer,
) -> Result<Judgement, InvalidQuantity> {
    let (numbers, unit) = read(question, answer)?;
    if is_millinewton_for_newton_metre(&unit, &question.unit) {
        return Err(InvalidQuantity::Millinewton);
    }
    let same_dimension = unit.dimension == question.unit.dimension;
    // With a wrong unit the bare magnitude is still compared, in the question's own unit.
    let scale = if same_dimension { unit.factor / question.unit.factor } else { 1.0 };
    let values: Vec<f64> = numbers.iter().map(|n| n.value * scale).collect();
    let right = question.tolerance.accepts(&values, &question.reference);
    if right && same_dimension {
        return Ok(Judgement::right(Feedback::Right { note: note.to_owned() }));
    }
    let unit = match same_dimension {
        false => UnitFinding::Mismatch { given: unit, wanted: question.unit.clone() },
        true if question.asks_unit => UnitFinding::Found,
        true => UnitFinding::Given,
    };
    let (misconception, number) = if right {
        (Some("unit"), NumberFinding::Right)
    } else if let Some((id, finding)) = misconception(question, &values) {
        (Some(id), finding)
    } else if question.tolerance.insufficient_precision(&numbers, scale) {
        return Err(InvalidQuantity::InsufficientPrecision { digits: question.tolerance.digits() });
    } else {
        (None, NumberFinding::Unknown)
    };
    let share = match (&number, &unit) {
        (NumberFinding::Right, _) => 1.0 - UNIT_SHARE,
        (_, UnitFinding::Found) => UNIT_SHARE,
        _ => 0.0,
    };
    let feedback = Feedback::Quantity(QuantityFeedback { shape: question.shape, number, unit });
    Ok(Judgement::wrong(share, misconception, feedback))
}

/// The numbers of an answer in the question's unit, if they can be read and their dimension is right.
pub(super) fn values(question: &QuantityQuestion, answer: &Answer) -> Option<Vec<f64>> {
    let (numbers, unit) = read(question, answer).ok()?;
    let factor = unit.factor / question.unit.factor;
    (unit.dimension == question.unit.dimension).then(|| numbers.iter().map(|n| n.value * factor).collect())
}

/// The cells of an answer, row by row.
fn cells<'a>(
    question: &QuantityQuestion,
    value: &'a TypedValue,
) -> Result<Vec<&'a TypedValue>, InvalidQuantity> {
    let [rows, columns] = question.size;
    match (question.shape, value) {
        (ValueShape::Number, TypedValue::List(_)) => Err(InvalidQuantity::List),
        (ValueShape::Number, one) => Ok(vec![one]),
        (ValueShape::Vector, TypedValue::List(list)) if list.len() == rows => Ok(list.iter().collect()),
        (ValueShape::Matrix, TypedValue::List(list)) if list.len() == rows => {
            let mut cells = Vec::new();
            for row in list {
                match row {
                    TypedValue::List(row) if row.len() == columns => cells.extend(row),
                    _ => return Err(InvalidQuantity::RowLength { columns }),
                }
            }
            Ok(cells)
        }
        (ValueShape::Vector, _) => Err(InvalidQuantity::Components { rows }),
        (ValueShape::Matrix, _) => Err(InvalidQuantity::Rows { rows, columns }),
    }
}

/// The numbers row by row, and the unit they are in.
fn read(question: &QuantityQuestion, answer: &Answer) -> Result<(Vec<ParsedNumber>, Unit), InvalidQuantity> {
    let value = answer.value.as_ref().ok_or(InvalidQuantity::NoValue)?;
    let mut numbers = Vec::new();
    let mut behind = String::new();
    for (k, cell) in cells(question, value)?.into_iter().enumerate() {
        let (number, rest) = match cell {
            TypedValue::Text(text) if text.trim().is_empty() => {
                return Err(InvalidQuantity::Empty { entry: k + 1 });
            }
            TypedValue::Text(text) => number::read(text)?,
            // A number that a program sent stands for itself; nobody chose its digits.
            TypedValue::Number(x) if x.is_finite() => {
                (ParsedNumber { value: *x, half_ulp_decimal: 0.0 }, String::new())
            }
            TypedValue::Number(_) => return Err(InvalidQuantity::NotFinite),
            TypedValue::List(_) => return Err(InvalidQuantity::Nested),
        };
        numbers.push(number);
        if !rest.is_empty() {
            if !behind.is_empty() && behind != rest {
                return Err(InvalidQuantity::DifferentUnits);
            }
            behind = rest;
        }
    }
    Ok((numbers, unit(question, answer, &behind)?))
}

/// The unit of an answer: behind its numbers, in its own field, or the question's.
fn unit(question: &QuantityQuestion, answer: &Answer, behind: &str) -> Result<Unit, InvalidQuantity> {
    let field = answer.unit.as_deref().map_or("", str::trim);
    if !behind.is_empty() && !field.is_empty() && behind != normalise(field) {
        return Err(InvalidQuantity::TwoUnits { behind: shorten(behind), field: shorten(field) });
    }
    let text = if behind.is_empty() { field } else { behind };
    if !text.is_empty() {
        return Ok(Unit::parse(text)?);
    }
    if question.asks_unit && question.unit.dimension != Dimension::default() {
        return Err(InvalidQuantity::NoUnit);
    }
    Ok(question.unit.clone())
}

/// The misconception that leads to these values: the author's own first, then those that any question can have.
fn misconception<'a>(question: &'a QuantityQuestion, values: &[f64]) -> Option<(&'a str, NumberFinding)> {
    let accepts = |wanted: &[f64]| question.tolerance.accepts(values, wanted);
    let own = question.misconceptions.iter().filter(|m| accepts(&m.value));
    if let Some(m) = own.min_by(|a, b| distance(values, &a.value).total_cmp(&distance(values, &b.value))) {
        return Some((&m.id, NumberFinding::Misconception { feedback: m.feedback.clone() }));
    }
    let reference = &question.reference;
    if question.tolerance.is_exact() || norm(reference) == 0.0 {
        return None;
    }
    let scaled = |k: f64| reference.iter().map(|t| k * t).collect::<Vec<_>>();
    if accepts(&scaled(-1.0)) {
        return Some(("opposite-sign", NumberFinding::OppositeSign));
    }
    if PREFIX_POWERS.iter().any(|k| accepts(&scaled(libm::pow(10.0, f64::from(*k))))) {
        return Some(("power-of-ten", NumberFinding::PowerOfTen));
    }
    if question.shape == ValueShape::Vector && question.tolerance.accepts(&[norm(values)], &[norm(reference)])
    {
        return Some(("direction", NumberFinding::Direction { frame: question.frame.clone() }));
    }
    None
}
