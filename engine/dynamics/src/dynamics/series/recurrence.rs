//! Arithmetic on power series, coefficient by coefficient — eq. (11.4).

use super::lanes::{plus_whole, sum_whole};
use nalgebra::Vector3;
use pulp::Simd;
use triad_linalg::fma;

/// Does something with each pair of one list, from its end, and another that is as long, from its beginning: two pairs at a time, as
/// moving along both lists takes as long as many a pair. The pair that the order before has just found is the last, so that the others
/// need not wait for it. No closure: those would not be compiled for the vectors in use.
macro_rules! for_folded {
    ($heads:expr, $tails:expr, $a:pat, $b:pat => $does:block) => {
        let ((heads, last), (first, tails)) = ($heads.as_chunks::<2>(), $tails.as_rchunks::<2>());
        if let ([$a], [$b]) = (last, first) {
            $does
        }
        for ([a, next], [before, b]) in heads.iter().rev().zip(tails) {
            let ($a, $b) = (next, before);
            $does
            let ($a, $b) = (a, b);
            $does
        }
    };
}

pub(super) use for_folded;

/// An order as a number: of fewer than 2³² one instruction makes it.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "orders are small")]
pub fn real(order: usize) -> f64 {
    f64::from(order as u32)
}

/// κ = (n + 1) (n + 2), by which coefficient n of a second derivative is that of order n + 2.
#[inline(always)]
pub fn acceleration_factor(n: usize) -> f64 {
    real((n + 1) * (n + 2))
}

/// Coefficients of a vector.
pub type Vectors = Vec<Vector3<f64>>;

/// Coefficients of four numbers, or of a vector and nothing.
pub type Quads = Vec<[f64; 4]>;

/// A vector as four numbers.
#[inline(always)]
pub fn quad([x, y, z]: [f64; 3]) -> [f64; 4] {
    [x, y, z, 0.0]
}

/// The sum of products of the vectors of one list, from its beginning, with those of another, from its end: every second pair on its
/// own, so that no sum waits for another.
#[inline(always)]
pub fn folded_vectors<S: Simd>(simd: S, a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    let (mut sums, mut others) = ([0.0; 4], [0.0; 4]);
    let ((heads, last), (first, tails)) = (a.as_chunks::<2>(), b.as_rchunks::<2>());
    for ([a, next], [before, b]) in heads.iter().zip(tails.iter().rev()) {
        sums = plus_whole(simd, a, b, &sums);
        others = plus_whole(simd, next, before, &others);
    }
    for (a, b) in last.iter().zip(first) {
        sums = plus_whole(simd, a, b, &sums);
    }
    let [x, y, z, _] = sum_whole(simd, &sums, &others);
    x + y + z
}

/// Coefficient n of a v, a scalar times a vector.
#[inline(always)]
pub fn scaled_quads<S: Simd>(simd: S, a: &[f64], v: &[[f64; 4]], n: usize) -> Vector3<f64> {
    let (mut sums, mut others) = ([0.0; 4], [0.0; 4]);
    let ((heads, last), (first, tails)) = (a[..=n].as_chunks::<2>(), v[..=n].as_rchunks::<2>());
    for ([a, next], [before, v]) in heads.iter().zip(tails.iter().rev()) {
        sums = plus_whole(simd, &[*a; 4], v, &sums);
        others = plus_whole(simd, &[*next; 4], before, &others);
    }
    for (a, v) in last.iter().zip(first) {
        sums = plus_whole(simd, &[*a; 4], v, &sums);
    }
    let [x, y, z, _] = sum_whole(simd, &sums, &others);
    Vector3::new(x, y, z)
}

/// The sum of products of the numbers of one list, from its beginning, with those of another, from its end: four sums beside each
/// other, so that none waits for another.
#[inline(always)]
pub fn folded(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let ((heads, last), (first, tails)) = (a.as_chunks::<4>(), b.as_rchunks::<4>());
    for (a, b) in heads.iter().zip(tails.iter().rev()) {
        for c in 0..4 {
            sums[c] = fma(a[c], b[3 - c], sums[c]);
        }
    }
    let mut rest = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (a, b) in last.iter().zip(first.iter().rev()) {
        rest = fma(*a, *b, rest);
    }
    rest
}

