//! Arithmetic on vectors of L bodies at once: component by component, one lane for each body.
//!
//! Plain loops of constant length, which the compiler turns into vector instructions. Products are added by
//! [`fma`], so that every processor gives the same bits.

use pulp::Simd;
use triad_linalg::{fma, larger, raise};

/// One number for each lane.
pub type Lane<const L: usize> = [f64; L];
/// A vector of three components for each lane.
pub type LaneVector<const L: usize> = [Lane<L>; 3];
/// Natural coordinates (r, u, v, w), or anything that lives on them.
pub type Natural<const L: usize> = [LaneVector<L>; 4];

/// The zero vector of natural coordinates.
pub const fn zero<const L: usize>() -> Natural<L> {
    [[[0.0; L]; 3]; 4]
}

/// a b.
#[inline(always)]
pub fn times<const L: usize>(a: &Lane<L>, b: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = a[l] * b[l];
    }
    out
}

/// a + b.
#[inline(always)]
pub fn sum<const L: usize>(a: &Lane<L>, b: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = a[l] + b[l];
    }
    out
}

/// a b + c.
#[inline(always)]
pub fn plus<const L: usize>(a: &Lane<L>, b: &Lane<L>, c: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = fma(a[l], b[l], c[l]);
    }
    out
}

/// c − a b.
#[inline(always)]
pub fn less<const L: usize>(a: &Lane<L>, b: &Lane<L>, c: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = fma(-a[l], b[l], c[l]);
    }
    out
}

/// a b − c d.
#[inline(always)]
pub fn minor<const L: usize>(a: &Lane<L>, b: &Lane<L>, c: &Lane<L>, d: &Lane<L>) -> Lane<L> {
    less(c, d, &times(a, b))
}

/// −a.
#[inline(always)]
pub fn negative<const L: usize>(a: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = -a[l];
    }
    out
}

/// 1 / √a.
#[inline(always)]
pub fn inverse_root<const L: usize>(a: &Lane<L>) -> Lane<L> {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = 1.0 / a[l].sqrt();
    }
    out
}

/// sum += a · b.
#[inline(always)]
pub fn add_dot<const L: usize>(sum: &mut Lane<L>, a: &LaneVector<L>, b: &LaneVector<L>) {
    for c in 0..3 {
        for l in 0..L {
            sum[l] = fma(a[c][l], b[c][l], sum[l]);
        }
    }
}

/// a · b.
#[inline(always)]
pub fn dot<const L: usize>(a: &LaneVector<L>, b: &LaneVector<L>) -> Lane<L> {
    let mut sum = [0.0; L];
    add_dot(&mut sum, a, b);
    sum
}

/// sum += a × b.
#[inline(always)]
pub fn add_cross<const L: usize>(sum: &mut LaneVector<L>, a: &LaneVector<L>, b: &LaneVector<L>) {
    for (c, (i, j)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
        for l in 0..L {
            sum[c][l] = fma(a[i][l], b[j][l], fma(-a[j][l], b[i][l], sum[c][l]));
        }
    }
}

/// a × b.
#[inline(always)]
pub fn cross<const L: usize>(a: &LaneVector<L>, b: &LaneVector<L>) -> LaneVector<L> {
    let mut sum = [[0.0; L]; 3];
    add_cross(&mut sum, a, b);
    sum
}

/// sum += factor · a, lane by lane.
#[inline(always)]
pub fn add_scaled<const L: usize>(sum: &mut LaneVector<L>, factor: &Lane<L>, a: &LaneVector<L>) {
    for c in 0..3 {
        for l in 0..L {
            sum[c][l] = fma(factor[l], a[c][l], sum[c][l]);
        }
    }
}

/// factor · a, lane by lane.
#[inline(always)]
pub fn scaled<const L: usize>(factor: &Lane<L>, a: &LaneVector<L>) -> LaneVector<L> {
    let mut product = [[0.0; L]; 3];
    add_scaled(&mut product, factor, a);
    product
}

/// M a for a matrix given by its rows.
#[inline(always)]
pub fn multiply<const L: usize>(rows: &[LaneVector<L>; 3], a: &LaneVector<L>) -> LaneVector<L> {
    [dot(&rows[0], a), dot(&rows[1], a), dot(&rows[2], a)]
}

/// Four numbers of each lane, lane by lane.
#[inline(always)]
pub fn rows_of_lanes<S: Simd, const L: usize>(simd: S, lanes: [Lane<L>; 4]) -> [[f64; 4]; L] {
    let mut rows = [[0.0; 4]; L];
    if S::F64_LANES == 4
        && let (Some(lanes), Some(out)) =
            (lanes.as_flattened().as_chunks().0.first_chunk::<4>(), rows.first_chunk_mut::<4>())
    {
        // In registers: numbers stored one by one are slow to read back in one piece.
        *out = simd.deinterleave_shfl_f64s::<[[f64; 4]; 4]>(*lanes);
        return rows;
    }
    for (l, row) in rows.iter_mut().enumerate() {
        *row = lanes.map(|lane| lane[l]);
    }
    rows
}

/// Largest |x| over all components of the first `lanes` lanes.
#[inline(always)]
pub fn largest<const L: usize>(x: &[Lane<L>]) -> f64 {
    let mut largest = [0.0f64; L];
    for component in x {
        raise(&mut largest, component);
    }
    largest.into_iter().fold(0.0, larger)
}
