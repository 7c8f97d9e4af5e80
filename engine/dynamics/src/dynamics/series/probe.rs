//! The island at other times than that of the state: how near a step comes to a singular configuration, and where it passes
//! one — THEORY section 8. A copy of the series has the other state; the factor at the end of the step stays as it is.

use super::expand::Value;
use super::instants::Instants;
use super::{Bodies, Series};
use crate::newton::{Movable, project_positions, project_velocities, rules};
use crate::system::System;
use pulp::{Simd, WithSimd};
use triad_linalg::{larger, larger_or_nan, raise};

/// A factorization of which only the pivots are wanted, to be compiled for each set of vector instructions.
struct PivotProducts<'a, const L: usize, B: Bodies<L>>(&'a mut Series<L, B>);

impl<const L: usize, B: Bodies<L>> WithSimd for PivotProducts<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.find_pivot_products(simd);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Makes a copy for other states of the system.
    pub fn enable_probes(&mut self, system: &System) {
        self.schur.factor.keep_pivot_products();
        let mut probe = self.clone();
        (probe.resolving, probe.corrects_only) = (true, true);
        self.probe = Some(Box::new(probe));
        self.instants = if L > 1 { Instants::new(self, system).map(Box::new) } else { None };
    }

    /// Whether rows that hardly hold are kept: see [`crate::dynamics::elimination::Elimination::set_resolving`].
    pub fn set_resolving(&mut self, resolving: bool) {
        if self.resolving != resolving {
            self.expansion.back = self.expansion.back.map(|_| false);
        }
        self.resolving = resolving;
        if let Some(meter) = &mut self.meter {
            meter.set_resolving(resolving);
        }
        if let Some(transport) = &mut self.transport {
            transport.set_resolving(resolving);
        }
    }

    /// Pivot products of the joints at the point of expansion.
    pub fn pivot_products(&self) -> &[f64] {
        self.schur.factor.pivot_products()
    }

    /// The copy, in the state a time τ after the start of the last step, which was cut at order `order`.
    pub fn probe_at(&mut self, start: f64, tau: f64, order: usize) -> Option<&mut Self> {
        let Self { instructions, q, stride, probe, angles, .. } = self;
        let probe = probe.as_deref_mut()?;
        for (own, given) in probe.angles.list.iter_mut().zip(&angles.list) {
            own.state.reference = given.state.reference;
        }
        probe.factor_is_here = false;
        probe.set_time(start + tau);
        for (b, state) in probe.state.iter_mut().enumerate() {
            let coefficients = &q[b * *stride..=b * *stride + order];
            *state = instructions.dispatch(Value::<L, B> { coefficients, tau });
        }
        Some(probe)
    }

    /// The copy, in the state that it was left in.
    pub fn probe(&mut self) -> Option<&mut Self> {
        self.probe.as_deref_mut()
    }

    /// How many numbers the state is made of: positions, then as many velocities.
    pub fn numbers(&self) -> usize {
        self.state.iter().flatten().map(|x| B::lanes(x).as_flattened().len()).sum()
    }

    /// Writes them.
    pub fn read(&mut self, out: &mut [f64]) {
        let (positions, velocities) = out.split_at_mut(out.len() / 2);
        let mut out = positions.iter_mut().zip(velocities);
        self.for_each(|x, v| {
            if let Some(out) = out.next() {
                (*out.0, *out.1) = (*x, *v);
            }
        });
    }

    /// Takes them over as the state at time t.
    pub fn write(&mut self, t: f64, numbers: &[f64]) {
        self.factor_is_here = false;
        self.set_time(t);
        let (positions, velocities) = numbers.split_at(numbers.len() / 2);
        let mut given = positions.iter().zip(velocities);
        self.for_each(|x, v| {
            if let Some(given) = given.next() {
                (*x, *v) = (*given.0, *given.1);
            }
        });
    }

    /// Moves the state onto the constraints. Returns by how much, if Newton's method has converged.
    pub fn project(&mut self, length: f64) -> Option<f64> {
        let positions = project_positions(self, &rules::PASSAGE_POSITIONS, length);
        project_velocities(self, &rules::PASSAGE_VELOCITIES, length);
        self.factor_is_here = positions.has_converged() && !self.regularized;
        positions.has_converged().then_some(positions.moved)
    }

    /// Largest |Φ|, each relative to the size of its row, those of rigid bodies included.
    pub fn open(&mut self) -> f64 {
        self.place_values();
        self.set_violation();
        let rows = self.rows.extra.iter().zip(&self.row_sizes);
        let mut most = rows.fold(0.0f64, |most, (extra, size)| larger(most, extra.abs() / size));
        for (bundle, [q, _]) in self.bundles.iter().zip(&self.state) {
            let stretch = B::stretch(q);
            for stretch in &stretch[..bundle.bodies().len()] {
                most = larger_or_nan(most, *stretch);
            }
        }
        most
    }

    /// Pivot products of the joints at the state, or where it was before the last correction of a projection that has converged.
    pub fn pivot_products_here(&mut self) -> &[f64] {
        if !self.factor_is_here {
            self.instructions.dispatch(PivotProducts(self));
        }
        self.pivot_products()
    }

    /// Which joints take part where rows of `joints` nearly depend on others, at the last pivot products.
    pub fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]) {
        self.schur.factor.raise_shares(joints, shares);
    }

    /// Goes back to the start t of the last step, from which the series were expanded. They serve the next step too, if they would be found
    /// in the same way.
    pub fn go_back(&mut self, t: f64) {
        for (b, state) in self.state.iter_mut().enumerate() {
            state.copy_from_slice(&self.q[b * self.stride..b * self.stride + 2]);
        }
        for angle in &mut self.angles.list {
            angle.state.reference = angle.theta[0];
        }
        self.set_time(t);
        self.expansion.back = Some(self.expansion.resolving == self.resolving);
        if let Some(transport) = &mut self.transport {
            transport.go_back(t);
        }
    }

    #[inline(always)]
    fn find_pivot_products<S: Simd>(&mut self, simd: S) {
        self.assemble_here(simd);
        self.schur.factor.factor(0.0, 0.0);
    }

    /// How fast rows turn at the state, 1/s: see [`crate::state::pace`].
    pub fn pace(&self, length: f64) -> f64 {
        let mut fastest = [0.0; L];
        for [_, rate] in &self.state {
            raise(&mut fastest, &B::pace(rate, length));
        }
        fastest.into_iter().fold(0.0, larger)
    }
}
