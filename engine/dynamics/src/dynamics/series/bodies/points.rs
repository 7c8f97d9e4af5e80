//! Points of bodies on their way to the rows of joints, and forces on their way back.

use super::bundle::Bundle;
use super::components::{Components, combined, widened};
use super::kernels::Points;
use super::pair::Pair;
use super::planar::Planar;
use super::single::Single;
use super::slot::FeatureSlot;
use crate::dynamics::series::lanes::{LaneVector, Natural, less_whole, plus_whole, times_whole};
use pulp::Simd;

impl<const L: usize> Points<L> for Bundle<L> {
    type Natural = Natural<L>;

    #[inline(always)]
    fn point<S: Simd>(simd: S, slot: &FeatureSlot<L>, x: &Natural<L>) -> LaneVector<L> {
        let mut value = [[0.0; L]; 3];
        for (c, value) in value.iter_mut().enumerate() {
            *value = times_whole(simd, &slot.point, &x[0][c]);
            for k in 0..3 {
                *value = plus_whole(simd, &slot.local[k], &x[1 + k][c], value);
            }
        }
        value
    }

    #[inline(always)]
    fn pull_off<S: Simd>(simd: S, slot: &FeatureSlot<L>, f: &LaneVector<L>, sum: &mut Natural<L>) {
        for c in 0..3 {
            sum[0][c] = less_whole(simd, &slot.point, &f[c], &sum[0][c]);
            for k in 0..3 {
                sum[1 + k][c] = less_whole(simd, &slot.local[k], &f[c], &sum[1 + k][c]);
            }
        }
    }
}

impl<const L: usize> Points<L> for Planar<L> {
    type Natural = [Pair<L>; 2];

    #[inline(always)]
    fn point<S: Simd>(simd: S, slot: &FeatureSlot<L>, [r, z]: &[Pair<L>; 2]) -> LaneVector<L> {
        let ([a, b, _], point) = (&slot.local, &slot.point);
        let first = plus_whole(simd, a, &z[0], &times_whole(simd, point, &r[0]));
        let second = plus_whole(simd, a, &z[1], &times_whole(simd, point, &r[1]));
        [less_whole(simd, b, &z[1], &first), plus_whole(simd, b, &z[0], &second), [0.0; L]]
    }

    #[inline(always)]
    fn pull_off<S: Simd>(simd: S, slot: &FeatureSlot<L>, [x, y, _]: &LaneVector<L>, sum: &mut [Pair<L>; 2]) {
        let ([a, b, _], point, [r, z]) = (&slot.local, &slot.point, sum);
        r[0] = less_whole(simd, point, x, &r[0]);
        r[1] = less_whole(simd, point, y, &r[1]);
        z[0] = less_whole(simd, b, y, &less_whole(simd, a, x, &z[0]));
        z[1] = plus_whole(simd, b, x, &less_whole(simd, a, y, &z[1]));
    }
}

impl Points<1> for Single {
    type Natural = [Components; 4];

    #[inline(always)]
    fn point<S: Simd>(simd: S, slot: &FeatureSlot<1>, x: &[Components; 4]) -> LaneVector<1> {
        let [[x, y, z, _]] = Self::point_rows(simd, slot, x);
        [[x], [y], [z]]
    }

    #[inline(always)]
    fn pull_off<S: Simd>(simd: S, slot: &FeatureSlot<1>, f: &LaneVector<1>, sum: &mut [Components; 4]) {
        Self::pull_off_rows(simd, slot, &[widened(f)], sum);
    }

    #[inline(always)]
    fn point_rows<S: Simd>(simd: S, slot: &FeatureSlot<1>, [r, u, v, w]: &[Components; 4]) -> [[f64; 4]; 1] {
        let [[a], [b], [c]] = slot.local;
        let turning = combined(simd, [a, b, c], &[*u, *v, *w]);
        [plus_whole(simd, &[slot.point[0]; 4], r, &turning)]
    }

    #[inline(always)]
    fn pull_off_rows<S: Simd>(
        simd: S,
        slot: &FeatureSlot<1>,
        [[x, y, z, _]]: &[[f64; 4]; 1],
        sum: &mut [Components; 4],
    ) {
        let f = [*x, *y, *z, 0.0];
        for (sum, factor) in sum.iter_mut().zip([&slot.point, &slot.local[0], &slot.local[1], &slot.local[2]])
        {
            *sum = less_whole(simd, &[factor[0]; 4], &f, sum);
        }
    }
}