/// The same for vectors.
#[inline(always)]
fn folded_dot(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    let mut sums = [0.0; 3];
    for (a, b) in a.iter().zip(b.iter().rev()) {
        for c in 0..3 {
            sums[c] = fma(a[c], b[c], sums[c]);
        }
    }
    sums[0] + sums[1] + sums[2]
}

/// Coefficient n of a b.
#[inline(always)]
pub fn product(a: &[f64], b: &[f64], n: usize) -> f64 {
    folded(&a[..=n], &b[..=n])
}

/// Coefficient n of a².
#[inline(always)]
pub fn square(a: &[f64], n: usize) -> f64 {
    let half = n.div_ceil(2);
    let twice = 2.0 * folded(&a[..half], &a[n + 1 - half..=n]);
    if n.is_multiple_of(2) { fma(a[half], a[half], twice) } else { twice }
}

/// Coefficient n of a · b.
#[inline(always)]
pub fn dot(a: &[Vector3<f64>], b: &[Vector3<f64>], n: usize) -> f64 {
    folded_dot(&a[..=n], &b[..=n])
}

/// Coefficient n of a · b without the terms of a_n and b_n.
#[inline(always)]
pub fn inner_dot(a: &[Vector3<f64>], b: &[Vector3<f64>], n: usize) -> f64 {
    folded_dot(&a[1..n], &b[1..n])
}

/// Coefficient n of a v, a scalar times a vector.
#[inline(always)]
pub fn scaled(a: &[f64], v: &[Vector3<f64>], n: usize) -> Vector3<f64> {
    let mut sums = [0.0; 3];
    for (a, v) in a[..=n].iter().zip(v[..=n].iter().rev()) {
        for c in 0..3 {
            sums[c] = fma(*a, v[c], sums[c]);
        }
    }
    sums.into()
}

/// Coefficient n of a / b, from those of the quotient before it.
#[inline(always)]
pub fn quotient(a_n: f64, b: &[f64], before: &[f64], n: usize) -> f64 {
    (a_n - folded(&b[1..=n], &before[..n])) / b[0]
}

/// Coefficient n of √a, from those of the root before it.
#[inline(always)]
pub fn root(a_n: f64, before: &[f64], n: usize) -> f64 {
    if n == 0 {
        return a_n.sqrt();
    }
    0.5 * (a_n - folded(&before[1..n], &before[1..n])) / before[0]
}

/// Coefficient n of the rate of a series.
#[inline(always)]
pub fn rate(a: &[f64], n: usize) -> f64 {
    (n + 1) as f64 * a[n + 1]
}

/// Coefficient n of a product of a with the rate of b.
#[inline(always)]
pub fn product_with_rate(a: &[f64], b: &[f64], n: usize) -> f64 {
    (0..=n).map(|i| a[i] * rate(b, n - i)).sum()
}

/// The value at τ of a series.
#[inline(always)]
pub fn value(series: &[f64], tau: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * tau + c)
}

/// The sums of the sizes of the terms of a series at τ, its first left out: of those up to `order`, and of the others.
pub fn kept_and_left(sizes: impl Iterator<Item = f64>, order: usize, tau: f64) -> [f64; 2] {
    let (mut sums, mut power) = ([0.0; 2], 1.0);
    for (k, size) in sizes.enumerate().skip(1) {
        power *= tau;
        // Of a step without end a term is none if its coefficient is.
        if size > 0.0 {
            sums[usize::from(k > order)] += size * power;
        }
    }
    sums
}

/// The value at τ of a series of vectors.
#[inline(always)]
pub fn vector_value(series: &[Vector3<f64>], tau: f64) -> Vector3<f64> {
    series.iter().rev().fold(Vector3::zeros(), |sum, c| sum * tau + c)
}
