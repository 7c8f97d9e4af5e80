//! S at other times than that of the state: how near a step comes to a singular configuration — THEORY section 8.

use super::expand::Value;
use super::{Bodies, Series};
use crate::state;
use crate::system::System;
use pulp::{Arch, Simd, WithSimd};

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
    /// Makes [`Series::pivot_products_inside`] possible.
    pub fn enable_probes(&mut self) {
        self.schur.factor.keep_pivot_products();
        self.probe = Some(Box::new(self.clone()));
    }

    /// Pivot products of the joints at the point of expansion.
    pub fn pivot_products(&self) -> &[f64] {
        self.schur.factor.pivot_products()
    }

    /// The same a time τ after the start of the last step, which was cut at order `order`. The factor at the end of the
    /// step stays as it is.
    pub fn pivot_products_inside(&mut self, start: f64, tau: f64, order: usize) -> &[f64] {
        let Self { q, stride, probe, .. } = self;
        let Some(probe) = probe.as_deref_mut() else { return &[] };
        probe.set_time(start + tau);
        for (b, state) in probe.state.iter_mut().enumerate() {
            let coefficients = &q[b * *stride..=b * *stride + order];
            *state = Arch::new().dispatch(Value::<L, B> { coefficients, tau });
        }
        Arch::new().dispatch(PivotProducts(probe));
        probe.pivot_products()
    }

    #[inline(always)]
    fn find_pivot_products<S: Simd>(&mut self, simd: S) {
        self.assemble_here(simd);
        self.schur.factor.factor(0.0, 0.0);
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
