//! Block-sparse Cholesky factorization S = L Lᵀ whose order and fill are fixed once.
//!
//! The blocks are the joints: S has a block for each pair of joints that share a moving body, so its graph is that
//! of the mechanism. The elimination order is greedy minimum degree; for chains, trees and ladders of loops the fill,
//! and with it the cost, is linear in the number of joints. The numeric phase runs a program of block operations
//! that was written down at assembly: it neither searches nor allocates.

use std::collections::BTreeSet;

/// Where a block of S is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Offset of its first number; rows are contiguous.
    pub offset: usize,
    /// Whether the stored block is the transpose of the one asked for.
    pub transposed: bool,
}

/// What a factorization met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivots {
    /// Smallest pivot, relative to the diagonal entry of S it came from.
    pub smallest: f64,
    /// Scalar row of S at which it stood.
    pub row: usize,
}

#[derive(Clone, Debug)]
struct Column {
    block: usize,
    size: usize,
    diagonal: usize,
    below: std::ops::Range<usize>,
    updates: std::ops::Range<usize>,
}

/// A block L_ij below the diagonal.
#[derive(Clone, Debug)]
struct Below {
    block: usize,
    rows: usize,
    offset: usize,
}

/// target −= left · rightᵀ.
#[derive(Clone, Debug)]
struct Update {
    target: usize,
    left: usize,
    right: usize,
    rows: usize,
    columns: usize,
}

