//! What acts on the bodies besides the joints' multipliers of the current order: loads, drivers, earlier multipliers.

use super::{Bodies, Series};
use nalgebra::Vector3;
use pulp::Simd;

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// What rows demand of κ Q_(n+2) beyond its own part.
    #[inline(always)]
    pub(super) fn demand<S: Simd>(&mut self, simd: S, n: usize, kappa: f64) {
        if self.rows.curved() {
            self.rows.set_convolutions(n, kappa);
        }
        self.angles.demand(simd, n + 2, kappa, &mut self.rows.extra);
        self.prescribed.demand(n + 2, kappa, &mut self.rows.extra);
    }

    /// Generalized forces of order n that loads and multipliers of lower order make.
    #[inline(always)]
    pub(super) fn set_known_forces<S: Simd>(&mut self, simd: S, n: usize) {
        self.forces.fill([[0.0; L]; 3]);
        self.add_multipliers_forces(simd, n);
        let (q, stride) = (&self.q, self.stride);
        let coefficient = |b: usize, i: usize| &q[b * stride + i];
        self.loads.apply::<S, L, B>(simd, n, coefficient, &mut self.forces, &mut self.bundles);
        self.prescribed.pull_back(n, &self.forces, &mut self.bundles);
        self.pull_back_convolved();
    }

    /// Adds to the forces on features those of order n that multipliers of lower order make.
    #[inline(always)]
    pub(super) fn add_multipliers_forces<S: Simd>(&mut self, simd: S, n: usize) {
        self.rows.add_known_forces(n, &mut self.forces);
        self.angles.add_known_forces(simd, n, &mut self.forces);
    }

    /// Adds to the forces on bodies those on features that such forces act on.
    #[inline(always)]
    pub(super) fn pull_back_convolved(&mut self) {
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            for &slot in self.points.convolved(b) {
                B::pull_back(&self.slots[slot], &self.forces[slot], bundle.force_mut());
            }
        }
    }

    /// What prescribed features have in order m besides the part that their bodies' coefficient m makes.
    #[inline(always)]
    pub(super) fn prepare_prescribed(&mut self, m: usize, factor: f64) {
        let (q, stride) = (&self.q, self.stride);
        self.prescribed.prepare::<L, B>(m, factor, |b, i| &q[b * stride + i]);
    }

    /// Multipliers of the solver rows a time τ after the point of the last expansion, from the series up to order `order` of
    /// Q; `across` tells the directions there that those of each common vector are written in. Not where rows are redundant: which of
    /// all multipliers that fit are smallest changes within a step.
    pub fn multipliers(
        &self,
        tau: f64,
        order: usize,
        across: impl Fn(usize) -> [Vector3<f64>; 2],
    ) -> Option<Vec<f64>> {
        if self.rows_left_out || order < 2 {
            return None;
        }
        let rows = self.correction.len();
        let last = (order - 1) * rows;
        let multiplier = |&place: &usize| {
            let coefficients = self.lambda[..last].iter().skip(place).step_by(rows);
            coefficients.rev().fold(0.0, |sum, c| sum * tau + c)
        };
        let mut lambda: Vec<f64> = self.schur.factor.places().iter().map(multiplier).collect();
        for (common, directions) in self.rows.commons.iter().zip((0..).map(across)) {
            // From the directions across the vector at the point of expansion to those at the state.
            let [t1, t2] = common.expanded.map(Vector3::from);
            let [first, second] = [0, 1].map(|k| common.solver + k);
            let sum = t1 * lambda[first] + t2 * lambda[second];
            [lambda[first], lambda[second]] = directions.map(|t| t.dot(&sum));
        }
        Some(lambda)
    }

    /// Takes over the time of the state, s: prescribed functions are expanded about it.
    pub fn set_time(&mut self, t: f64) {
        self.time = t;
        self.prescribed.expand(t, &mut self.slots, &mut self.ground);
        self.loads.expand(t);
        self.next_break = self.prescribed.next_break(t).min(self.loads.next_break(t));
    }

    /// How many times prescribed functions change to another piece before `end`, at most so many.
    pub fn breakpoints_before(&self, end: f64, most: usize) -> usize {
        let next = |&t: &f64| Some(self.prescribed.next_break(t).min(self.loads.next_break(t)));
        std::iter::successors(Some(self.next_break), next).take(most).take_while(|&t| t < end).count()
    }

    /// Whether a part of more than `part` of what a prescribed function does within h is in terms that a motion up to an order knows
    /// nothing of: those of forces are two orders lower.
    pub(super) fn prescribed_goes_on(&self, h: f64, order: usize, part: f64) -> bool {
        self.prescribed.goes_on(h, order, part) || self.loads.goes_on(h, order.saturating_sub(2), part)
    }

    /// Whether prescribed functions are, a time h after the point of expansion, what their series say, but for a
    /// relative error.
    pub(super) fn meets_prescribed(&self, h: f64, time: f64, error: f64) -> bool {
        self.prescribed.meets(h, time, error) && self.loads.meets(h, time, error)
    }
}
