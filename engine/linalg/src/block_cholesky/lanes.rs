//! Pivots of L matrices of one pattern at once, one in each lane: how near each is to being singular. No factor is left with which
//! to solve.

use super::runs::{Alike, Run, by_kind, by_size};
use super::{BlockCholesky, Pivot, stride};
use crate::arithmetic::{fma, larger};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// L matrices side by side.
#[derive(Clone, Debug)]
pub struct PivotLanes<const L: usize> {
    /// Their entries, where a [`BlockCholesky`] of the pattern has them; an elimination uses them up.
    pub values: Vec<[f64; L]>,
    /// Their diagonals before the elimination, by scalar row.
    diagonal: Vec<[f64; L]>,
    /// Of each block, the least of the pivots of its rows relative to that diagonal.
    products: Vec<[f64; L]>,
}

impl<const L: usize> PivotLanes<L> {
    /// What [`BlockCholesky::pivot_products`] would be of each matrix, as the last elimination has found it.
    pub fn pivot_products(&self) -> &[[f64; L]] {
        &self.products
    }
}

struct Eliminate<'a, const L: usize> {
    pattern: &'a BlockCholesky,
    lanes: &'a mut PivotLanes<L>,
}

impl<const L: usize> WithSimd for Eliminate<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.pattern.eliminate_here(self.lanes);
    }
}

impl BlockCholesky {
    /// Room for L matrices of this pattern. `None` if rows are left out, which differ from one matrix to the next.
    pub fn pivot_lanes<const L: usize>(&self) -> Option<PivotLanes<L>> {
        let all = self.rows_left_out.is_empty() && self.pivots.iter().all(|pivot| pivot.left_out == 0);
        all.then(|| PivotLanes {
            values: vec![[0.0; L]; self.values.len()],
            diagonal: vec![[0.0; L]; self.diagonal.len()],
            products: vec![[1.0; L]; self.pivots.len()],
        })
    }

    /// Eliminates all rows of L matrices of this pattern, for their pivots.
    pub fn eliminate<const L: usize>(&self, lanes: &mut PivotLanes<L>) {
        Arch::new().dispatch(Eliminate { pattern: self, lanes });
    }

    #[inline(always)]
    fn eliminate_here<const L: usize>(&self, lanes: &mut PivotLanes<L>) {
        for (entry, &at) in lanes.diagonal.iter_mut().zip(&self.diagonal_at) {
            *entry = lanes.values[at];
        }
        for Run { pivots, alike } in &self.runs {
            by_kind!(
                alike,
                N, W, beside => self.eliminate_alike::<N, W, L>(pivots, beside, lanes),
                self.eliminate_mixed(pivots.start, lanes)
            );
        }
    }

    /// Eliminates a run of pivots that are alike.
    #[inline(always)]
    fn eliminate_alike<const N: usize, const W: usize, const L: usize>(
        &self,
        pivots: &Range<usize>,
        beside: usize,
        lanes: &mut PivotLanes<L>,
    ) {
        let numbers = (1 + beside) * N * W;
        for pivot in &self.pivots[pivots.clone()] {
            let end = pivot.diagonal + numbers;
            // Targets belong to later pivots than the blocks that they are made of.
            let (done, later) = lanes.values.split_at_mut(end);
            let own = done[pivot.diagonal..].as_chunks_mut::<W>().0.as_chunks_mut::<N>().0;
            let (Some((block, beside)), Some(reference)) =
                (own.split_first_mut(), lanes.diagonal[pivot.start..].first_chunk::<N>())
            else {
                return;
            };
            let Decomposed { lower, reciprocals, least } = decompose(block, reference);
            for block in &mut *beside {
                for i in 0..N {
                    for k in i + 1..N {
                        block[k] = less_row(&lower[k][i], &block[i], &block[k]);
                    }
                }
            }
            let mut updates = self.updates[pivot.updates.clone()].iter();
            for (i, left) in beside.iter().enumerate() {
                let mut scaled = [[[0.0; L]; N]; N];
                for p in 0..N {
                    for c in 0..N {
                        scaled[p][c] = times(&left[p][c], &reciprocals[p]);
                    }
                }
                for (right, update) in beside[i..].iter().zip(&mut updates) {
                    let target = later[update.target - end..].as_chunks_mut::<W>().0.first_chunk_mut::<N>();
                    let Some(target) = target else { return };
                    for (r, row) in target.iter_mut().enumerate() {
                        for p in 0..N {
                            for c in 0..N {
                                row[c] = less(&scaled[p][r], &right[p][c], &row[c]);
                            }
                        }
                    }
                }
            }
            lanes.products[pivot.block] = least;
        }
    }

