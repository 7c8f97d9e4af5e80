//! Corrections of the state at the end of a step, onto the constraints — eq. (10.2).

use super::Series;
use super::bundle::symmetric;
use super::lanes::{Lane, Lifted, largest, zero};

impl<const L: usize> Series<L> {
    /// One mass-orthogonal Newton step of the positions towards Φ = 0, with the factor at hand. Returns its size.
    #[inline(always)]
    pub fn correct_positions(&mut self) -> f64 {
        self.values_of(|state, _| state[0]);
        self.set_ground(true);
        self.rows.store_factors(0, &self.values);
        self.rows.set_violation(&self.values);
        self.angles.place(&self.values);
        self.angles.set_violation(&self.values, &mut self.rows.extra);
        self.prescribed.demand(0, 1.0, &mut self.rows.extra);
        self.correct(0, |state| {
            let mut gamma = symmetric(&state[0], &state[0]);
            for (k, entry) in gamma.iter_mut().enumerate() {
                for x in entry {
                    *x = if k < 3 { 1.0 - 0.5 * *x } else { -0.5 * *x };
                }
            }
            gamma
        })
    }

    /// One mass-orthogonal Newton step of the velocities towards Φ̇ = 0, with the factor at hand.
    #[inline(always)]
    pub fn correct_velocities(&mut self) -> f64 {
        self.values_of(|state, _| state[0]);
        self.set_ground(true);
        self.rows.store_factors(0, &self.values);
        self.angles.place(&self.values);
        self.values_of(|state, _| state[1]);
        self.set_ground(false);
        let state = &self.state;
        self.prescribed.prepare(1, 1.0, |b, _| &state[b][0]);
        self.prescribed.add_known(1.0, &mut self.values);
        self.rows.set_rate_violation(&self.values);
        self.angles.set_rate_violation(&self.values, &mut self.rows.extra);
        self.prescribed.demand(1, 1.0, &mut self.rows.extra);
        self.correct(1, |state| symmetric(&state[0], &state[1]).map(|entry| entry.map(|x| -x)))
    }

    #[inline(always)]
    fn correct(&mut self, which: usize, gamma: impl Fn(&[Lifted<L>; 2]) -> [Lane<L>; 6]) -> f64 {
        for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
            bundle.force = zero();
            bundle.moment = [[0.0; L]; 3];
            bundle.begin(&state[0], &gamma(state), [[0.0; L]; 3]);
        }
        self.prescribed.hold();
        // The multipliers of a correction mean nothing; the highest order has room for them.
        self.solve(self.stride - 1);
        let mut moved: f64 = 0.0;
        for (bundle, state) in self.bundles.iter().zip(&mut self.state) {
            let step = bundle.solution.as_flattened();
            moved = moved.max(largest(step));
            let target = state[which].as_flattened_mut().as_flattened_mut();
            for (x, dx) in target.iter_mut().zip(step.as_flattened()) {
                *x += dx;
            }
        }
        moved
    }
}
