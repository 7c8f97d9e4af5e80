//! Solution with the factor: a sweep through the pivots in the order of their elimination, and one back.

use super::numeric::rows;
use super::runs::{Alike, Run, by_kind, by_size};
use super::{BlockCholesky, Pivot, kernel, narrow, stride, wide};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

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

/// W numbers from a place on. Their end is found without overflow, so that one comparison tells whether they are there.
#[inline(always)]
fn numbers<const W: usize>(x: &[f64], at: u32) -> Option<&[f64; W]> {
    let at = at as usize;
    x.get(at..at + W)?.first_chunk()
}

#[inline(always)]
fn numbers_mut<const W: usize>(x: &mut [f64], at: u32) -> Option<&mut [f64; W]> {
    let at = at as usize;
    x.get_mut(at..at + W)?.first_chunk_mut()
}

impl BlockCholesky {
    /// Replaces b by the solution of S x = b, whose numbers stand at [`Self::places`].
    pub fn solve_in_place(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve { matrix: self, x });
    }

    /// The same from within what is compiled for vectors: a ball on its own, as a body on one joint has it, takes no sweeps.
    #[inline(always)]
    pub fn solve_within<S: Simd>(&self, _: S, x: &mut [f64]) {
        if let [Run { pivots, alike: Some(Alike { size: 3, beside: 0 }) }] = &*self.runs
            && let [pivot] = &self.pivots[pivots.clone()]
            && let Some(inverse) = rows::<3, { stride(3) }>(&self.factors[pivot.diagonal..])
            && let Some(x) = x[pivot.place..].first_chunk_mut()
        {
            *x = kernel::multiply(inverse, x);
            return;
        }
        self.solve_in_place(x);
    }

    /// The same for numbers in the order of scalar rows.
    pub fn solve(&mut self, x: &mut [f64]) {
        let mut placed = std::mem::take(&mut self.placed);
        for (x, &place) in x.iter().zip(&self.places) {
            placed[place] = *x;
        }
        self.solve_in_place(&mut placed);
        for (x, &place) in x.iter_mut().zip(&self.places) {
            *x = placed[place];
        }
        self.placed = placed;
    }

    /// The same with the factor of another matrix of the same layout.
    pub fn solve_with(&mut self, other: &Self, x: &mut [f64]) {
        for (x, &place) in x.iter().zip(&self.places) {
            self.placed[place] = *x;
        }
        other.solve_in_place(&mut self.placed);
        for (x, &place) in x.iter_mut().zip(&self.places) {
            *x = self.placed[place];
        }
    }

    /// Takes out of a solution of S + ε diag(S) what it has along vectors that S takes to zero: there is nothing else to tell but what
    /// rounding makes of it, divided by ε. The rest keeps its size to the part ε.
    pub fn clean(&mut self, epsilon: f64, x: &mut [f64]) {
        self.clean_at(epsilon, x, |row, _| row);
    }

    /// The same where the numbers stand at [`Self::places`].
    pub fn clean_placed(&mut self, epsilon: f64, x: &mut [f64]) {
        self.clean_at(epsilon, x, |_, place| place);
    }

    fn clean_at(&mut self, epsilon: f64, x: &mut [f64], at: impl Fn(usize, usize) -> usize) {
        let mut placed = std::mem::take(&mut self.placed);
        for (row, (&place, diagonal)) in self.places.iter().zip(&self.diagonal).enumerate() {
            placed[place] = epsilon * diagonal * x[at(row, place)];
        }
        self.solve_in_place(&mut placed);
        for (row, &place) in self.places.iter().enumerate() {
            x[at(row, place)] -= placed[place];
        }
        self.placed = placed;
    }

    #[inline(always)]
    fn solve_here(&self, x: &mut [f64]) {
        for Run { pivots, alike } in &self.runs {
            by_kind!(
                alike,
                N, W, beside => self.forward::<N, W>(pivots, beside, x),
                self.forward_mixed(pivots, x)
            );
        }
        for Run { pivots, alike } in self.runs.iter().rev() {
            by_kind!(
                alike,
                N, W, beside => self.backward::<N, W>(pivots, beside, x),
                self.backward_mixed(pivots, x)
            );
        }
    }

    /// Takes what pivots that are alike know off the right-hand sides of those after them.
    #[inline(always)]
    fn forward<const N: usize, const W: usize>(&self, pivots: &Range<usize>, beside: usize, x: &mut [f64]) {
        let (false, Some(first)) = (beside == 0, self.pivots[pivots.clone()].first()) else { return };
        let blocks = self.factors[first.diagonal..].chunks_exact((1 + beside) * N * W);
        let others = self.beside[first.beside.start..].chunks_exact(beside);
        let mut at = narrow(first.place);
        for (blocks, others) in blocks.zip(others).take(pivots.len()) {
            let (_, blocks) = blocks.split_at(N * W);
            let Some(&y) = numbers::<W>(x, at) else { return };
            for (block, other) in blocks.as_chunks::<W>().0.as_chunks::<N>().0.iter().zip(others) {
                if let Some(target) = numbers_mut::<W>(x, other.place) {
                    kernel::subtract(block, &y, target);
                }
            }
            at += const { narrow(W) };
        }
    }

    /// Solutions of pivots that are alike, those after them being known.
    #[inline(always)]
    fn backward<const N: usize, const W: usize>(&self, pivots: &Range<usize>, beside: usize, x: &mut [f64]) {
        let [first, ..] = &self.pivots[pivots.clone()] else { return };
        if beside == 0 {
            self.alone::<N, W>(first, pivots.len(), x);
            return;
        }
        let at = first.diagonal..first.diagonal + pivots.len() * (1 + beside) * N * W;
        let blocks = self.factors[at.clone()].chunks_exact((1 + beside) * N * W);
        let turned = self.values[at].chunks_exact((1 + beside) * N * W);
        let mut others = &self.beside[first.beside.start..first.beside.start + pivots.len() * beside];
        let mut at = narrow(first.place + pivots.len() * W);
        for (blocks, turned) in blocks.zip(turned).rev() {
            at -= const { narrow(W) };
            let (rest, own) = others.split_at(others.len() - beside);
            others = rest;
            let Some(inverse) = blocks.as_chunks::<W>().0.first_chunk::<N>() else { return };
            let Some(y) = numbers::<W>(x, at) else { return };
            let mut solution = kernel::multiply(inverse, y);
            let (_, turned) = turned.split_at(N * W);
            for (block, other) in turned.as_chunks::<W>().0.as_chunks::<N>().0.iter().zip(own) {
                if let Some(source) = numbers::<W>(x, other.place) {
                    kernel::subtract(block, source, &mut solution);
                }
            }
            if let Some(out) = numbers_mut::<W>(x, at) {
                *out = solution;
            }
        }
    }

    /// Solutions of so many pivots with nothing beside them.
    #[inline(always)]
    fn alone<const N: usize, const W: usize>(&self, first: &Pivot, count: usize, x: &mut [f64]) {
        let blocks = self.factors[first.diagonal..].as_chunks::<W>().0.as_chunks::<N>().0;
        for (inverse, x) in blocks.iter().zip(x[first.place..].as_chunks_mut::<W>().0).take(count) {
            *x = kernel::multiply(inverse, x);
        }
    }

    /// The same for one pivot whose blocks are of different widths, or wider than those of joints.
    #[inline(always)]
    fn forward_mixed(&self, pivots: &Range<usize>, x: &mut [f64]) {
        let pivot = &self.pivots[pivots.start];
        by_size!(pivot.size, N, W => self.forward_one::<N, W>(pivot, x), {
            let (before, behind) = x.split_at_mut(pivot.place + pivot.size);
            for other in &self.beside[pivot.beside.clone()] {
                let target = &mut behind[other.place as usize - pivot.place - pivot.size..];
                wide::forward(&before[pivot.place..], &self.factors[other.offset..], other.columns, target);
            }
        });
    }

    #[inline(always)]
    fn forward_one<const N: usize, const W: usize>(&self, pivot: &Pivot, x: &mut [f64]) {
        let Some(&y) = x[pivot.place..].first_chunk::<W>() else { return };
        for other in &self.beside[pivot.beside.clone()] {
            let (block, target) = (&self.factors[other.offset..], &mut x[other.place as usize..]);
            if other.columns == N
                && let (Some(block), Some(target)) = (rows::<N, W>(block), target.first_chunk_mut::<W>())
            {
                kernel::subtract(block, &y, target);
            } else {
                by_size!(
                    other.columns, M, V => if let (Some(block), Some(target)) =
                        (rows::<N, V>(block), target.first_chunk_mut::<V>())
                    {
                        kernel::subtract_rows::<N, M, V>(block, &y, target);
                    },
                    wide::forward(&y[..N], block, other.columns, target)
                );
            }
        }
    }

    /// The same for one pivot whose blocks are of different widths, or wider than those of joints.
    #[inline(always)]
    fn backward_mixed(&self, pivots: &Range<usize>, x: &mut [f64]) {
        let pivot = &self.pivots[pivots.start];
        by_size!(pivot.size, N, W => self.backward_one::<N, W>(pivot, x), self.backward_wide(pivot, x));
    }

    #[inline(always)]
    fn backward_one<const N: usize, const W: usize>(&self, pivot: &Pivot, x: &mut [f64]) {
        let inverse = rows::<N, W>(&self.factors[pivot.diagonal..]);
        let (Some(inverse), Some(y)) = (inverse, x[pivot.place..].first_chunk::<W>()) else { return };
        let mut solution = kernel::multiply(inverse, y);
        for other in &self.beside[pivot.beside.clone()] {
            let source = &x[other.place as usize..];
            if other.columns == N
                && let (Some(block), Some(source)) =
                    (rows::<N, W>(&self.values[other.offset..]), source.first_chunk::<W>())
            {
                kernel::subtract(block, source, &mut solution);
            } else {
                let block = &self.factors[other.offset..];
                by_size!(
                    other.columns, M, V => if let (Some(block), Some(source)) =
                        (rows::<N, V>(block), source.first_chunk::<M>())
                    {
                        kernel::subtract_products(block, source, &mut solution);
                    },
                    wide::backward(block, &source[..other.columns], &mut solution[..N])
                );
            }
        }
        if let Some(out) = x[pivot.place..].first_chunk_mut::<W>() {
            *out = solution;
        }
    }

    fn backward_wide(&self, pivot: &Pivot, x: &mut [f64]) {
        let (n, own) = (pivot.size, pivot.place..pivot.place + pivot.size);
        let mut solution = vec![0.0; n];
        wide::multiply(
            n,
            &self.factors[pivot.diagonal..pivot.diagonal + n * n],
            &x[own.clone()],
            &mut solution,
        );
        for other in &self.beside[pivot.beside.clone()] {
            let source = &x[other.place as usize..][..other.columns];
            wide::backward(&self.factors[other.offset..], source, &mut solution);
        }
        x[own].copy_from_slice(&solution);
    }
}
