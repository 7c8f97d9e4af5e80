//! Formulas: two are the same if they agree at many random points of the symbols' ranges.

use super::Outcome;
use crate::exercise::FormulaBody;
use crate::expression::Expression;
use crate::markdown::render_short;
use crate::random::Random;
use crate::submission::{Answer, Entry};

/// Points at which formulas are compared.
const POINTS: usize = 24;
/// Relative difference below which two values agree.
const AGREEMENT: f64 = 1e-9;

/// Judges a formula; `seed` makes the points of each question its own.
pub(super) fn judge(question: &FormulaBody, seed: &str, note: &str, answer: &Answer) -> Outcome {
    let Some(Entry::Text(text)) = &answer.value else {
        return Outcome::invalid("This question asks for a formula, written as text such as 2*m*g.");
    };
    let names: Vec<&str> = question.symbols.iter().map(String::as_str).collect();
    let formula = match Expression::parse(text, &names) {
        Ok(formula) => formula,
        Err(error) => return Outcome::invalid(&format!("The formula cannot be read: {error}.")),
    };
    if same(&formula, &question.reference, &question.ranges, seed, 1.0) {
        return Outcome::right(note);
    }
    for (id, wrong, feedback) in &question.misconceptions {
        if same(&formula, wrong, &question.ranges, seed, 1.0) {
            return Outcome::wrong(Some(id), format!("<p>Not right.</p>{}", render_short(feedback)));
        }
    }
    if same(&formula, &question.reference, &question.ranges, seed, -1.0) {
        let text = "<p>Not right.</p><p>The formula is right but for its sign.</p>";
        return Outcome::wrong(Some("opposite-sign"), text.to_owned());
    }
    let missing: Vec<&str> = (0..names.len())
        .filter(|k| question.reference.uses(*k) && !formula.uses(*k))
        .map(|k| names[k])
        .collect();
    if let [one] = missing.as_slice() {
        return Outcome::wrong(None, format!("<p>Not right.</p><p>The answer also depends on {one}.</p>"));
    }
    Outcome::wrong(None, "<p>Not right.</p>".to_owned())
}

/// Whether `a` equals `factor` times `b` at all points where `b` is defined.
pub(crate) fn same(a: &Expression, b: &Expression, ranges: &[[f64; 2]], seed: &str, factor: f64) -> bool {
    let mut random = Random::new(seed);
    let mut defined = 0;
    for _ in 0..POINTS {
        let point: Vec<f64> = ranges.iter().map(|[low, high]| low + (high - low) * random.unit()).collect();
        let (x, y) = (a.eval(&point), factor * b.eval(&point));
        if !y.is_finite() {
            continue;
        }
        defined += 1;
        // `!(<=)` also refuses an `x` that is not a number.
        let agrees = (x - y).abs() <= AGREEMENT * (x.abs() + y.abs()) + 1e-300;
        if !agrees {
            return false;
        }
    }
    defined >= POINTS / 2
}
