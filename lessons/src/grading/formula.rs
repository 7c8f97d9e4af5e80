//! Formulas: two are the same if they agree at many random points of the symbols' ranges.

use crate::answers::{Answer, TypedValue};
use crate::exercise::Formula;
use crate::random::SeededRandom;
use crate::recognition::formula::recognise;
use crate::verdict::feedback::{Feedback, FormulaFinding, Judgement};
use crate::verdict::invalid::InvalidClosed;
use triad_engine::scene::expression::Expression;

/// Points at which formulas are compared.
const POINTS: usize = 24;
/// Difference below which two values agree, as a part of their sum.
const AGREEMENT: f64 = 1e-9;
/// The same where a number with decimals is part of the answer, rounded to four digits at least: 1.155 may stand for 2/√3.
const ROUNDED_AGREEMENT: f64 = 2.5e-4;

/// Judges a formula; `seed` makes the points of each question its own.
pub(crate) fn judge(
    question: &Formula,
    seed: &str,
    note: &str,
    answer: &Answer,
) -> Result<Judgement, InvalidClosed> {
    let Some(TypedValue::Text(text)) = &answer.value else { return Err(InvalidClosed::NoFormula) };
    let names: Vec<&str> = question.symbols.iter().map(String::as_str).collect();
    let formula = Expression::parse(text, &names)?;
    let is = |other: &Expression, factor| same(&formula, other, &question.ranges, seed, factor);
    if is(&question.reference, 1.0) {
        return Ok(Judgement::right(Feedback::Right { note: note.to_owned() }));
    }
    let wrong = |id: Option<&str>, finding| Ok(Judgement::wrong(0.0, id, Feedback::Formula(finding)));
    if let Some((id, _, feedback)) = question.misconceptions.iter().find(|(_, wrong, _)| is(wrong, 1.0)) {
        return wrong(Some(id), FormulaFinding::Misconception { feedback: feedback.clone() });
    }
    if is(&question.reference, -1.0) {
        return wrong(Some("opposite-sign"), FormulaFinding::OppositeSign);
    }
    let missing: Vec<&str> = (0..names.len())
        .filter(|k| question.reference.uses(*k) && !formula.uses(*k))
        .map(|k| names[k])
        .collect();
    if let [one] = missing.as_slice() {
        return wrong(Some("missing-symbol"), FormulaFinding::MissingSymbol { symbol: (*one).to_owned() });
    }
    match recognise(question, &formula, seed) {
        Some(usual) => wrong(Some(usual.mistake.code), FormulaFinding::Usual(usual)),
        None => wrong(None, FormulaFinding::Unknown),
    }
}

/// Whether `a` equals `factor` times `b` at all points where `b` is defined; less closely where `a` has decimals, which may
/// be rounded.
pub(crate) fn same(a: &Expression, b: &Expression, ranges: &[[f64; 2]], seed: &str, factor: f64) -> bool {
    let agreement = if a.has_decimals() { ROUNDED_AGREEMENT } else { AGREEMENT };
    let mut random = SeededRandom::new(seed);
    let mut defined = 0;
    for _ in 0..POINTS {
        let point: Vec<f64> = ranges.iter().map(|[low, high]| low + (high - low) * random.unit()).collect();
        let (x, y) = (a.eval(&point), factor * b.eval(&point));
        if !y.is_finite() {
            continue;
        }
        defined += 1;
        let agrees = x.is_finite() && (x - y).abs() <= agreement * x.abs() + agreement * y.abs() + 1e-300;
        if !agrees {
            return false;
        }
    }
    defined >= POINTS / 2
}
