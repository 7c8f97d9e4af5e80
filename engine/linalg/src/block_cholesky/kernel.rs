//! Dense kernels of the block factorization, compiled for the sizes that joints have.
//!
//! A block of N rows is an array of N rows of W numbers; W may be larger than the block is wide, so that a row fills a
//! vector of the processor, and what stands behind its end is zero. Products are added by [`fma`]: the same bits on
//! every processor.

use crate::arithmetic::fma;

/// Pivots, relative to the diagonal, above which a small block is inverted by its minors, with one division; below, rounding
/// of the minors would count, and the block is eliminated row by row.
const FAR_FROM_SINGULAR: f64 = 1e-3;

/// Inverse of a symmetric block, of which the lower triangle is read. `reference` is the diagonal of S, or infinite for
/// rows that are left out. Returns the pivots relative to it as well, infinite for rows that were left out; one not above
/// `skip` drops its row.
#[inline(always)]
pub fn invert<const N: usize, const W: usize>(
    block: &[[f64; W]; N],
    reference: &[f64; N],
    skip: f64,
) -> ([[f64; W]; N], [f64; N]) {
    if N == 2 || N == 3 {
        let (inverse, relative) = by_minors(block, reference);
        // A comparison that is false for NaN as well.
        if relative.iter().all(|&r| r > FAR_FROM_SINGULAR.max(skip)) {
            return (inverse, relative);
        }
    }
    by_elimination(block, reference, skip)
}

/// The inverse of two or three rows from their minors.
#[inline(always)]
fn by_minors<const N: usize, const W: usize>(
    block: &[[f64; W]; N],
    reference: &[f64; N],
) -> ([[f64; W]; N], [f64; N]) {
    let mut inverse = [[0.0; W]; N];
    let minor = |a: f64, b: f64, c: f64, d: f64| fma(a, b, -(c * d));
    let mut relative = [0.0; N];
    relative[0] = block[0][0] / reference[0];
    let second = minor(block[0][0], block[1][1], block[1][0], block[1][0]);
    relative[1] = second / (block[0][0] * reference[1]);
    if N == 2 {
        let scale = 1.0 / second;
        let corner = -(block[1][0] * scale);
        (inverse[0][0], inverse[1][1]) = (block[1][1] * scale, block[0][0] * scale);
        (inverse[0][1], inverse[1][0]) = (corner, corner);
        return (inverse, relative);
    }
    let (a, b, c) = (block[0][0], block[1][0], block[1][1]);
    let (d, e, f) = (block[2][0], block[2][1], block[2][2]);
    let first = [minor(c, f, e, e), minor(d, e, b, f), minor(b, e, c, d)];
    let determinant = fma(a, first[0], fma(b, first[1], d * first[2]));
    relative[2] = determinant / (second * reference[2]);
    let scale = 1.0 / determinant;
    let (middle, corner) = (minor(a, f, d, d) * scale, minor(b, d, a, e) * scale);
    let first = first.map(|x| x * scale);
    for c in 0..3 {
        inverse[0][c] = first[c];
        inverse[c][0] = first[c];
    }
    (inverse[1][1], inverse[2][2]) = (middle, second * scale);
    (inverse[1][2], inverse[2][1]) = (corner, corner);
    (inverse, relative)
}

