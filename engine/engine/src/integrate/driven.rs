//! A mechanism that its drivers move completely: nothing is left to integrate. Positions, velocities and accelerations
//! follow from Φ(q, t) = 0, Φ_q q̇ = ν and Φ_q q̈ = γ at any time; steps only keep to the branch that the motion is on.

use super::hermite;
use super::step::{MIN_RETRY, StepRecord, StopReason};
use super::stepper::Stepper;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_dynamics::ode::OdeSystem;

/// Largest correction of a position predicted from q, q̇ and q̈, in lengths of the mechanism: it is that much nearer to the
/// motion than to another branch.
const FORESEEN: f64 = 1e-3;
/// Least and greatest change of the step, as factors.
const CHANGE: (f64, f64) = (0.2, 2.0);
/// Part of the step that the correction, of order 3, allows that is taken.
const CAUTION: f64 = 0.8;
/// Least number of steps of a run: a motion that begins and ends within one would not be noticed.
const MIN_STEPS: f64 = 100.0;

/// The last step of a driven mechanism.
#[derive(Clone, Debug)]
pub struct Driven {
    last: StepRecord,
    /// State at the start of the last step.
    y_old: Vec<f64>,
    /// ẏ at its end and at its start.
    rate: Vec<f64>,
    rate_old: Vec<f64>,
    trial: Vec<f64>,
    /// Size of the next step, and the largest one.
    h: f64,
    largest: f64,
    fixed: bool,
}

impl Driven {
    /// Starts at the consistent state y.
    pub fn new(mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Self {
        let settings = &mechanism.system.model.settings;
        let largest = (settings.duration - t) / MIN_STEPS;
        let (h, fixed) = (settings.step.unwrap_or(largest), settings.step.is_some());
        let mut rate = vec![0.0; y.len()];
        mechanism.rhs(t, y, &mut rate);
        Self {
            last: StepRecord::new(t, y),
            y_old: y.to_vec(),
            rate_old: rate.clone(),
            rate,
            trial: y.to_vec(),
            h,
            largest,
            fixed,
        }
    }

    /// Moves what is predicted for time t onto the constraints. Returns how far that was, in lengths of the mechanism.
    fn close(mechanism: &mut Mechanism, t: f64, y: &mut [f64]) -> Option<f64> {
        let (n, length) = (mechanism.system.coordinates, mechanism.system.length);
        mechanism.set_state(t, y);
        let positions =
            project_positions(&mut mechanism.projectable(y), &rules::KINEMATICS_POSITIONS, length);
        mechanism.state.set_velocities(&mechanism.system, &y[n..]);
        project_velocities(&mut mechanism.projectable(y), &rules::KINEMATICS_VELOCITIES, length);
        let found = positions.has_converged() && y.iter().all(|y| y.is_finite());
        found.then_some(positions.moved / length)
    }

    /// The state at the end of a step of size h. Returns how far off it was predicted.
    fn attempt(&mut self, mechanism: &mut Mechanism, h: f64) -> Option<f64> {
        let n = mechanism.system.coordinates;
        for i in 0..n {
            let (q, v, a) = (self.last.y[i], self.last.y[n + i], self.rate[n + i]);
            self.trial[i] = q + h * (v + 0.5 * h * a);
            self.trial[n + i] = v + h * a;
        }
        Self::close(mechanism, self.last.t + h, &mut self.trial)
    }
}

impl Stepper for Driven {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        loop {
            let h = self.last.next_size(self.h, end)?;
            let missed = self.attempt(mechanism, h).filter(|_| mechanism.knows_turns());
            let by = missed.map_or(CHANGE.0, |missed| CAUTION * libm::cbrt(FORESEEN / missed));
            if missed.is_none_or(|missed| missed > FORESEEN && !self.fixed) {
                if self.fixed || h < MIN_RETRY * (1.0 + self.last.t.abs()) {
                    return Err(StopReason::NoConvergence { time: self.last.t, step: h });
                }
                self.last.steps.rejected += 1;
                self.h = h * by.clamp(CHANGE.0, CAUTION);
                continue;
            }
            self.y_old.copy_from_slice(&self.last.y);
            self.last.y.copy_from_slice(&self.trial);
            self.last.advance(h, end);
            self.rate_old.copy_from_slice(&self.rate);
            let StepRecord { t, y, .. } = &self.last;
            mechanism.rhs(*t, y, &mut self.rate);
            mechanism.state.commit_motion();
            if self.rate.iter().any(|x| !x.is_finite()) {
                return Err(self.last.not_finite());
            }
            if !self.fixed {
                let next = h * by.clamp(CHANGE.0, CHANGE.1);
                self.h = if h < self.h { self.h.max(next) } else { next }.min(self.largest);
            }
            return Ok(());
        }
    }

    /// Exact: what is interpolated is moved onto the constraints.
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        if self.last.has_ended(t) {
            y.copy_from_slice(&self.last.y);
            return;
        }
        let n = y.len() / 2;
        let s = self.last.part(t);
        for i in 0..n {
            let at = |y: &[f64], rate: &[f64]| [y[i], y[n + i], rate[n + i]];
            let (start, end) = (at(&self.y_old, &self.rate_old), at(&self.last.y, &self.rate));
            (y[i], y[n + i]) = hermite::quintic(start, end, self.last.h, s);
        }
        Self::close(mechanism, t, y);
    }

    fn next_size(&self) -> Option<f64> {
        Some(self.h)
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
