//! The kernels for blocks whose lengths are known only at run time: wider than those that are compiled one by one, or of
//! joints of two kinds.

use super::stride;
use crate::arithmetic::fma;

/// Marks in the diagonal of S, as infinite, so many rows of a symmetric block X/// ones of an elimination whose pivots are the largest, relative to that diagonal. The block is used up.
pub fn leave_out(count: usize, block: &mut [f64], reference: &mut [f64]) {
    let n = reference.len();
    for _ in count..n {
        let size = |i: usize| if reference[i] > 0.0 { block[i * n + i] / reference[i] } else { 0.0 };
        let pivot = (0..n).max_by(|&i, &k| size(i).total_cmp(&size(k))).unwrap_or(0);
        let scale = if size(pivot) > 0.0 { 1.0 / block[pivot * n + pivot] } else { 0.0 };
        for i in (0..n).filter(|&i| i != pivot) {
            let factor = block[i.max(pivot) * n + i.min(pivot)] * scale;
            for k in (0..=i).filter(|&k| k != pivot) {
                block[i * n + k] -= factor * block[k.max(pivot) * n + k.min(pivot)];
            }
        }
        for i in 0..n {
            block[i.max(pivot) * n + i.min(pivot)] = 0.0;
        }
        // Done with, and never the largest again.
        block[pivot * n + pivot] = f64::NEG_INFINITY;
    }
    for i in 0..n {
        if block[i * n + i] != f64::NEG_INFINITY {
            reference[i] = f64::INFINITY;
        }
    }
}

/// Replaces a symmetric n × n block, of which the lower triangle is read, by its inverse, by L D Lᵀ. `reference` is the
/// diagonal of S, or infinite for rows that are left out; `all` gets the pivots relative to it, and one not above
/// `skip` drops its row.
pub fn invert(n: usize, block: &mut [f64], reference: &[f64], skip: f64, all: &mut [f64]) {
    for i in 0..n {
        for k in 0..i {
            for p in 0..k {
                block[i * n + k] -= block[i * n + p] * block[k * n + p];
            }
        }
        let mut pivot = block[i * n + i];
        for k in 0..i {
            let row = block[i * n + k];
            block[i * n + k] = row * block[k * n + k];
            pivot -= row * block[i * n + k];
        }
        if reference[i] == f64::INFINITY {
            (block[i * n + i], all[i]) = (0.0, f64::INFINITY);
            continue;
        }
        let relative = if reference[i] == 0.0 { 0.0 } else { pivot / reference[i] };
        all[i] = relative;
        block[i * n + i] = if relative <= skip { 0.0 } else { 1.0 / pivot };
    }
    // M = L⁻¹ in place; the diagonal keeps the reciprocals of the pivots.
    for i in 0..n {
        for k in 0..i {
            let sum: f64 = (k + 1..i).map(|p| block[i * n + p] * block[p * n + k]).sum();
            block[i * n + k] = -(block[i * n + k] + sum);
        }
    }
    // Row r of Mᵀ diag M needs only the rows of M from r on.
    for r in 0..n {
        for c in 0..=r {
            let own = if c == r { 1.0 } else { block[r * n + c] };
            let mut sum = block[r * n + r] * own;
            for i in r + 1..n {
                sum += block[i * n + r] * block[i * n + i] * block[i * n + c];
            }
            // The diagonal comes last, as the whole row needs its reciprocal.
            block[r * n + c] = sum;
        }
        for c in 0..r {
            block[c * n + r] = block[r * n + c];
        }
    }
}

/// U ← D⁻¹ B, where D⁻¹ has n rows of `width` numbers and B has `columns`.
#[inline(always)]
pub fn scale(n: usize, inverse: &[f64], width: usize, columns: usize, block: &[f64], out: &mut [f64]) {
    let step = stride(columns);
    for (own, out) in inverse.chunks_exact(width).zip(out.chunks_exact_mut(step)).take(n) {
        out.fill(0.0);
        for (factor, row) in own.iter().zip(block.chunks_exact(step)).take(n) {
            for (out, x) in out[..columns].iter_mut().zip(row) {
                *out = fma(*factor, *x, *out);
            }
        }
    }
}

/// target −= Uᵀ B, where U and B have n rows, and the target `rows` and `columns`.
#[inline(always)]
pub fn update(n: usize, scaled: &[f64], block: &[f64], rows: usize, columns: usize, target: &mut [f64]) {
    for (i, out) in target.chunks_exact_mut(stride(columns)).take(rows).enumerate() {
        let column = scaled[i..].iter().step_by(stride(rows));
        for (factor, row) in column.zip(block.chunks_exact(stride(columns))).take(n) {
            for (out, x) in out[..columns].iter_mut().zip(row) {
                *out = fma(-factor, *x, *out);
            }
        }
    }
}

/// target −= Uᵀ y, where U has `columns`.
#[inline(always)]
pub fn forward(y: &[f64], scaled: &[f64], columns: usize, target: &mut [f64]) {
    for (y, row) in y.iter().zip(scaled.chunks_exact(stride(columns))) {
        for (out, u) in target[..columns].iter_mut().zip(row) {
            *out = fma(-y, *u, *out);
        }
    }
}

/// x −= U source.
#[inline(always)]
pub fn backward(scaled: &[f64], source: &[f64], x: &mut [f64]) {
    for (x, row) in x.iter_mut().zip(scaled.chunks_exact(stride(source.len()))) {
        for (u, source) in row.iter().zip(source) {
            *x = fma(-u, *source, *x);
        }
    }
}

/// M x for a symmetric matrix.
pub fn multiply(n: usize, matrix: &[f64], x: &[f64], out: &mut [f64]) {
    for (row, out) in matrix.chunks_exact(n).zip(out) {
        *out = row.iter().zip(x).map(|(a, b)| a * b).sum();
    }
}
