//! Sums and differences of states and of their series, compiled for each set of vector instructions.

use crate::dynamics::series::Bodies;
use crate::dynamics::series::lanes::{largest, plus};
use pulp::{Arch, Simd, WithSimd};
use triad_linalg::larger;

/// x + s y.
#[inline(always)]
pub(super) fn moved<const L: usize, B: Bodies<L>>(x: &B::Natural, s: f64, y: &B::Natural) -> B::Natural {
    let mut sum = *x;
    for (x, y) in B::lanes_mut(&mut sum).as_flattened_mut().iter_mut().zip(B::lanes(y).as_flattened()) {
        *x += s * y;
    }
    sum
}

/// The same for positions and velocities.
pub(super) fn moved_both<const L: usize, B: Bodies<L>>(
    x: &[B::Natural; 2],
    s: f64,
    y: &[B::Natural; 2],
) -> [B::Natural; 2] {
    [0, 1].map(|k| moved::<L, B>(&x[k], s, &y[k]))
}

/// Value and derivative of a polynomial.
#[inline(always)]
pub(super) fn value<const L: usize, B: Bodies<L>>(coefficients: &[B::Natural], tau: f64) -> [B::Natural; 2] {
    let nothing = [B::zero(); 2];
    coefficients
        .iter()
        .rev()
        .fold(nothing, |[x, v], c| [moved::<L, B>(c, tau, &x), moved::<L, B>(&x, tau, &v)])
}

/// The s-th part of the difference of two series, and its value after h, to be compiled for each set of vector instructions.
pub(super) struct Differ<'a, const L: usize, B: Bodies<L>> {
    pub of: [&'a [B::Natural]; 2],
    pub stride: usize,
    pub order: usize,
    pub s: f64,
    pub h: f64,
    pub carried: &'a mut [B::Natural],
    pub arrived: &'a mut [[B::Natural; 2]],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Differ<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { of: [here, there], stride, order, s, h, carried, arrived } = self;
        for (b, arrived) in arrived.iter_mut().enumerate() {
            let range = b * stride..=b * stride + order;
            let carried = &mut carried[range.clone()];
            for ((carried, here), there) in carried.iter_mut().zip(&here[range.clone()]).zip(&there[range]) {
                let difference = moved::<L, B>(here, -1.0, there);
                *carried = if s < 1.0 { moved::<L, B>(&B::zero(), 1.0 / s, &difference) } else { difference };
            }
            *arrived = value::<L, B>(carried, h);
        }
    }
}

/// Second derivatives of the series of all bodies at the end of a step, to be compiled likewise.
struct Missed<'a, const L: usize, B: Bodies<L>> {
    series: &'a [B::Natural],
    stride: usize,
    step: (usize, f64),
    out: &'a mut [[B::Natural; 2]],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Missed<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { series, stride, step: (order, h), out } = self;
        for (b, out) in out.iter_mut().enumerate() {
            let coefficients = &series[b * stride..=b * stride + order];
            let mut second = B::zero();
            for k in (2..=order).rev() {
                let c = moved::<L, B>(&B::zero(), (k * (k - 1)) as f64, &coefficients[k]);
                second = moved::<L, B>(&c, h, &second);
            }
            out[0] = second;
        }
    }
}

/// Writes the second derivative of the series of each body at the end of a step, of which order and size are given, to the first of
/// each pair.
pub(super) fn find_missed<const L: usize, B: Bodies<L>>(
    series: &[B::Natural],
    stride: usize,
    step: (usize, f64),
    missed: &mut [[B::Natural; 2]],
) {
    Arch::new().dispatch(Missed::<L, B> { series, stride, step, out: missed });
}

/// The size of an error, to be compiled likewise.
struct Size<'a, const L: usize, B: Bodies<L>> {
    error: &'a [[B::Natural; 2]],
    h: f64,
    length: f64,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Size<'_, L, B> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Self { error, h, length } = self;
        // Zero times infinity or NaN is NaN.
        let mut zeros = [0.0; L];
        let mut most = 0.0;
        for [x, v] in error {
            let mut sizes = [0.0; 2];
            for (size, x) in sizes.iter_mut().zip([x, v]) {
                for lane in B::lanes(x) {
                    zeros = plus(&[0.0; L], lane, &zeros);
                }
                let (position, directors) = B::lanes(x).split_at(B::DIRECTIONS);
                *size = larger(largest(position), length * largest(directors));
            }
            most = larger(most, sizes[0] + h * sizes[1]);
        }
        if zeros.iter().sum::<f64>() == 0.0 { most } else { f64::NAN }
    }
}

/// Size of an error, m: of positions, of directors for a mechanism of this length, and of what their rates make in a time h.
/// Not a number if any of its components is none.
pub(super) fn size<const L: usize, B: Bodies<L>>(error: &[[B::Natural; 2]], h: f64, length: f64) -> f64 {
    Arch::new().dispatch(Size::<L, B> { error, h, length })
}
