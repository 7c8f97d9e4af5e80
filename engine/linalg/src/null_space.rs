//! Which rows of a matrix are independent.

use nalgebra::DMatrix;

/// Part of an orthonormal set that rounding leaves of none.
const ACROSS: f64 = 1e-8;

/// Squared lengths closer than this are equal.
const EQUAL: f64 = 1e-10;

/// A largest set of independent rows, by QR factorization of the transpose with column pivoting, in ascending order.
///
/// At each step the row with the largest part across those already taken is taken; rows whose largest part is below
/// `tolerance` times the length of the longest row depend on the others. Among equals the last row wins.
pub fn independent_rows(matrix: &DMatrix<f64>, tolerance: f64) -> Vec<usize> {
    independent_rows_while(matrix, tolerance, &|| true)
}

/// As [`independent_rows`], as long as that is wanted: otherwise those that were found.
pub fn independent_rows_while(
    matrix: &DMatrix<f64>,
    tolerance: f64,
    wanted: &dyn Fn() -> bool,
) -> Vec<usize> {
    // Columns are contiguous: work on the transpose, one column for each row.
    let mut rest = matrix.transpose();
    let count = rest.ncols();
    let mut left: Vec<usize> = (0..count).collect();
    let mut norms: Vec<f64> = rest.column_iter().map(|column| column.norm_squared()).collect();
    let longest = norms.iter().fold(0.0f64, |a, b| a.max(*b));
    let smallest = tolerance * tolerance * longest;
    let mut taken = Vec::with_capacity(count.min(rest.nrows()));
    while let Some((place, norm)) = largest(&left, &norms).filter(|_| wanted()) {
        // Near its end the updated norm is rounding; the column itself knows better.
        let row = left[place];
        let true_norm = rest.column(row).norm_squared();
        if true_norm < 0.5 * norm {
            norms[row] = true_norm;
            continue;
        }
        if true_norm <= smallest {
            break;
        }
        left.remove(place);
        taken.push(row);
        let direction = rest.column(row) / true_norm.sqrt();
        for &other in &left {
            let mut column = rest.column_mut(other);
            let along = column.dot(&direction);
            if along != 0.0 {
                column.axpy(-along, &direction, 1.0);
                norms[other] -= along * along;
            }
        }
    }
    taken.sort_unstable();
    taken
}

/// Place in `left` of the row with the largest norm, and that norm.
fn largest(left: &[usize], norms: &[f64]) -> Option<(usize, f64)> {
    let mut best = None;
    for (place, &row) in left.iter().enumerate() {
        if best.is_none_or(|(_, norm)| norms[row] >= norm * (1.0 - EQUAL)) {
            best = Some((place, norms[row]));
        }
    }
    best
}

/// Orthonormal columns n with nᵀ `matrix` = 0: one for each row that depends on others.
///
/// Each dependent row is written with the independent ones, by QR factorization of these; the coefficients are a null
/// vector. (An iterative singular value decomposition is no help where many singular values coincide.)
pub fn left_null_space(matrix: &DMatrix<f64>, tolerance: f64) -> DMatrix<f64> {
    let kept = independent_rows(matrix, tolerance);
    let rest: Vec<usize> = (0..matrix.nrows()).filter(|row| kept.binary_search(row).is_err()).collect();
    let mut null = DMatrix::zeros(matrix.nrows(), rest.len());
    for (k, &row) in rest.iter().enumerate() {
        null[(row, k)] = 1.0;
    }
    if rest.is_empty() || kept.is_empty() {
        return null;
    }
    let qr = matrix.select_rows(&kept).transpose().qr();
    let mut coefficients = qr.q().tr_mul(&matrix.select_rows(&rest).transpose());
    // R is regular: its rows were chosen independent.
    if qr.r().solve_upper_triangular_mut(&mut coefficients) {
        for (i, &row) in kept.iter().enumerate() {
            for k in 0..rest.len() {
                null[(row, k)] = -coefficients[(i, k)];
            }
        }
    }
    null.qr().q()
}

/// Orthonormal x with `matrix` x = 0, parts of it below `smallest` being none, and orthonormal ones across.
pub fn null_and_rest(matrix: &DMatrix<f64>, smallest: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = matrix.ncols();
    let longest = matrix.column_iter().fold(0.0f64, |a, column| a.max(column.norm()));
    let null = if longest <= smallest {
        DMatrix::identity(n, n)
    } else {
        left_null_space(&matrix.transpose(), smallest / longest)
    };
    let rest = left_null_space(&null, ACROSS);
    (null, rest)
}

/// The shortest x with `matrix` x = `right`, as nearly as can be, and the null space of `matrix`, as [`null_and_rest`] takes it. (The
/// iterative singular value decomposition is wrong in the second digit where columns are parallel to rounding.)
pub fn least_squares(
    matrix: &DMatrix<f64>,
    right: &DMatrix<f64>,
    smallest: f64,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let (null, rest) = null_and_rest(matrix, smallest);
    let mut x = DMatrix::zeros(rest.ncols(), right.ncols());
    if !rest.is_empty() {
        let columns = matrix * &rest;
        let (q, r) = columns.clone().qr().unpack();
        let mut left = right.clone();
        // Once more for what rounding leaves of the first solution.
        for _ in 0..2 {
            let mut added = q.tr_mul(&left);
            // R is regular: what is left of the columns is independent.
            r.solve_upper_triangular_mut(&mut added);
            left -= &columns * &added;
            x += added;
        }
    }
    (rest * x, null)
}
