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
