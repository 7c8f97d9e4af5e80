//! The search for a state with given independent coordinates.

use super::Chart;
use crate::integrate::in_chart::guess::Guess;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::newton::Projectable;

/// A guess that is moved onto the constraints and to given η, or η̇, in turn — eq. (10.4).
pub struct AtCoordinates<'a> {
    /// The chart.
    pub chart: &'a mut Chart,
    /// The mechanism, placed as the guess says.
    pub mechanism: &'a mut Mechanism,
    /// The guess.
    pub guess: &'a mut Guess,
    /// η, or η̇.
    pub wanted: &'a [f64],
}

impl Projectable for AtCoordinates<'_> {
    fn linearize(&mut self) {
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        elimination.linearize(system, state);
    }

    /// p ← p + Δp, then p ← p + Z H (η − L (p − p₀)); the sizes of both together.
    fn correct_positions(&mut self) -> f64 {
        let Self { chart, mechanism, guess, wanted } = self;
        let Chart { numbers, base, basis, functionals, gap, change, search, .. } = &mut **chart;
        let step = numbers.correct_positions(mechanism, &mut guess.p, change);
        change.copy_from(&guess.p);
        *change -= &*base;
        search.reach(functionals, change, &mut guess.tilt);
        gap.copy_from_slice(wanted);
        *gap -= &search.from;
        search.ask(&guess.tilt, gap);
        guess.p.gemv(1.0, basis, &search.asked, 1.0);
        if !numbers.place(mechanism, guess.p.as_slice()) {
            return f64::NAN;
        }
        step + gap.amax()
    }

    /// ṗ ← ṗ + Z H (η̇ − L ṗ), then ṗ ← ṗ + Δṗ, which the state has not taken over yet; the sizes of both together, relative to
    /// the fastest.
    fn correct_velocities(&mut self) -> f64 {
        let Self { chart, mechanism, guess, wanted } = self;
        let Chart { numbers, basis, functionals, gap, change, search, .. } = &mut **chart;
        search.from.gemv(1.0, functionals, &guess.p_dot, 0.0);
        gap.copy_from_slice(wanted);
        *gap -= &search.from;
        search.ask(&guess.tilt, gap);
        guess.p_dot.gemv(1.0, basis, &search.asked, 1.0);
        numbers.move_at(mechanism, guess.p_dot.as_slice());
        let step = numbers.correct_velocities(mechanism, &mut guess.p_dot, change) + gap.amax();
        search.reach(functionals, &guess.p_dot, &mut guess.tilt);
        step / mechanism.system.length.max(1.0).max(guess.p_dot.amax())
    }
}
