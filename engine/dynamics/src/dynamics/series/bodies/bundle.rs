//! L bodies side by side: the part of the equations of motion that concerns each body alone — THEORY sections 7, 11.

use super::convolution::{gram, moment, symmetric};
use super::inertia::{invert_inertia, products_of_inertia};
use super::kernels::{Bodies, scale_and_add};
use super::slot::FeatureSlot;
use crate::dynamics::series::lanes::{
    Lane, LaneVector, Natural, add_cross, add_dot, add_scaled, cross, dot, less, minor, multiply, negative,
    plus, scaled, sum, times, zero,
};
use crate::dynamics::series::recurrence::acceleration_factor;
use crate::system::{System, body::RigidBody, natural::NaturalCoordinates};
use nalgebra::Vector3;
use pulp::Simd;
use std::ops::Range;

/// L bodies: what never changes, what belongs to the point of expansion, and the present solution.
#[derive(Clone, Debug)]
pub struct Bundle<const L: usize> {
    /// The bodies; fewer than L in the last bundle, whose other lanes hold bodies at rest without joints.
    bodies: Range<usize>,
    /// Their features.
    slots: Range<usize>,
    pub(super) mass: Lane<L>,
    /// 1/m, or zero for a body about its pivot.
    pub(super) inverse_mass: Lane<L>,
    /// Ī of u, v, w.
    pub(super) ibar: LaneVector<L>,
    /// δ, the inertia regularization.
    pub(super) regularizing_inertia: Lane<L>,
    /// The weight, as a generalized force.
    pub(super) weight: Natural<L>,
    /// Half the dual basis of the directors.
    pub(super) dual: [LaneVector<L>; 3],
    /// Rows of I_g⁻¹, δ included.
    pub(super) inverse: [LaneVector<L>; 3],
    /// Lower triangle (00, 10, 11, 20, 21, 22) of C⁻¹, I_g = C Cᵀ.
    lower: [Lane<L>; 6],
    /// Generalized force that acts, less the known convolutions.
    force: Natural<L>,
    /// Moment about the centre of mass that acts besides.
    moment: LaneVector<L>,
    /// The unknown: κ Q_(n+2), or a correction of Q.
    solution: Natural<L>,
    /// Its twist part ω̇.
    omega: LaneVector<L>,
}

impl<const L: usize> Bundle<L> {
    fn vector(x: &Natural<L>, k: usize, lane: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| x[k][c][lane])
    }
}

impl<const L: usize> Bodies<L> for Bundle<L> {
    type Rigid = [Lane<L>; 6];
    type Moment = LaneVector<L>;
    type Directors = [LaneVector<L>; 3];
    type Mobility = [LaneVector<L>; 3];
    const ZERO: Self::Natural = zero();
    const NO_DIRECTORS: Self::Directors = [[[0.0; L]; 3]; 3];
    const NO_MOBILITY: Self::Mobility = [[[0.0; L]; 3]; 3];
    const NO_MOMENT: Self::Moment = [[0.0; L]; 3];
    const DIRECTIONS: usize = 3;
    const TWIST: usize = 6;
    const STRIPS: usize = 3;

    fn empty(bodies: Range<usize>, slots: Range<usize>) -> Self {
        let zeros = [[0.0; L]; 3];
        Self {
            bodies,
            slots,
            mass: [1.0; L],
            inverse_mass: [1.0; L],
            ibar: [[1.0; L]; 3],
            regularizing_inertia: [0.0; L],
            weight: zero(),
            dual: [zeros; 3],
            inverse: [zeros; 3],
            lower: [[0.0; L]; 6],
            force: zero(),
            moment: zeros,
            solution: zero(),
            omega: zeros,
        }
    }

    fn set_body(&mut self, lane: usize, system: &System, body: &RigidBody) {
        (self.mass[lane], self.inverse_mass[lane]) = (body.mass, body.free_inverse_mass());
        self.regularizing_inertia[lane] = body.regularizing_inertia;
        for c in 0..3 {
            self.ibar[c][lane] = body.ibar[c];
        }
        let mut weights = self.weight;
        self.read(lane, &body.weight(&system.model.gravity), &mut weights);
        self.weight = weights;
    }

    fn bodies(&self) -> Range<usize> {
        self.bodies.clone()
    }

    fn slots(&self) -> Range<usize> {
        self.slots.clone()
    }

    fn at_rest() -> Natural<L> {
        let mut q = zero();
        for k in 0..3 {
            q[1 + k][k] = [1.0; L];
        }
        q
    }

