//! Corrections of the state at the end of a step, onto the constraints — eq. (10.2).

use super::lanes::{largest, sum};
use super::{Bodies, Dependent, Series};

/// A relative pivot below this belongs to a row that depends on others.
const DEPENDENT: f64 = 1e-10;
/// How far the rank is taken away from a state, relative to the size of the mechanism.
const AWAY: f64 = 0.03;

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// One mass-orthogonal Newton step of the positions towards Φ = 0, with the factor at hand. Returns its size.
    pub fn correct_positions(&mut self) -> f64 {
        self.correct(0)
    }

    /// One mass-orthogonal Newton step of the velocities towards Φ̇ = 0, with the factor at hand.
    pub fn correct_velocities(&mut self) -> f64 {
        self.correct(1)
    }

    /// The one of the positions (0) or of the velocities (1); one body of code, because it is compiled many times.
    #[inline(always)]
    pub(super) fn correct_here(&mut self, which: usize) -> f64 {
        self.place_values();
        self.rows.store_factors(0, &self.values);
        self.angles.place(&self.values);
        if which == 0 {
            self.rows.set_violation(B::DIRECTIONS, &self.values);
            self.angles.set_violation(&self.values, &mut self.rows.extra);
        } else {
            self.values_of(|state, _| state[1]);
            self.set_ground(false);
            let state = &self.state;
            self.prescribed.prepare::<L, B>(1, 1.0, |b, _| &state[b][0]);
            self.prescribed.add_known(1.0, &mut self.values);
            self.rows.set_rate_violation(B::DIRECTIONS, &self.values);
            self.angles.set_rate_violation(&self.values, &mut self.rows.extra);
        }
        self.prescribed.demand(which, 1.0, &mut self.rows.extra);
        for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
            bundle.clear_force();
            let gamma = if which == 0 {
                bundle.position_correction(&state[0])
            } else {
                bundle.velocity_correction(&state[0], &state[1])
            };
            bundle.begin(&state[0], &gamma, B::no_moment());
        }
        self.prescribed.hold();
        // The multipliers of a correction mean nothing; the highest order has room for them.
        self.solve(self.stride - 1);
        let mut moved: f64 = 0.0;
        for (bundle, state) in self.bundles.iter().zip(&mut self.state) {
            let step = B::lanes(bundle.solution());
            moved = moved.max(largest(step));
            for (x, dx) in B::lanes_mut(&mut state[which]).iter_mut().zip(step) {
                *x = sum(x, dx);
            }
        }
        moved
    }

    /// Finds the rows that depend on others everywhere, which the factorization then leaves out: those that do a little away
    /// from the state, along an admissible velocity without symmetry. Tells whether there are any. S is left to be factored.
    pub fn find_dependent(&mut self, length: f64) -> bool {
        let state = self.state.clone();
        self.linearize();
        let velocities = self.state.iter_mut().flat_map(|[_, rate]| B::lanes_mut(rate).as_flattened_mut());
        for (i, v) in velocities.enumerate() {
            *v = (1.0 + i as f64 * 0.754_877_666_2).sin();
        }
        self.correct_velocities();
        self.correct_velocities();
        let largest = self.state.iter().map(|[_, rate]| largest(B::lanes(rate))).fold(0.0, f64::max);
        if largest > 1e-9 {
            let scale = AWAY * length / largest;
            for [position, rate] in &mut self.state {
                let rates = B::lanes(rate).as_flattened();
                for (x, v) in B::lanes_mut(position).as_flattened_mut().iter_mut().zip(rates) {
                    *x += scale * v;
                }
            }
            for _ in 0..12 {
                self.linearize();
                if self.correct_positions() < 1e-12 * length {
                    break;
                }
            }
        }
        self.assemble();
        let dependent = self.schur.factor.find_dependent(DEPENDENT);
        self.dependent = if dependent == 0 { Dependent::None } else { Dependent::LeftOut };
        self.state = state;
        self.dependent != Dependent::None
    }
}
