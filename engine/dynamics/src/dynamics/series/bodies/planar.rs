//! L bodies side by side that move in a plane: the same formulation with one director z of two components.
//!
//! A point is P = r + a z + b J z with J a quarter turn, the only rigid-body row is z · z = 1, the twist is
//! (ṙ, ω) with three components, and the mass matrix is diag(m, m, I, I) with the moment of inertia I about the normal.

use super::alone_in_plane::AloneInPlane;
use super::kernels::{Bodies, scale_and_add};
use super::pair::{Pair, cross, each, gram, moment, turned};
use super::slot::FeatureSlot;
use crate::dynamics::series::lanes::{Lane, LaneVector, plus};
use crate::dynamics::series::recurrence::acceleration_factor;
use crate::system::System;
use crate::system::body::{PlanarPose, RigidBody};
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;
use pulp::Simd;
use std::ops::Range;
use std::slice::{from_mut, from_ref};

/// L bodies in a plane.
#[derive(Clone, Debug)]
pub struct Planar<const L: usize> {
    bodies: Range<usize>,
    slots: Range<usize>,
    /// How each body stands in the plane, and the plane itself.
    poses: [PlanarPose; L],
    height: Lane<L>,
    pub(super) mass: Lane<L>,
    /// 1/m, or zero for a body about its pivot.
    inverse_mass: Lane<L>,
    pub(super) inertia: Lane<L>,
    regularizing_inertia: Lane<L>,
    /// The weight, as a generalized force.
    pub(super) weight: [Pair<L>; 2],
    /// z / (2 |z|²), and the part of z̈ that satisfies z · z = 1.
    dual: Pair<L>,
    particular: Pair<L>,
    /// 1 / I_g and its root, δ included.
    inverse: Lane<L>,
    root: Lane<L>,
    force: [Pair<L>; 2],
    /// Moment that acts besides.
    moment: Lane<L>,
    solution: [Pair<L>; 2],
    omega: Lane<L>,
    /// Half the accelerations of their centres of mass, and how they turn, if nothing joins them to others.
    fall: Pair<L>,
    alone: AloneInPlane<L>,
}

impl<const L: usize> Planar<L> {
    /// Adds the effect of a force at the centre of mass and of a moment about it. z̈ is computed from the sum of all ω̇: where δ
    /// is small, their large parts must not leave their rounding in z · z̈.
    #[inline(always)]
    fn push(&mut self, z: &Pair<L>, force: &Pair<L>, moment: &Lane<L>) {
        for l in 0..L {
            self.omega[l] += self.inverse[l] * moment[l];
            self.solution[0][0][l] += self.inverse_mass[l] * force[0][l];
            self.solution[0][1][l] += self.inverse_mass[l] * force[1][l];
            self.solution[1][0][l] = self.particular[0][l] - self.omega[l] * z[1][l];
            self.solution[1][1][l] = self.particular[1][l] + self.omega[l] * z[0][l];
        }
    }
}

impl<const L: usize> Bodies<L> for Planar<L> {
    /// Of z · z = 1.
    type Rigid = Lane<L>;
    type Moment = Lane<L>;
    type Directors = Pair<L>;
    type Mobility = Pair<L>;
    const ZERO: Self::Natural = [[[0.0; L]; 2]; 2];
    const NO_DIRECTORS: Self::Directors = [[0.0; L]; 2];
    const NO_MOBILITY: Self::Mobility = [[0.0; L]; 2];
    const NO_MOMENT: Self::Moment = [0.0; L];
    const DIRECTIONS: usize = 2;
    const TWIST: usize = 3;
    const STRIPS: usize = 1;

    fn empty(bodies: Range<usize>, slots: Range<usize>) -> Self {
        let zeros = [[0.0; L]; 2];
        Self {
            bodies,
            slots,
            poses: [PlanarPose::default(); L],
            height: [0.0; L],
            mass: [1.0; L],
            inverse_mass: [1.0; L],
            inertia: [1.0; L],
            regularizing_inertia: [0.0; L],
            weight: [zeros; 2],
            dual: zeros,
            particular: zeros,
            inverse: [1.0; L],
            root: [1.0; L],
            force: [zeros; 2],
            moment: [0.0; L],
            solution: [zeros; 2],
            omega: [0.0; L],
            fall: zeros,
            alone: AloneInPlane::empty(),
        }
    }

