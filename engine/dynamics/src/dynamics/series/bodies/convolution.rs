//! What bodies in space know of an order from all orders before it: sums over products of coefficients.

use crate::dynamics::series::lanes::{Lane, LaneVector, Natural, add_cross, negative, plus, sum};
use crate::dynamics::series::recurrence::for_folded;

/// −Σ e_k(i) · e_l(n−i) over 0 < i < n for the six rigid-body rows, from the series q.
#[inline(always)]
pub fn gram<const L: usize>(q: &[Natural<L>], n: usize) -> [Lane<L>; 6] {
    if cfg!(target_family = "wasm") && L > PAIR {
        in_parts::<L, PAIR, 6>(|at| gram_of(q, n, at))
    } else {
        gram_of(q, n, 0)
    }
}

/// Numbers in a vector of WebAssembly. The nine sums of four bodies fill eighteen of those, and a processor holds sixteen: two
/// bodies after the other two are faster there than four at once, which are stored and read back with each product.
const PAIR: usize = 2;

/// What a function finds of W lanes, given which of them, for all L.
#[inline(always)]
fn in_parts<const L: usize, const W: usize, const N: usize>(
    of: impl Fn(usize) -> [Lane<W>; N],
) -> [Lane<L>; N] {
    let mut all = [[0.0; L]; N];
    for at in 0..L / W {
        for (all, part) in all.iter_mut().zip(of(at)) {
            all.as_chunks_mut().0[at] = part;
        }
    }
    all
}

/// The `at`-th W lanes of a number.
#[inline(always)]
fn part<const L: usize, const W: usize>(x: &Lane<L>, at: usize) -> Lane<W> {
    x.as_chunks().0[at]
}

/// [`gram`] of the `at`-th W lanes.
#[inline(always)]
fn gram_of<const L: usize, const W: usize>(q: &[Natural<L>], n: usize, at: usize) -> [Lane<W>; 6] {
    let mut sums = Products::default();
    let half = (n - 1) / 2;
    let (heads, tails) = (&q[1..=half], &q[n - half..n]);
    for_folded!(heads, tails, a, b => {
        sums.add(a, b, at);
    });
    let mut all = sums.symmetric();
    if n.is_multiple_of(2) {
        let mut square = Products::default();
        square.add(&q[n / 2], &q[n / 2], at);
        for (sum, square) in all.iter_mut().zip(square.symmetric()) {
            *sum = plus(&[0.5; W], &square, sum);
        }
    }
    let [uu, vv, ww, uv, uw, vw] = &all;
    [negative(uu), negative(vv), negative(ww), negative(uv), negative(uw), negative(vw)]
}

/// Sums of e_k · f_l, apart from those of e_l · f_k, so that no sum waits for another.
struct Products<const W: usize> {
    /// uu, vv, ww.
    same: [Lane<W>; 3],
    /// uv, uw, vw, and vu, wu, wv.
    other: [[Lane<W>; 3]; 2],
}

impl<const W: usize> Default for Products<W> {
    #[inline(always)]
    fn default() -> Self {
        Self { same: [[0.0; W]; 3], other: [[[0.0; W]; 3]; 2] }
    }
}

impl<const W: usize> Products<W> {
    /// Adds the products of the `at`-th W lanes.
    #[inline(always)]
    fn add<const L: usize>(&mut self, e: &Natural<L>, f: &Natural<L>, at: usize) {
        let [[uv, uw, vw], [vu, wu, wv]] = &mut self.other;
        let [uu, vv, ww] = &mut self.same;
        for c in 0..3 {
            let [u, v, w] = [1, 2, 3].map(|k| part(&e[k][c], at));
            let [x, y, z] = [1, 2, 3].map(|k| part(&f[k][c], at));
            *uu = plus(&u, &x, uu);
            *uv = plus(&u, &y, uv);
            *uw = plus(&u, &z, uw);
            *vu = plus(&v, &x, vu);
            *vv = plus(&v, &y, vv);
            *vw = plus(&v, &z, vw);
            *wu = plus(&w, &x, wu);
            *wv = plus(&w, &y, wv);
            *ww = plus(&w, &z, ww);
        }
    }

    /// Entries e_k · f_l + e_l · f_k for the six rigid-body rows uu, vv, ww, uv, uw, vw.
    #[inline(always)]
    fn symmetric(&self) -> [Lane<W>; 6] {
        let [[uv, uw, vw], [vu, wu, wv]] = &self.other;
        let [uu, vv, ww] = &self.same;
        [sum(uu, uu), sum(vv, vv), sum(ww, ww), sum(uv, vu), sum(uw, wu), sum(vw, wv)]
    }
}

/// Σ_k Σ e_k(i) × p_k(n−i) over 0 < i ≤ n: the part of the moment that lower orders make.
#[inline(always)]
pub fn moment<const L: usize>(q: &[Natural<L>], p: &[[LaneVector<L>; 3]], n: usize) -> LaneVector<L> {
    if cfg!(target_family = "wasm") && L > PAIR {
        in_parts::<L, PAIR, 3>(|at| moment_of(q, p, n, at))
    } else {
        moment_of(q, p, n, 0)
    }
}

/// [`moment`] of the `at`-th W lanes.
#[inline(always)]
fn moment_of<const L: usize, const W: usize>(
    q: &[Natural<L>],
    p: &[[LaneVector<L>; 3]],
    n: usize,
    at: usize,
) -> LaneVector<W> {
    // For each director on its own, so that no sum waits for another.
    let mut sums = [[[0.0; W]; 3]; 3];
    for_folded!(q[1..=n], p[..n], e, p => {
        for k in 0..3 {
            let [e, p] = [&e[1 + k], &p[k]].map(|vector| [0, 1, 2].map(|c| part(&vector[c], at)));
            add_cross(&mut sums[k], &e, &p);
        }
    });
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
    products.add(e, f, 0);
    products.symmetric()
}
