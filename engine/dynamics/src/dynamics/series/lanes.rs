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

/// The numbers in one register of the processor, where one has L of them.
#[inline(always)]
fn register<S: Simd, const L: usize>(x: &Lane<L>) -> Option<S::f64s> {
    if L > 1 && S::F64_LANES == L { S::as_simd_f64s(x).0.first().copied() } else { None }
}

#[inline(always)]
fn lane<S: Simd, const L: usize>(x: S::f64s) -> Lane<L> {
    let mut out = [0.0; L];
    if let Some(out) = S::as_mut_simd_f64s(&mut out).0.first_mut() {
        *out = x;
    }
    out
}

/// [`times`], [`plus`] and [`less`] for numbers that are turned over into rows, or come from there: the compiler would take plain
/// loops apart into the numbers of each row.
#[inline(always)]
pub fn times_whole<S: Simd, const L: usize>(simd: S, a: &Lane<L>, b: &Lane<L>) -> Lane<L> {
    match (register::<S, L>(a), register::<S, L>(b)) {
        (Some(a), Some(b)) => lane::<S, L>(simd.mul_f64s(a, b)),
        _ => times(a, b),
    }
}

/// a + b, likewise.
#[inline(always)]
pub fn sum_whole<S: Simd, const L: usize>(simd: S, a: &Lane<L>, b: &Lane<L>) -> Lane<L> {
    match (register::<S, L>(a), register::<S, L>(b)) {
        (Some(a), Some(b)) => lane::<S, L>(simd.add_f64s(a, b)),
        _ => sum(a, b),
    }
}

/// a − b, likewise.
#[inline(always)]
pub fn difference_whole<S: Simd, const L: usize>(simd: S, a: &Lane<L>, b: &Lane<L>) -> Lane<L> {
    match (register::<S, L>(a), register::<S, L>(b)) {
        (Some(a), Some(b)) => lane::<S, L>(simd.sub_f64s(a, b)),
        _ => sum(a, &negative(b)),
    }
}

/// a b + c.
#[inline(always)]
pub fn plus_whole<S: Simd, const L: usize>(simd: S, a: &Lane<L>, b: &Lane<L>, c: &Lane<L>) -> Lane<L> {
    match (register::<S, L>(a), register::<S, L>(b), register::<S, L>(c)) {
        (Some(a), Some(b), Some(c)) => lane::<S, L>(simd.mul_add_f64s(a, b, c)),
        _ => plus(a, b, c),
    }
}

/// c − a b.
#[inline(always)]
pub fn less_whole<S: Simd, const L: usize>(simd: S, a: &Lane<L>, b: &Lane<L>, c: &Lane<L>) -> Lane<L> {
    match (register::<S, L>(a), register::<S, L>(b), register::<S, L>(c)) {
        (Some(a), Some(b), Some(c)) => lane::<S, L>(simd.mul_add_f64s(simd.neg_f64s(a), b, c)),
        _ => less(a, b, c),
    }
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

/// The same numbers the other way: four of each lane, side by side.
#[inline(always)]
pub fn lanes_of_rows<S: Simd, const L: usize>(simd: S, rows: &[[f64; 4]; L]) -> [Lane<L>; 4] {
    let mut lanes = [[0.0; L]; 4];
    if S::F64_LANES == 4
        && let (Some(rows), Some(out)) =
            (rows.first_chunk::<4>(), lanes.as_flattened_mut().as_chunks_mut().0.first_chunk_mut::<4>())
    {
        *out = simd.deinterleave_shfl_f64s::<[[f64; 4]; 4]>(*rows);
        return lanes;
    }
    for (l, row) in rows.iter().enumerate() {
        for (lane, x) in lanes.iter_mut().zip(row) {
            lane[l] = *x;
        }
    }
    lanes
}

/// Raises each of four numbers to the size of the one beside it, where that is larger; those that are none raise nothing.
#[inline(always)]
pub fn raise_whole<S: Simd>(simd: S, largest: &mut Lane<4>, x: &Lane<4>) {
    match (register::<S, 4>(largest), register::<S, 4>(x)) {
        (Some(most), Some(x)) => *largest = lane::<S, 4>(simd.max_f64s(simd.abs_f64s(x), most)),
        _ => raise(largest, x),
    }
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
