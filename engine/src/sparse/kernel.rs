//! Dense kernels of the block factorization, compiled for the sizes that joints have.

/// Inverse of a symmetric block, of which the lower triangle is read, by L D Lᵀ. `reference` is the diagonal of S, or
/// infinite for rows that are left out; `visit` sees each other pivot relative to it, and one not above `skip` drops its
/// row.
#[inline(always)]
pub fn invert<const N: usize>(
    block: &[[f64; N]; N],
    reference: &[f64; N],
    skip: f64,
    mut visit: impl FnMut(usize, f64),
) -> [[f64; N]; N] {
    let mut l = [[0.0; N]; N];
    let mut reciprocal = [0.0; N];
    for i in 0..N {
        let mut row = block[i];
        for k in 0..i {
            for p in 0..k {
                row[k] -= row[p] * l[k][p];
            }
        }
        let mut pivot = block[i][i];
        for k in 0..i {
            l[i][k] = row[k] * reciprocal[k];
            pivot -= row[k] * l[i][k];
        }
        let relative = if reference[i] == 0.0 { 0.0 } else { pivot / reference[i] };
        if reference[i] == f64::INFINITY {
            reciprocal[i] = 0.0;
            continue;
        }
        visit(i, relative);
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
                sum += l[i][p] * m[p][k];
            }
            m[i][k] = -sum;
        }
    }
    let mut inverse = [[0.0; N]; N];
    for r in 0..N {
        for c in 0..=r {
            let mut sum = 0.0;
            for i in r..N {
                sum += m[i][r] * reciprocal[i] * m[i][c];
            }
            inverse[r][c] = sum;
            inverse[c][r] = sum;
        }
    }
    inverse
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = a[0] * b[0];
    for p in 1..N {
        sum += a[p] * b[p];
    }
    sum
}

/// E ← B D⁻¹ row by row.
#[inline(always)]
pub fn scale<const N: usize>(inverse: &[[f64; N]; N], block: &[f64], out: &mut [f64]) {
    let (rows, out) = (block.as_chunks::<N>().0, out.as_chunks_mut::<N>().0);
    for (row, out) in rows.iter().zip(out) {
        let mut sum = [0.0; N];
        for p in 0..N {
            for c in 0..N {
                sum[c] += row[p] * inverse[p][c];
            }
        }
        *out = sum;
    }
}

/// target −= E Bᵀ, where the rows of B are `columns` in number.
#[inline(always)]
pub fn update<const N: usize>(scaled: &[f64], block: &[f64], columns: usize, target: &mut [f64]) {
    let scaled = scaled.as_chunks::<N>().0;
    let block = block.as_chunks::<N>().0;
    // The commonest case, all joints of one kind, with every length known.
    if let (Some(e), Some(b), Some(out)) = (
        scaled.first_chunk::<N>(),
        block.first_chunk::<N>(),
        target.as_chunks_mut::<N>().0.first_chunk_mut::<N>(),
    ) && scaled.len() == N
        && columns == N
    {
        for i in 0..N {
            for k in 0..N {
                out[i][k] -= dot(&e[i], &b[k]);
            }
        }
        return;
    }
    for (e, out) in scaled.iter().zip(target.chunks_exact_mut(columns)) {
        for (b, out) in block.iter().zip(out) {
            *out -= dot(e, b);
        }
    }
}

/// y_i −= E y_j.
#[inline(always)]
pub fn forward<const N: usize>(scaled: &[f64], y: &[f64; N], target: &mut [f64]) {
    for (e, out) in scaled.as_chunks::<N>().0.iter().zip(target) {
        *out -= dot(e, y);
    }
}

/// x_j −= Eᵀ x_i.
#[inline(always)]
pub fn backward<const N: usize>(scaled: &[f64], source: &[f64], x: &mut [f64; N]) {
    for (e, value) in scaled.as_chunks::<N>().0.iter().zip(source) {
        for p in 0..N {
            x[p] -= e[p] * value;
        }
    }
}

/// M x for a symmetric matrix.
#[inline(always)]
pub fn multiply<const N: usize>(matrix: &[[f64; N]; N], x: &[f64; N]) -> [f64; N] {
    let mut out = [0.0; N];
    for r in 0..N {
        out[r] = dot(&matrix[r], x);
    }
    out
}
