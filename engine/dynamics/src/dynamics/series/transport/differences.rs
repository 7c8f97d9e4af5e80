//! Sums and differences of states and of their series, compiled for each set of vector instructions.

use super::Transport;
use super::tail::Tail;
use crate::dynamics::series::lanes::{difference_whole, largest, plus, plus_whole, raise_whole};
use crate::dynamics::series::{Bodies, Series};
use pulp::{Simd, WithSimd};
use std::iter::repeat;
use triad_linalg::{fma, larger};

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
#[inline(always)]
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
    let nothing = [B::ZERO; 2];
    coefficients
        .iter()
        .rev()
        .fold(nothing, |[x, v], c| [moved::<L, B>(c, tau, &x), moved::<L, B>(&x, tau, &v)])
}

/// Size of an error: of positions, m, directors, and their rates, each the largest component of all bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Size([f64; 4]);

impl Size {
    /// What it makes of positions in a time h in a mechanism of this length, m. Not a number if it is none.
    #[inline(always)]
    pub fn after(self, h: f64, length: f64) -> f64 {
        let [position, turn, velocity, spin] = self.0;
        larger(position, length * turn) + h * larger(velocity, length * spin)
    }

    #[inline(always)]
    fn raise<const L: usize, B: Bodies<L>>(&mut self, error: &[B::Natural; 2]) {
        for (k, x) in error.iter().enumerate() {
            let (position, directors) = B::lanes(x).split_at(B::DIRECTIONS);
            self.0[2 * k] = larger(self.0[2 * k], largest(position));
            self.0[2 * k + 1] = larger(self.0[2 * k + 1], largest(directors));
        }
    }

    /// The same, or no numbers if a component of the error is none.
    #[inline(always)]
    fn proven<const L: usize, B: Bodies<L>>(self, error: &[[B::Natural; 2]]) -> Self {
        // Zero times infinity or NaN is NaN.
        let mut zeros = [0.0; L];
        for lane in error.as_flattened().iter().flat_map(|x| B::lanes(x)) {
            zeros = plus(&[0.0; L], lane, &zeros);
        }
        if zeros.iter().sum::<f64>() == 0.0 { self } else { Self([f64::NAN; 4]) }
    }
}

/// The s-th part of the difference of a series and that of its twin, which is expanded as far as the difference asks for, to be compiled
/// for each set of vector instructions. The order that was reached, what the difference is worth after h, and whether it asks for more
/// terms than there are, are returned.
pub(super) struct Differ<'a, const L: usize, B: Bodies<L>> {
    pub of: &'a [B::Natural],
    pub twin: &'a mut Series<L, B>,
    /// The first at which it is looked at, and the most.
    pub orders: [usize; 2],
    pub s: f64,
    pub h: f64,
    pub length: f64,
    /// What two successive terms are the last below, m.
    pub enough: f64,
    /// The difference, its terms' sizes, and its value and rate after h.
    pub carried: &'a mut [B::Natural],
    pub terms: &'a mut [f64],
    pub arrived: &'a mut [[B::Natural; 2]],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Differ<'_, L, B> {
    type Output = (usize, f64, bool);

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> (usize, f64, bool) {
        let ([fewest, most], h) = (self.orders, self.h);
        self.twin.begin_expansion(simd);
        let mut power = 1.0;
        for k in 0..=most {
            if k >= 2 {
                self.twin.solve_order(simd, k - 2);
                power *= h;
            }
            self.add(simd, k, power);
            let last = power * larger(h * self.terms[k], self.terms[k.saturating_sub(1)]);
            let finished = last <= self.enough;
            if k == most || k >= fewest && finished {
                return (k, self.after(), !finished);
            }
        }
        (most, f64::NAN, false)
    }
}

impl<const L: usize, B: Bodies<L>> Differ<'_, L, B> {
    /// What all terms so far are worth at the end of the step.
    #[inline(always)]
    fn after(&self) -> f64 {
        let mut size = Size::default();
        self.arrived.iter().for_each(|both| size.raise::<L, B>(both));
        size.proven::<L, B>(self.arrived).after(self.h, self.length)
    }

    /// Adds the term of order k, given h to the power of k − 1: four numbers at a time, whatever they belong to.
    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, k: usize, power: f64) {
        let stride = self.twin.stride;
        let by = if k == 0 { [1.0, 0.0] } else { [self.h * power, k as f64 * power] };
        let mut largest = [0.0; 4];
        for (b, [value, rate]) in self.arrived.iter_mut().enumerate() {
            let at = b * stride + k;
            let (value, rate) = (B::fours_mut(value), B::fours_mut(rate));
            let (here, there) = (B::fours(&self.of[at]), B::fours(&self.twin.q[at]));
            let carried = B::fours_mut(&mut self.carried[at]);
            for ((((out, here), there), value), rate) in
                carried.iter_mut().zip(here).zip(there).zip(value).zip(rate)
            {
                let mut term = difference_whole(simd, here, there);
                if self.s < 1.0 {
                    term = term.map(|x| x / self.s);
                }
                raise_whole(simd, &mut largest, &term);
                if k == 0 {
                    (*value, *rate) = ([0.0; 4], [0.0; 4]);
                }
                *value = plus_whole(simd, &[by[0]; 4], &term, value);
                *rate = plus_whole(simd, &[by[1]; 4], &term, rate);
                *out = term;
            }
        }
        self.terms[k] = largest.into_iter().fold(0.0, larger);
    }
}

