//! Vectors in the plane, L side by side, and the convolutions of planar bodies.

use crate::dynamics::series::lanes::{Lane, less, plus, sum, times};
use crate::dynamics::series::recurrence::for_folded;
use triad_linalg::fma;

/// A vector in the plane for each lane.
pub type Pair<const L: usize> = [Lane<L>; 2];

/// A number for each lane.
#[inline(always)]
pub fn each<const L: usize>(of: impl Fn(usize) -> f64) -> Lane<L> {
    let mut out = [0.0; L];
    for (l, out) in out.iter_mut().enumerate() {
        *out = of(l);
    }
    out
}

/// a z + b J z.
#[inline(always)]
pub fn turned<const L: usize>([a, b]: &Pair<L>, z: &Pair<L>) -> Pair<L> {
    let mut out = [[0.0; L]; 2];
    for l in 0..L {
        out[0][l] = fma(a[l], z[0][l], -(b[l] * z[1][l]));
        out[1][l] = fma(a[l], z[1][l], b[l] * z[0][l]);
    }
    out
}

/// The normal component of a × b.
#[inline(always)]
pub fn cross<const L: usize>(a: &Pair<L>, b: &Pair<L>) -> Lane<L> {
    each(|l| a[0][l] * b[1][l] - a[1][l] * b[0][l])
}

/// −κ times coefficient n of z · z, but for the terms with coefficients 0 and n.
#[inline(always)]
pub fn gram<const L: usize>(q: &[[Pair<L>; 2]], n: usize, kappa: f64) -> Lane<L> {
    let mut sums = [[0.0; L]; 2];
    let half = (n - 1) / 2;
    let (heads, tails) = (&q[1..=half], &q[n - half..n]);
    for_folded!(heads, tails, [_, a], [_, b] => {
        sums[0] = plus(&a[0], &b[0], &sums[0]);
        sums[1] = plus(&a[1], &b[1], &sums[1]);
    });
    let half = sum(&sums[0], &sums[1]);
    let mut all = sum(&half, &half);
    if n.is_multiple_of(2) {
        let [_, z] = &q[n / 2];
        all = plus(&z[0], &z[0], &plus(&z[1], &z[1], &all));
    }
    times(&[-kappa; L], &all)
}

/// Coefficient n of z × p, but for the term with coefficient n of p.
#[inline(always)]
pub fn moment<const L: usize>(q: &[[Pair<L>; 2]], p: &[Pair<L>], n: usize) -> Lane<L> {
    let mut sums = [[0.0; L]; 2];
    for_folded!(q[1..=n], p[..n], [_, z], p => {
        sums[0] = plus(&z[0], &p[1], &sums[0]);
        sums[1] = less(&z[1], &p[0], &sums[1]);
    });
    sum(&sums[0], &sums[1])
}
