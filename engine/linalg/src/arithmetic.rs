//! The one place that says how a product and a sum are rounded.
//!
//! Every kernel of the engine adds products by [`fma`], so that a program has one arithmetic from its first kernel to its
//! last. No program needs two, so this is a choice of the machine that it is built for and no parameter of a hundred
//! functions.

/// a b + c.
///
/// Rounded once (fused) on machines that can: the same bits on all of them, with or without vectors of the processor.
/// WebAssembly has no such instruction and computes it in software, at a fortieth of the speed: there it is rounded twice.
/// Its results have other bits and lie within the same estimates of error; they are never used for grading.
#[inline(always)]
#[allow(clippy::disallowed_methods, reason = "the only place")]
pub const fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_family = "wasm") { a * b + c } else { a.mul_add(b, c) }
}

/// The larger of two numbers; a itself where b is none.
///
/// One comparison, also of vectors, on every machine. `f64::max` asks both for being numbers, and in WebAssembly it is a call.
#[inline(always)]
pub const fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The larger of two numbers; none is larger than any.
#[inline(always)]
pub const fn larger_or_nan(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The largest |xᵢ|; those that are none are passed over.
pub fn largest_size(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| larger(most, x.abs()))
}

/// The largest |aᵢ − bᵢ|; those that are none are passed over.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| larger(most, (a - b).abs()))
}

/// Raises each of L numbers to the size of the one beside it, where that is larger; those that are none raise nothing.
///
/// No compiler takes the vectors of WebAssembly for it by itself, because it may not leave out what comparisons say of numbers
/// that are none.
#[inline(always)]
pub fn raise<const L: usize>(largest: &mut [f64; L], x: &[f64; L]) {
    let ((pairs, last), (beside, single)) = (largest.as_chunks_mut::<2>(), x.as_chunks::<2>());
    for (pair, x) in pairs.iter_mut().zip(beside) {
        *pair = larger_size(*pair, *x);
    }
    for (last, x) in last.iter_mut().zip(single) {
        *last = larger(*last, x.abs());
    }
}

/// The larger of a and |x|, twice.
#[cfg(all(target_family = "wasm", target_feature = "simd128"))]
#[inline(always)]
fn larger_size(a: [f64; 2], x: [f64; 2]) -> [f64; 2] {
    use core::arch::wasm32::{f64x2, f64x2_abs, f64x2_extract_lane, f64x2_pmax};
    let most = f64x2_pmax(f64x2(a[0], a[1]), f64x2_abs(f64x2(x[0], x[1])));
    [f64x2_extract_lane::<0>(most), f64x2_extract_lane::<1>(most)]
}

/// The larger of a and |x|, twice.
#[cfg(not(all(target_family = "wasm", target_feature = "simd128")))]
#[inline(always)]
fn larger_size(a: [f64; 2], x: [f64; 2]) -> [f64; 2] {
    [larger(a[0], x[0].abs()), larger(a[1], x[1].abs())]
}
