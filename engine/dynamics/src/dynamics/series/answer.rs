//! What joints answer to the bodies' solutions: the multipliers that close what is left of their rows, and the forces that these make.

use super::{Bodies, Series};
use pulp::{Simd, WithSimd};

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Adds to the bodies' solutions the multipliers, left as the correction of λ, that answer to what is left of all rows.
    #[inline(always)]
    pub(super) fn answer<S: Simd>(&mut self, simd: S) {
        self.set_residual(simd);
        self.schur.factor.solve_within(simd, &mut self.correction);
        self.counters.solves += 1;
        if self.points.has_others() {
            let correction = std::mem::take(&mut self.correction);
            self.set_multipliers_forces(&correction);
            self.correction = correction;
        }
        for b in 0..self.bundles.len() {
            let force = self.multipliers_force(simd, b, &self.correction);
            self.bundles[b].apply(simd, &self.state[b][0], &force);
        }
    }

    /// Sets the forces that multipliers make on features of rows that ask for them.
    #[inline(always)]
    pub(super) fn set_multipliers_forces(&mut self, multipliers: &[f64]) {
        self.forces.fill([[0.0; L]; 3]);
        self.rows.add_forces(B::DIRECTIONS, multipliers, &mut self.forces);
        self.angles.add_forces(multipliers, &mut self.forces);
    }

    /// The generalized force that multipliers make on bundle b, with the forces on features in place.
    #[inline(always)]
    pub(super) fn multipliers_force<S: Simd>(&self, simd: S, b: usize, multipliers: &[f64]) -> B::Natural {
        let mut force = B::ZERO;
        self.points.add_forces::<S, B>(simd, b, multipliers, &mut force);
        if self.points.has_others() {
            for &slot in self.points.others(b) {
                B::pull_back(&self.slots[slot], &self.forces[slot], &mut force);
            }
        }
        force
    }

    /// What is left of all rows, given the bodies' part of the unknown.
    #[inline(always)]
    fn set_residual<S: Simd>(&mut self, simd: S) {
        let others = self.points.has_others();
        self.correction.copy_from_slice(&self.rows.extra);
        for (b, bundle) in self.bundles.iter().enumerate() {
            let x = bundle.solution();
            self.points.add_residual::<S, B>(simd, b, x, &mut self.correction);
            if others {
                for &slot in self.points.others(b) {
                    self.values[slot] = B::value(&self.slots[slot], x);
                }
            }
        }
        if others {
            self.prescribed.add_known(1.0, &mut self.values);
            self.rows.residual(B::DIRECTIONS, &self.values, &mut self.correction);
            self.angles.residual(&self.values, &self.rows.extra, &mut self.correction);
        }
    }
}

/// [`Series::answer`] on its own: it is long, and compiled once for each set of vector instructions, not where it is seldom asked for.
pub(super) struct Answer<'a, const L: usize, B: Bodies<L>>(pub &'a mut Series<L, B>);

impl<const L: usize, B: Bodies<L>> WithSimd for Answer<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.answer(simd);
    }
}