/// The matrix and its factor, in one store.
#[derive(Clone, Debug)]
pub struct BlockCholesky {
    columns: Vec<Column>,
    below: Vec<Below>,
    updates: Vec<Update>,
    /// Place of each block in the elimination order.
    rank: Vec<usize>,
    /// First scalar row of each block.
    start: Vec<usize>,
    values: Vec<f64>,
    /// Diagonal of S before the factorization.
    diagonal: Vec<f64>,
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
        let (order, fill) = minimum_degree(graph);
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
            columns: Vec::with_capacity(count),
            below: Vec::new(),
            updates: Vec::new(),
            rank,
            start,
            values: Vec::new(),
            diagonal: vec![0.0; sizes.iter().sum()],
        };
        factor.lay_out(sizes, &order, &fill);
        factor.write_updates();
        factor
    }

    fn lay_out(&mut self, sizes: &[usize], order: &[usize], fill: &[Vec<usize>]) {
        let mut next = 0;
        for (&block, neighbours) in order.iter().zip(fill) {
            let size = sizes[block];
            let diagonal = next;
            next += size * size;
            let first = self.below.len();
            let mut rows: Vec<usize> = neighbours.clone();
            rows.sort_by_key(|&i| self.rank[i]);
            for i in rows {
                self.below.push(Below { block: i, rows: sizes[i], offset: next });
                next += sizes[i] * size;
            }
            let below = first..self.below.len();
            self.columns.push(Column { block, size, diagonal, below, updates: 0..0 });
        }
        self.values = vec![0.0; next];
    }

    fn write_updates(&mut self) {
        for place in 0..self.columns.len() {
            let first = self.updates.len();
            let range = self.columns[place].below.clone();
            for k in range.clone() {
                for i in k..range.end {
                    let (left, right) = (&self.below[i], &self.below[k]);
                    let target = self.offset(left.block, right.block);
                    self.updates.push(Update {
                        target,
                        left: left.offset,
                        right: right.offset,
                        rows: left.rows,
                        columns: right.rows,
                    });
                }
            }
            self.columns[place].updates = first..self.updates.len();
        }
    }

    /// Offset of the block of two joints, the one eliminated later first.
    fn offset(&self, later: usize, earlier: usize) -> usize {
        let column = &self.columns[self.rank[earlier]];
        if later == earlier {
            return column.diagonal;
        }
        let below = &self.below[column.below.clone()];
        let at = below.binary_search_by_key(&self.rank[later], |b| self.rank[b.block]);
        at.map_or(usize::MAX, |at| below[at].offset)
    }

    /// Where the block of joints i and j is stored. The pair must be an edge that was announced, or i = j.
    pub fn slot(&self, i: usize, j: usize) -> Slot {
        let transposed = self.rank[i] < self.rank[j];
        let (later, earlier) = if transposed { (j, i) } else { (i, j) };
        Slot { offset: self.offset(later, earlier), transposed }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// The numbers of the matrix, to be filled through slots.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Blocks of L, with fill.
    pub fn blocks(&self) -> usize {
        self.columns.len() + self.below.len()
    }

    /// Replaces S by the factor of S + ε diag(S).
    ///
    /// A pivot that is not larger than `skip` times the diagonal entry of S is replaced by infinity, which drops
    /// its row. `visit` sees each relative pivot with its scalar row.
    pub fn factor(&mut self, epsilon: f64, skip: f64, mut visit: impl FnMut(usize, f64)) -> Pivots {
        let mut pivots = Pivots { smallest: f64::INFINITY, row: 0 };
        let values = self.values.as_mut_slice();
        for column in &self.columns {
            let n = column.size;
            let first = self.start[column.block];
            for i in 0..n {
                let entry = &mut values[column.diagonal + i * n + i];
                self.diagonal[first + i] = *entry;
                *entry += epsilon * *entry;
            }
        }
        for column in &self.columns {
            let n = column.size;
            let first = self.start[column.block];
            let (head, tail) = values.split_at_mut(column.diagonal + n * n);
            let l = &mut head[column.diagonal..];
            for i in 0..n {
                for k in 0..i {
                    let dot: f64 = (0..k).map(|p| l[i * n + p] * l[k * n + p]).sum();
                    l[i * n + k] = (l[i * n + k] - dot) / l[k * n + k];
                }
                let dot: f64 = (0..i).map(|p| l[i * n + p] * l[i * n + p]).sum();
                let pivot = l[i * n + i] - dot;
                let reference = self.diagonal[first + i];
                let relative = if reference > 0.0 { pivot / reference } else { 0.0 };
                visit(first + i, relative);
                if relative < pivots.smallest {
                    pivots = Pivots { smallest: relative, row: first + i };
                }
                l[i * n + i] = if relative > skip { pivot.sqrt() } else { f64::INFINITY };
            }
            for below in &self.below[column.below.clone()] {
                let at = below.offset - (column.diagonal + n * n);
                solve_rows(l, n, &mut tail[at..at + below.rows * n]);
            }
            for update in &self.updates[column.updates.clone()] {
                apply(values, update, n);
            }
        }
        pivots
    }

    /// Replaces b by the solution of L Lᵀ x = b.
    pub fn solve(&self, x: &mut [f64]) {
        for column in &self.columns {
            let n = column.size;
            let first = self.start[column.block];
            let l = &self.values[column.diagonal..column.diagonal + n * n];
            for i in 0..n {
                let dot: f64 = (0..i).map(|p| l[i * n + p] * x[first + p]).sum();
                x[first + i] = (x[first + i] - dot) / l[i * n + i];
            }
            for below in &self.below[column.below.clone()] {
                let block = &self.values[below.offset..below.offset + below.rows * n];
                let target = self.start[below.block];
                for (i, row) in block.chunks_exact(n).enumerate() {
                    let dot: f64 = row.iter().zip(&x[first..first + n]).map(|(a, b)| a * b).sum();
                    x[target + i] -= dot;
                }
            }
        }
        for column in self.columns.iter().rev() {
            let n = column.size;
            let first = self.start[column.block];
            for below in &self.below[column.below.clone()] {
                let block = &self.values[below.offset..below.offset + below.rows * n];
                let source = self.start[below.block];
                for (i, row) in block.chunks_exact(n).enumerate() {
                    let value = x[source + i];
                    for (p, a) in row.iter().enumerate() {
                        x[first + p] -= a * value;
                    }
                }
            }
            let l = &self.values[column.diagonal..column.diagonal + n * n];
            for i in (0..n).rev() {
                let dot: f64 = (i + 1..n).map(|p| l[p * n + i] * x[first + p]).sum();
                x[first + i] = (x[first + i] - dot) / l[i * n + i];
            }
        }
    }
}

