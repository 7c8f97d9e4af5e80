//! Numbers, vectors and matrices: unit and magnitude are judged apart, misconceptions are recognised.

use super::reading::{self, Reading};
use crate::answers::Answer;
use crate::answers::tolerance::{ValueShape, distance, norm};
use crate::exercise::{Misconception, QuantityQuestion};
use crate::recognition::digits;
use crate::recognition::quantity::{recognise, with_one_more_slip};
use crate::verdict::feedback::{Feedback, Judgement, NumberFinding, QuantityFeedback, UnitFinding};
use crate::verdict::invalid::InvalidQuantity;

/// Share of the points that belongs to the unit, where finding it is part of the question: the right number alone is not
/// enough to pass.
const UNIT_SHARE: f64 = 0.5;
/// Part of the reference's size from which an answer is far off, however few its digits.
const FAR: f64 = 0.1;
/// Powers of ten that a wrong prefix makes.
const PREFIX_POWERS: [i32; 8] = [-6, -3, -2, -1, 1, 2, 3, 6];

/// Judges an answer; `note` is said when it is right. Where the verdict is `held` back too few digits are a wrong answer: to be
/// asked for more would tell that these are right.
pub(crate) fn judge(
    question: &QuantityQuestion,
    note: &str,
    answer: &Answer,
    held: bool,
) -> Result<Judgement, InvalidQuantity> {
    let reading = reading::read(question, answer)?;
    // With a wrong unit the bare magnitude is still compared, in the question's own unit.
    let values = &reading.values;
    let right = question.tolerance.accepts(values, &question.reference);
    let unit = match &reading.mismatch {
        None if right => return Ok(Judgement::right(Feedback::Right { note: note.to_owned() })),
        Some(given) => UnitFinding::Mismatch { given: given.clone(), wanted: question.unit.clone() },
        None if question.asks_unit => UnitFinding::Found,
        None => UnitFinding::Given,
    };
    let rounding: Vec<f64> = roundings(&reading).collect();
    let tells = !is_short(question, &reading) || digits::tell_apart(question, values, &rounding);
    let stands = tells || digits::is_misconception(question, values);
    let (misconception, number) = if right {
        (Some("unit"), NumberFinding::Right)
    } else if let Some((id, finding)) = misconception(question, values).filter(|_| stands) {
        (Some(id), finding)
    } else if is_too_coarse(question, &reading) {
        let digits = question.tolerance.digits();
        if !held {
            return Err(InvalidQuantity::InsufficientPrecision { digits });
        }
        (None, NumberFinding::TooCoarse { digits })
    } else if !tells {
        // What went wrong cannot be told from these digits, if they do not stand for themselves.
        match digits::usual(question, values, &rounding) {
            Some(usual) => (Some(usual.mistake.code), NumberFinding::Usual(usual)),
            None => (None, NumberFinding::TooCoarse { digits: question.tolerance.digits() }),
        }
    } else if let Some((id, finding)) = turned(question, values) {
        (Some(id), finding)
    } else if let Some(usual) = recognise(question, values, &reading.rounding) {
        (Some(usual.mistake.code), NumberFinding::Usual(usual))
    } else if let Some(at) = with_one_more_slip(question, values, &reading.rounding) {
        let m = &question.misconceptions[at];
        (Some(m.id.as_str()), NumberFinding::MisconceptionAndMore { feedback: m.feedback.clone() })
    } else if let Some(finding) = direction(question, values) {
        (Some("direction"), finding)
    } else {
        (None, NumberFinding::Unknown)
    };
    let share = match (&number, &unit) {
        (NumberFinding::Right, _) => 1.0 - UNIT_SHARE,
        (_, UnitFinding::Found) => 0.5 * UNIT_SHARE,
        _ => 0.0,
    };
    let feedback = Feedback::Quantity(QuantityFeedback { shape: question.shape, number, unit });
    Ok(Judgement::wrong(share, misconception, feedback))
}

/// Whether an answer is wrong by no more than the rounding of its own few digits: then more digits may make it right. It tells
/// nothing that the verdict on those digits would not. Nobody rounds by a tenth of the whole.
fn is_too_coarse(question: &QuantityQuestion, reading: &Reading) -> bool {
    let size = norm(&question.reference);
    let allowed = question.tolerance.allowed(size);
    let explained = reading
        .values
        .iter()
        .zip(roundings(reading))
        .zip(&question.reference)
        .all(|((value, rounding), right)| (value - right).abs() <= (allowed + rounding) * (1.0 + 1e-12));
    is_short(question, reading) && explained && distance(&reading.values, &question.reference) <= FAR * size
}