    fn set_body(&mut self, lane: usize, system: &System, body: &RigidBody) {
        self.mass[lane] = body.mass;
        self.inverse_mass[lane] = body.free_inverse_mass();
        self.inertia[lane] = body.ibar[0];
        self.regularizing_inertia[lane] = body.regularizing_inertia;
        let Some(pose) = body.planar_pose else { return };
        (self.poses[lane], self.height[lane]) = (pose, pose.height);
        let (weight, center) = (system.model.gravity * body.mass, pose.directors * body.center());
        let of_director =
            [center[0] * weight[0] + center[1] * weight[1], center[0] * weight[1] - center[1] * weight[0]];
        for c in 0..2 {
            self.weight[0][c][lane] = weight[c];
            self.weight[1][c][lane] = of_director[c];
            self.fall[c][lane] = 0.5 * self.inverse_mass[lane] * weight[c];
        }
        self.alone.set_torque(lane, of_director.map(|force| force / body.ibar[0]));
    }

    fn bodies(&self) -> Range<usize> {
        self.bodies.clone()
    }

    fn slots(&self) -> Range<usize> {
        self.slots.clone()
    }

    fn at_rest() -> [Pair<L>; 2] {
        [[[0.0; L]; 2], [[1.0; L], [0.0; L]]]
    }

    #[inline(always)]
    fn lanes(x: &[Pair<L>; 2]) -> &[Lane<L>] {
        x.as_flattened()
    }

    #[inline(always)]
    fn lanes_mut(x: &mut [Pair<L>; 2]) -> &mut [Lane<L>] {
        x.as_flattened_mut()
    }

    fn read(&self, lane: usize, lift: &NaturalCoordinates, out: &mut [Pair<L>; 2]) {
        let ([x, y], [c, s]) = self.poses[lane].lower(lift);
        for (out, value) in out.as_flattened_mut().iter_mut().zip([x, y, c, s]) {
            out[lane] = value;
        }
    }

    fn write(&self, lane: usize, x: &[Pair<L>; 2], rate: bool) -> NaturalCoordinates {
        let [r, z] = x.map(|v| [v[0][lane], v[1][lane]]);
        self.poses[lane].raise(r, z, rate)
    }

    #[inline(always)]
    fn value(slot: &FeatureSlot<L>, x: &[Pair<L>; 2]) -> LaneVector<L> {
        let [r, z] = x;
        let ([a, b, _], point) = (&slot.local, &slot.point);
        [
            each(|l| point[l] * r[0][l] + a[l] * z[0][l] - b[l] * z[1][l]),
            each(|l| point[l] * r[1][l] + a[l] * z[1][l] + b[l] * z[0][l]),
            [0.0; L],
        ]
    }

    #[inline(always)]
    fn add_constant(&self, slot: &FeatureSlot<L>, value: &mut LaneVector<L>) {
        for l in 0..L {
            value[2][l] += slot.local[2][l] + slot.point[l] * self.height[l];
        }
    }

    #[inline(always)]
    fn pull_back(slot: &FeatureSlot<L>, f: &LaneVector<L>, sum: &mut [Pair<L>; 2]) {
        let ([a, b, _], point, [x, y, _]) = (&slot.local, &slot.point, f);
        for l in 0..L {
            sum[0][0][l] += point[l] * x[l];
            sum[0][1][l] += point[l] * y[l];
            sum[1][0][l] += a[l] * x[l] + b[l] * y[l];
            sum[1][1][l] += a[l] * y[l] - b[l] * x[l];
        }
    }

    fn arm(local: &Vector3<f64>, q: &[Pair<L>; 2], lane: usize, order: usize) -> Vector3<f64> {
        let (a, b, [c, s]) = (local[0], local[1], [0, 1].map(|k| q[1][k][lane]));
        Vector3::new(a * c - b * s, a * s + b * c, if order == 0 { local[2] } else { 0.0 })
    }

    fn center(q: &[Pair<L>; 2], lane: usize) -> Vector3<f64> {
        Vector3::new(q[0][0][lane], q[0][1][lane], 0.0)
    }

