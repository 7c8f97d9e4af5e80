//! The most that a run has seen of what its energy balance is measured by.

use crate::integrate::StepRecord;
use triad_dynamics::state::kinetic_of_step;
use triad_dynamics::system::System;

/// Roundings of the energies that were summed up below which a drift is nothing but that.
const ROUNDINGS: f64 = 100.0;

/// Largest energies so far.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    /// End of the last step, s, and the state (q, q̇) there.
    time: f64,
    state: Vec<f64>,
    /// Largest kinetic energy, J, at ends of steps, or of the mean velocity of one.
    pub kinetic: f64,
    /// Largest work of drivers and of loads without potential since the start, J, at ends of steps.
    pub work: f64,
}

impl Seen {
    /// Of a run that starts at (t, y).
    pub fn new(time: f64, y: &[f64]) -> Self {
        Self { time, state: y.to_vec(), kinetic: 0.0, work: 0.0 }
    }

    /// Takes over a step, with the work up to its start.
    pub fn step(&mut self, system: &System, step: &StepRecord, work: f64) {
        let h = step.t - self.time;
        let [end, mean] = kinetic_of_step(system, &self.state, &step.y, h);
        self.kinetic = self.kinetic.max(end);
        // Nothing is known of a step without duration.
        if h > 0.0 {
            self.kinetic = self.kinetic.max(mean);
        }
        self.work = self.work.max(work.abs());
        self.time = step.t;
        self.state.copy_from_slice(&step.y);
    }

    /// What is left of a drift beyond the rounding of energies whose sizes have this sum, J, and of what was seen.
    pub fn beyond_rounding(&self, drift: f64, energies: f64) -> f64 {
        let sizes = energies + self.kinetic + self.work;
        if drift.abs() <= ROUNDINGS * f64::EPSILON * sizes { 0.0 } else { drift.abs() }
    }
}
