//! Newton's method onto the constraints, along the smallest change in the sense of the masses — eq. (10.2): one loop for
//! every use, over the scalar evaluation and over the series.

pub mod rules;

mod redundancy;

pub use redundancy::{DEPENDENT, Movable, find_dependent_rows, move_away};
pub use rules::{Linearize, StopRule};

/// A state that can be moved onto its constraints, with the matrices that do it.
pub trait Projectable {
    /// Builds and factors S at the positions in place — eq. (7.6).
    fn linearize(&mut self);

    /// Moves the positions by the Δq of eq. (10.2), Φ_q Δq = −Φ, with the factor at hand. Returns the largest change of a
    /// number, in the unit of the size that [`project_positions`] is given.
    fn correct_positions(&mut self) -> f64;

    /// Moves the velocities by the Δq̇ of eq. (10.2), Φ_q Δq̇ = −(Φ_q q̇ − ν), with the factor at hand. Returns the largest
    /// change of a number, in the unit of the size that [`project_velocities`] is given.
    fn correct_velocities(&mut self) -> f64;
}

/// A state that is corrected as long as that is wanted: then a projection ends with its next correction, which is none.
pub struct AsWanted<'a, P> {
    /// The state.
    pub on: P,
    /// Whether somebody waits for it.
    pub wanted: &'a dyn Fn() -> bool,
}

impl<P: Projectable> Projectable for AsWanted<'_, P> {
    fn linearize(&mut self) {
        if (self.wanted)() {
            self.on.linearize();
        }
    }

    fn correct_positions(&mut self) -> f64 {
        if (self.wanted)() { self.on.correct_positions() } else { f64::NAN }
    }

    fn correct_velocities(&mut self) -> f64 {
        if (self.wanted)() { self.on.correct_velocities() } else { f64::NAN }
    }
}

/// How a projection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The last correction was small enough.
    Consistent,
    /// Rounding keeps corrections from shrinking further.
    Stalled,
    /// All corrections that the rule allows were made.
    Exhausted,
    /// A correction was too large, or no number.
    Diverged,
}

/// What a projection did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// How it ended.
    pub ending: Ending,
    /// Corrections made.
    pub corrections: usize,
    /// The sum of their sizes.
    pub moved: f64,
}

impl Projected {
    /// Whether nothing is left to correct but rounding.
    pub fn has_converged(&self) -> bool {
        matches!(self.ending, Ending::Consistent | Ending::Stalled)
    }
}

/// Moves the positions onto Φ(q, t) = 0 by repeated corrections (10.2), until one is small as `rule` says, relative to
/// `size`: the length of the mechanism, m.
#[inline]
pub fn project_positions<P: Projectable>(on: &mut P, rule: &StopRule, size: f64) -> Projected {
    repeat(on, rule, size, P::correct_positions)
}

/// Moves the velocities onto Φ_q q̇ = ν likewise. The problem is linear: corrections after the first take out what
/// rounding, a regularized factor (7.7) or one from nearby positions have left.
#[inline]
pub fn project_velocities<P: Projectable>(on: &mut P, rule: &StopRule, size: f64) -> Projected {
    repeat(on, rule, size, P::correct_velocities)
}

#[inline]
fn repeat<P: Projectable>(
    on: &mut P,
    rule: &StopRule,
    size: f64,
    correct: impl Fn(&mut P) -> f64,
) -> Projected {
    let (mut moved, mut last) = (0.0, f64::INFINITY);
    for corrections in 1..=rule.max_corrections {
        if rule.linearize.is_due(corrections - 1) {
            on.linearize();
        }
        let step = correct(on);
        moved += step;
        if let Some(ending) = rule.ending(corrections, step, last, size) {
            return Projected { ending, corrections, moved };
        }
        last = step;
    }
    Projected { ending: Ending::Exhausted, corrections: rule.max_corrections, moved }
}