    fn spin([_, z]: &[Pair<L>; 2], [_, rate]: &[Pair<L>; 2], lane: usize) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, z[0][lane] * rate[1][lane] - z[1][lane] * rate[0][lane])
    }

    fn add_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..2 {
            self.force[0][c][lane] += force[c];
        }
        self.add_director_force(lane, at, force);
    }

    fn add_director_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        let (a, b, x, y) = (at[0], at[1], force[0], force[1]);
        self.force[1][0][lane] += a * x + b * y;
        self.force[1][1][lane] += a * y - b * x;
    }

    fn add_moment(&mut self, lane: usize, moment: &Vector3<f64>) {
        self.moment[lane] += moment[2];
    }

    #[inline(always)]
    fn linearize(&mut self, q: &[Pair<L>; 2]) {
        let z = &q[1];
        for l in 0..L {
            let square = z[0][l] * z[0][l] + z[1][l] * z[1][l];
            let half = 0.5 / square;
            self.dual[0][l] = half * z[0][l];
            self.dual[1][l] = half * z[1][l];
            self.inverse[l] = 1.0 / (self.inertia[l] * square + self.regularizing_inertia[l]);
            self.root[l] = self.inverse[l].sqrt();
        }
    }

    #[inline(always)]
    fn half_mobility(&self, slot: &FeatureSlot<L>, q: &[Pair<L>; 2]) -> Pair<L> {
        let [a, b, _] = slot.local;
        let ([x, y], root) = (turned(&[a, b], &q[1]), &self.root);
        [each(|l| -(root[l] * y[l])), each(|l| root[l] * x[l])]
    }

    #[inline(always)]
    fn add_translation(g: &[f64; 3], factor: f64, row: &mut [f64]) {
        for (row, g) in row.iter_mut().take(2).zip(g) {
            *row += factor * g;
        }
    }

    #[inline(always)]
    fn set_unit_rotations(m: &Pair<L>, lane: usize, sign: f64, block: &mut [f64]) {
        let lane = lane % L;
        let Some(block) = block.as_chunks_mut::<3>().0.first_chunk_mut::<2>() else { return };
        for (k, row) in block.iter_mut().enumerate() {
            row[2] = sign * m[k][lane];
        }
    }

    #[inline(always)]
    fn add_rotation(m: &Pair<L>, lane: usize, g: &[f64; 3], sign: f64, row: &mut [f64]) {
        let (lane, Some(row)) = (lane % L, row.first_chunk_mut::<3>()) else { return };
        row[2] += sign * (m[0][lane] * g[0] + m[1][lane] * g[1]);
    }

    #[inline(always)]
    fn pair(a: &Pair<L>, b: &Pair<L>) -> [[Lane<L>; 4]; 3] {
        let mut strip = [[0.0; L]; 4];
        for i in 0..2 {
            for k in 0..2 {
                for l in 0..L {
                    strip[2 * i + k][l] = a[i][l] * b[k][l];
                }
            }
        }
        [strip, [[0.0; L]; 4], [[0.0; L]; 4]]
    }

    #[inline(always)]
    fn clear_force(&mut self) {
        self.force = Self::ZERO;
        self.moment = [0.0; L];
    }

    #[inline(always)]
    fn add_weight(&mut self) {
        self.force = self.weight;
    }

    #[inline(always)]
    fn force_mut(&mut self) -> &mut [Pair<L>; 2] {
        &mut self.force
    }

    #[inline(always)]
    fn begin<S: Simd>(&mut self, _: S, q: &[Pair<L>; 2], gamma: &Lane<L>, mut moment: Lane<L>) {
        let z = &q[1];
        for l in 0..L {
            self.particular[0][l] = gamma[l] * self.dual[0][l];
            self.particular[1][l] = gamma[l] * self.dual[1][l];
            let p = [0, 1].map(|c| self.force[1][c][l] - self.inertia[l] * self.particular[c][l]);
            moment[l] += self.moment[l] + z[0][l] * p[1] - z[1][l] * p[0];
            self.omega[l] = 0.0;
        }
        self.solution[0] = [[0.0; L]; 2];
        let force = self.force[0];
        self.push(z, &force, &moment);
    }

    #[inline(always)]
    fn apply<S: Simd>(&mut self, _: S, q: &[Pair<L>; 2], force: &[Pair<L>; 2]) {
        let moment = cross(&q[1], &force[1]);
        for c in 0..2 {
            for l in 0..L {
                self.force[0][c][l] += force[0][c][l];
                self.force[1][c][l] += force[1][c][l];
            }
        }
        self.push(&q[1], &force[0], &moment);
    }

    #[inline(always)]
    fn moment_of<S: Simd>(_: S, [_, z]: &[Pair<L>; 2], [_, force]: &[Pair<L>; 2]) -> Lane<L> {
        cross(z, force)
    }

    #[inline(always)]
    fn turn<S: Simd>(&mut self, _: S, [_, z]: &[Pair<L>; 2], moment: Lane<L>) {
        self.push(z, &[[0.0; L]; 2], &moment);
    }

    #[inline(always)]
    fn rotate<S: Simd>(&mut self, _: S, [_, z]: &[Pair<L>; 2], omega: Lane<L>) {
        for l in 0..L {
            self.omega[l] += omega[l];
        }
        self.push(z, &[[0.0; L]; 2], &[0.0; L]);
    }

    #[inline(always)]
    fn carried_on(_: &[[Pair<L>; 2]], _: &[Lane<L>]) -> Lane<L> {
        // The normal is the same in all orders.
        [0.0; L]
    }

    #[inline(always)]
    fn moments_squared(&self) -> Lane<L> {
        each(|l| {
            let of = |c: usize| (self.force[1][c][l], self.inertia[l] * self.solution[1][c][l]);
            [of(0), of(1)].into_iter().map(|(force, inertial)| force * force + inertial * inertial).sum()
        })
    }

    #[inline(always)]
    fn delta(&self) -> &Lane<L> {
        &self.regularizing_inertia
    }

    #[inline(always)]
    fn omega(&self) -> &Lane<L> {
        &self.omega
    }

    #[inline(always)]
    fn moment_lanes(moment: &Lane<L>) -> &[Lane<L>] {
        from_ref(moment)
    }

    #[inline(always)]
    fn moment_lanes_mut(moment: &mut Lane<L>) -> &mut [Lane<L>] {
        from_mut(moment)
    }

    #[inline(always)]
    fn directors([_, z]: &[Pair<L>; 2]) -> Pair<L> {
        *z
    }

    #[inline(always)]
    fn rest(&mut self) {
        self.solution = Self::ZERO;
        self.omega = [0.0; L];
        self.particular = [[0.0; L]; 2];
        self.clear_force();
    }

    #[inline(always)]
    fn scale_and_add(&mut self, own: f64, other: &Self, factor: f64) {
        scale_and_add(self.solution.as_flattened_mut(), own, other.solution.as_flattened(), factor);
        scale_and_add(self.force.as_flattened_mut(), own, other.force.as_flattened(), factor);
        scale_and_add(from_mut(&mut self.omega), own, from_ref(&other.omega), factor);
    }

    #[inline(always)]
    fn solution(&self) -> &[Pair<L>; 2] {
        &self.solution
    }

    #[inline(always)]
    fn director_forces<S: Simd>(&self, _: S) -> Pair<L> {
        let ([x, y], mut p) = (&self.solution[1], self.force[1]);
        for l in 0..L {
            p[0][l] -= self.inertia[l] * x[l];
            p[1][l] -= self.inertia[l] * y[l];
        }
        p
    }

    #[inline(always)]
    fn gram<S: Simd>(_: S, q: &[[Pair<L>; 2]], n: usize, kappa: f64) -> Self::Rigid {
        gram(q, n, kappa)
    }

    #[inline(always)]
    fn moment<S: Simd>(_: S, q: &[[Pair<L>; 2]], p: &[Pair<L>], n: usize) -> Lane<L> {
        moment(q, p, n)
    }

    #[inline(always)]
    fn known_turn(q: &[[Pair<L>; 2]], n: usize) -> Lane<L> {
        let mut known = [0.0; L];
        for (i, [_, z]) in q[1..=n].iter().enumerate() {
            let across = cross(z, &q[n + 1 - i][1]);
            known = plus(&[acceleration_factor(n - 1 - i); L], &across, &known);
        }
        known
    }

    #[inline(always)]
    fn alone<S: Simd>(&mut self, _: S, q: &[[Pair<L>; 2]], n: usize) -> Option<[Pair<L>; 2]> {
        let fall = if n == 0 { self.fall } else { [[0.0; L]; 2] };
        Some([fall, self.alone.expand(q, n)])
    }

    #[inline(always)]
    fn position_correction(&self, [_, z]: &[Pair<L>; 2]) -> Lane<L> {
        each(|l| 1.0 - (z[0][l] * z[0][l] + z[1][l] * z[1][l]))
    }

    #[inline(always)]
    fn velocity_correction(&self, [_, z]: &[Pair<L>; 2], [_, rate]: &[Pair<L>; 2]) -> Lane<L> {
        each(|l| -2.0 * (z[0][l] * rate[0][l] + z[1][l] * rate[1][l]))
    }
}
