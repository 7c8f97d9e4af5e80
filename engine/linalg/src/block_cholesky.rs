//! Block-sparse factorization S = Uᵀ D U whose order and fill are fixed once.
//!
//! Libraries choose their kernels for large blocks; those of joints have one to six rows. `tests/peers/sparse` times this
//! factorization beside that of faer, on the same matrices.
//!
//! The blocks are the joints: S has a block for each pair of joints that share a moving body, so its graph is that
//! of the mechanism. The elimination order is greedy minimum degree; for chains, trees and ladders of loops the fill,
//! and with it the cost, is linear in the number of joints. The numeric phase runs a program of block operations
//! that was written down at assembly: it neither searches nor allocates. Diagonal blocks are inverted outright, so
//! that a solve is a chain of short products without divisions.

mod kernel;
mod lanes;
mod numeric;
mod order;
mod runs;
mod solve;
mod wide;

pub use lanes::PivotLanes;

use crate::larger;
use order::minimum_degree;
use runs::Run;
use std::collections::BTreeSet;
use std::ops::Range;

/// Where a block of S is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockSlot {
    /// Offset of its first number; rows are contiguous.
    pub offset: usize,
    /// Whether the stored block is the transpose of the one asked for.
    pub transposed: bool,
}

#[derive(Clone, Debug)]
struct Pivot {
    block: usize,
    size: usize,
    /// First scalar row.
    start: usize,
    /// Its first number in the order of elimination.
    place: usize,
    diagonal: usize,
    beside: Range<usize>,
    updates: Range<usize>,
    /// How many of its rows are left out: those with the smallest pivots.
    left_out: usize,
}

/// A block in the rows of a pivot and the columns of one that is eliminated later.
#[derive(Clone, Debug)]
struct Beside {
    block: usize,
    columns: usize,
    /// First number of its columns in the order of elimination.
    place: u32,
    offset: usize,
}

/// target −= leftᵀ · right.
#[derive(Clone, Debug)]
struct Update {
    target: usize,
    left: usize,
    right: usize,
    rows: usize,
    columns: usize,
}

/// A place among the numbers of a solution, of which there are far fewer than 2³².
#[allow(clippy::cast_possible_truncation, reason = "no factor has so many numbers")]
const fn narrow(place: usize) -> u32 {
    place as u32
}

/// Numbers from one row of a block to the next: rows of three fill a vector of four, whose last is zero.
pub const fn stride(columns: usize) -> usize {
    if columns == 3 { 4 } else { columns }
}

/// The matrix and its factor S = Uᵀ D U, D block-diagonal.
#[derive(Clone, Debug)]
pub struct BlockCholesky {
    pivots: Vec<Pivot>,
    beside: Vec<Beside>,
    updates: Vec<Update>,
    /// All pivots that have rows, in runs of such that are alike.
    runs: Vec<Run>,
    /// Place of each block in the elimination order.
    rank: Vec<usize>,
    /// The entries of S; the factorization overwrites them, at last by the transposes of the blocks of U in runs.
    values: Vec<f64>,
    /// D⁻¹ on the diagonal, blocks of U beside it.
    factors: Vec<f64>,
    /// Diagonal of S before the factorization, or infinite for rows that are left out.
    diagonal: Vec<f64>,
    /// Place of each diagonal entry in `values`, by scalar row.
    diagonal_at: Vec<usize>,
    /// Pivots of the last factorization relative to that diagonal, by scalar row; infinite for rows that were left out.
    relative: Vec<f64>,
    /// A copy of a diagonal block, in which dependent rows are searched for.
    scratch: Vec<f64>,
    /// Scalar rows that are left out.
    rows_left_out: Vec<usize>,
    /// Where scalar rows stand in the order of elimination, and room for so many numbers.
    places: Vec<usize>,
    placed: Vec<f64>,
    /// Products of the relative pivots of each block, if they are kept.
    pivot_products: Option<Vec<f64>>,
}

/// Whether a factorization of so many blocks, joined by `edges`, takes at most `most` products of blocks. It is found out without
/// doing more than that.
pub fn products_within(count: usize, edges: impl Iterator<Item = (usize, usize)>, most: usize) -> bool {
    let mut graph = vec![BTreeSet::new(); count];
    let mut joined = 0;
    for (i, j) in edges.filter(|(i, j)| i != j) {
        joined += usize::from(graph[i].insert(j));
        graph[j].insert(i);
        if joined > most {
            return false;
        }
    }
    minimum_degree(graph, most).0.len() == count
}

