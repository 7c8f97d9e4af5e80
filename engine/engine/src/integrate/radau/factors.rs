//! The linear systems of Newton's method, those of all blocks side by side.

use super::blocks::{Blocks, NONE, Pair, less_product, plus_product, plus_scaled};
use super::linear::RateJacobian;
use crate::integrate::wide::MOST_LANES;
use pulp::{Arch, Simd, WithSimd};
use triad_linalg::fma;

/// Factors of μ² I − μ C − K for the μ of all blocks, for one step size. With inverses in their place estimates of errors near 1e-12 are worse.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The step size, s; not a number where they belong to no matrix.
    pub h: f64,
    n: usize,
    groups: usize,
    mu: Vec<Pair>,
    /// P M = L U by columns, L below the diagonal without it.
    entries: Vec<Pair>,
    /// One by the diagonal of U.
    inverse: Vec<Pair>,
    /// The row that each one was exchanged with, in all blocks of a group alike.
    exchanged: Vec<usize>,
    right: Vec<Pair>,
}

/// One.
const ONE: Pair = [[1.0; MOST_LANES], [0.0; MOST_LANES]];

struct Factor<'a>(&'a mut Factors, &'a RateJacobian, &'a Blocks, f64);

impl WithSimd for Factor<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        self.0.factor_here(self.1, self.2, self.3)
    }
}

impl Factors {
    /// Room for n coordinates.
    pub fn new(n: usize, blocks: &Blocks) -> Self {
        let groups = blocks.groups;
        Self {
            h: f64::NAN,
            n,
            groups,
            mu: vec![NONE; groups],
            entries: vec![NONE; n * n * groups],
            inverse: vec![NONE; n * groups],
            exchanged: vec![0; n * groups],
            right: vec![NONE; n],
        }
    }

    /// They no longer belong to the matrices in use.
    pub fn forget(&mut self) {
        self.h = f64::NAN;
    }

    /// The eigenvalues over the step.
    #[inline(always)]
    pub fn mu(&self) -> &[Pair] {
        &self.mu
    }

    /// Finds those for a step of size h. False if a matrix is singular.
    pub fn factor(&mut self, jacobian: &RateJacobian, blocks: &Blocks, h: f64) -> bool {
        Arch::new().dispatch(Factor(self, jacobian, blocks, h))
    }

    #[inline(always)]
    fn factor_here(&mut self, jacobian: &RateJacobian, blocks: &Blocks, h: f64) -> bool {
        self.h = f64::NAN;
        for (mu, over) in self.mu.iter_mut().zip(blocks.over(h)) {
            *mu = over;
        }
        let n = self.n;
        for group in 0..self.groups {
            let mu = self.mu[group];
            let entries = &mut self.entries[group * n * n..][..n * n];
            let known = jacobian.stiffness.as_slice().iter().zip(jacobian.damping.as_slice());
            for (entry, (k, c)) in entries.iter_mut().zip(known) {
                for l in 0..MOST_LANES {
                    entry[0][l] = fma(-mu[0][l], *c, -*k);
                    entry[1][l] = -mu[1][l] * c;
                }
            }
            for entry in entries.iter_mut().step_by(n + 1) {
                *entry = plus_product(*entry, &mu, &mu);
            }
            for k in 0..n {
                if !self.eliminate(group, k) {
                    return false;
                }
            }
        }
        self.h = h;
        true
    }

    /// Eliminates column k. False if it has no pivot.
    #[inline(always)]
    fn eliminate(&mut self, group: usize, k: usize) -> bool {
        let n = self.n;
        let entries = &mut self.entries[group * n * n..][..n * n];
        let (mut pivot, mut most) = (k, 0.0);
        for (i, x) in entries[k * n..][..n].iter().enumerate().skip(k) {
            let size = x.as_flattened().iter().map(|x| x.abs()).sum::<f64>();
            if size > most {
                (pivot, most) = (i, size);
            }
        }
        self.exchanged[group * n + k] = pivot;
        if pivot != k {
            for column in entries.chunks_exact_mut(n) {
                column.swap(k, pivot);
            }
        }
        let (before, behind) = entries.split_at_mut((k + 1) * n);
        let column = &mut before[k * n..];
        let [re, im] = column[k];
        let mut inverse = NONE;
        let mut regular = true;
        for l in 0..MOST_LANES {
            let square = fma(re[l], re[l], im[l] * im[l]);
            regular &= square > 0.0 && square.is_finite();
            (inverse[0][l], inverse[1][l]) = (re[l] / square, -im[l] / square);
        }
        self.inverse[group * n + k] = inverse;
        for x in &mut column[k + 1..] {
            *x = plus_product(NONE, x, &inverse);
        }
        for other in behind.chunks_exact_mut(n) {
            let factor = other[k];
            for (x, l) in other[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *x = less_product(*x, l, &factor);
            }
        }
        regular
    }

    /// (μ I − J)⁻¹ r of all blocks, in place: rows of all numbers. From the halves of (μ I − J)(a, b) = r:
    /// b = μ a − r_a, (μ² − μ C − K) a = r_b + (μ − C) r_a.
    #[inline(always)]
    pub fn solve(&mut self, jacobian: &RateJacobian, r: &mut [Pair]) {
        let (n, groups) = (self.n, self.groups);
        let (a, b) = r.split_at_mut(n * groups);
        for group in 0..groups {
            let mu = self.mu[group];
            let right = &mut self.right[..n];
            let damping = jacobian.damping.as_slice();
            for (i, right) in right.iter_mut().enumerate() {
                let mut sum = plus_product(b[i * groups + group], &mu, &a[i * groups + group]);
                for (c, x) in damping[i..].iter().step_by(n).zip(a[group..].iter().step_by(groups)) {
                    sum = plus_scaled(sum, x, -c);
                }
                *right = sum;
            }
            let exchanged = &self.exchanged[group * n..][..n];
            let factors = (&self.entries[group * n * n..][..n * n], &self.inverse[group * n..][..n]);
            solve_group(factors, exchanged, right);
            for (i, right) in right.iter().enumerate() {
                let (a, b) = (&mut a[i * groups + group], &mut b[i * groups + group]);
                // μ a − r_a.
                *b = plus_product(less_product(NONE, a, &ONE), &mu, right);
                *a = *right;
            }
        }
    }
}

/// x ← M⁻¹ x of one group of blocks.
#[inline(always)]
fn solve_group((entries, inverse): (&[Pair], &[Pair]), exchanged: &[usize], x: &mut [Pair]) {
    let n = x.len();
    for (k, &other) in exchanged.iter().enumerate() {
        x.swap(k, other);
    }
    for i in 1..n {
        let (known, rest) = x.split_at_mut(i);
        let mut sum = rest[0];
        for (x, l) in known.iter().zip(entries[i..].iter().step_by(n)) {
            sum = less_product(sum, l, x);
        }
        rest[0] = sum;
    }
    for i in (0..n).rev() {
        let (rest, known) = x.split_at_mut(i + 1);
        let mut sum = rest[i];
        for (x, u) in known.iter().zip(entries[(i + 1) * n..].iter().skip(i).step_by(n)) {
            sum = less_product(sum, u, x);
        }
        rest[i] = plus_product(NONE, &sum, &inverse[i]);
    }
}
