//! Arithmetic on power series, coefficient by coefficient — eq. (11.4).

use nalgebra::Vector3;

/// Coefficients of a vector.
pub type Vectors = Vec<Vector3<f64>>;

/// Coefficient n of a b.
#[inline(always)]
pub fn product(a: &[f64], b: &[f64], n: usize) -> f64 {
    a[..=n].iter().zip(b[..=n].iter().rev()).map(|(a, b)| a * b).sum()
}

/// Coefficient n of a · b.
#[inline(always)]
pub fn dot(a: &[Vector3<f64>], b: &[Vector3<f64>], n: usize) -> f64 {
    a[..=n].iter().zip(b[..=n].iter().rev()).map(|(a, b)| a.dot(b)).sum()
}

/// Coefficient n of a · b without the terms of a_n and b_n.
#[inline(always)]
pub fn inner_dot(a: &[Vector3<f64>], b: &[Vector3<f64>], n: usize) -> f64 {
    (1..n).map(|i| a[i].dot(&b[n - i])).sum()
}

/// Coefficient n of a v, a scalar times a vector.
#[inline(always)]
pub fn scaled(a: &[f64], v: &[Vector3<f64>], n: usize) -> Vector3<f64> {
    a[..=n].iter().zip(v[..=n].iter().rev()).map(|(a, v)| v * *a).sum()
}

/// Coefficient n of a / b, from those of the quotient before it.
#[inline(always)]
pub fn quotient(a_n: f64, b: &[f64], before: &[f64], n: usize) -> f64 {
    let known: f64 = (1..=n).map(|j| b[j] * before[n - j]).sum();
    (a_n - known) / b[0]
}

/// Coefficient n of √a, from those of the root before it.
#[inline(always)]
pub fn root(a_n: f64, before: &[f64], n: usize) -> f64 {
    if n == 0 {
        return a_n.sqrt();
    }
    let known: f64 = (1..n).map(|i| before[i] * before[n - i]).sum();
    0.5 * (a_n - known) / before[0]
}

/// Coefficient n of the rate of a series.
#[inline(always)]
pub fn rate(a: &[f64], n: usize) -> f64 {
    (n + 1) as f64 * a[n + 1]
}

/// Coefficient n of a product of a with the rate of b.
#[inline(always)]
pub fn product_with_rate(a: &[f64], b: &[f64], n: usize) -> f64 {
    (0..=n).map(|i| a[i] * rate(b, n - i)).sum()
}

/// The value at τ of a series.
#[inline(always)]
pub fn value(series: &[f64], tau: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * tau + c)
}

/// The value at τ of a series of vectors.
#[inline(always)]
pub fn vector_value(series: &[Vector3<f64>], tau: f64) -> Vector3<f64> {
    series.iter().rev().fold(Vector3::zeros(), |sum, c| sum * tau + c)
}