/// The inverse by L D Lᵀ.
#[inline(always)]
fn by_elimination<const N: usize, const W: usize>(
    block: &[[f64; W]; N],
    reference: &[f64; N],
    skip: f64,
) -> ([[f64; W]; N], [f64; N]) {
    let mut inverse = [[0.0; W]; N];
    let mut l = [[0.0; N]; N];
    let mut reciprocal = [0.0; N];
    let mut all = [f64::INFINITY; N];
    for i in 0..N {
        let mut row = [0.0; N];
        row.copy_from_slice(&block[i][..N]);
        for k in 0..i {
            for p in 0..k {
                row[k] = fma(-row[p], l[k][p], row[k]);
            }
        }
        let mut pivot = block[i][i];
        for k in 0..i {
            l[i][k] = row[k] * reciprocal[k];
            pivot = fma(-row[k], l[i][k], pivot);
        }
        if reference[i] == f64::INFINITY {
            continue;
        }
        let relative = if reference[i] == 0.0 { 0.0 } else { pivot / reference[i] };
        all[i] = relative;
        // A comparison that lets NaN through, so that it is not mistaken for a dependent row.
        reciprocal[i] = if relative <= skip { 0.0 } else { 1.0 / pivot };
    }
    // M = L⁻¹, then Mᵀ diag(reciprocal) M.
    let mut m = [[0.0; N]; N];
    for i in 0..N {
        m[i][i] = 1.0;
        for k in 0..i {
            let mut sum = l[i][k];
            for p in k + 1..i {
                sum = fma(l[i][p], m[p][k], sum);
            }
            m[i][k] = -sum;
        }
    }
    for r in 0..N {
        for c in 0..=r {
            let mut sum = 0.0;
            for i in r..N {
                sum = fma(m[i][r] * reciprocal[i], m[i][c], sum);
            }
            inverse[r][c] = sum;
            inverse[c][r] = sum;
        }
    }
    (inverse, all)
}

/// The row Σ a_p M_p of the rows of a matrix.
#[inline(always)]
fn row_times<const N: usize, const W: usize>(a: &[f64; N], matrix: &[[f64; W]; N]) -> [f64; W] {
    let mut sum = [0.0; W];
    for c in 0..W {
        sum[c] = a[0] * matrix[0][c];
    }
    for p in 1..N {
        for c in 0..W {
            sum[c] = fma(a[p], matrix[p][c], sum[c]);
        }
    }
    sum
}

/// U ← D⁻¹ B for a block as wide as it is high.
#[inline(always)]
pub fn scale<const N: usize, const W: usize>(
    inverse: &[[f64; W]; N],
    block: &[[f64; W]; N],
    out: &mut [[f64; W]; N],
) {
    for i in 0..N {
        let mut row = [0.0; N];
        row.copy_from_slice(&inverse[i][..N]);
        out[i] = row_times(&row, block);
    }
}

/// target −= Uᵀ B for blocks as wide as they are high.
#[inline(always)]
pub fn update<const N: usize, const W: usize>(
    scaled: &[[f64; W]; N],
    block: &[[f64; W]; N],
    target: &mut [[f64; W]; N],
) {
    for i in 0..N {
        for p in 0..N {
            for c in 0..W {
                target[i][c] = fma(-scaled[p][i], block[p][c], target[i][c]);
            }
        }
    }
}

/// Uᵀ of a block as wide as it is high.
#[inline(always)]
pub fn turn<const N: usize, const W: usize>(scaled: &[[f64; W]; N], out: &mut [[f64; W]; N]) {
    for i in 0..N {
        for p in 0..N {
            out[i][p] = scaled[p][i];
        }
    }
}

/// target −= Uᵀ y for a block as wide as it is high.
#[inline(always)]
pub fn subtract<const N: usize, const W: usize>(scaled: &[[f64; W]; N], y: &[f64; W], target: &mut [f64; W]) {
    for p in 0..N {
        for c in 0..W {
            target[c] = fma(-y[p], scaled[p][c], target[c]);
        }
    }
}

/// target −= Uᵀ y for a block that is M wide.
#[inline(always)]
pub fn subtract_rows<const N: usize, const M: usize, const V: usize>(
    scaled: &[[f64; V]; N],
    y: &[f64],
    target: &mut [f64; V],
) {
    for (row, y) in scaled.iter().zip(y) {
        for c in 0..M {
            target[c] = fma(-y, row[c], target[c]);
        }
    }
}

/// x −= U y for a block that is M wide.
#[inline(always)]
pub fn subtract_products<const N: usize, const M: usize, const V: usize>(
    scaled: &[[f64; V]; N],
    y: &[f64; M],
    x: &mut [f64],
) {
    for (row, x) in scaled.iter().zip(x) {
        for c in 0..M {
            *x = fma(-row[c], y[c], *x);
        }
    }
}

/// M x for a symmetric matrix.
#[inline(always)]
pub fn multiply<const N: usize, const W: usize>(matrix: &[[f64; W]; N], x: &[f64; W]) -> [f64; W] {
    let mut factors = [0.0; N];
    factors.copy_from_slice(&x[..N]);
    row_times(&factors, matrix)
}
