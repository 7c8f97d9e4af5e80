//! Vectors whose components stand side by side in a vector of the processor, and what a body alone knows of an order from all orders
//! before it. Loops, no closures: those would not be compiled for the vectors in use.

use crate::dynamics::series::lanes::{
    Lane, LaneVector, Natural, difference_whole, plus_whole, rows_of_lanes, sum_whole, times_whole,
};
use crate::dynamics::series::recurrence::for_folded;
use pulp::Simd;

/// The components of a vector, and zero.
pub type Components = Lane<4>;

/// Zero.
pub const ZERO: Components = [0.0; 4];

/// The components one place on: those of a × b are those of a ∘ b′ − a′ ∘ b one place on.
#[inline(always)]
pub fn turned([x, y, z, rest]: Components) -> Components {
    [y, z, x, rest]
}

/// Components side by side.
#[inline(always)]
pub fn widened(x: &LaneVector<1>) -> Components {
    [x[0][0], x[1][0], x[2][0], 0.0]
}

/// Components one by one.
#[inline(always)]
pub fn column(&[x, y, z, _]: &Components) -> LaneVector<1> {
    [[x], [y], [z]]
}

/// Coordinates of a body, number by number.
#[inline(always)]
pub fn narrowed(x: &[Components; 4]) -> Natural<1> {
    let [r, u, v, w] = x;
    [column(r), column(u), column(v), column(w)]
}

/// Its directors.
#[inline(always)]
pub fn directors([_, e @ ..]: &[Components; 4]) -> &[Components; 3] {
    e
}

/// Σ a_k × b_k.
#[inline(always)]
pub fn cross<S: Simd>(simd: S, a: &[Components; 3], b: &[Components; 3]) -> Components {
    let (mut ahead, mut behind) = (ZERO, ZERO);
    for k in 0..3 {
        ahead = plus_whole(simd, &a[k], &turned(b[k]), &ahead);
        behind = plus_whole(simd, &turned(a[k]), &b[k], &behind);
    }
    turned(difference_whole(simd, &ahead, &behind))
}

/// Σ a_k m_k for the columns m_k of a matrix.
#[inline(always)]
pub fn combined<S: Simd>(simd: S, a: [f64; 3], columns: &[Components; 3]) -> Components {
    let first = times_whole(simd, &[a[0]; 4], &columns[0]);
    plus_whole(simd, &[a[2]; 4], &columns[2], &plus_whole(simd, &[a[1]; 4], &columns[1], &first))
}

#[inline(always)]
fn double<S: Simd>(simd: S, x: &Components) -> Components {
    sum_whole(simd, x, x)
}

/// κ times −Σ e_k(i) · e_l(n−i) over 0 < i < n for the six rigid-body rows: uu, vv, ww, uv, and uw, vw.
#[inline(always)]
pub fn gram<S: Simd>(simd: S, q: &[[Components; 4]], n: usize, kappa: f64) -> [Components; 2] {
    let mut sums = Products::default();
    let half = (n - 1) / 2;
    let (heads, tails) = (&q[1..=half], &q[n - half..n]);
    for_folded!(heads, tails, e, f => {
        sums.add(simd, e, f);
    });
    sums.gram(simd, n.is_multiple_of(2).then_some(&q[n / 2]), kappa)
}

/// Sums of e_k ∘ f_l, apart from those of e_l ∘ f_k, so that no sum waits for another.
#[derive(Default)]
struct Products([[Components; 3]; 3]);

impl Products {
    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, e: &[Components; 4], f: &[Components; 4]) {
        for k in 0..3 {
            for l in 0..3 {
                self.0[k][l] = plus_whole(simd, &e[1 + k], &f[1 + l], &self.0[k][l]);
            }
        }
    }

    /// −κ times the right-hand sides of the rigid-body rows: from each pair both ways, and from the one in the middle once.
    #[inline(always)]
    fn gram<S: Simd>(&self, simd: S, middle: Option<&[Components; 4]>, kappa: f64) -> [Components; 2] {
        let [[uu, uv, uw], [vu, vv, vw], [wu, wv, ww]] = &self.0;
        let mut all = [
            [double(simd, uu), double(simd, vv), double(simd, ww), sum_whole(simd, uv, vu)],
            [sum_whole(simd, uw, wu), sum_whole(simd, vw, wv), ZERO, ZERO],
        ];
        if let Some([_, u, v, w]) = middle {
            let [[uu, vv, ww, uv], [uw, vw, ..]] = &mut all;
            *uu = plus_whole(simd, u, u, uu);
            *vv = plus_whole(simd, v, v, vv);
            *ww = plus_whole(simd, w, w, ww);
            *uv = plus_whole(simd, u, v, uv);
            *uw = plus_whole(simd, u, w, uw);
            *vw = plus_whole(simd, v, w, vw);
        }
        let mut gamma = [ZERO; 2];
        for (out, sums) in gamma.iter_mut().zip(all) {
            let [x, y, z, _] = rows_of_lanes(simd, sums);
            *out = times_whole(simd, &[-kappa; 4], &sum_whole(simd, &sum_whole(simd, &x, &y), &z));
        }
        gamma
    }
}

/// Σ_k Σ e_k(i) × p_k(n−i) over 0 < i ≤ n: the part of the moment that lower orders make.
#[inline(always)]
pub fn moment<S: Simd>(simd: S, q: &[[Components; 4]], p: &[[Components; 3]], n: usize) -> Components {
    // For each director on its own, so that no sum waits for another.
    let (mut ahead, mut behind) = ([ZERO; 3], [ZERO; 3]);
    for_folded!(q[1..=n], p[..n], e, p => {
        for k in 0..3 {
            ahead[k] = plus_whole(simd, &e[1 + k], &turned(p[k]), &ahead[k]);
            behind[k] = plus_whole(simd, &turned(e[1 + k]), &p[k], &behind[k]);
        }
    });
    let mut all = ZERO;
    for k in 0..3 {
        all = sum_whole(simd, &all, &difference_whole(simd, &ahead[k], &behind[k]));
    }
    turned(all)
}

/// The right-hand sides of the rigid-body rows side by side.
pub fn packed([uu, vv, ww, uv, uw, vw]: &[Lane<1>; 6]) -> [Components; 2] {
    [[uu[0], vv[0], ww[0], uv[0]], [uw[0], vw[0], 0.0, 0.0]]
}
