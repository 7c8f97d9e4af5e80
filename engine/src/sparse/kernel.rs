//! Dense kernels of the block factorization, compiled for the sizes that joints have.
//!
//! `fused` says whether the processor multiplies and adds in one instruction; it is a constant wherever these are inlined.

/// Pivots above this part of the diagonal let a small block be inverted by its minors, with one division.
const FAR_FROM_SINGULAR: f64 = 1e-3;

/// a b + c.
#[inline(always)]
fn add(fused: bool, a: f64, b: f64, c: f64) -> f64 {
    if fused { a.mul_add(b, c) } else { a * b + c }
}

/// Inverse of a symmetric block, of which the lower triangle is read. `reference` is the diagonal of S, or infinite for
/// rows that are left out. Returns the pivots relative to it as well, infinite for rows that were left out; one not above
/// `skip` drops its row.
#[inline(always)]
pub fn invert<const N: usize>(
    fused: bool,
    block: &[[f64; N]; N],
    reference: &[f64; N],
    skip: f64,
) -> ([[f64; N]; N], [f64; N]) {
    if N == 2 || N == 3 {
        let (inverse, relative) = by_minors(fused, block, reference);
        // A comparison that is false for NaN as well.
        if relative.iter().all(|&r| r > FAR_FROM_SINGULAR.max(skip)) {
            return (inverse, relative);
        }
    }
    by_elimination(fused, block, reference, skip)
}

/// The inverse of two or three rows from their minors.
#[inline(always)]
fn by_minors<const N: usize>(
    fused: bool,
    block: &[[f64; N]; N],
    reference: &[f64; N],
) -> ([[f64; N]; N], [f64; N]) {
    let mut inverse = [[0.0; N]; N];
    let minor = |a: f64, b: f64, c: f64, d: f64| add(fused, a, b, -(c * d));
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
    let determinant = add(fused, a, first[0], add(fused, b, first[1], d * first[2]));
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
fn by_elimination<const N: usize>(
    fused: bool,
    block: &[[f64; N]; N],
    reference: &[f64; N],
    skip: f64,
) -> ([[f64; N]; N], [f64; N]) {
    let mut inverse = [[0.0; N]; N];
    let mut l = [[0.0; N]; N];
    let mut reciprocal = [0.0; N];
    let mut all = [f64::INFINITY; N];
    for i in 0..N {
        let mut row = block[i];
        for k in 0..i {
            for p in 0..k {
                row[k] = add(fused, -row[p], l[k][p], row[k]);
            }
        }
        let mut pivot = block[i][i];
        for k in 0..i {
            l[i][k] = row[k] * reciprocal[k];
            pivot = add(fused, -row[k], l[i][k], pivot);
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
                sum = add(fused, l[i][p], m[p][k], sum);
            }
            m[i][k] = -sum;
        }
    }
    for r in 0..N {
        for c in 0..=r {
            let mut sum = 0.0;
            for i in r..N {
                sum = add(fused, m[i][r] * reciprocal[i], m[i][c], sum);
            }
            inverse[r][c] = sum;
            inverse[c][r] = sum;
        }
    }
    (inverse, all)
}

#[inline(always)]
fn dot<const N: usize>(fused: bool, a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = a[0] * b[0];
    for p in 1..N {
        sum = add(fused, a[p], b[p], sum);
    }
    sum
}

/// The row aᵀ M.
#[inline(always)]
fn row_times<const N: usize>(fused: bool, a: &[f64; N], matrix: &[[f64; N]; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for c in 0..N {
        sum[c] = a[0] * matrix[0][c];
    }
    for p in 1..N {
        for c in 0..N {
            sum[c] = add(fused, a[p], matrix[p][c], sum[c]);
        }
    }
    sum
}

/// E ← B D⁻¹ row by row.
#[inline(always)]
pub fn scale<const N: usize>(fused: bool, inverse: &[[f64; N]; N], block: &[f64], out: &mut [f64]) {
    let (rows, out) = (block.as_chunks::<N>().0, out.as_chunks_mut::<N>().0);
    // The commonest case, all joints of one kind, with every length known.
    if let (Some(rows), Some(out)) = (rows.first_chunk::<N>(), out.first_chunk_mut::<N>())
        && block.len() == N * N
    {
        for i in 0..N {
            out[i] = row_times(fused, &rows[i], inverse);
        }
        return;
    }
    for (row, out) in rows.iter().zip(out) {
        *out = row_times(fused, row, inverse);
    }
}

/// target −= E Bᵀ, where the rows of B are `columns` in number; of a diagonal block the lower triangle, which is all that is
/// read of it.
#[inline(always)]
pub fn update<const N: usize>(
    fused: bool,
    scaled: &[f64],
    block: &[f64],
    columns: usize,
    diagonal: bool,
    target: &mut [f64],
) {
    let scaled = scaled.as_chunks::<N>().0;
    let block = block.as_chunks::<N>().0;
    let less = |e: &[f64; N], b: &[f64; N], x: f64| {
        let mut x = x;
        for p in 0..N {
            x = add(fused, -e[p], b[p], x);
        }
        x
    };
    if let (Some(e), Some(b), Some(out)) = (
        scaled.first_chunk::<N>(),
        block.first_chunk::<N>(),
        target.as_chunks_mut::<N>().0.first_chunk_mut::<N>(),
    ) && scaled.len() == N
        && columns == N
    {
        for i in 0..N {
            for k in 0..if diagonal { i + 1 } else { N } {
                out[i][k] = less(&e[i], &b[k], out[i][k]);
            }
        }
        return;
    }
    for (e, out) in scaled.iter().zip(target.chunks_exact_mut(columns)) {
        for (b, out) in block.iter().zip(out) {
            *out = less(e, b, *out);
        }
    }
}

/// y_i −= E y_j.
#[inline(always)]
pub fn forward<const N: usize>(fused: bool, scaled: &[f64], y: &[f64; N], target: &mut [f64]) {
    let rows = scaled.as_chunks::<N>().0;
    if let (Some(rows), Some(out)) = (rows.first_chunk::<N>(), target.first_chunk_mut::<N>())
        && scaled.len() == N * N
    {
        for i in 0..N {
            out[i] -= dot(fused, &rows[i], y);
        }
        return;
    }
    for (e, out) in rows.iter().zip(target) {
        *out -= dot(fused, e, y);
    }
}

/// x_j −= Eᵀ x_i.
#[inline(always)]
pub fn backward<const N: usize>(fused: bool, scaled: &[f64], source: &[f64], x: &mut [f64; N]) {
    let rows = scaled.as_chunks::<N>().0;
    if let (Some(rows), Some(source)) = (rows.first_chunk::<N>(), source.first_chunk::<N>())
        && scaled.len() == N * N
    {
        let known = row_times(fused, source, rows);
        for p in 0..N {
            x[p] -= known[p];
        }
        return;
    }
    for (e, value) in rows.iter().zip(source) {
        for p in 0..N {
            x[p] = add(fused, -e[p], *value, x[p]);
        }
    }
}

/// M x for a symmetric matrix.
#[inline(always)]
pub fn multiply<const N: usize>(fused: bool, matrix: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    row_times(fused, x, matrix)
}
