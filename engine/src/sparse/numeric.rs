//! Factorization and solution: the program of block operations, run on the processor's vector instructions.

use super::{BlockCholesky, Column, kernel, wide};
use pulp::{Arch, Simd, WithSimd};

/// Runs `$call` with the constant `$n` equal to a block's size, or `$wide` for blocks wider than those of joints.
macro_rules! by_size {
    ($size:expr, $n:ident => $call:expr, $wide:expr) => {
        by_size!(@ $size, $n => $call, $wide; 1 2 3 4 5 6)
    };
    (@ $size:expr, $n:ident => $call:expr, $wide:expr; $($value:literal)*) => {
        match $size {
            0 => {}
            $($value => { const $n: usize = $value; $call })*
            _ => $wide,
        }
    };
}

struct Factor<'a> {
    matrix: &'a mut BlockCholesky,
    epsilon: f64,
    skip: f64,
}

impl WithSimd for Factor<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        self.matrix.factor_here(!S::IS_SCALAR, self.epsilon, self.skip)
    }
}

struct Solve<'a> {
    matrix: &'a BlockCholesky,
    x: &'a mut [f64],
}

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.matrix.solve_here(!S::IS_SCALAR, self.x);
    }
}

impl BlockCholesky {
    /// Factors S + ε diag(S), or without ε the rows of S that do not depend on others; S is used up. Returns the smallest
    /// pivot relative to the diagonal entry of S it came from.
    ///
    /// A pivot that is not larger than `skip` times the diagonal entry of S is replaced by infinity, which drops
    /// its row.
    pub fn factor(&mut self, epsilon: f64, skip: f64) -> f64 {
        let smallest = Arch::new().dispatch(Factor { matrix: &mut *self, epsilon, skip });
        self.find_holds();
        smallest
    }

