//! The usual mistake behind a wrong formula.

use super::mutation::KINDS;
use super::quantity::Recognised;
use crate::exercise::Formula;
use crate::mistakes::{self, Mistake};
use crate::random::SeededRandom;
use triad_engine::scene::expression::{Expression, Node};

/// Points at which wrong formulas are compared.
const POINTS: usize = 6;
/// Relative difference below which two values agree; numbers that people type may be rounded.
const AGREEMENT: f64 = 1e-4;
/// Times that difference from which on a number counts as added.
const NOTICED: f64 = 10.0;
/// Powers that a symbol may have too many or too few.
const EXPONENTS: [f64; 8] = [1.0, -1.0, 2.0, -2.0, 0.5, -0.5, 4.0, -4.0];

/// Whether two values are the same, or neither is defined.
fn agree(a: f64, b: f64) -> bool {
    match (a.is_finite(), b.is_finite()) {
        (true, true) => (a - b).abs() <= AGREEMENT * a.abs().max(b.abs()),
        (one, other) => one == other,
    }
}

/// The usual mistake that leads to this formula, if there is one.
pub(crate) fn recognise(question: &Formula, formula: &Expression, seed: &str) -> Option<Recognised> {
    let mut random = SeededRandom::new(seed);
    let ranges = &question.ranges;
    let point = |random: &mut SeededRandom| -> Vec<f64> {
        ranges.iter().map(|[low, high]| low + (high - low) * random.unit()).collect()
    };
    let points: Vec<Vec<f64>> = (0..POINTS).map(|_| point(&mut random)).collect();
    let typed: Vec<f64> = points.iter().map(|p| formula.eval(p)).collect();
    let right: Vec<f64> = points.iter().map(|p| question.reference.eval(p)).collect();
    let plainly = |mistake| Some(Recognised { mistake, and_sign: false });
    if typed.iter().all(|x| *x == 0.0) {
        return plainly(mistakes::ZERO);
    }
    if [2.0, 0.5].iter().any(|k| typed.iter().zip(&right).all(|(x, r)| agree(*x, k * r))) {
        return plainly(mistakes::FACTOR_TWO);
    }
    let whole = |power: fn(f64) -> f64| typed.iter().zip(&right).all(|(x, r)| agree(*x, power(*r)));
    if whole(|r| r * r) || whole(f64::sqrt) {
        return plainly(mistakes::POWER);
    }
    // A formula that is hardly defined anywhere cannot be compared.
    if typed.iter().filter(|x| x.is_finite()).count() < 2 {
        return None;
    }
    let root = question.reference.clone().into_root();
    let used = (0..question.symbols.len()).filter(|k| question.reference.uses(*k));
    let missing = used.filter(|k| !formula.uses(*k)).count();
    if missing > 1 {
        return plainly(mistakes::SYMBOLS_MISSING);
    }
    if let Some(mistake) = one_slip(&root, &points, &typed) {
        return plainly(mistake);
    }
    if let Some(mistake) = ratio(&points, &typed, &right) {
        return plainly(mistake);
    }
    let opposite: Vec<f64> = typed.iter().map(|x| -x).collect();
    one_slip(&root, &points, &opposite).map(|mistake| Recognised { mistake, and_sign: true })
}

/// One mistake of a kind that gives the typed values at all points.
fn one_slip(root: &Node, points: &[Vec<f64>], typed: &[f64]) -> Option<&'static Mistake> {
    let found = KINDS.iter().find(|kind| {
        let tried: Vec<Vec<f64>> = points.iter().map(|p| kind.values(root, p, p)).collect();
        let n = tried.iter().map(Vec::len).min().unwrap_or(0);
        (0..n).any(|k| tried.iter().zip(typed).all(|(values, x)| agree(values[k], *x)))
    });
    found.map(|kind| kind.mistake)
}

/// Whether typed and right values differ by a number, or by a power of one symbol and a number.
fn ratio(points: &[Vec<f64>], typed: &[f64], right: &[f64]) -> Option<&'static Mistake> {
    let ratios: Vec<f64> = typed.iter().zip(right).map(|(x, r)| x / r).collect();
    let constant = |by: &dyn Fn(&[f64]) -> f64| {
        let first = ratios.first().zip(points.first()).map(|(ratio, p)| ratio * by(p));
        first.is_some_and(|first| {
            first.is_finite() && ratios.iter().zip(points).all(|(ratio, p)| agree(ratio * by(p), first))
        })
    };
    if constant(&|_| 1.0) {
        return Some(mistakes::CONSTANT_FACTOR);
    }
    let added: Vec<f64> = typed.iter().zip(right).map(|(x, r)| x - r).collect();
    let size = right.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    // What is nearly nothing is nearly the same everywhere, and is not added.
    if added.windows(2).all(|w| (w[0] - w[1]).abs() <= AGREEMENT * size)
        && added.iter().all(|x| x.is_finite() && x.abs() > NOTICED * AGREEMENT * size)
    {
        return Some(mistakes::CONSTANT_TERM);
    }
    let symbols = points.first().map_or(0, Vec::len);
    let powers = |k: usize, l: usize| {
        EXPONENTS.iter().any(|e| {
            let one = |p: &[f64], k: usize, e: f64| libm::pow(p[k], e);
            if k == l {
                return constant(&|p| one(p, k, *e));
            }
            EXPONENTS.iter().any(|f| constant(&|p| one(p, k, *e) * one(p, l, *f)))
        })
    };
    (0..symbols).any(|k| (0..=k).any(|l| powers(k, l))).then_some(mistakes::SYMBOL_POWER)
}