/// The second derivative of a polynomial, whose last two terms, the last first, stand for these further ones.
#[inline(always)]
fn curvature<const L: usize, B: Bodies<L>>(
    coefficients: &[B::Natural],
    tau: f64,
    further: [f64; 2],
) -> B::Natural {
    let mut second = B::ZERO;
    let further = further.into_iter().chain(repeat(0.0));
    for ((k, c), further) in coefficients.iter().enumerate().skip(2).rev().zip(further) {
        let factor = (k * (k - 1)) as f64 + further;
        for (second, c) in B::lanes_mut(&mut second).iter_mut().zip(B::lanes(c)) {
            for l in 0..L {
                second[l] = fma(tau, second[l], factor * c[l]);
            }
        }
    }
    second
}

/// The error of positions and rates that a second derivative tells, given half that of the equations.
#[inline(always)]
fn local<const L: usize, B: Bodies<L>>(
    by: [f64; 2],
    second: &B::Natural,
    half: &B::Natural,
) -> [B::Natural; 2] {
    let missed = moved::<L, B>(second, -2.0, half);
    by.map(|by| moved::<L, B>(&B::ZERO, by, &missed))
}

/// An error less what the last two coefficients, the last first, tell of those that are left out.
#[inline(always)]
fn less_left_out<const L: usize, B: Bodies<L>>(
    [error, rate]: &[B::Natural; 2],
    by: [[f64; 2]; 2],
    [last, before]: [&B::Natural; 2],
) -> [B::Natural; 2] {
    let less = |x: &B::Natural, by: [f64; 2]| moved::<L, B>(&moved::<L, B>(x, -by[0], last), -by[1], before);
    [less(error, by[0]), less(rate, by[1])]
}

/// What a step adds to an error and what that is in all, at its end, to be compiled likewise: eq. (11.11), from the second
/// derivative of the series there, and that of the equations, which the twin has. How its terms go on and the sizes of both, the whole
/// first, are returned.
pub(super) struct Missed<'a, const L: usize, B: Bodies<L>> {
    pub series: &'a [B::Natural],
    /// Whether its terms are those of the motion alone, not of prescribed functions.
    pub is_own: bool,
    pub twin: &'a Series<L, B>,
    /// Its order and size.
    pub step: (usize, f64),
    pub arrived: &'a [[B::Natural; 2]],
    /// Where the step has too few terms for the error: those of the error, and half the accelerations of the motion without it.
    pub beside: Option<[&'a [B::Natural]; 2]>,
    /// What it adds beyond what its last terms tell.
    pub added: &'a mut [[B::Natural; 2]],
    pub error: &'a mut [[B::Natural; 2]],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Missed<'_, L, B> {
    type Output = (Tail, [Size; 2]);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> (Tail, [Size; 2]) {
        let Self { series, is_own, twin, step: (order, h), arrived, beside, added, error } = self;
        let p = order as f64;
        let by = [h * h / (p * (p + 1.0)), h / p];
        let mut sizes = [Size::default(); 2];
        let tail = Tail::of::<L, B>(series, twin.stride, order, h, is_own);
        let (left_out, further) = tail.at_end();
        for (b, added) in added.iter_mut().enumerate() {
            let first = b * twin.stride;
            let terms = first..=first + order;
            let second = curvature::<L, B>(&series[terms.clone()], h, further);
            let last = [&series[first + order], &series[first + order - 1]];
            *added = local::<L, B>(by, &second, &twin.q[first + 2]);
            let mut whole = less_left_out::<L, B>(added, left_out, last);
            sizes[1].raise::<L, B>(&whole);
            if let Some([carried, half]) = beside {
                let carried = curvature::<L, B>(&carried[terms], h, [0.0; 2]);
                *added = local::<L, B>(by, &moved::<L, B>(&second, -1.0, &carried), &half[b]);
                whole = less_left_out::<L, B>(added, left_out, last);
            }
            error[b] = moved_both::<L, B>(&arrived[b], 1.0, &whole);
            sizes[0].raise::<L, B>(&error[b]);
        }
        (tail, [sizes[0].proven::<L, B>(error), sizes[1]])
    }
}

/// The error of a bundle within a step, of which the step itself has added these parts to positions and velocities so far, and these of its
/// last two terms; to be compiled for each set of vector instructions.
pub(super) struct Within<'a, const L: usize, B: Bodies<L>> {
    pub transport: &'a Transport<L, B>,
    pub b: usize,
    pub tau: f64,
    pub weights: [f64; 2],
    pub last: [&'a B::Natural; 2],
    pub left_out: [[f64; 2]; 2],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Within<'_, L, B> {
    type Output = [B::Natural; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [B::Natural; 2] {
        let Self { transport, b, tau, weights, last, left_out } = self;
        let (carried, added) = (transport.at(b, tau), &transport.added[b]);
        let whole = [0, 1].map(|k| moved::<L, B>(&carried[k], weights[k], &added[k]));
        less_left_out::<L, B>(&whole, left_out, last)
    }
}

/// The s-th part of what lies between two states, to be compiled likewise. Its size is returned.
pub(super) struct Between<'a, const L: usize, B: Bodies<L>> {
    pub here: &'a [[B::Natural; 2]],
    pub there: &'a [[B::Natural; 2]],
    pub s: f64,
    pub out: &'a mut [[B::Natural; 2]],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Between<'_, L, B> {
    type Output = Size;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Size {
        let mut size = Size::default();
        for ((out, here), there) in self.out.iter_mut().zip(self.here).zip(self.there) {
            *out = moved_both::<L, B>(here, -1.0, there);
            if self.s < 1.0 {
                *out = moved_both::<L, B>(&[B::ZERO; 2], 1.0 / self.s, out);
            }
            size.raise::<L, B>(out);
        }
        size.proven::<L, B>(self.out)
    }
}
