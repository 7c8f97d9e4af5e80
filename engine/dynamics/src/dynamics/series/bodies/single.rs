//! One body in space: what a bundle of one does, with the components of each vector side by side in a vector of the processor,
//! and zero behind the third. What is seldom asked for is left to that bundle.

use super::alone::Alone;
use super::bundle::Bundle;
use super::components::{
    Components, ZERO, column, combined, cross, gram, moment, narrowed, packed, turned, widened,
};
use super::kernels::{Bodies, scale_and_add};
use super::slot::FeatureSlot;
use crate::dynamics::series::lanes::{
    Lane, LaneVector, add_cross, difference_whole, plus_whole, scaled, sum_whole, times_whole,
};
use crate::dynamics::series::recurrence::acceleration_factor;
use crate::system::System;
use crate::system::body::RigidBody;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;
use pulp::Simd;
use std::ops::Range;
use std::slice::{from_mut, from_ref};
use triad_linalg::fma;

/// One body.
#[derive(Clone, Debug)]
pub struct Single {
    /// The same with its numbers one by one: its constants and what is made of them at the point of expansion.
    pub(super) plain: Bundle<1>,
    /// 1/m and −Ī of u, v, w, as often as a vector has components.
    inverse_mass: Components,
    minus_ibar: [Components; 3],
    weight: [Components; 4],
    /// Half the dual basis of the directors, and the columns of I_g⁻¹.
    dual: [Components; 3],
    inverse: [Components; 3],
    force: [Components; 4],
    moment: Components,
    solution: [Components; 4],
    omega: Components,
    /// What it does if nothing joins it to others.
    alone: Alone,
}

impl Single {
    fn vector(x: &[Components; 4], k: usize) -> Vector3<f64> {
        Vector3::new(x[k][0], x[k][1], x[k][2])
    }
}

impl Bodies<1> for Single {
    /// Those of uu, vv, ww, uv, and of uw, vw.
    type Rigid = [Components; 2];
    type Moment = Components;
    type Directors = [Components; 3];
    type Mobility = [LaneVector<1>; 3];
    const ZERO: Self::Natural = [ZERO; 4];
    const NO_DIRECTORS: Self::Directors = [ZERO; 3];
    const NO_MOBILITY: Self::Mobility = Bundle::NO_MOBILITY;
    const NO_MOMENT: Self::Moment = ZERO;
    const DIRECTIONS: usize = 3;
    const TWIST: usize = 6;
    const STRIPS: usize = 3;

    fn empty(bodies: Range<usize>, slots: Range<usize>) -> Self {
        Self {
            plain: Bundle::empty(bodies, slots),
            inverse_mass: ZERO,
            minus_ibar: [ZERO; 3],
            weight: [ZERO; 4],
            dual: [ZERO; 3],
            inverse: [ZERO; 3],
            force: [ZERO; 4],
            moment: ZERO,
            solution: [ZERO; 4],
            omega: ZERO,
            alone: Alone::empty(),
        }
    }

    fn set_body(&mut self, lane: usize, system: &System, body: &RigidBody) {
        self.plain.set_body(lane, system, body);
        self.inverse_mass = [body.free_inverse_mass(); 4];
        self.alone = Alone::of(system, body);
        self.weight = self.plain.weight.map(|x| widened(&x));
        for c in 0..3 {
            self.minus_ibar[c] = [-body.ibar[c]; 4];
        }
    }

    fn bodies(&self) -> Range<usize> {
        self.plain.bodies()
    }

    fn slots(&self) -> Range<usize> {
        self.plain.slots()
    }

    fn at_rest() -> [Components; 4] {
        Bundle::at_rest().map(|x| widened(&x))
    }

    #[inline(always)]
    fn lanes(x: &[Components; 4]) -> &[Lane<1>] {
        x.as_flattened().as_chunks().0
    }

    #[inline(always)]
    fn lanes_mut(x: &mut [Components; 4]) -> &mut [Lane<1>] {
        x.as_flattened_mut().as_chunks_mut().0
    }

    fn read(&self, _: usize, lift: &NaturalCoordinates, out: &mut [Components; 4]) {
        for (out, vector) in out.iter_mut().zip([lift.r, lift.e[0], lift.e[1], lift.e[2]]) {
            *out = [vector[0], vector[1], vector[2], 0.0];
        }
    }

    fn write(&self, _: usize, x: &[Components; 4], _rate: bool) -> NaturalCoordinates {
        let [r, u, v, w] = [0, 1, 2, 3].map(|k| Self::vector(x, k));
        NaturalCoordinates { r, e: [u, v, w] }
    }

    #[inline(always)]
    fn value(slot: &FeatureSlot<1>, x: &[Components; 4]) -> LaneVector<1> {
        Bundle::value(slot, &narrowed(x))
    }

    #[inline(always)]
    fn add_constant(&self, _: &FeatureSlot<1>, _: &mut LaneVector<1>) {}

