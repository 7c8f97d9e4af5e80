//! What a step is judged by: its own error, that of the work, and what corrections of Newton's method may hide where a friction
//! starts or ends to slide.

use super::Radau;
use super::stages::{Stages, scale};
use triad_dynamics::ode::OdeSystem;

/// Error of the work in a step, relative to the work so far: so many tolerances, but not less nor more than the others.
const WORK_TOLERANCE: (f64, f64, f64) = (1e2, 1e-6, 1e-3);

impl Radau {
    /// Error of the step relative to the tolerance; after a refusal, or at the start, its stiff part is filtered twice.
    pub(super) fn error(&mut self, system: &mut impl OdeSystem, rejected: bool) -> f64 {
        self.trial_rate.copy_from_slice(&self.rate);
        let size = self.filtered_defect();
        if size < 1.0 || !(rejected || self.last.steps.accepted == 0) {
            return size;
        }
        for (trial, (x, e)) in self.trial.iter_mut().zip(self.last.y.iter().zip(&self.defect)) {
            *trial = x + e;
        }
        system.rhs(self.last.t, &self.trial, &mut self.trial_rate);
        self.filtered_defect()
    }

    /// Whether a dry friction slides otherwise at the end of a step of size h, which is in `trial`, than at its start. Then the Jacobian
    /// matrix of one of the two is wrong for the other, and what the filter calls stiff may be the error: it went unseen.
    pub(super) fn slides_otherwise(&mut self, system: &mut impl OdeSystem, h: f64, end: f64) -> bool {
        let [before, after] = &mut self.slidings;
        system.slidings(self.last.t, &self.last.y, before);
        if before.is_empty() {
            return false;
        }
        system.slidings(self.last.end_of(h, end), &self.trial, after);
        before != after
    }

    /// Error of the work of what changes the energy in a step of size h, relative to what it may be: a driver may oscillate where
    /// the coordinates hardly move. Work that begins within the step is measured by what the tolerance leaves open anyway: beside none
    /// before it, any would be too much, however short the step.
    pub(super) fn work_error(&mut self, system: &mut impl OdeSystem, h: f64) -> f64 {
        let Some(power) = self.power else { return 0.0 };
        let [off, turnover] = self.stages.find_power(system, &self.last, h, power);
        self.new_turnover = self.turnover + turnover;
        let may_be = (WORK_TOLERANCE.0 * self.estimated).clamp(WORK_TOLERANCE.1, WORK_TOLERANCE.2);
        if off == 0.0 {
            return 0.0;
        }
        off / (may_be * self.new_turnover).max(system.energy_of(self.estimated))
    }

    /// (μ I − J)⁻¹ (ẋ − p'(0) / h) with ẋ in `trial_rate`, the real μ and the slope p' of the stages. Returns its size.
    fn filtered_defect(&mut self) -> f64 {
        self.find_defect();
        self.stages.filter(&self.jacobian, &mut self.factors, &mut self.defect);
        self.size_of_defect()
    }

    /// The same of a J that knows of no forces.
    pub(super) fn plain_defect(&mut self) -> f64 {
        self.trial_rate.copy_from_slice(&self.rate);
        self.find_defect();
        let over = self.factors.h / self.stages.method.tables.real;
        let (places, rates) = self.defect.split_at_mut(self.rate.len() / 2);
        for (place, rate) in places.iter_mut().zip(rates) {
            *rate *= over;
            *place = (*place + *rate) * over;
        }
        self.size_of_defect()
    }

    /// What the rates at the stages make of the step, less what was found, in tolerances: corrections may be small where a matrix
    /// is far too stiff, and the stages nowhere near.
    pub(super) fn unsolved(&mut self, system: &mut impl OdeSystem, h: f64) -> f64 {
        let Some(end) = self.stages.z.last() else { return 0.0 };
        self.defect.iter_mut().zip(end).for_each(|(defect, z)| *defect = -z);
        for ((node, weight), z) in self.stages.method.tables.nodes.iter().zip(&self.stages.z) {
            for (trial, (x, z)) in self.trial.iter_mut().zip(self.last.y.iter().zip(z)) {
                *trial = x + z;
            }
            system.rhs(self.last.t + node * h, &self.trial, &mut self.trial_rate);
            let part = weight * h;
            self.defect.iter_mut().zip(&self.trial_rate).for_each(|(defect, rate)| *defect += part * rate);
        }
        self.size_of_defect()
    }

    fn find_defect(&mut self) {
        let Stages { method, z, .. } = &self.stages;
        for i in 0..self.defect.len() {
            let slope: f64 = method.estimate.iter().zip(z).map(|(weight, z)| weight * z[i]).sum();
            self.defect[i] = slope / self.factors.h + self.trial_rate[i];
        }
    }

    /// Its size in tolerances. Leaves the end of the step in `trial`.
    fn size_of_defect(&mut self) -> f64 {
        if let Some(end) = self.stages.z.last() {
            for (trial, (x, z)) in self.trial.iter_mut().zip(self.last.y.iter().zip(end)) {
                *trial = x + z;
            }
        }
        let n = self.defect.len();
        let ends = self.last.y.iter().zip(&self.trial).map(|(a, b)| a.abs().max(b.abs()));
        let parts = self.defect.iter().zip(ends).enumerate();
        let sum: f64 = parts.map(|(i, (x, y))| x * scale(i, n, y, self.estimated)).map(|x| x * x).sum();
        (sum / n as f64).sqrt()
    }
}
