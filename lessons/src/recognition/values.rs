//! Mistakes that are seen from the right answer alone.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

use super::fit::Fit;
use crate::answers::tolerance::{ValueShape, norm};
use crate::mistakes::{self, Mistake};

/// Standard gravity as courses state it, m/s².
const G: f64 = 9.81;

/// Cosine of the angle from which a vector points elsewhere, some 45°.
const ELSEWHERE: f64 = 0.7;
/// Largest error of the entries of a rotation that somebody typed.
const ROTATION: f64 = 1e-3;

/// Plain factors, the likelier first; each stands for its reciprocal too.
const FACTORS: [(f64, &Mistake); 20] = [
    (PI, mistakes::FACTOR_PI),
    (TAU, mistakes::FACTOR_PI),
    (FRAC_PI_2, mistakes::FACTOR_PI),
    (180.0 / PI, mistakes::ANGLE_UNIT),
    (360.0, mistakes::ANGLE_UNIT),
    (G, mistakes::MASS_AND_WEIGHT),
    (SQRT_2, mistakes::ROOT_TWO),
    (4.0, mistakes::SMALL_FACTOR),
    (3.0, mistakes::SMALL_FACTOR),
    (1.5, mistakes::SMALL_FACTOR),
    (6.0, mistakes::SMALL_FACTOR),
    (8.0, mistakes::SMALL_FACTOR),
    (12.0, mistakes::SMALL_FACTOR),
    (4.0 / 3.0, mistakes::SMALL_FACTOR),
    (60.0, mistakes::SMALL_FACTOR),
    (5.0, mistakes::SMALL_FACTOR),
    (5.0 / 3.0, mistakes::SMALL_FACTOR),
    (2.5, mistakes::SMALL_FACTOR),
    (1.25, mistakes::SMALL_FACTOR),
    (1.2, mistakes::SMALL_FACTOR),
];

/// What nobody can doubt.
pub(super) fn certain(fit: &Fit, shape: ValueShape, columns: usize) -> Option<&'static Mistake> {
    if norm(fit.reference) > 0.0 && fit.values.iter().all(|x| *x == 0.0) {
        return Some(mistakes::ZERO);
    }
    if [2.0, 0.5].iter().any(|k| fit.is(&scaled(fit.reference, *k))) {
        return Some(mistakes::FACTOR_TWO);
    }
    match shape {
        ValueShape::Number => None,
        ValueShape::Vector => vector(fit),
        ValueShape::Matrix => matrix(fit, columns),
    }
}

/// Plain factors, and the whole squared, rooted or upside down.
pub(super) fn factor(fit: &Fit, shape: ValueShape) -> Option<&'static Mistake> {
    let factor = FACTORS
        .iter()
        .find(|(k, _)| [*k, 1.0 / k, -*k, -1.0 / k].iter().any(|k| fit.is(&scaled(fit.reference, *k))));
    if let Some((_, mistake)) = factor {
        return Some(mistake);
    }
    let (ValueShape::Number, [x]) = (shape, fit.reference) else { return None };
    let whole = [
        (1.0 / x, mistakes::UPSIDE_DOWN),
        (TAU / x, mistakes::PERIOD),
        (1.0 / (TAU * x), mistakes::PERIOD),
        (x * x, mistakes::POWER),
        (x.abs().sqrt(), mistakes::POWER),
    ];
    whole.iter().find(|(value, _)| fit.is(&[*value]) || fit.is(&[-*value])).map(|(_, mistake)| *mistake)
}

/// What is true of many wrong answers, and therefore said last.
pub(super) fn vague(fit: &Fit, shape: ValueShape) -> Option<&'static Mistake> {
    if fit.is_near() {
        return Some(mistakes::NEARLY);
    }
    if shape != ValueShape::Vector {
        return None;
    }
    let (size, right) = (norm(fit.values), norm(fit.reference));
    if right > 0.0 {
        let cosine = fit.values.iter().zip(fit.reference).map(|(a, b)| a * b).sum::<f64>() / (size * right);
        if fit.is(&scaled(fit.reference, size / right)) && cosine > 0.0 {
            return Some(mistakes::LENGTH);
        }
        if fit.is(&scaled(fit.reference, -size / right)) {
            return Some(mistakes::LINE);
        }
        if cosine < ELSEWHERE {
            return Some(mistakes::OTHER_DIRECTION);
        }
    }
    let n = fit.values.len();
    let wrong = (0..n).filter(|k| !fit.component_right(*k)).count();
    let shown = (0..n).any(|k| fit.component_right(k) && fit.reference[k].abs() > 0.05 * right);
    (wrong == 1 && shown).then_some(mistakes::ONE_COMPONENT)
}

fn scaled(values: &[f64], k: f64) -> Vec<f64> {
    values.iter().map(|x| k * x).collect()
}

fn vector(fit: &Fit) -> Option<&'static Mistake> {
    let n = fit.values.len();
    let sign = |k: usize| fit.component_right(k) || fit.component_is(k, -fit.reference[k]);
    if (0..n).all(sign) {
        return Some(mistakes::COMPONENT_SIGN);
    }
    let kept = (0..n).any(|k| fit.values[k] != 0.0);
    if kept && (0..n).all(|k| fit.component_right(k) || fit.values[k] == 0.0) {
        return Some(mistakes::COMPONENT_MISSING);
    }
    permuted(fit, n).then_some(mistakes::COMPONENT_ORDER)
}

/// Whether the answer has the right components in other places, perhaps with other signs.
fn permuted(fit: &Fit, n: usize) -> bool {
    let mut left: Vec<f64> = fit.reference.to_vec();
    (0..n).all(|k| {
        let found = left.iter().position(|x| fit.component_is(k, *x) || fit.component_is(k, -*x));
        found.map(|at| left.swap_remove(at)).is_some()
    })
}

fn matrix(fit: &Fit, columns: usize) -> Option<&'static Mistake> {
    let n = fit.values.len();
    let rows = n / columns.max(1);
    let entry = |row: usize, column: usize| fit.reference[row * columns + column];
    if rows == columns {
        let transposed: Vec<f64> = (0..n).map(|k| entry(k % columns, k / columns)).collect();
        if fit.is(&transposed) {
            return Some(mistakes::TRANSPOSED);
        }
        let identity: Vec<f64> = (0..n).map(|k| if k / columns == k % columns { 1.0 } else { 0.0 }).collect();
        if fit.is(&identity) {
            return Some(mistakes::IDENTITY);
        }
    }
    if (0..n).all(|k| fit.component_right(k) || fit.component_is(k, -fit.reference[k])) {
        return Some(mistakes::ENTRY_SIGN);
    }
    if permuted(fit, n) {
        return Some(mistakes::ENTRY_ORDER);
    }
    let rotations =
        rows == columns && is_rotation(fit.reference, columns) && is_rotation(fit.values, columns);
    rotations.then_some(mistakes::OTHER_ROTATION)
}

/// Whether the rows have unit length and are perpendicular.
fn is_rotation(values: &[f64], columns: usize) -> bool {
    let rows: Vec<&[f64]> = values.chunks(columns.max(1)).collect();
    rows.iter().enumerate().all(|(i, a)| {
        rows.iter().enumerate().all(|(j, b)| {
            let product: f64 = a.iter().zip(*b).map(|(x, y)| x * y).sum();
            let wanted = if i == j { 1.0 } else { 0.0 };
            (product - wanted).abs() <= ROTATION
        })
    })
}