/// What rounding may have changed. Nobody rounds to zero what is not small.
fn roundings(reading: &Reading) -> impl Iterator<Item = f64> {
    reading.values.iter().zip(&reading.rounding).map(|(value, r)| if *value == 0.0 { 0.0 } else { *r })
}

/// Whether rounding to these digits alone can make an answer wrong, whatever is right.
fn is_short(question: &QuantityQuestion, reading: &Reading) -> bool {
    let allowed = question.tolerance.allowed(norm(&reading.values));
    !question.tolerance.is_exact() && roundings(reading).any(|rounding| rounding > allowed)
}

/// What a short answer is told beside one that is asked for more digits: the same, whether it is right or not.
pub(super) fn more_digits(question: &QuantityQuestion, answer: &Answer) -> Option<InvalidQuantity> {
    let reading = reading::read(question, answer).ok()?;
    is_short(question, &reading)
        .then(|| InvalidQuantity::InsufficientPrecision { digits: question.tolerance.digits() })
}

/// The numbers of an answer in the question's unit, if they can be read and their dimension is right.
pub(super) fn values(question: &QuantityQuestion, answer: &Answer) -> Option<Vec<f64>> {
    let reading = reading::read(question, answer).ok()?;
    reading.mismatch.is_none().then_some(reading.values)
}

/// How many tolerances an answer lies from the reference; none where it cannot be read or only the exact number counts.
pub(super) fn tolerances(question: &QuantityQuestion, answer: &Answer) -> Option<f64> {
    let allowed = question.tolerance.allowed(norm(&question.reference));
    let values = values(question, answer)?;
    (allowed > 0.0).then(|| distance(&values, &question.reference) / allowed)
}

/// The numbers of an answer if they can be read: in the question's unit, or as they are beside a unit of another dimension.
pub(super) fn magnitudes(question: &QuantityQuestion, answer: &Answer) -> Option<Vec<f64>> {
    reading::read(question, answer).ok().map(|reading| reading.values)
}

/// The misconception that leads to these values: the author's own first, then an opposite sign and a power of ten.
fn misconception<'a>(question: &'a QuantityQuestion, values: &[f64]) -> Option<(&'a str, NumberFinding)> {
    let accepts = |wanted: &[f64]| question.tolerance.accepts(values, wanted);
    let own = question.misconceptions.iter().filter(|m| accepts(&m.value));
    if let Some(m) = own.min_by(|a, b| distance(values, &a.value).total_cmp(&distance(values, &b.value))) {
        return Some((&m.id, NumberFinding::Misconception { feedback: m.feedback.clone() }));
    }
    let reference = &question.reference;
    if norm(reference) == 0.0 {
        return None;
    }
    let scaled = |k: f64| reference.iter().map(|t| k * t).collect::<Vec<_>>();
    if accepts(&scaled(-1.0)) {
        return Some(("opposite-sign", NumberFinding::OppositeSign));
    }
    if !question.tolerance.is_exact()
        && PREFIX_POWERS.iter().any(|k| accepts(&scaled(libm::pow(10.0, f64::from(*k)))))
    {
        return Some(("power-of-ten", NumberFinding::PowerOfTen));
    }
    None
}

/// A misconception of the author's with the opposite sign: what is said of it holds as well.
fn turned<'a>(question: &'a QuantityQuestion, values: &[f64]) -> Option<(&'a str, NumberFinding)> {
    let opposite: Vec<f64> = values.iter().map(|x| -x).collect();
    let accepts =
        |m: &&Misconception| question.tolerance.accepts(&opposite, &m.value) && norm(&m.value) > 0.0;
    let m = question.misconceptions.iter().find(accepts)?;
    Some((&m.id, NumberFinding::Misconception { feedback: m.feedback.clone() }))
}

/// A vector of the right length.
fn direction(question: &QuantityQuestion, values: &[f64]) -> Option<NumberFinding> {
    let (typed, right) = ([norm(values)], [norm(&question.reference)]);
    let fits = question.shape == ValueShape::Vector && question.tolerance.accepts(&typed, &right);
    fits.then(|| NumberFinding::Direction { frame: question.frame.clone() })
}