/// Each row b of `block` becomes the solution of x Lᵀ = b.
fn solve_rows(l: &[f64], n: usize, block: &mut [f64]) {
    for row in block.chunks_exact_mut(n) {
        for k in 0..n {
            let dot: f64 = (0..k).map(|p| row[p] * l[k * n + p]).sum();
            row[k] = (row[k] - dot) / l[k * n + k];
        }
    }
}

fn apply(values: &mut [f64], update: &Update, n: usize) {
    for i in 0..update.rows {
        for k in 0..update.columns {
            let left = update.left + i * n;
            let right = update.right + k * n;
            let dot: f64 = (0..n).map(|p| values[left + p] * values[right + p]).sum();
            values[update.target + i * update.columns + k] -= dot;
        }
    }
}

/// Greedy minimum degree: the order, and for each eliminated block its neighbours at that moment.
fn minimum_degree(mut graph: Vec<BTreeSet<usize>>) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut queue: BTreeSet<(usize, usize)> = graph.iter().enumerate().map(|(i, n)| (n.len(), i)).collect();
    let mut order = Vec::with_capacity(graph.len());
    let mut fill = Vec::with_capacity(graph.len());
    while let Some((_, block)) = queue.pop_first() {
        let neighbours: Vec<usize> = std::mem::take(&mut graph[block]).into_iter().collect();
        for &i in &neighbours {
            queue.remove(&(graph[i].len(), i));
            graph[i].remove(&block);
        }
        for (at, &i) in neighbours.iter().enumerate() {
            for &j in &neighbours[at + 1..] {
                graph[i].insert(j);
                graph[j].insert(i);
            }
        }
        for &i in &neighbours {
            queue.insert((graph[i].len(), i));
        }
        order.push(block);
        fill.push(neighbours);
    }
    (order, fill)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((*seed >> 33) as f64) / f64::from(1u32 << 30) - 1.0
    }

    proptest! {
        #[test]
        fn solves_what_a_dense_factorization_solves(
            sizes in prop::collection::vec(1usize..6, 1..12),
            links in prop::collection::vec((0usize..12, 0usize..12), 0..20),
            mut seed in any::<u64>(),
        ) {
            let count = sizes.len();
            let edges: Vec<(usize, usize)> =
                links.into_iter().map(|(i, j)| (i % count, j % count)).filter(|(i, j)| i != j).collect();
            let start: Vec<usize> = (0..count).map(|i| sizes[..i].iter().sum()).collect();
            let n: usize = sizes.iter().sum();
            let mut dense = DMatrix::<f64>::identity(n, n) * 200.0;
            let mut factor = BlockCholesky::new(&sizes, edges.iter().copied());
            factor.clear();
            let mut add = |i: usize, j: usize, factor: &mut BlockCholesky| {
                let slot = factor.slot(i, j);
                for a in 0..sizes[i] {
                    for b in 0..sizes[j] {
                        let x = if i == j { 0.0 } else { random(&mut seed) };
                        dense[(start[i] + a, start[j] + b)] += x;
                        if i != j { dense[(start[j] + b, start[i] + a)] += x; }
                        let (row, column, width) =
                            if slot.transposed { (b, a, sizes[i]) } else { (a, b, sizes[j]) };
                        let diagonal = if i == j && a == b { 200.0 } else { 0.0 };
                        factor.values_mut()[slot.offset + row * width + column] += x + diagonal;
                    }
                }
            };
            for i in 0..count { add(i, i, &mut factor); }
            for &(i, j) in &edges { add(i, j, &mut factor); }
            let b = DVector::from_fn(n, |i, _| (i as f64).sin());
            let mut x = b.clone();
            factor.factor(0.0, 0.0, |_, _| {});
            factor.solve(x.as_mut_slice());
            prop_assert!((dense * x - b).amax() < 1e-12);
        }
    }

    #[test]
    fn a_chain_has_no_fill() {
        let factor = BlockCholesky::new(&[3; 50], (0..49).map(|i| (i, i + 1)));
        assert_eq!(factor.blocks(), 50 + 49);
    }
}