    /// Replaces b by the solution of S x = b.
    pub fn solve(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve { matrix: self, x });
    }

    #[inline(always)]
    fn factor_here(&mut self, fused: bool, epsilon: f64, skip: f64) -> f64 {
        // The shift of every diagonal entry is relative to S itself, so it comes before any update.
        for (entry, &at) in self.diagonal.iter_mut().zip(&self.diagonal_at) {
            *entry = self.values[at];
        }
        if epsilon != 0.0 {
            for (entry, &at) in self.diagonal.iter().zip(&self.diagonal_at) {
                self.values[at] += epsilon * entry;
            }
        }
        if epsilon == 0.0 && skip == 0.0 {
            self.known_dependent.iter().for_each(|&row| self.diagonal[row] = f64::INFINITY);
        }
        let mut smallest = f64::INFINITY;
        for place in 0..self.columns.len() {
            let Column { size, start, diagonal, dependent, .. } = self.columns[place];
            if dependent > 0 && epsilon == 0.0 {
                let block = &mut self.scratch[..size * size];
                block.copy_from_slice(&self.values[diagonal..diagonal + size * size]);
                wide::leave_out(dependent, block, &mut self.diagonal[start..start + size]);
            }
            by_size!(
                size,
                N => smallest = self.factor_column::<N>(fused, place, skip).min(smallest),
                smallest = self.factor_wide(place, skip).min(smallest)
            );
        }
        smallest
    }

    #[inline(always)]
    fn factor_column<const N: usize>(&mut self, fused: bool, place: usize, skip: f64) -> f64 {
        let Self { columns, below, updates, values, factors, diagonal, relative, .. } = self;
        let column = &columns[place];
        let (Some(block), Some(place), Some(reference), Some(relative)) = (
            values[column.diagonal..].as_chunks::<N>().0.first_chunk::<N>(),
            factors[column.diagonal..].as_chunks_mut::<N>().0.first_chunk_mut::<N>(),
            diagonal[column.start..].first_chunk::<N>(),
            relative[column.start..].first_chunk_mut::<N>(),
        ) else {
            return f64::INFINITY;
        };
        // Kept in registers: what was just written number by number is slow to read back in one piece.
        let (inverse, pivots) = kernel::invert(fused, block, reference, skip);
        (*place, *relative) = (inverse, pivots);
        for below in &below[column.below.clone()] {
            let at = below.offset..below.offset + below.rows * N;
            kernel::scale(fused, &inverse, &values[at.clone()], &mut factors[at]);
        }
        for update in &updates[column.updates.clone()] {
            // The target belongs to a later column than the blocks it is made of.
            let (done, later) = values.split_at_mut(update.target);
            kernel::update::<N>(
                fused,
                &factors[update.left..update.left + update.rows * N],
                &done[update.right..update.right + update.columns * N],
                update.columns,
                update.left == update.right,
                &mut later[..update.rows * update.columns],
            );
        }
        pivots.iter().fold(f64::INFINITY, |least, &r| least.min(r))
    }

    fn factor_wide(&mut self, place: usize, skip: f64) -> f64 {
        let column = &self.columns[place];
        let n = column.size;
        let at = column.diagonal..column.diagonal + n * n;
        let rows = column.start..column.start + n;
        self.factors[at.clone()].copy_from_slice(&self.values[at.clone()]);
        let relative = &mut self.relative[rows.clone()];
        wide::invert(n, &mut self.factors[at.clone()], &self.diagonal[rows], skip, relative);
        let smallest = relative.iter().fold(f64::INFINITY, |least, &r| least.min(r));
        for below in &self.below[column.below.clone()] {
            // Blocks of a column stand behind its diagonal.
            let (inverse, rest) = self.factors.split_at_mut(at.end);
            let own = below.offset..below.offset + below.rows * n;
            let out = &mut rest[own.start - at.end..own.end - at.end];
            wide::scale(n, &inverse[at.clone()], &self.values[own], out);
        }
        for update in &self.updates[column.updates.clone()] {
            let (done, later) = self.values.split_at_mut(update.target);
            wide::update(
                n,
                &self.factors[update.left..update.left + update.rows * n],
                &done[update.right..update.right + update.columns * n],
                update.columns,
                &mut later[..update.rows * update.columns],
            );
        }
        smallest
    }

    #[inline(always)]
    fn solve_here(&self, fused: bool, x: &mut [f64]) {
        for column in &self.columns {
            by_size!(column.size, N => self.forward::<N>(fused, column, x), self.forward_wide(column, x));
        }
        for column in self.columns.iter().rev() {
            by_size!(column.size, N => self.backward::<N>(fused, column, x), self.backward_wide(column, x));
        }
    }

    fn forward_wide(&self, column: &Column, x: &mut [f64]) {
        for below in &self.below[column.below.clone()] {
            for r in 0..below.rows {
                let first = below.offset + r * column.size;
                let e = &self.factors[first..first + column.size];
                let known: f64 = e.iter().zip(&x[column.start..]).map(|(e, y)| e * y).sum();
                x[below.start + r] -= known;
            }
        }
    }

    fn backward_wide(&self, column: &Column, x: &mut [f64]) {
        let n = column.size;
        let inverse = &self.factors[column.diagonal..column.diagonal + n * n];
        let mut solution = vec![0.0; n];
        wide::multiply(n, inverse, &x[column.start..column.start + n], &mut solution);
        for below in &self.below[column.below.clone()] {
            let block = &self.factors[below.offset..below.offset + below.rows * n];
            for (e, value) in block.chunks_exact(n).zip(&x[below.start..]) {
                for (solution, e) in solution.iter_mut().zip(e) {
                    *solution -= e * value;
                }
            }
        }
        x[column.start..column.start + n].copy_from_slice(&solution);
    }

    #[inline(always)]
    fn forward<const N: usize>(&self, fused: bool, column: &Column, x: &mut [f64]) {
        let Some(&y) = x[column.start..].first_chunk::<N>() else { return };
        for below in &self.below[column.below.clone()] {
            let block = &self.factors[below.offset..below.offset + below.rows * N];
            kernel::forward(fused, block, &y, &mut x[below.start..below.start + below.rows]);
        }
    }

    #[inline(always)]
    fn backward<const N: usize>(&self, fused: bool, column: &Column, x: &mut [f64]) {
        let inverse = self.factors[column.diagonal..].as_chunks::<N>().0;
        let (Some(inverse), Some(y)) = (inverse.first_chunk::<N>(), x[column.start..].first_chunk::<N>())
        else {
            return;
        };
        let mut solution = kernel::multiply(fused, inverse, y);
        for below in &self.below[column.below.clone()] {
            let block = &self.factors[below.offset..below.offset + below.rows * N];
            kernel::backward(fused, block, &x[below.start..below.start + below.rows], &mut solution);
        }
        if let Some(out) = x[column.start..].first_chunk_mut::<N>() {
            *out = solution;
        }
    }
}