    #[inline(always)]
    fn lanes(x: &Natural<L>) -> &[Lane<L>] {
        x.as_flattened()
    }

    #[inline(always)]
    fn lanes_mut(x: &mut Natural<L>) -> &mut [Lane<L>] {
        x.as_flattened_mut()
    }

    fn read(&self, lane: usize, lift: &NaturalCoordinates, out: &mut Natural<L>) {
        for (out, vector) in out.iter_mut().zip([lift.r, lift.e[0], lift.e[1], lift.e[2]]) {
            for c in 0..3 {
                out[c][lane] = vector[c];
            }
        }
    }

    fn write(&self, lane: usize, x: &Natural<L>, _rate: bool) -> NaturalCoordinates {
        let [r, u, v, w] = [0, 1, 2, 3].map(|k| Self::vector(x, k, lane));
        NaturalCoordinates { r, e: [u, v, w] }
    }

    #[inline(always)]
    fn value(slot: &FeatureSlot<L>, x: &Natural<L>) -> LaneVector<L> {
        let mut value = scaled(&slot.point, &x[0]);
        for k in 0..3 {
            add_scaled(&mut value, &slot.local[k], &x[1 + k]);
        }
        value
    }

    #[inline(always)]
    fn add_constant(&self, _: &FeatureSlot<L>, _: &mut LaneVector<L>) {}

    #[inline(always)]
    fn pull_back(slot: &FeatureSlot<L>, f: &LaneVector<L>, sum: &mut Natural<L>) {
        add_scaled(&mut sum[0], &slot.point, f);
        for k in 0..3 {
            add_scaled(&mut sum[1 + k], &slot.local[k], f);
        }
    }

    fn arm(local: &Vector3<f64>, q: &Natural<L>, lane: usize, _order: usize) -> Vector3<f64> {
        Vector3::from_fn(|c, _| (0..3).map(|k| local[k] * q[1 + k][c][lane]).sum())
    }

    fn center(q: &Natural<L>, lane: usize) -> Vector3<f64> {
        Self::vector(q, 0, lane)
    }

    fn spin(e: &Natural<L>, f: &Natural<L>, lane: usize) -> Vector3<f64> {
        let cross = |k: usize| Self::vector(e, k, lane).cross(&Self::vector(f, k, lane));
        (1..4).map(cross).sum::<Vector3<f64>>() * 0.5
    }

