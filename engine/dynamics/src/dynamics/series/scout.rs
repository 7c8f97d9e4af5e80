//! S elsewhere than at the state: how near a step comes to a singular position — THEORY section 8.

use super::{Bodies, Dependent, REGULARIZATION, Series, Value};
use crate::state;
use crate::system::System;
use pulp::{Arch, Simd, WithSimd};

/// A factorization of which only the pivots are wanted, to be compiled for each set of vector instructions.
struct Holds<'a, const L: usize, B: Bodies<L>>(&'a mut Series<L, B>);

impl<const L: usize, B: Bodies<L>> WithSimd for Holds<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.find_holds(simd);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Makes it possible to look inside steps.
    pub fn allow_looks(&mut self) {
        self.schur.factor.keep_pivot_products();
        self.scout = Some(Box::new(self.clone()));
    }

    /// How firmly each joint holds at the point of expansion: see [`triad_linalg::BlockCholesky::pivot_products`].
    pub fn holds(&self) -> &[f64] {
        self.schur.factor.pivot_products()
    }

    /// The same a time τ after the start of the last step, which was cut at order `order`. The factor at the end of the
    /// step stays as it is.
    pub fn holds_inside(&mut self, start: f64, tau: f64, order: usize) -> &[f64] {
        let Self { q, stride, scout, .. } = self;
        let Some(scout) = scout.as_deref_mut() else { return &[] };
        scout.set_time(start + tau);
        for (b, state) in scout.state.iter_mut().enumerate() {
            let coefficients = &q[b * *stride..=b * *stride + order];
            *state = Arch::new().dispatch(Value::<L, B> { coefficients, tau });
        }
        Arch::new().dispatch(Holds(scout));
        scout.holds()
    }

    #[inline(always)]
    fn find_holds<S: Simd>(&mut self, simd: S) {
        self.assemble_here(simd);
        let epsilon = if self.dependent == Dependent::Shifted { REGULARIZATION } else { 0.0 };
        self.schur.factor.factor(epsilon, 0.0);
    }

    /// How fast rows turn at the state, 1/s: see [`state::pace`].
    pub fn pace(&self, system: &System) -> f64 {
        let mut fastest: f64 = 0.0;
        for (bundle, [_, rate]) in self.bundles.iter().zip(&self.state) {
            for lane in 0..bundle.bodies().len() {
                fastest = fastest.max(state::pace(&bundle.write(lane, rate, true), system.length));
            }
        }
        fastest
    }
}