    /// The same for one pivot whose blocks are of different widths, or wider than those of joints.
    fn eliminate_mixed<const L: usize>(&self, place: usize, lanes: &mut PivotLanes<L>) {
        let PivotLanes { values, diagonal, products } = lanes;
        let Pivot { block, size, start, diagonal: first, ref beside, ref updates, .. } = self.pivots[place];
        let at = |i: usize, k: usize| first + i * stride(size) + k;
        let mut least = [f64::INFINITY; L];
        for i in 0..size {
            let reciprocal = judge(&values[at(i, i)], &diagonal[start + i], &mut least);
            for k in i + 1..size {
                let factor = times(&values[at(k, i)], &reciprocal);
                for j in i + 1..=k {
                    values[at(k, j)] = less(&factor, &values[at(j, i)], &values[at(k, j)]);
                }
                for beside in &self.beside[beside.clone()] {
                    let step = stride(beside.columns);
                    for c in beside.offset..beside.offset + beside.columns {
                        values[c + k * step] = less(&factor, &values[c + i * step], &values[c + k * step]);
                    }
                }
            }
            values[at(i, i)] = reciprocal;
        }
        for update in &self.updates[updates.clone()] {
            let [left, right] = [update.rows, update.columns].map(stride);
            for p in 0..size {
                for r in 0..update.rows {
                    let factor = times(&values[update.left + p * left + r], &values[at(p, p)]);
                    for c in 0..update.columns {
                        let target = update.target + r * right + c;
                        let source = update.right + p * right + c;
                        values[target] = less(&factor, &values[source], &values[target]);
                    }
                }
            }
        }
        products[block] = least.map(|least| least.clamp(0.0, 1.0));
    }
}

/// A symmetric block, decomposed.
struct Decomposed<const N: usize, const L: usize> {
    /// The factors below the diagonal.
    lower: [[[f64; L]; N]; N],
    /// Of the pivots.
    reciprocals: [[f64; L]; N],
    /// The least pivot relative to a diagonal, between 0 and 1.
    least: [f64; L],
}

/// Decomposes a block, of which the lower triangle is read.
#[inline(always)]
fn decompose<const N: usize, const W: usize, const L: usize>(
    block: &[[[f64; L]; W]; N],
    reference: &[[f64; L]; N],
) -> Decomposed<N, L> {
    let mut rest = [[[0.0; L]; N]; N];
    for i in 0..N {
        rest[i].copy_from_slice(&block[i][..N]);
    }
    let (mut lower, mut reciprocals) = ([[[0.0; L]; N]; N], [[0.0; L]; N]);
    let mut least = [f64::INFINITY; L];
    for i in 0..N {
        reciprocals[i] = judge(&rest[i][i], &reference[i], &mut least);
        for k in i + 1..N {
            lower[k][i] = times(&rest[k][i], &reciprocals[i]);
            for j in i + 1..=k {
                rest[k][j] = less(&lower[k][i], &rest[j][i], &rest[k][j]);
            }
        }
    }
    for least in &mut least {
        *least = larger(0.0, if *least < 1.0 { *least } else { 1.0 });
    }
    Decomposed { lower, reciprocals, least }
}

/// The reciprocal of a pivot, zero where the row depends on others; `least` is the least pivot relative to the diagonal of S.
#[inline(always)]
fn judge<const L: usize>(pivot: &[f64; L], reference: &[f64; L], least: &mut [f64; L]) -> [f64; L] {
    let mut reciprocal = [0.0; L];
    for l in 0..L {
        // Without branches, which would take the lanes apart. A row whose diagonal is zero has nothing but zeros.
        let relative = pivot[l] / larger(f64::MIN_POSITIVE, reference[l]);
        least[l] = if relative < least[l] { relative } else { least[l] };
        reciprocal[l] = 1.0 / if pivot[l] > 0.0 { pivot[l] } else { f64::INFINITY };
    }
    reciprocal
}

#[inline(always)]
fn times<const L: usize>(a: &[f64; L], b: &[f64; L]) -> [f64; L] {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = a[l] * b[l];
    }
    out
}

/// c − a b.
#[inline(always)]
fn less<const L: usize>(a: &[f64; L], b: &[f64; L], c: &[f64; L]) -> [f64; L] {
    let mut out = [0.0; L];
    for l in 0..L {
        out[l] = fma(-a[l], b[l], c[l]);
    }
    out
}

/// The same for a row of numbers.
#[inline(always)]
fn less_row<const W: usize, const L: usize>(
    a: &[f64; L],
    b: &[[f64; L]; W],
    c: &[[f64; L]; W],
) -> [[f64; L]; W] {
    let mut out = [[0.0; L]; W];
    for k in 0..W {
        out[k] = less(a, &b[k], &c[k]);
    }
    out
}
