//! Factorization: the program of block operations, run on the processor's vector instructions.

use super::runs::{Alike, Run, by_kind, by_size};
use super::{BlockCholesky, Pivot, kernel, stride, wide};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

struct Factor<'a> {
    matrix: &'a mut BlockCholesky,
    epsilon: f64,
    skip: f64,
    leaves_out: bool,
}

impl WithSimd for Factor<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        self.matrix.factor_here(self.epsilon, self.skip, self.leaves_out)
    }
}

impl BlockCholesky {
    /// Factors S + ε diag(S), or without ε the rows of S that do not depend on others; S is overwritten. Returns the smallest
    /// pivot relative to the diagonal entry of S it came from.
    ///
    /// A pivot that is not larger than `skip` times the diagonal entry of S is replaced by infinity, which drops
    /// its row.
    pub fn factor(&mut self, epsilon: f64, skip: f64) -> f64 {
        let leaves_out = epsilon == 0.0 && skip == 0.0;
        let smallest = Arch::new().dispatch(Factor { matrix: &mut *self, epsilon, skip, leaves_out });
        if !leaves_out && !self.rows_left_out.is_empty() {
            self.forget_rows_left_out();
        }
        smallest
    }

    #[inline(always)]
    fn factor_here(&mut self, epsilon: f64, skip: f64, leaves_out: bool) -> f64 {
        // The shift of every diagonal entry is relative to S itself, so it comes before any update.
        for (entry, &at) in self.diagonal.iter_mut().zip(&self.diagonal_at) {
            *entry = self.values[at];
        }
        if epsilon != 0.0 {
            for (entry, &at) in self.diagonal.iter().zip(&self.diagonal_at) {
                self.values[at] += epsilon * entry;
            }
        }
        if leaves_out {
            self.rows_left_out.iter().for_each(|&row| self.diagonal[row] = f64::INFINITY);
        }
        let mut smallest = f64::INFINITY;
        for k in 0..self.runs.len() {
            let Run { pivots, alike } = self.runs[k].clone();
            let least = by_kind!(
                &alike,
                N, W, beside => self.factor_alike::<N, W>(pivots, beside, skip, leaves_out),
                self.factor_mixed(pivots.start, skip, leaves_out)
            );
            smallest = smallest.min(least);
        }
        smallest
    }

    /// Factors a run of pivots that are alike.
    #[inline(always)]
    fn factor_alike<const N: usize, const W: usize>(
        &mut self,
        pivots: Range<usize>,
        beside: usize,
        skip: f64,
        leaves_out: bool,
    ) -> f64 {
        let numbers = (1 + beside) * N * W;
        let Self { updates, values, factors, diagonal, relative, scratch, pivot_products, .. } = self;
        let pivots = &self.pivots[pivots];
        let Some(first) = pivots.first() else { return f64::INFINITY };
        let mut updates = updates[first.updates.start..].iter();
        let mut smallest = f64::INFINITY;
        for (pivot, factors) in pivots.iter().zip(factors[first.diagonal..].chunks_exact_mut(numbers)) {
            if leaves_out && pivot.left_out > 0 {
                leave_out(pivot, &values[pivot.diagonal..], scratch, diagonal);
            }
            // Targets belong to later pivots than the blocks that they are made of.
            let end = pivot.diagonal + numbers;
            let (done, later) = values.split_at_mut(end);
            let own = done[pivot.diagonal..].as_chunks_mut::<W>().0.as_chunks_mut::<N>().0;
            let out = factors.as_chunks_mut::<W>().0.as_chunks_mut::<N>().0;
            let (Some((block, beside)), Some((place, scaled)), Some(reference), Some(relative)) = (
                own.split_first_mut(),
                out.split_first_mut(),
                diagonal[pivot.start..].first_chunk::<N>(),
                relative[pivot.start..].first_chunk_mut::<N>(),
            ) else {
                return f64::INFINITY;
            };
            // Kept in registers: what was just written number by number is slow to read back in one piece.
            let (inverse, found) = kernel::invert(block, reference, skip);
            (*place, *relative) = (inverse, found);
            for (block, scaled) in beside.iter().zip(&mut *scaled) {
                kernel::scale(&inverse, block, scaled);
            }
            for (i, scaled) in scaled.iter().enumerate() {
                for (block, update) in beside[i..].iter().zip(&mut updates) {
                    if let Some(target) = rows_mut::<N, W>(&mut later[update.target - end..]) {
                        kernel::update(scaled, block, target);
                    }
                }
            }
            for (block, scaled) in beside.iter_mut().zip(&*scaled) {
                kernel::turn(scaled, block);
            }
            let least = found.iter().fold(f64::INFINITY, |least, &r| least.min(r));
            smallest = smallest.min(least);
            if let Some(products) = pivot_products {
                products[pivot.block] = least.clamp(0.0, 1.0);
            }
        }
        smallest
    }

    /// Factors a pivot whose blocks are of different widths, or wider than those of joints.
    #[inline(always)]
    fn factor_mixed(&mut self, place: usize, skip: f64, leaves_out: bool) -> f64 {
        let Self { pivots, values, scratch, diagonal, .. } = self;
        let pivot = &pivots[place];
        if leaves_out && pivot.left_out > 0 {
            leave_out(pivot, &values[pivot.diagonal..], scratch, diagonal);
        }
        let (block, size) = (pivot.block, pivot.size);
        let least = by_size!(
            size,
            N, W => self.factor_pivot::<N, W>(place, skip),
            self.factor_wide(place, skip)
        );
        if let Some(products) = &mut self.pivot_products {
            products[block] = least.clamp(0.0, 1.0);
        }
        least
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
        for beside in beside[pivot.beside.clone()].iter().filter(|beside| beside.columns == N) {
            let (scaled, block) = (&factors[beside.offset..], &mut values[beside.offset..]);
            if let (Some(scaled), Some(block)) = (rows::<N, W>(scaled), rows_mut::<N, W>(block)) {
                kernel::turn(scaled, block);
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
}

/// Chooses the rows of a pivot that are left out, given its block of S.
fn leave_out(pivot: &Pivot, own: &[f64], scratch: &mut [f64], diagonal: &mut [f64]) {
    let size = pivot.size;
    let block = &mut scratch[..size * size];
    for (own, row) in block.chunks_exact_mut(size).zip(own.chunks_exact(stride(size))) {
        own.copy_from_slice(&row[..size]);
    }
    wide::leave_out(pivot.left_out, block, &mut diagonal[pivot.start..pivot.start + size]);
}

#[inline(always)]
pub(super) fn rows<const N: usize, const W: usize>(block: &[f64]) -> Option<&[[f64; W]; N]> {
    block.as_chunks::<W>().0.first_chunk::<N>()
}

#[inline(always)]
fn rows_mut<const N: usize, const W: usize>(block: &mut [f64]) -> Option<&mut [[f64; W]; N]> {
    block.as_chunks_mut::<W>().0.first_chunk_mut::<N>()
}
