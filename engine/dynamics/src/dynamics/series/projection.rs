//! Corrections of the state at the end of a step, onto the constraints — eq. (10.2).

use super::lanes::{largest, sum};
use super::step::Which;
use super::{Bodies, Series};

/// Relative pivot below which a row depends on others.
const DEPENDENT: f64 = 1e-10;
/// Distance from a state at which the rank is taken, in lengths of the mechanism.
const AWAY: f64 = 0.03;
/// Largest velocity below which no motion leads away from the state.
const AT_REST: f64 = 1e-9;
/// Most corrections of the positions at that distance.
const MAX_CORRECTIONS: usize = 12;
/// Correction, in lengths of the mechanism, below which the positions there are consistent.
const CONSISTENT: f64 = 1e-12;
/// Phase between the velocities of successive coordinates, rad: the inverse of the plastic number, so that the motion has no
/// symmetry.
const PHASE: f64 = 0.754_877_666_2;

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// One mass-orthogonal Newton step of the positions towards Φ = 0, with the present factor of S. Returns its size.
    pub fn correct_positions(&mut self) -> f64 {
        self.piece(Which::Correct(0))
    }

    /// One mass-orthogonal Newton step of the velocities towards Φ̇ = 0, with the present factor of S.
    pub fn correct_velocities(&mut self) -> f64 {
        self.piece(Which::Correct(1))
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
        self.prescribed.clear_known();
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
    /// from the state, along an admissible velocity without symmetry. Returns whether there are any. S must be factored
    /// afterwards. Where some are expected, S is regularized from the beginning.
    pub fn find_dependent(&mut self, length: f64, expected: bool) -> bool {
        let state = self.state.clone();
        self.piece(Which::Linearize { regularized: expected });
        let velocities = self.state.iter_mut().flat_map(|[_, rate]| B::lanes_mut(rate).as_flattened_mut());
        for (i, v) in velocities.enumerate() {
            *v = (1.0 + i as f64 * PHASE).sin();
        }
        self.correct_velocities();
        self.correct_velocities();
        let largest = self.state.iter().map(|[_, rate]| largest(B::lanes(rate))).fold(0.0, f64::max);
        if largest > AT_REST {
            let scale = AWAY * length / largest;
            for [position, rate] in &mut self.state {
                let rates = B::lanes(rate).as_flattened();
                for (x, v) in B::lanes_mut(position).as_flattened_mut().iter_mut().zip(rates) {
                    *x += scale * v;
                }
            }
            for _ in 0..MAX_CORRECTIONS {
                self.piece(Which::Linearize { regularized: expected });
                if self.correct_positions() < CONSISTENT * length {
                    break;
                }
            }
        }
        self.piece(Which::Assemble);
        self.rows_left_out = self.schur.factor.find_dependent(DEPENDENT) > 0;
        self.state = state;
        self.rows_left_out
    }
}
