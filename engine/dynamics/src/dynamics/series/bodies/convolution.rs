//! What bodies in space know of an order from all orders before it: sums over products of coefficients.

use crate::dynamics::series::lanes::{Lane, LaneVector, Natural, add_cross, negative, plus, sum};

/// −Σ e_k(i) · e_l(n−i) over 0 < i < n for the six rigid-body rows, from the series q.
#[inline(always)]
pub fn gram<const L: usize>(q: &[Natural<L>], n: usize) -> [Lane<L>; 6] {
    let mut sums = Products::default();
    let (heads, tails) = (q[1..n].iter(), q[1..n].iter().rev());
    for (a, b) in heads.zip(tails).take((n - 1) / 2) {
        sums.add(a, b);
    }
    let mut all = sums.symmetric();
    if n.is_multiple_of(2) {
        let mut square = Products::default();
        square.add(&q[n / 2], &q[n / 2]);
        for (sum, square) in all.iter_mut().zip(square.symmetric()) {
            *sum = plus(&[0.5; L], &square, sum);
        }
    }
    let [uu, vv, ww, uv, uw, vw] = &all;
    [negative(uu), negative(vv), negative(ww), negative(uv), negative(uw), negative(vw)]
}

/// Sums of e_k · f_l, apart from those of e_l · f_k, so that no sum waits for another.
struct Products<const L: usize> {
    /// uu, vv, ww.
    same: [Lane<L>; 3],
    /// uv, uw, vw, and vu, wu, wv.
    other: [[Lane<L>; 3]; 2],
}

impl<const L: usize> Default for Products<L> {
    #[inline(always)]
    fn default() -> Self {
        Self { same: [[0.0; L]; 3], other: [[[0.0; L]; 3]; 2] }
    }
}

impl<const L: usize> Products<L> {
    #[inline(always)]
    fn add(&mut self, [_, u, v, w]: &Natural<L>, [_, x, y, z]: &Natural<L>) {
        let [[uv, uw, vw], [vu, wu, wv]] = &mut self.other;
        let [uu, vv, ww] = &mut self.same;
        for c in 0..3 {
            *uu = plus(&u[c], &x[c], uu);
            *uv = plus(&u[c], &y[c], uv);
            *uw = plus(&u[c], &z[c], uw);
            *vu = plus(&v[c], &x[c], vu);
            *vv = plus(&v[c], &y[c], vv);
            *vw = plus(&v[c], &z[c], vw);
            *wu = plus(&w[c], &x[c], wu);
            *wv = plus(&w[c], &y[c], wv);
            *ww = plus(&w[c], &z[c], ww);
        }
    }

    /// Entries e_k · f_l + e_l · f_k for the six rigid-body rows uu, vv, ww, uv, uw, vw.
    #[inline(always)]
    fn symmetric(&self) -> [Lane<L>; 6] {
        let [[uv, uw, vw], [vu, wu, wv]] = &self.other;
        let [uu, vv, ww] = &self.same;
        [sum(uu, uu), sum(vv, vv), sum(ww, ww), sum(uv, vu), sum(uw, wu), sum(vw, wv)]
    }
}

/// Σ_k Σ e_k(i) × p_k(n−i) over 0 < i ≤ n: the part of the moment that lower orders make.
#[inline(always)]
pub fn moment<const L: usize>(q: &[Natural<L>], p: &[[LaneVector<L>; 3]], n: usize) -> LaneVector<L> {
    // For each director on its own, so that no sum waits for another.
    let mut sums = [[[0.0; L]; 3]; 3];
    for (e, p) in q[1..=n].iter().zip(p[..n].iter().rev()) {
        for k in 0..3 {
            add_cross(&mut sums[k], &e[1 + k], &p[k]);
        }
    }
    let [mut all, second, third] = sums;
    for c in 0..3 {
        all[c] = sum(&all[c], &sum(&second[c], &third[c]));
    }
    all
}

/// Entries e_k · f_l + e_l · f_k for the six rigid-body rows.
#[inline(always)]
pub fn symmetric<const L: usize>(e: &Natural<L>, f: &Natural<L>) -> [Lane<L>; 6] {
    let mut products = Products::default();
    products.add(e, f);
    products.symmetric()
}