impl BlockCholesky {
    /// Fixes the order and the fill for blocks of the given sizes, joined by `edges`.
    pub fn new(sizes: &[usize], edges: impl Iterator<Item = (usize, usize)>) -> Self {
        let count = sizes.len();
        let mut graph = vec![BTreeSet::new(); count];
        for (i, j) in edges {
            if i != j {
                graph[i].insert(j);
                graph[j].insert(i);
            }
        }
        let (order, fill) = minimum_degree(graph, usize::MAX);
        let mut rank = vec![0; count];
        for (place, &block) in order.iter().enumerate() {
            rank[block] = place;
        }
        let start: Vec<usize> = sizes
            .iter()
            .scan(0, |next, &size| {
                *next += size;
                Some(*next - size)
            })
            .collect();
        let mut factor = Self {
            pivots: Vec::with_capacity(count),
            beside: Vec::new(),
            updates: Vec::new(),
            runs: Vec::new(),
            rank,
            values: Vec::new(),
            factors: Vec::new(),
            diagonal: vec![0.0; sizes.iter().sum()],
            diagonal_at: vec![0; sizes.iter().sum()],
            relative: vec![0.0; sizes.iter().sum()],
            scratch: vec![0.0; sizes.iter().map(|size| size * size).max().unwrap_or(0)],
            rows_left_out: Vec::new(),
            places: vec![0; sizes.iter().sum()],
            placed: vec![0.0; sizes.iter().map(|&size| stride(size)).sum()],
            pivot_products: None,
        };
        factor.lay_out(sizes, &start, &order, &fill);
        factor.write_updates();
        factor.runs = runs::find(&factor.pivots, &factor.beside);
        factor
    }

    fn lay_out(&mut self, sizes: &[usize], start: &[usize], order: &[usize], fill: &[Vec<usize>]) {
        let mut first = vec![0; sizes.len()];
        let mut next = 0;
        for &block in order {
            first[block] = next;
            next += stride(sizes[block]);
        }
        next = 0;
        for (&block, neighbours) in order.iter().zip(fill) {
            let (size, place) = (sizes[block], first[block]);
            let diagonal = next;
            for i in 0..size {
                self.diagonal_at[start[block] + i] = diagonal + i * (stride(size) + 1);
                self.places[start[block] + i] = place + i;
            }
            next += size * stride(size);
            let beside = self.beside.len();
            let mut columns: Vec<usize> = neighbours.clone();
            columns.sort_by_key(|&i| self.rank[i]);
            for i in columns {
                self.beside.push(Beside {
                    block: i,
                    columns: sizes[i],
                    place: narrow(first[i]),
                    offset: next,
                });
                next += size * stride(sizes[i]);
            }
            let beside = beside..self.beside.len();
            self.pivots.push(Pivot {
                block,
                size,
                start: start[block],
                place,
                diagonal,
                beside,
                updates: 0..0,
                left_out: 0,
            });
        }
        self.values = vec![0.0; next];
        self.factors = vec![0.0; next];
    }

    fn write_updates(&mut self) {
        for place in 0..self.pivots.len() {
            let first = self.updates.len();
            let range = self.pivots[place].beside.clone();
            for i in range.clone() {
                for k in i..range.end {
                    let (left, right) = (&self.beside[i], &self.beside[k]);
                    let target = self.offset(left.block, right.block);
                    self.updates.push(Update {
                        target,
                        left: left.offset,
                        right: right.offset,
                        rows: left.columns,
                        columns: right.columns,
                    });
                }
            }
            self.pivots[place].updates = first..self.updates.len();
        }
    }

    /// Offset of the block of two joints, the one eliminated earlier first.
    fn offset(&self, earlier: usize, later: usize) -> usize {
        let pivot = &self.pivots[self.rank[earlier]];
        if later == earlier {
            return pivot.diagonal;
        }
        let beside = &self.beside[pivot.beside.clone()];
        let at = beside.binary_search_by_key(&self.rank[later], |b| self.rank[b.block]);
        at.map_or(usize::MAX, |at| beside[at].offset)
    }

    /// Where the block of joints i and j is stored, with rows of [`stride`] numbers. The pair must be an edge that was
    /// announced, or i = j.
    pub fn slot(&self, i: usize, j: usize) -> BlockSlot {
        let transposed = self.rank[i] > self.rank[j];
        let (earlier, later) = if transposed { (j, i) } else { (i, j) };
        BlockSlot { offset: self.offset(earlier, later), transposed }
    }

