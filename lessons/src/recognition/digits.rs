//! Whether the digits of a wrong number are enough to tell by which mistake it came about.

use super::fit::EXACT;
use super::quantity::{Recognised, recognise, recognise_exactly, with_one_more_slip};
use crate::answers::tolerance::{distance, norm};
use crate::exercise::QuantityQuestion;

/// Part of its distance from the right answer that the rounding of a number may have if a mistake is read off it.
const NARROW: f64 = 0.1;
/// Relative distance of the numbers that are looked at within the rounding: not more than twice what a mistake is met by.
const STEP: f64 = 1.5e-3;

/// Rounding, as a part of the number, from which nobody can say what was rounded.
const BROAD: f64 = 0.06;

/// Whether the digits of a number tell a mistake apart: their rounding is narrow beside the distance from the right answer, and all
/// that may have been rounded to it comes from one mistake at most. Components of vectors are looked at together.
pub(crate) fn tell_apart(question: &QuantityQuestion, typed: &[f64], rounding: &[f64]) -> bool {
    let ([one], [width]) = (typed, rounding) else { return true };
    is_narrow(question, typed, rounding) && of_one_mistake(question, *one, *width)
}

/// What a number tells to the last digit, however few it has: that it is one of the author's misconceptions.
pub(crate) fn is_misconception(question: &QuantityQuestion, typed: &[f64]) -> bool {
    question.misconceptions.iter().any(|m| distance(typed, &m.value) <= EXACT * norm(typed))
}

/// The same of a usual mistake: that it is a number of the question as it stands, say, and no rounded one that is nearly right.
pub(crate) fn usual(question: &QuantityQuestion, typed: &[f64], rounding: &[f64]) -> Option<Recognised> {
    recognise_exactly(question, typed).filter(|_| is_narrow(question, typed, rounding))
}

fn is_narrow(question: &QuantityQuestion, typed: &[f64], rounding: &[f64]) -> bool {
    norm(rounding) <= NARROW * distance(typed, &question.reference)
}

fn of_one_mistake(question: &QuantityQuestion, typed: f64, rounding: f64) -> bool {
    // False for NaN as well.
    let told = rounding <= BROAD * typed.abs();
    if !told {
        return false;
    }
    let count = (rounding / (STEP * typed.abs())).ceil().max(1.0);
    let mut known: Option<&str> = None;
    let mut k = -count;
    while k <= count {
        let found = mistake(question, typed + rounding * k / count);
        if known.is_some() && found.is_some() && known != found {
            return false;
        }
        known = known.or(found);
        k += 1.0;
    }
    true
}

/// The mistake that leads to just this number.
fn mistake(question: &QuantityQuestion, x: f64) -> Option<&str> {
    let is = |wanted: &[f64]| {
        question.tolerance.accepts(&[x], wanted) || question.tolerance.accepts(&[-x], wanted)
    };
    let own = question.misconceptions.iter().position(|m| is(&m.value));
    let usual = || recognise(question, &[x], &[0.0]).map(|usual| usual.mistake.code);
    let more =
        || with_one_more_slip(question, &[x], &[0.0]).map(|at| question.misconceptions[at].id.as_str());
    own.map(|at| question.misconceptions[at].id.as_str()).or_else(usual).or_else(more)
}
