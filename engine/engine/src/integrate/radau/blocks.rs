//! The blocks into which A⁻¹ falls, side by side in lanes: the real eigenvalue and one of each pair of complex ones. A number of all stages is a
//! row of [`Pair`]s there, each with the parts of four blocks.

use super::coefficients::{Method, RadauTables};
use crate::integrate::wide::{MOST_LANES, Stored};
use triad_linalg::fma;

/// Real and imaginary parts of some blocks.
pub type Pair = [Stored; 2];

/// No part.
pub const NONE: Pair = [[0.0; MOST_LANES]; 2];

/// sum + a b, lane by lane: numbers go in and out whole, so that the compiler keeps them in registers.
#[inline(always)]
#[must_use]
pub fn plus(sum: Stored, a: Stored, b: Stored) -> Stored {
    let mut out = [0.0; MOST_LANES];
    for l in 0..MOST_LANES {
        out[l] = fma(a[l], b[l], sum[l]);
    }
    out
}

/// sum − a b.
#[inline(always)]
#[must_use]
pub fn less(sum: Stored, a: Stored, b: Stored) -> Stored {
    let mut out = [0.0; MOST_LANES];
    for l in 0..MOST_LANES {
        out[l] = fma(-a[l], b[l], sum[l]);
    }
    out
}

/// sum + a times a number.
#[inline(always)]
#[must_use]
pub fn plus_scaled([re, im]: Pair, a: &Pair, by: f64) -> Pair {
    let by = [by; MOST_LANES];
    [plus(re, a[0], by), plus(im, a[1], by)]
}

/// sum + a b of complex numbers.
#[inline(always)]
#[must_use]
pub fn plus_product([re, im]: Pair, a: &Pair, b: &Pair) -> Pair {
    [less(plus(re, a[0], b[0]), a[1], b[1]), plus(plus(im, a[0], b[1]), a[1], b[0])]
}

/// sum − a b.
#[inline(always)]
#[must_use]
pub fn less_product([re, im]: Pair, a: &Pair, b: &Pair) -> Pair {
    [plus(less(re, a[0], b[0]), a[1], b[1]), less(less(im, a[0], b[1]), a[1], b[0])]
}

/// How stages turn into blocks and back.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Pairs of a row.
    pub groups: usize,
    /// Stages, and where each part of the blocks stands in a row.
    pub places: Vec<usize>,
    /// T⁻¹: for each stage what it adds to a row.
    turns: Vec<Pair>,
    /// T: for each part what it adds to the stages.
    turns_back: Vec<Stored>,
    /// T⁻¹ diag(c) T: for each part what it adds to a row.
    along: Vec<Pair>,
    /// The eigenvalues; idle lanes repeat the real one.
    eigenvalues: Vec<Pair>,
}

impl Blocks {
    /// Those of a method.
    pub fn new(method: &Method) -> Self {
        let RadauTables { nodes, real, pairs } = method.tables;
        let (s, groups) = (nodes.len(), (pairs.len() + 1).div_ceil(MOST_LANES));
        let place =
            |block: usize, part: usize| (block / MOST_LANES * 2 + part) * MOST_LANES + block % MOST_LANES;
        let places: Vec<usize> =
            [place(0, 0)].into_iter().chain((0..s - 1).map(|k| place(1 + k / 2, k % 2))).collect();
        let mut turns = vec![NONE; s * groups];
        let mut along = vec![NONE; s * groups];
        let mut turns_back = vec![[0.0; MOST_LANES]; s * s.div_ceil(MOST_LANES)];
        let row = |pairs: &mut [Pair], of: usize, at: usize, value: f64| {
            pairs[of * groups..].as_flattened_mut().as_flattened_mut()[at] = value;
        };
        for stage in 0..s {
            for (k, &place) in places.iter().enumerate() {
                row(&mut turns, stage, place, method.t_inverse[(stage, k)]);
                turns_back[k * s.div_ceil(MOST_LANES)..].as_flattened_mut()[stage] = method.t[(k, stage)];
            }
        }
        for from in 0..s {
            for (to, &place) in places.iter().enumerate() {
                let terms = (0..s).map(|j| method.t_inverse[(j, to)] * nodes[j].0 * method.t[(from, j)]);
                row(&mut along, from, place, terms.sum());
            }
        }
        let mut eigenvalues = vec![[[*real; MOST_LANES], [0.0; MOST_LANES]]; groups];
        for (block, pair) in pairs.iter().enumerate().map(|(place, pair)| (place + 1, pair)) {
            let [re, im] = &mut eigenvalues[block / MOST_LANES];
            (re[block % MOST_LANES], im[block % MOST_LANES]) = (pair.re, pair.im);
        }
        Self { groups, places, turns, turns_back, along, eigenvalues }
    }

    /// The eigenvalues over a step.
    pub fn over(&self, h: f64) -> impl Iterator<Item = Pair> {
        self.eigenvalues.iter().map(move |pair| pair.map(|lanes| lanes.map(|x| x / h)))
    }

    /// The row of a number of all stages.
    #[inline(always)]
    pub fn turn(&self, stages: &[Vec<f64>], number: usize, row: &mut [Pair]) {
        for (group, row) in row.iter_mut().enumerate() {
            let mut sum = NONE;
            for (stage, columns) in stages.iter().zip(self.turns.chunks_exact(self.groups)) {
                sum = plus_scaled(sum, &columns[group], stage[number]);
            }
            *row = sum;
        }
    }

    /// The same number of all stages out of its row.
    #[inline(always)]
    pub fn turn_back(&self, row: &[Pair], number: usize, stages: &mut [Vec<f64>]) {
        let row = row.as_flattened().as_flattened();
        let length = stages.len().div_ceil(MOST_LANES);
        for (some, stages) in stages.chunks_mut(MOST_LANES).enumerate() {
            let mut sum = [0.0; MOST_LANES];
            for (columns, place) in self.turns_back.chunks_exact(length).zip(&self.places) {
                sum = plus(sum, columns[some], [row[*place]; MOST_LANES]);
            }
            for (stage, x) in stages.iter_mut().zip(sum) {
                stage[number] = x;
            }
        }
    }

    /// Adds to a row what a change along the step makes of another: (from + h c) at each stage.
    #[inline(always)]
    pub fn add_along(&self, [from, h]: [f64; 2], row: &[Pair], out: &mut [Pair]) {
        let numbers = row.as_flattened().as_flattened();
        for (group, (out, own)) in out.iter_mut().zip(row).enumerate() {
            let mut sum = plus_scaled(*out, own, from);
            for (columns, place) in self.along.chunks_exact(self.groups).zip(&self.places) {
                sum = plus_scaled(sum, &columns[group], h * numbers[*place]);
            }
            *out = sum;
        }
    }
}

/// Adds a real matrix of n rows, by columns, times a group of rows.
#[inline(always)]
pub fn add_product(
    (matrix, n): (&[f64], usize),
    rows: &[Pair],
    (group, groups): (usize, usize),
    out: &mut [Pair],
) {
    for (i, out) in out[group..].iter_mut().step_by(groups).enumerate() {
        let mut sum = *out;
        for (a, x) in matrix[i..].iter().step_by(n).zip(rows[group..].iter().step_by(groups)) {
            sum = plus_scaled(sum, x, *a);
        }
        *out = sum;
    }
}
