//! The usual mistake behind a wrong number, vector or matrix.

use super::fit::Fit;
use super::mutation::{KINDS, miscounted, part_results};
use super::values;
use crate::answers::tolerance::norm;
use crate::exercise::QuantityQuestion;
use crate::exercise::derivation::Derivation;
use crate::mistakes::{self, Mistake};
use triad_engine::scene::expression::Node;

/// What was recognised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Recognised {
    pub mistake: &'static Mistake,
    /// Its sign is the opposite one besides.
    pub and_sign: bool,
}

impl Recognised {
    fn plainly(mistake: &'static Mistake) -> Self {
        Self { mistake, and_sign: false }
    }
}

/// The place of the author's misconception that leads to a number together with one more slip: another g, a factor of 2,
/// a square or a root.
pub(crate) fn with_one_more_slip(
    question: &QuantityQuestion,
    typed: &[f64],
    rounding: &[f64],
) -> Option<usize> {
    let fit = Fit::new(typed, rounding, &question.reference, question.tolerance);
    if question.tolerance.is_exact() || fit.is_near() {
        return None;
    }
    let more = [mistakes::OTHER_GRAVITY, mistakes::POWER];
    let Derivation { wrong, symbols, given, .. } = &question.derivation;
    let leads = |node: &Node| {
        let value = node.eval(symbols);
        let kinds = KINDS.iter().filter(|kind| more.contains(&kind.mistake));
        let mut slips = kinds.flat_map(|kind| kind.values(node, symbols, given));
        slips.any(|x| fit.is(&[x])) || [2.0, 0.5].iter().any(|k| fit.is(&[k * value]))
    };
    wrong.iter().find(|(_, node)| leads(node)).map(|(at, _)| *at)
}

/// The usual mistake that leads to these values, if there is one. `rounding` is what the digits may have changed.
pub(crate) fn recognise(question: &QuantityQuestion, typed: &[f64], rounding: &[f64]) -> Option<Recognised> {
    let fit = Fit::new(typed, rounding, &question.reference, question.tolerance);
    if let Some(mistake) = values::certain(&fit, question.shape, question.size[1]) {
        return Some(Recognised::plainly(mistake));
    }
    if question.tolerance.is_exact() && typed.iter().any(|x| x.fract() != 0.0) && whole(&question.reference) {
        return Some(Recognised::plainly(mistakes::NO_WHOLE_NUMBER));
    }
    let shown = question.derivation.worlds.answers().iter();
    let in_unit = |values: &[f64]| values.iter().map(|x| x / question.unit.factor).collect::<Vec<_>>();
    let mut worlds = shown.filter(|(_, values)| norm(values) > 0.0);
    if let Some((mistake, _)) = worlds.find(|(_, values)| fit.is(&in_unit(values))) {
        return Some(Recognised::plainly(mistake));
    }
    if let Some(mistake) = one_slip(question, &fit).or_else(|| values::factor(&fit, question.shape)) {
        return Some(Recognised::plainly(mistake));
    }
    if let Some(mistake) = given(question, &fit).or_else(|| miscount(question, typed)) {
        return Some(Recognised::plainly(mistake));
    }
    let opposite: Vec<f64> = typed.iter().map(|x| -x).collect();
    if let Some(mistake) = one_slip(question, &fit.with(&opposite)) {
        return Some(Recognised { mistake, and_sign: true });
    }
    values::vague(&fit, question.shape).map(Recognised::plainly)
}

fn whole(values: &[f64]) -> bool {
    values.iter().all(|x| x.fract() == 0.0)
}

/// One mistake in the reference's expressions: of one kind in all components that are wrong.
fn one_slip(question: &QuantityQuestion, fit: &Fit) -> Option<&'static Mistake> {
    let (entries, symbols) = (&question.derivation.entries, &question.derivation.symbols);
    if entries.len() != fit.values.len() {
        return None;
    }
    let wrong: Vec<usize> = (0..fit.values.len()).filter(|k| !fit.component_right(*k)).collect();
    let found = KINDS.iter().find(|kind| {
        // An answer that is nearly right has lost digits rather than a term.
        (kind.mistake == mistakes::OTHER_GRAVITY || !fit.is_near())
            && wrong.iter().all(|k| {
                let tried = kind.values(&entries[*k], symbols, &question.derivation.given);
                tried.into_iter().any(|value| fit.component_is(*k, value))
            })
    });
    found.filter(|_| !wrong.is_empty()).map(|kind| kind.mistake)
}

/// A number of the question as it stands, a step on the way, or one of its numbers as a factor too many.
fn given(question: &QuantityQuestion, fit: &Fit) -> Option<&'static Mistake> {
    let (derivation, [right]) = (&question.derivation, question.reference.as_slice()) else { return None };
    if question.tolerance.is_exact() || fit.is_near() {
        return None;
    }
    let either = |x: f64| fit.is(&[x]) || fit.is(&[-x]);
    if derivation.given.iter().any(|x| either(*x)) {
        return Some(mistakes::GIVEN_NUMBER);
    }
    let steps = derivation.entries.iter().flat_map(|node| part_results(node, &derivation.symbols));
    if steps.into_iter().any(|x| fit.is(&[x])) {
        return Some(mistakes::PART_RESULT);
    }
    let factor = |x: &f64| either(right * x) || either(right / x);
    derivation.given.iter().any(factor).then_some(mistakes::GIVEN_FACTOR)
}

/// One too many or too few, or two slips of a count.
fn miscount(question: &QuantityQuestion, typed: &[f64]) -> Option<&'static Mistake> {
    let (true, [x], [right]) = (question.tolerance.is_exact(), typed, question.reference.as_slice()) else {
        return None;
    };
    if (x - right).abs() == 1.0 {
        return Some(mistakes::OFF_BY_ONE);
    }
    let derivation = &question.derivation;
    let tried = derivation.entries.iter().flat_map(|node| miscounted(node, &derivation.symbols));
    let of_given = derivation.given.iter().flat_map(|a| [*a, right - a, right + a]);
    let sum = derivation.entries.iter().any(|node| matches!(node, Node::Binary('+' | '-', ..)));
    (sum || tried.chain(of_given).any(|value| value == *x)).then_some(mistakes::COUNT)
}
