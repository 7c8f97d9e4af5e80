//! Corrections of the state at the end of a step, onto the constraints — eq. (10.2).

use super::lanes::{largest, sum};
use super::step::Part;
use super::{Bodies, Series};
use crate::newton::{Movable, Projectable, find_dependent_rows, project_positions, rules};
use crate::system::index::SolverRow;
use pulp::Simd;
use triad_linalg::larger;

impl<const L: usize, B: Bodies<L>> Projectable for Series<L, B> {
    fn linearize(&mut self) {
        self.call(Part::Linearize);
        if let Some(transport) = &mut self.transport {
            transport.note_factored(&self.state);
        }
    }

    fn correct_positions(&mut self) -> f64 {
        self.call(Part::Correct(0))
    }

    fn correct_velocities(&mut self) -> f64 {
        self.call(Part::Correct(1))
    }
}

impl<const L: usize, B: Bodies<L>> Movable for Series<L, B> {
    fn for_each(&mut self, mut change: impl FnMut(&mut f64, &mut f64)) {
        for [position, rate] in &mut self.state {
            let rates = B::lanes_mut(rate).as_flattened_mut();
            for (x, v) in B::lanes_mut(position).as_flattened_mut().iter_mut().zip(rates) {
                change(x, v);
            }
        }
    }

    fn dependent_rows(&mut self, least: f64) -> Vec<SolverRow> {
        self.call(Part::Assemble);
        self.schur.factor.dependent_rows(least).into_iter().map(SolverRow).collect()
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// One mass-orthogonal Newton step of the positions (0) or of the velocities (1) with the current factor. Both are one
    /// function, because it is compiled for each kind of bundle and each set of vector instructions.
    #[inline(always)]
    pub(super) fn correct_here<S: Simd>(&mut self, simd: S, which: usize) -> f64 {
        if !self.is_bare() {
            self.place_values();
            if which == 0 {
                self.set_violation();
            } else {
                self.set_rate_violation();
            }
        }
        for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
            bundle.clear_force();
            let gamma = if which == 0 {
                bundle.position_correction(&state[0])
            } else {
                bundle.velocity_correction(&state[0], &state[1])
            };
            bundle.begin(simd, &state[0], &gamma, B::NO_MOMENT);
        }
        self.prescribed.clear_known();
        // The multipliers of a correction mean nothing; the highest order has room for them.
        let mut regularization = self.regularization.take();
        if let Some(regularization) = &mut regularization {
            regularization.begin();
        }
        self.solve(simd, regularization.as_deref_mut(), self.stride - 1);
        self.regularization = regularization;
        let mut moved: f64 = 0.0;
        for (bundle, state) in self.bundles.iter().zip(&mut self.state) {
            let step = B::lanes(bundle.solution());
            moved = larger(moved, largest(step));
            for (x, dx) in B::lanes_mut(&mut state[which]).iter_mut().zip(step) {
                *x = sum(x, dx);
            }
        }
        moved
    }

    /// Takes over the values of features at the state, as a correction leaves them.
    #[inline(always)]
    pub(super) fn settle(&mut self) {
        self.place_values();
        self.take_factors();
        self.angles.place(&self.values);
    }

    /// Φ̇ of the joints' rows, from the features' values in place.
    #[inline(always)]
    fn set_rate_violation(&mut self) {
        self.take_factors();
        self.angles.place(&self.values);
        self.values_of(|state, _| state[1]);
        self.set_ground(false);
        let state = &self.state;
        self.prescribed.prepare::<L, B>(1, 1.0, |b, _| &state[b][0]);
        self.prescribed.add_known(1.0, &mut self.values);
        self.rows.set_rate_violation(B::DIRECTIONS, &self.values);
        self.angles.set_rate_violation(&self.values, &mut self.rows.extra);
        self.prescribed.demand(1, 1.0, &mut self.rows.extra);
    }

    /// Φ of the joints' rows, from the features' values in place.
    #[inline(always)]
    pub(super) fn set_violation(&mut self) {
        self.take_factors();
        self.angles.place(&self.values);
        self.rows.set_violation(B::DIRECTIONS, &self.values);
        self.angles.set_violation(&self.values, &mut self.rows.extra);
        self.prescribed.demand(0, 1.0, &mut self.rows.extra);
    }

    /// The rows that depend on others everywhere — eq. (8.1); the state is left elsewhere. Where some are expected, S is
    /// regularized from the beginning. If fewer do where drivers have moved the mechanism `later`, those.
    pub fn find_dependent(&mut self, length: f64, expected: bool, later: Option<f64>) -> Vec<SolverRow> {
        self.redundant = expected;
        let start = self.state.clone();
        let dependent = find_dependent_rows(self, length);
        let Some(later) = later.filter(|_| !dependent.is_empty()) else { return dependent };
        self.state.clone_from(&start);
        self.set_time(later);
        self.redundant = true;
        let found = project_positions(self, &rules::ASSEMBLY_POSITIONS, length);
        if !(found.has_converged() && self.is_finite()) {
            // From a dead point Newton's method does not know whither: any way aside is one.
            self.state = start;
        }
        let there = find_dependent_rows(self, length);
        if there.len() < dependent.len() { there } else { dependent }
    }

    /// From now on leaves out rows that depend on others everywhere. S must be factored afterwards.
    pub fn leave_out(&mut self, rows: &[SolverRow]) {
        self.schur.factor.leave_out_weakest(rows.iter().map(|row| row.index()));
        self.rows_left_out = !rows.is_empty();
    }
}
