//! The record of the last step, and what all integrators do alike with it.

use serde::Serialize;

/// A step that is at least this part of what is left to the end of the run is stretched or cut to end there, so that no
/// sliver remains.
const LAST_STEP: f64 = 1.01;
/// Safety factor of the step control: the step relative to the one that the error estimate allows (Hairer, Nørsett, Wanner,
/// section II.4).
pub const SAFETY: f64 = 0.9;
/// Error relative to the tolerance below which a larger step is not considered: the step control would divide by zero.
pub const MIN_ERROR: f64 = 1e-12;
/// Step below which states that are not finite, or equations that cannot be solved, are no longer answered by a smaller one, s
/// for each second of time.
pub const MIN_RETRY: f64 = 1e-10;

/// Steps to the next break of a given function but one from which on a step ends at a break whether it shows or not. Where breaks follow
/// more closely, as those of a table, steps that pass them are as exact as tolerances ask, and far fewer.
pub const RARE_BREAKS: f64 = 2.0;
/// Breaks of given functions in a run up to which a step ends at each of them: so many steps cost little. Of more, at those that are rare; a
/// second solution, which is to see what that leaves out, ends its steps at all.
pub const FEW_BREAKS: usize = 300;

/// Steps of an integrator so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Steps {
    /// Accepted steps.
    pub accepted: u64,
    /// Rejected steps.
    pub rejected: u64,
}

/// Why an integrator cannot go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopReason {
    /// The step that meets the tolerance is below the resolution of time.
    StepTooSmall {
        /// Time, s.
        time: f64,
        /// The step that was refused, s.
        step: f64,
    },
    /// The accelerations are not finite.
    NotFinite {
        /// Time, s.
        time: f64,
    },
    /// Steps have become so small that the run would never end.
    Stalled {
        /// Time, s.
        time: f64,
        /// Their size, s.
        step: f64,
    },
    /// The motions that the constraints allow cannot be determined, or there are none.
    Undetermined {
        /// Time, s.
        time: f64,
    },
    /// The trapezoidal rule was asked for without the augmented Lagrangian, which is solved together with it.
    Alone,
    /// A joint turns faster or slower at the end of a step than at its start by so much that its whole turns are not known.
    TurnsUnknown {
        /// Time, s.
        time: f64,
        /// The step that was tried, s.
        step: f64,
    },
    /// The equations of an implicit step cannot be solved.
    NoConvergence {
        /// Time, s.
        time: f64,
        /// The step that was tried, s.
        step: f64,
    },
}

/// The last step of an integrator: every integrator fills one.
#[derive(Clone, Debug)]
pub struct StepRecord {
    /// End of the last step, s.
    pub t: f64,
    /// State at its end.
    pub y: Vec<f64>,
    /// Start of the last step, s.
    pub t_old: f64,
    /// Size of the last step, s; zero before the first step, and when the coordinates have changed since.
    pub h: f64,
    /// Steps so far.
    pub steps: Steps,
}

impl StepRecord {
    /// A run that starts at (t, y).
    pub fn new(t: f64, y: &[f64]) -> Self {
        Self { t, y: y.to_vec(), t_old: t, h: 0.0, steps: Steps::default() }
    }

    /// Whether no part of the last step lies after time t.
    pub fn has_ended(&self, t: f64) -> bool {
        t >= self.t || self.h == 0.0
    }

    /// Time t as a part of the last step, from 0 at its start to 1 at its end.
    pub fn part(&self, t: f64) -> f64 {
        ((t - self.t_old) / self.h).clamp(0.0, 1.0)
    }

    /// The size of the next step, not beyond `end`, if a step of size h is wanted.
    pub(super) fn next_size(&self, h: f64, end: f64) -> Result<f64, StopReason> {
        let left = end - self.t;
        let h = if LAST_STEP * h >= left { left } else { h };
        self.check_size(h, end)?;
        Ok(h)
    }

    /// Refuses a step that is below the resolution of time in a run to `end`.
    pub(super) fn check_size(&self, h: f64, end: f64) -> Result<(), StopReason> {
        let resolution = 16.0 * f64::EPSILON * self.t.abs().max(end.abs());
        if h <= resolution && end - self.t > h {
            return Err(StopReason::StepTooSmall { time: self.t, step: h });
        }
        Ok(())
    }

    /// The end of the next step if that has the size h, in a run to `end`.
    pub(super) fn end_of(&self, h: f64, end: f64) -> f64 {
        if h == end - self.t { end } else { self.t + h }
    }

    /// Counts an accepted step of size h in a run to `end`. The state is the caller's to write.
    pub(super) fn advance(&mut self, h: f64, end: f64) {
        (self.t_old, self.t) = (self.t, self.end_of(h, end));
        self.h = h;
        self.steps.accepted += 1;
    }

    /// Has taken the last step of another record. The state is the caller's to write.
    pub(super) fn follow(&mut self, other: &Self) {
        (self.t_old, self.t, self.h) = (self.t, other.t, other.h);
        self.steps.accepted += 1;
    }

    /// Takes the last step back, which then counts as rejected. The state is the caller's to write.
    pub(super) fn take_back(&mut self) {
        self.t = self.t_old;
        self.h = 0.0;
        self.steps.accepted = self.steps.accepted.saturating_sub(1);
        self.steps.rejected += 1;
    }

    /// The reason why a state that is not finite ends the run.
    pub(super) fn not_finite(&self) -> StopReason {
        StopReason::NotFinite { time: self.t }
    }
}

/// Root mean square of x relative to tol (1 + max(|y|, |y'|)): the norm in which errors are compared with one.
pub(super) fn weighted_norm(x: impl Iterator<Item = f64>, y: &[f64], y_new: &[f64], tolerance: f64) -> f64 {
    let sum: f64 = x
        .zip(y.iter().zip(y_new))
        .map(|(x, (a, b))| x / (tolerance * (1.0 + a.abs().max(b.abs()))))
        .map(|d| d * d)
        .sum();
    (sum / y.len().max(1) as f64).sqrt()
}