    fn add_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..3 {
            self.force[0][c][lane] += force[c];
        }
        self.add_director_force(lane, at, force);
    }

    fn add_director_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..3 {
            for k in 0..3 {
                self.force[1 + k][c][lane] += at[k] * force[c];
            }
        }
    }

    fn add_moment(&mut self, lane: usize, moment: &Vector3<f64>) {
        for c in 0..3 {
            self.moment[c][lane] += moment[c];
        }
    }

    /// Dual basis and inertia at the position q.
    #[inline(always)]
    fn linearize(&mut self, q: &Natural<L>) {
        let [_, u, v, w] = q;
        let dual = [cross(v, w), cross(w, u), cross(u, v)];
        let half = dot(u, &dual[0]).map(|volume| 0.5 / volume);
        self.dual = dual.map(|d| scaled(&half, &d));
        let products = products_of_inertia(&self.ibar, q);
        (self.inverse, self.lower) = invert_inertia(&products, &self.regularizing_inertia);
    }

    /// C⁻¹ s̃ of a feature's arm s: three rows.
    #[inline(always)]
    fn half_mobility(&self, slot: &FeatureSlot<L>, q: &Natural<L>) -> [LaneVector<L>; 3] {
        let mut arm = [[0.0; L]; 3];
        for k in 0..3 {
            add_scaled(&mut arm, &slot.local[k], &q[1 + k]);
        }
        let [x, y, z] = &arm;
        let [p0, m10, p1, m20, m21, p2] = &self.lower;
        // s̃ = [[0, −z, y], [z, 0, −x], [−y, x, 0]].
        [
            [[0.0; L], negative(&times(p0, z)), times(p0, y)],
            [times(p1, z), negative(&times(m10, z)), minor(m10, y, p1, x)],
            [minor(m21, z, p2, y), minor(p2, x, m20, z), minor(m20, y, m21, x)],
        ]
    }

    #[inline(always)]
    fn add_translation(g: &[f64; 3], factor: f64, row: &mut [f64]) {
        for (row, g) in row.iter_mut().zip(g) {
            *row += factor * g;
        }
    }

    #[inline(always)]
    fn set_unit_rotations(m: &[LaneVector<L>; 3], lane: usize, sign: f64, block: &mut [f64]) {
        let lane = lane % L;
        let Some(block) = block.as_chunks_mut::<6>().0.first_chunk_mut::<3>() else { return };
        for (k, row) in block.iter_mut().enumerate() {
            for (c, z) in m.iter().enumerate() {
                row[3 + c] = sign * z[k][lane];
            }
        }
    }

    #[inline(always)]
    fn add_rotation(m: &[LaneVector<L>; 3], lane: usize, g: &[f64; 3], sign: f64, row: &mut [f64]) {
        let (lane, Some(row)) = (lane % L, row.first_chunk_mut::<6>()) else { return };
        for (c, z) in m.iter().enumerate() {
            row[3 + c] += sign * (z[0][lane] * g[0] + z[1][lane] * g[1] + z[2][lane] * g[2]);
        }
    }

    #[inline(always)]
    fn pair(a: &[LaneVector<L>; 3], b: &[LaneVector<L>; 3]) -> [[Lane<L>; 4]; 3] {
        let mut block = [[[0.0; L]; 4]; 3];
        for (i, strip) in block.iter_mut().enumerate() {
            for (k, out) in strip.iter_mut().enumerate().take(3) {
                let first = times(&a[0][i], &b[0][k]);
                *out = plus(&a[2][i], &b[2][k], &plus(&a[1][i], &b[1][k], &first));
            }
        }
        block
    }

    #[inline(always)]
    fn clear_force(&mut self) {
        self.force = zero();
        self.moment = [[0.0; L]; 3];
    }

    #[inline(always)]
    fn add_weight(&mut self) {
        self.force = self.weight;
    }

    #[inline(always)]
    fn force_mut(&mut self) -> &mut Natural<L> {
        &mut self.force
    }

    #[inline(always)]
    fn solution(&self) -> &Natural<L> {
        &self.solution
    }

    #[inline(always)]
    fn gram<S: Simd>(_: S, q: &[Natural<L>], n: usize, kappa: f64) -> [Lane<L>; 6] {
        gram(q, n).map(|entry| entry.map(|x| kappa * x))
    }

    #[inline(always)]
    fn moment<S: Simd>(_: S, q: &[Natural<L>], p: &[[LaneVector<L>; 3]], n: usize) -> LaneVector<L> {
        moment(q, p, n)
    }

    #[inline(always)]
    fn known_turn(q: &[Natural<L>], n: usize) -> LaneVector<L> {
        let mut known = [[0.0; L]; 3];
        for (i, e) in q[1..=n].iter().enumerate() {
            let half = 0.5 * acceleration_factor(n - 1 - i);
            for (e, f) in e[1..].iter().zip(&q[n + 1 - i][1..]) {
                add_cross(&mut known, e, &scaled(&[half; L], f));
            }
        }
        known
    }

    #[inline(always)]
    fn position_correction(&self, q: &Natural<L>) -> [Lane<L>; 6] {
        let mut gamma = symmetric(q, q);
        for (k, entry) in gamma.iter_mut().enumerate() {
            for x in entry {
                *x = if k < 3 { 1.0 - 0.5 * *x } else { -0.5 * *x };
            }
        }
        gamma
    }

    #[inline(always)]
    fn velocity_correction(&self, q: &Natural<L>, q_dot: &Natural<L>) -> [Lane<L>; 6] {
        symmetric(q, q_dot).map(|entry| entry.map(|x| -x))
    }

    /// Solution without the joints' forces, for right-hand sides Γ of the rigid-body rows and a known moment.
    #[inline(always)]
    fn begin<S: Simd>(&mut self, _: S, q: &Natural<L>, gamma: &[Lane<L>; 6], known: LaneVector<L>) {
        let mut moment = known;
        for c in 0..3 {
            moment[c] = sum(&moment[c], &self.moment[c]);
        }
        let [uu, vv, ww, uv, uw, vw] = gamma;
        let d = &self.dual;
        let mut particular = [[[0.0; L]; 3]; 3];
        for (out, row) in particular.iter_mut().zip([[uu, uv, uw], [uv, vv, vw], [uw, vw, ww]]) {
            for k in 0..3 {
                add_scaled(out, row[k], &d[k]);
            }
        }
        for k in 0..3 {
            let mut p = self.force[1 + k];
            for c in 0..3 {
                p[c] = less(&self.ibar[k], &particular[k][c], &p[c]);
            }
            add_cross(&mut moment, &q[1 + k], &p);
        }
        self.omega = multiply(&self.inverse, &moment);
        self.solution[0] = scaled(&self.inverse_mass, &self.force[0]);
        for k in 0..3 {
            self.solution[1 + k] = particular[k];
            add_cross(&mut self.solution[1 + k], &self.omega, &q[1 + k]);
        }
    }

    /// Adds what further generalized forces do.
    #[inline(always)]
    fn apply<S: Simd>(&mut self, simd: S, q: &Natural<L>, force: &Natural<L>) {
        let moment = Self::moment_of(simd, q, force);
        add_scaled(&mut self.solution[0], &self.inverse_mass, &force[0]);
        self.turn(simd, q, moment);
        for (all, force) in self.force.as_flattened_mut().iter_mut().zip(force.as_flattened()) {
            *all = sum(all, force);
        }
    }

    #[inline(always)]
    fn moment_of<S: Simd>(_: S, q: &Natural<L>, force: &Natural<L>) -> LaneVector<L> {
        let mut moment = [[0.0; L]; 3];
        for k in 0..3 {
            add_cross(&mut moment, &q[1 + k], &force[1 + k]);
        }
        moment
    }

    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, q: &Natural<L>, moment: LaneVector<L>) {
        let omega = multiply(&self.inverse, &moment);
        self.rotate(simd, q, omega);
    }

    #[inline(always)]
    fn rotate<S: Simd>(&mut self, _: S, q: &Natural<L>, omega: LaneVector<L>) {
        for c in 0..3 {
            self.omega[c] = sum(&self.omega[c], &omega[c]);
        }
        for k in 0..3 {
            add_cross(&mut self.solution[1 + k], &omega, &q[1 + k]);
        }
    }

    #[inline(always)]
    fn carried_on(q: &[Natural<L>], turns: &[LaneVector<L>]) -> LaneVector<L> {
        let mut expected = [[0.0; L]; 3];
        for k in 1..4 {
            let mut along = [0.0; L];
            for (turn, e) in turns.iter().zip(q[1..=turns.len()].iter().rev()) {
                add_dot(&mut along, turn, &e[k]);
            }
            add_scaled(&mut expected, &negative(&along), &q[0][k]);
        }
        expected
    }

    #[inline(always)]
    fn moments_squared(&self) -> Lane<L> {
        let mut squared = [0.0; L];
        for k in 0..3 {
            add_dot(&mut squared, &self.force[1 + k], &self.force[1 + k]);
            let inertial = scaled(&self.ibar[k], &self.solution[1 + k]);
            add_dot(&mut squared, &inertial, &inertial);
        }
        squared
    }

    #[inline(always)]
    fn delta(&self) -> &Lane<L> {
        &self.regularizing_inertia
    }

    #[inline(always)]
    fn omega(&self) -> &LaneVector<L> {
        &self.omega
    }

    #[inline(always)]
    fn moment_lanes(moment: &LaneVector<L>) -> &[Lane<L>] {
        moment
    }

    #[inline(always)]
    fn moment_lanes_mut(moment: &mut LaneVector<L>) -> &mut [Lane<L>] {
        moment
    }

    #[inline(always)]
    fn directors([_, e @ ..]: &Natural<L>) -> [LaneVector<L>; 3] {
        *e
    }

    #[inline(always)]
    fn rest(&mut self) {
        self.solution = zero();
        self.omega = [[0.0; L]; 3];
        self.clear_force();
    }

    #[inline(always)]
    fn scale_and_add(&mut self, own: f64, other: &Self, factor: f64) {
        scale_and_add(self.solution.as_flattened_mut(), own, other.solution.as_flattened(), factor);
        scale_and_add(self.force.as_flattened_mut(), own, other.force.as_flattened(), factor);
        scale_and_add(&mut self.omega, own, &other.omega, factor);
    }

    /// p_k = P_k − Ī_k ë_k of the solution: what the directors' moments are made of.
    #[inline(always)]
    fn director_forces<S: Simd>(&self, _: S) -> [LaneVector<L>; 3] {
        let mut p = [self.force[1], self.force[2], self.force[3]];
        for k in 0..3 {
            for c in 0..3 {
                p[k][c] = less(&self.ibar[k], &self.solution[1 + k][c], &p[k][c]);
            }
        }
        p
    }
}
