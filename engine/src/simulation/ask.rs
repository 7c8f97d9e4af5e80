//! What can be asked of the shown state beyond its frame: Jacobian, accelerations, multipliers and reactions.

use super::Simulation;
use crate::error::EngineError;
use crate::integrate::Plant;
use crate::jacobian::Jacobian;
use crate::mechanism::Mechanism;
use crate::reaction::report::{Convention, ReactionReport, report};
use crate::reaction::{self, JointMultipliers};

impl Simulation {
    /// The Jacobian Φ_q at the shown state, rigid-body rows first.
    pub fn jacobian(&mut self) -> &Jacobian {
        self.mechanism.set_state(self.time, &self.shown);
        let Mechanism { system, elimination, .. } = &self.mechanism;
        let jacobian = self.jacobian.get_or_insert_with(|| Jacobian::new(system, elimination));
        jacobian.refresh(system, elimination);
        jacobian
    }

    /// Accelerations q̈ at the shown state.
    pub fn accelerations(&mut self) -> Vec<f64> {
        let time = self.time;
        self.without_counting(|mechanism, shown| {
            let mut rate = vec![0.0; shown.len()];
            mechanism.rate(time, shown, &mut rate);
            rate.split_off(mechanism.system.coordinates)
        })
    }

    /// Accelerations of the centres of mass at the shown state, in the world, m/s².
    pub fn mass_accelerations(&mut self) -> Vec<[f64; 3]> {
        let q_ddot = self.accelerations();
        self.system().bodies.iter().map(|body| body.layout.position(&q_ddot).r.into()).collect()
    }

    /// Multipliers λ and reactions of each joint at the shown state.
    pub fn multipliers(&mut self) -> Vec<JointMultipliers> {
        self.accelerations();
        reaction::multipliers(&self.mechanism.system, &self.mechanism.elimination)
    }

    /// The same, read off the series of the last step where the integrator has them: without an evaluation, and as exact
    /// as the tolerance makes the accelerations. For pictures of many moments.
    pub fn multipliers_between_steps(&mut self) -> Vec<JointMultipliers> {
        self.mechanism.set_state(self.time, &self.shown);
        if self.integrator.give_multipliers(&mut self.mechanism, self.time) {
            return reaction::multipliers(&self.mechanism.system, &self.mechanism.elimination);
        }
        self.multipliers()
    }

    /// Reactions of joints and drivers at the shown state, with what is unique about them.
    pub fn reactions(&mut self, convention: Convention) -> Result<ReactionReport, EngineError> {
        self.accelerations();
        let Mechanism { system, elimination, .. } = &self.mechanism;
        Ok(report(system, elimination, self.time, convention)?)
    }

    /// What is asked out of curiosity must not change the counters of the run.
    pub(super) fn without_counting<T>(&mut self, ask: impl FnOnce(&mut Mechanism, &[f64]) -> T) -> T {
        let counters = self.mechanism.elimination.counters;
        let answer = ask(&mut self.mechanism, &self.shown);
        self.mechanism.elimination.counters = counters;
        answer
    }
}
