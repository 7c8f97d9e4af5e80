//! Inertia of bodies about the centre of mass, and its inverse, L side by side.

use crate::dynamics::series::lanes::{
    Lane, LaneVector, Natural, inverse_root, less, negative, plus, scaled, sum, times,
};

/// Σ Ī_k e_k e_kᵀ, the second term of I_g = Σ Ī_k (|e_k|² 1 − e_k e_kᵀ): xx, xy, yy, xz, yz, zz.
#[inline(always)]
pub fn products_of_inertia<const L: usize>(ibar: &LaneVector<L>, q: &Natural<L>) -> [Lane<L>; 6] {
    let mut products = [[0.0; L]; 6];
    for k in 0..3 {
        let e = &q[1 + k];
        let weighted = scaled(&ibar[k], e);
        for (sum, (i, j)) in products.iter_mut().zip([(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)]) {
            *sum = plus(&weighted[i], &e[j], sum);
        }
    }
    products
}

/// I_g⁻¹, and the lower triangle (00, 10, 11, 20, 21, 22) of C⁻¹ with I_g = C Cᵀ, from the products of inertia
/// (xx, xy, yy, xz, yz, zz) and what is added to the diagonal.
#[inline(always)]
pub fn invert_inertia<const L: usize>(
    products: &[Lane<L>; 6],
    extra: &Lane<L>,
) -> ([LaneVector<L>; 3], [Lane<L>; 6]) {
    let [xx, xy, yy, xz, yz, zz] = products;
    let mut diagonal = [[0.0; L]; 3];
    for (out, (a, b)) in diagonal.iter_mut().zip([(yy, zz), (xx, zz), (xx, yy)]) {
        *out = sum(&sum(a, b), extra);
    }
    // C⁻¹ of I_g = C Cᵀ, and I_g⁻¹ = C⁻ᵀ C⁻¹.
    let p0 = inverse_root(&diagonal[0]);
    let (l10, l20) = (negative(&times(xy, &p0)), negative(&times(xz, &p0)));
    let p1 = inverse_root(&less(&l10, &l10, &diagonal[1]));
    let l21 = times(&less(&l20, &l10, &negative(yz)), &p1);
    let p2 = inverse_root(&less(&l20, &l20, &less(&l21, &l21, &diagonal[2])));
    let m10 = negative(&times(&times(&l10, &p0), &p1));
    let m21 = negative(&times(&times(&l21, &p1), &p2));
    let m20 = negative(&times(&plus(&l20, &p0, &times(&l21, &m10)), &p2));
    let corner = plus(&m10, &p1, &times(&m20, &m21));
    let (side, low) = (times(&m20, &p2), times(&m21, &p2));
    let first = plus(&p0, &p0, &plus(&m10, &m10, &times(&m20, &m20)));
    let middle = plus(&p1, &p1, &times(&m21, &m21));
    let inverse = [[first, corner, side], [corner, middle, low], [side, low, times(&p2, &p2)]];
    (inverse, [p0, m10, p1, m20, m21, p2])
}
