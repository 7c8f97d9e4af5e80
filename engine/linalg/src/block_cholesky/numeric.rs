//! Factorization and solution: the program of block operations, run on the processor's vector instructions.

use super::{BlockCholesky, Pivot, kernel, stride, wide};
use pulp::{Arch, Simd, WithSimd};

/// Runs `$call` with the constant `$n` equal to a block's size and `$w` to its stride, or `$wide` for blocks wider than
/// those of joints.
macro_rules! by_size {
    ($size:expr, $n:ident, $w:ident => $call:expr, $wide:expr) => {
        by_size!(@ $size, $n, $w => $call, $wide; 1 2 3 4 5 6)
    };
    (@ $size:expr, $n:ident, $w:ident => $call:expr, $wide:expr; $($value:literal)*) => {
        match $size {
            0 => {}
            $($value => { const $n: usize = $value; const $w: usize = stride($value); $call })*
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
        self.matrix.factor_here(self.epsilon, self.skip)
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
        self.matrix.solve_here(self.x);
    }
}

impl BlockCholesky {
    /// Factors S + ε diag(S), or without ε the rows of S that do not depend on others; S is overwritten. Returns the smallest
    /// pivot relative to the diagonal entry of S it came from.
    ///
    /// A pivot that is not larger than `skip` times the diagonal entry of S is replaced by infinity, which drops
    /// its row.
    pub fn factor(&mut self, epsilon: f64, skip: f64) -> f64 {
        let smallest = Arch::new().dispatch(Factor { matrix: &mut *self, epsilon, skip });
        self.find_pivot_products();
        smallest
    }

    /// Replaces b by the solution of S x = b.
    pub fn solve(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve { matrix: self, x });
    }

    #[inline(always)]
    fn factor_here(&mut self, epsilon: f64, skip: f64) -> f64 {
        // The shift of every diagonal entry is relative to S itself, so it comes before any update.
        for (entry, &at) in self.diagonal.iter_mut().zip(&self.diagonal_at) {
            *entry = self.values[at];
        }
        if epsilon != 0.0 {
            for (entry, &at) in self.diagonal.iter().zip(&self.diagonal_at) {
                self.values[at] += epsilon * entry;
            }
        }
        let leaves_out = epsilon == 0.0 && skip == 0.0;
        if leaves_out {
            self.rows_left_out.iter().for_each(|&row| self.diagonal[row] = f64::INFINITY);
        }
        let mut smallest = f64::INFINITY;
        for place in 0..self.pivots.len() {
            let Pivot { size, start, diagonal, left_out, .. } = self.pivots[place];
            if leaves_out && left_out > 0 {
                let block = &mut self.scratch[..size * size];
                let rows = self.values[diagonal..].chunks_exact(stride(size));
                for (own, row) in block.chunks_exact_mut(size).zip(rows) {
                    own.copy_from_slice(&row[..size]);
                }
                wide::leave_out(left_out, block, &mut self.diagonal[start..start + size]);
            }
            by_size!(
                size,
                N, W => smallest = self.factor_pivot::<N, W>(place, skip).min(smallest),
                smallest = self.factor_wide(place, skip).min(smallest)
            );
        }
        smallest
    }

    #[inline(always)]
    fn factor_pivot<const N: usize, const W: usize>(&mut self, place: usize, skip: f64) -> f64 {
        let Self { pivots, beside, updates, values, factors, diagonal, relative, .. } = self;
        let pivot = &pivots[place];
        let (Some(block), Some(place), Some(reference), Some(relative)) = (
            rows::<N, W>(&values[pivot.diagonal..]),
            rows_mut::<N, W>(&mut factors[pivot.diagonal..]),
            diagonal[pivot.start..].first_chunk::<N>(),
            relative[pivot.start..].first_chunk_mut::<N>(),
        ) else {
            return f64::INFINITY;
        };
        // Kept in registers: what was just written number by number is slow to read back in one piece.
        let (inverse, pivots) = kernel::invert(block, reference, skip);
        (*place, *relative) = (inverse, pivots);
        for beside in &beside[pivot.beside.clone()] {
            let (block, out) = (&values[beside.offset..], &mut factors[beside.offset..]);
            // The commonest case, all joints of one kind, with every length known.
            if beside.columns == N
                && let (Some(block), Some(out)) = (rows::<N, W>(block), rows_mut::<N, W>(out))
            {
                kernel::scale(&inverse, block, out);
            } else {
                wide::scale(N, inverse.as_flattened(), W, beside.columns, block, out);
            }
        }
        for update in &updates[pivot.updates.clone()] {
            // The target belongs to a later pivot than the blocks it is made of.
            let (done, later) = values.split_at_mut(update.target);
            let (scaled, block) = (&factors[update.left..], &done[update.right..]);
            if update.rows == N
                && update.columns == N
                && let (Some(scaled), Some(block), Some(target)) =
                    (rows::<N, W>(scaled), rows::<N, W>(block), rows_mut::<N, W>(later))
            {
                kernel::update(scaled, block, target);
            } else {
                wide::update(N, scaled, block, update.rows, update.columns, later);
            }
        }
        pivots.iter().fold(f64::INFINITY, |least, &r| least.min(r))
    }

    fn factor_wide(&mut self, place: usize, skip: f64) -> f64 {
        let pivot = &self.pivots[place];
        let n = pivot.size;
        let at = pivot.diagonal..pivot.diagonal + n * n;
        let own = pivot.start..pivot.start + n;
        self.factors[at.clone()].copy_from_slice(&self.values[at.clone()]);
        let relative = &mut self.relative[own.clone()];
        wide::invert(n, &mut self.factors[at.clone()], &self.diagonal[own], skip, relative);
        let smallest = relative.iter().fold(f64::INFINITY, |least, &r| least.min(r));
        for beside in &self.beside[pivot.beside.clone()] {
            // Blocks beside a pivot stand behind it.
            let (inverse, rest) = self.factors.split_at_mut(at.end);
            let (block, out) = (&self.values[beside.offset..], &mut rest[beside.offset - at.end..]);
            wide::scale(n, &inverse[at.clone()], n, beside.columns, block, out);
        }
        for update in &self.updates[pivot.updates.clone()] {
            let (done, later) = self.values.split_at_mut(update.target);
            let (scaled, block) = (&self.factors[update.left..], &done[update.right..]);
            wide::update(n, scaled, block, update.rows, update.columns, later);
        }
        smallest
    }

    #[inline(always)]
    fn solve_here(&self, x: &mut [f64]) {
        for pivot in &self.pivots {
            by_size!(pivot.size, N, W => self.forward::<N, W>(pivot, x), self.forward_wide(pivot, x));
        }
        for pivot in self.pivots.iter().rev() {
            by_size!(pivot.size, N, W => self.backward::<N, W>(pivot, x), self.backward_wide(pivot, x));
        }
    }

    #[inline(always)]
    fn forward<const N: usize, const W: usize>(&self, pivot: &Pivot, x: &mut [f64]) {
        let Some(&y) = x[pivot.start..].first_chunk::<N>() else { return };
        for beside in &self.beside[pivot.beside.clone()] {
            let block = &self.factors[beside.offset..];
            let target = &mut x[beside.start..];
            if beside.columns == N
                && let (Some(block), Some(target)) = (rows::<N, W>(block), target.first_chunk_mut::<N>())
            {
                kernel::forward(block, &y, target);
            } else {
                wide::forward(&y, block, beside.columns, target);
            }
        }
    }

    #[inline(always)]
    fn backward<const N: usize, const W: usize>(&self, pivot: &Pivot, x: &mut [f64]) {
        let inverse = rows::<N, W>(&self.factors[pivot.diagonal..]);
        let (Some(inverse), Some(y)) = (inverse, x[pivot.start..].first_chunk::<N>()) else { return };
        let mut solution = kernel::multiply(inverse, y);
        for beside in &self.beside[pivot.beside.clone()] {
            let (block, source) = (&self.factors[beside.offset..], &x[beside.start..]);
            if beside.columns == N
                && let (Some(block), Some(source)) = (rows::<N, W>(block), source.first_chunk::<N>())
            {
                kernel::backward(block, source, &mut solution);
            } else {
                wide::backward(block, &source[..beside.columns], &mut solution);
            }
        }
        if let Some(out) = x[pivot.start..].first_chunk_mut::<N>() {
            *out = solution;
        }
    }

    fn forward_wide(&self, pivot: &Pivot, x: &mut [f64]) {
        for beside in &self.beside[pivot.beside.clone()] {
            let (own, others) = own_and_others(x, pivot, beside.start);
            wide::forward(own, &self.factors[beside.offset..], beside.columns, others);
        }
    }

    fn backward_wide(&self, pivot: &Pivot, x: &mut [f64]) {
        let n = pivot.size;
        let inverse = &self.factors[pivot.diagonal..pivot.diagonal + n * n];
        let mut solution = vec![0.0; n];
        wide::multiply(n, inverse, &x[pivot.start..pivot.start + n], &mut solution);
        for beside in &self.beside[pivot.beside.clone()] {
            let source = &x[beside.start..beside.start + beside.columns];
            wide::backward(&self.factors[beside.offset..], source, &mut solution);
        }
        x[pivot.start..pivot.start + n].copy_from_slice(&solution);
    }
}

/// The rows of one pivot, and those from `other` on, of another.
fn own_and_others<'a>(x: &'a mut [f64], pivot: &Pivot, other: usize) -> (&'a [f64], &'a mut [f64]) {
    let own = pivot.start..pivot.start + pivot.size;
    if other < pivot.start {
        let (before, from) = x.split_at_mut(pivot.start);
        (&from[..pivot.size], &mut before[other..])
    } else {
        let (before, behind) = x.split_at_mut(own.end);
        (&before[own.start..], &mut behind[other - own.end..])
    }
}

#[inline(always)]
fn rows<const N: usize, const W: usize>(block: &[f64]) -> Option<&[[f64; W]; N]> {
    block.as_chunks::<W>().0.first_chunk::<N>()
}

#[inline(always)]
fn rows_mut<const N: usize, const W: usize>(block: &mut [f64]) -> Option<&mut [[f64; W]; N]> {
    block.as_chunks_mut::<W>().0.first_chunk_mut::<N>()
}