    /// Where the numbers of scalar rows stand in right-hand sides and solutions: in the order of elimination.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// How many numbers a right-hand side has: more than there are rows, as those of joints with three fill a vector of four.
    pub fn numbers(&self) -> usize {
        self.placed.len()
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// The numbers of the matrix.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The numbers of the matrix, to be filled through slots.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The blocks in the order of their elimination.
    pub fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rank.len()).collect();
        order.sort_by_key(|&block| self.rank[block]);
        order
    }

    /// Pivots of the last factorization relative to the diagonal entries of S they came from, by scalar row; infinite for
    /// rows that were left out.
    pub fn relative_pivots(&self) -> &[f64] {
        &self.relative
    }

    /// The scalar rows that depend on others, in ascending order: those whose pivots are at most the part `least` of their
    /// diagonal entries. Each of them is left out while those after it are judged. S is overwritten, and the factor cannot be used to solve.
    pub fn dependent_rows(&mut self, least: f64) -> Vec<usize> {
        self.factor(0.0, least);
        let rows = self.relative.iter().enumerate();
        rows.filter(|(_, relative)| **relative <= least).map(|(row, _)| row).collect()
    }

    /// From now on leaves these scalar rows, in ascending order, out of factorizations without regularization: they depend on
    /// others at every state. Pivot products are without them in any case, and comparable along a run.
    pub fn leave_out(&mut self, rows: impl IntoIterator<Item = usize>) {
        self.rows_left_out = rows.into_iter().collect();
    }

    /// Leaves out as many rows of each block, but chooses in each factorization those with the smallest pivots beside the
    /// others of their block: the solution then has the least rounding.
    pub fn leave_out_weakest(&mut self, rows: impl IntoIterator<Item = usize>) {
        let rows: Vec<usize> = rows.into_iter().collect();
        let before = |row: usize| rows.partition_point(|&left_out| left_out < row);
        for pivot in &mut self.pivots {
            pivot.left_out = before(pivot.start + pivot.size) - before(pivot.start);
        }
    }

    /// From now on each factorization keeps its pivot products.
    pub fn keep_pivot_products(&mut self) {
        self.pivot_products = Some(vec![1.0; self.pivots.len()]);
    }

    /// Of each block, the product of the relative pivots of its rows that do not depend on others, in the last
    /// factorization: near zero at a singular position. Empty unless they are kept.
    pub fn pivot_products(&self) -> &[f64] {
        self.pivot_products.as_deref().unwrap_or_default()
    }

    /// Which blocks take part where a row of each of `blocks` nearly depends on others: raises the share of each block to the
    /// largest |xᵢ| √Sᵢᵢ of its rows, relative to the largest of all, x = S⁻¹ e and e the row of a block with the smallest pivot,
    /// or the sum of several with their weights. The factorization must be one without regularization.
    pub fn raise_shares(&mut self, blocks: &[(usize, f64)], shares: &mut [f64]) {
        let mut x = std::mem::take(&mut self.placed);
        x.fill(0.0);
        for &(block, weight) in blocks {
            let Pivot { size, start, .. } = self.pivots[self.rank[block]];
            let weakest =
                (start..start + size).min_by(|a, b| self.relative[*a].total_cmp(&self.relative[*b]));
            let Some(weakest) = weakest else { continue };
            x[self.places[weakest]] = weight;
        }
        self.solve_in_place(&mut x);
        let part = |row: usize| {
            let diagonal = self.diagonal[row];
            if diagonal.is_finite() { x[self.places[row]].abs() * diagonal.sqrt() } else { 0.0 }
        };
        let most = (0..self.places.len()).map(part).fold(f64::MIN_POSITIVE, f64::max);
        for (share, &place) in shares.iter_mut().zip(&self.rank) {
            let Pivot { size, start, .. } = self.pivots[place];
            *share = (start..start + size).map(|row| part(row) / most).fold(*share, f64::max);
        }
        self.placed = x;
    }

    /// The largest |xᵢ| Sᵢᵢ / sizeᵢ of all rows that are not left out: what each xᵢ would make of its own row alone, with S as it was
    /// factored last. x and the sizes stand where the factor has its rows.
    pub fn largest_alone(&self, x: &[f64], sizes: &[f64]) -> f64 {
        let alone = |(&place, diagonal): (&usize, &f64)| {
            if diagonal.is_finite() { x[place].abs() * diagonal / sizes[place] } else { 0.0 }
        };
        self.places.iter().zip(&self.diagonal).map(alone).fold(0.0, larger)
    }

    /// Takes rows that are left out of other factorizations out of the pivot products of one that has them.
    fn forget_rows_left_out(&mut self) {
        let Self { pivot_products: Some(products), pivots, relative, rows_left_out, .. } = self else {
            return;
        };
        for &Pivot { block, size, start, .. } in &*pivots {
            let counts = |row: &usize| rows_left_out.binary_search(row).is_err();
            let rows = (start..start + size).filter(counts).map(|row| relative[row]);
            products[block] = rows.fold(1.0, f64::min).max(0.0);
        }
    }
}