    #[inline(always)]
    fn pull_back(slot: &FeatureSlot<1>, f: &LaneVector<1>, sum: &mut [Components; 4]) {
        for c in 0..3 {
            sum[0][c] += slot.point[0] * f[c][0];
            for k in 0..3 {
                sum[1 + k][c] += slot.local[k][0] * f[c][0];
            }
        }
    }

    fn arm(local: &Vector3<f64>, q: &[Components; 4], lane: usize, order: usize) -> Vector3<f64> {
        Bundle::arm(local, &narrowed(q), lane, order)
    }

    fn center(q: &[Components; 4], _: usize) -> Vector3<f64> {
        Self::vector(q, 0)
    }

    fn spin(e: &[Components; 4], f: &[Components; 4], lane: usize) -> Vector3<f64> {
        Bundle::spin(&narrowed(e), &narrowed(f), lane)
    }

    fn add_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..3 {
            self.force[0][c] += force[c];
        }
        self.add_director_force(lane, at, force);
    }

    fn add_director_force(&mut self, _: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..3 {
            for k in 0..3 {
                self.force[1 + k][c] += at[k] * force[c];
            }
        }
    }

    fn add_moment(&mut self, _: usize, moment: &Vector3<f64>) {
        for c in 0..3 {
            self.moment[c] += moment[c];
        }
    }

    #[inline(always)]
    fn linearize(&mut self, q: &[Components; 4]) {
        self.plain.linearize(&narrowed(q));
        let Bundle { dual, inverse, .. } = &self.plain;
        for k in 0..3 {
            (self.dual[k], self.inverse[k]) = (widened(&dual[k]), widened(&inverse[k]));
        }
    }

    #[inline(always)]
    fn half_mobility(&self, slot: &FeatureSlot<1>, q: &[Components; 4]) -> [LaneVector<1>; 3] {
        self.plain.half_mobility(slot, &narrowed(q))
    }

    #[inline(always)]
    fn add_translation(g: &[f64; 3], factor: f64, row: &mut [f64]) {
        <Bundle<1> as Bodies<1>>::add_translation(g, factor, row);
    }

    #[inline(always)]
    fn set_unit_rotations(m: &[LaneVector<1>; 3], lane: usize, sign: f64, block: &mut [f64]) {
        Bundle::set_unit_rotations(m, lane, sign, block);
    }

    #[inline(always)]
    fn add_rotation(m: &[LaneVector<1>; 3], lane: usize, g: &[f64; 3], sign: f64, row: &mut [f64]) {
        Bundle::add_rotation(m, lane, g, sign, row);
    }

    #[inline(always)]
    fn pair(a: &[LaneVector<1>; 3], b: &[LaneVector<1>; 3]) -> [[Lane<1>; 4]; 3] {
        Bundle::pair(a, b)
    }

    #[inline(always)]
    fn clear_force(&mut self) {
        self.force = [ZERO; 4];
        self.moment = ZERO;
    }

    #[inline(always)]
    fn add_weight(&mut self) {
        self.force = self.weight;
    }

    #[inline(always)]
    fn force_mut(&mut self) -> &mut [Components; 4] {
        &mut self.force
    }

    #[inline(always)]
    fn solution(&self) -> &[Components; 4] {
        &self.solution
    }

    #[inline(always)]
    fn position_correction(&self, q: &[Components; 4]) -> [Components; 2] {
        packed(&self.plain.position_correction(&narrowed(q)))
    }

    #[inline(always)]
    fn velocity_correction(&self, q: &[Components; 4], q_dot: &[Components; 4]) -> [Components; 2] {
        packed(&self.plain.velocity_correction(&narrowed(q), &narrowed(q_dot)))
    }

    #[inline(always)]
    fn gram<S: Simd>(simd: S, q: &[[Components; 4]], n: usize, kappa: f64) -> [Components; 2] {
        gram(simd, q, n, kappa)
    }

    #[inline(always)]
    fn moment<S: Simd>(simd: S, q: &[[Components; 4]], p: &[[Components; 3]], n: usize) -> Components {
        moment(simd, q, p, n)
    }

    #[inline(always)]
    fn known_turn(q: &[[Components; 4]], n: usize) -> Components {
        let mut known = [[0.0]; 3];
        for (i, e) in q[1..=n].iter().enumerate() {
            let half = 0.5 * acceleration_factor(n - 1 - i);
            for (e, f) in e[1..].iter().zip(&q[n + 1 - i][1..]) {
                add_cross(&mut known, &column(e), &scaled(&[half], &column(f)));
            }
        }
        widened(&known)
    }

    #[inline(always)]
    fn alone<S: Simd>(&mut self, simd: S, q: &[[Components; 4]], n: usize) -> Option<[Components; 4]> {
        Some(self.alone.expand(simd, q, n))
    }

    #[inline(always)]
    fn begin<S: Simd>(&mut self, simd: S, q: &[Components; 4], gamma: &[Components; 2], known: Components) {
        let [[uu, vv, ww, uv], [uw, vw, ..]] = *gamma;
        let (mut particular, mut p) = ([ZERO; 3], [ZERO; 3]);
        for (k, row) in [[uu, uv, uw], [uv, vv, vw], [uw, vw, ww]].into_iter().enumerate() {
            particular[k] = combined(simd, row, &self.dual);
            p[k] = plus_whole(simd, &self.minus_ibar[k], &particular[k], &self.force[1 + k]);
        }
        let [_, u, v, w] = *q;
        let moment = sum_whole(simd, &sum_whole(simd, &known, &self.moment), &cross(simd, &[u, v, w], &p));
        self.omega = ZERO;
        let [u, v, w] = particular;
        self.solution = [times_whole(simd, &self.inverse_mass, &self.force[0]), u, v, w];
        self.turn(simd, q, moment);
    }

    #[inline(always)]
    fn apply<S: Simd>(&mut self, simd: S, q: &[Components; 4], force: &[Components; 4]) {
        let ([_, u, v, w], [f, a, b, c]) = (*q, *force);
        self.solution[0] = plus_whole(simd, &self.inverse_mass, &f, &self.solution[0]);
        self.turn(simd, q, cross(simd, &[u, v, w], &[a, b, c]));
        for (all, force) in self.force.iter_mut().zip(force) {
            *all = sum_whole(simd, all, force);
        }
    }

    #[inline(always)]
    fn moment_of<S: Simd>(simd: S, [_, u, v, w]: &[Components; 4], force: &[Components; 4]) -> Components {
        let [_, a, b, c] = *force;
        cross(simd, &[*u, *v, *w], &[a, b, c])
    }

    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, q: &[Components; 4], moment: Components) {
        let [x, y, z, _] = moment;
        let omega = combined(simd, [x, y, z], &self.inverse);
        self.rotate(simd, q, omega);
    }

    #[inline(always)]
    fn rotate<S: Simd>(&mut self, simd: S, q: &[Components; 4], omega: Components) {
        self.omega = sum_whole(simd, &self.omega, &omega);
        let ahead = turned(omega);
        for k in 1..4 {
            let (first, second) =
                (times_whole(simd, &omega, &turned(q[k])), times_whole(simd, &ahead, &q[k]));
            let across = turned(difference_whole(simd, &first, &second));
            self.solution[k] = sum_whole(simd, &self.solution[k], &across);
        }
    }

    #[inline(always)]
    fn carried_on(q: &[[Components; 4]], turns: &[Components]) -> Components {
        let mut expected = ZERO;
        for k in 1..4 {
            let mut along = 0.0;
            for (turn, e) in turns.iter().zip(q[1..=turns.len()].iter().rev()) {
                for c in 0..3 {
                    along = fma(turn[c], e[k][c], along);
                }
            }
            for c in 0..3 {
                expected[c] = fma(-along, q[0][k][c], expected[c]);
            }
        }
        expected
    }

    #[inline(always)]
    fn moments_squared(&self) -> Lane<1> {
        let mut squared = 0.0;
        for k in 0..3 {
            for c in 0..3 {
                let inertial = self.minus_ibar[k][c] * self.solution[1 + k][c];
                squared = fma(self.force[1 + k][c], self.force[1 + k][c], fma(inertial, inertial, squared));
            }
        }
        [squared]
    }

    #[inline(always)]
    fn delta(&self) -> &Lane<1> {
        &self.plain.regularizing_inertia
    }

    #[inline(always)]
    fn omega(&self) -> &Components {
        &self.omega
    }

    #[inline(always)]
    fn moment_lanes(moment: &Components) -> &[Lane<1>] {
        moment.as_chunks().0
    }

    #[inline(always)]
    fn moment_lanes_mut(moment: &mut Components) -> &mut [Lane<1>] {
        moment.as_chunks_mut().0
    }

    #[inline(always)]
    fn directors([_, e @ ..]: &[Components; 4]) -> [Components; 3] {
        *e
    }

    #[inline(always)]
    fn rest(&mut self) {
        self.solution = [ZERO; 4];
        self.omega = ZERO;
        self.clear_force();
    }

    #[inline(always)]
    fn scale_and_add(&mut self, own: f64, other: &Self, factor: f64) {
        scale_and_add(&mut self.solution, own, &other.solution, factor);
        scale_and_add(&mut self.force, own, &other.force, factor);
        scale_and_add(from_mut(&mut self.omega), own, from_ref(&other.omega), factor);
    }

    #[inline(always)]
    fn director_forces<S: Simd>(&self, simd: S) -> [Components; 3] {
        let mut p = [ZERO; 3];
        for k in 0..3 {
            p[k] = plus_whole(simd, &self.minus_ibar[k], &self.solution[1 + k], &self.force[1 + k]);
        }
        p
    }
}
