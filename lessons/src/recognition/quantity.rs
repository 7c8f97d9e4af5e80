//! The usual mistake behind a wrong number, vector or matrix.

use super::fit::Fit;
use super::mutation::{KINDS, part_results};
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
    recognise_by(question, typed, &Fit::new(typed, rounding, &question.reference, question.tolerance))
}

/// The same for values that meet a wrong one to the last digit.
pub(super) fn recognise_exactly(question: &QuantityQuestion, typed: &[f64]) -> Option<Recognised> {
    recognise_by(question, typed, &Fit::exactly(typed, &question.reference, question.tolerance))
}

fn recognise_by(question: &QuantityQuestion, typed: &[f64], fit: &Fit) -> Option<Recognised> {
    if question.tolerance.is_exact() && typed.iter().any(|x| x.fract() != 0.0) && whole(&question.reference) {
        return Some(Recognised::plainly(mistakes::NO_WHOLE_NUMBER));
    }
    if is_count(question) {
        return Some(Recognised::plainly(miscount(question, fit)));
    }
    let certain = values::certain(fit, question.shape, question.size[1]);
    if let Some(mistake) = certain.or_else(|| wrong_model(question, fit)) {
        return Some(Recognised::plainly(mistake));
    }
    if let Some(mistake) = one_slip(question, fit, |_| true).or_else(|| values::factor(fit, question.shape)) {
        return Some(Recognised::plainly(mistake));
    }
    if let Some(mistake) = given(question, fit) {
        return Some(Recognised::plainly(mistake));
    }
    let opposite: Vec<f64> = typed.iter().map(|x| -x).collect();
    if let Some(mistake) = one_slip(question, &fit.with(&opposite), |_| true) {
        return Some(Recognised { mistake, and_sign: true });
    }
    values::vague(fit, question.shape).map(Recognised::plainly)
}

fn whole(values: &[f64]) -> bool {
    values.iter().all(|x| x.fract() == 0.0)
}

/// The wrong model whose run shows this.
fn wrong_model(question: &QuantityQuestion, fit: &Fit) -> Option<&'static Mistake> {
    let shown = question.derivation.worlds.answers().iter();
    let in_unit = |values: &[f64]| values.iter().map(|x| x / question.unit.factor).collect::<Vec<_>>();
    let mut worlds = shown.filter(|(_, values)| norm(values) > 0.0);
    worlds.find(|(_, values)| fit.is(&in_unit(values))).map(|(mistake, _)| *mistake)
}

/// One mistake in the reference's expressions: of one kind, among those that may be tried, in all components that are wrong.
fn one_slip(
    question: &QuantityQuestion,
    fit: &Fit,
    tried: impl Fn(&Mistake) -> bool,
) -> Option<&'static Mistake> {
    let (entries, symbols) = (&question.derivation.entries, &question.derivation.symbols);
    if entries.len() != fit.values.len() {
        return None;
    }
    let wrong: Vec<usize> = (0..fit.values.len()).filter(|k| !fit.component_right(*k)).collect();
    let found = KINDS.iter().filter(|kind| tried(kind.mistake)).find(|kind| {
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

/// Whether something is counted: one exact number, or exact ones to which only sums and products lead.
fn is_count(question: &QuantityQuestion) -> bool {
    question.tolerance.is_exact()
        && (question.size == [1, 1] || question.derivation.entries.iter().all(adds_up))
}

fn adds_up(node: &Node) -> bool {
    match node {
        Node::Number(_) | Node::Symbol(_) => true,
        Node::Negative(a) => adds_up(a),
        Node::Binary('+' | '-' | '*', a, b) => adds_up(a) && adds_up(b),
        Node::Binary(..) | Node::Call(..) => false,
    }
}

/// What went wrong with a count. Small whole numbers meet one another by chance: no factor, power or angle is looked for.
fn miscount(question: &QuantityQuestion, fit: &Fit) -> &'static Mistake {
    if fit.values.iter().all(|x| *x == 0.0) {
        return mistakes::ZERO;
    }
    let terms = [mistakes::TERM_MISSING, mistakes::TERM_SIGN];
    let known =
        wrong_model(question, fit).or_else(|| one_slip(question, fit, |mistake| terms.contains(&mistake)));
    let by_one = fit.values.iter().zip(fit.reference).all(|(x, right)| (x - right).abs() == 1.0);
    known.unwrap_or(if by_one { mistakes::OFF_BY_ONE } else { mistakes::COUNT })
}
