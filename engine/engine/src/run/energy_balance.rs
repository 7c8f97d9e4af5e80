//! Where the energy goes: power of drivers and of loads that have no potential — THEORY section 6.
//!
//! The total energy of a run changes by exactly the work that these do. What is left over is the error of the run.

use super::Simulation;
use crate::integrate::power;
use triad_dynamics::constraints::mechanism::Mechanism;

/// Nodes and weights of Gauss-Legendre quadrature of order 10 on [0, 1].
const NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

impl Simulation {
    /// Work of drivers and of loads without potential from the start of the last step to time t, J. Counters stay.
    pub(super) fn work_of_last_step(&mut self, t: f64) -> f64 {
        if let Some(work) = self.known_work(t) {
            return work;
        }
        let counters = self.mechanism.elimination.counters;
        let Self { mechanism, integrator, scratch, .. } = self;
        let start = integrator.last().t - integrator.last().h;
        let work = work(mechanism, (start, t), scratch, |mechanism, t, state| {
            integrator.interpolate(mechanism, t, state);
        });
        self.mechanism.elimination.counters = counters;
        work
    }

    /// The same to the current time, computed once.
    pub(super) fn work_up_to_current(&self) -> f64 {
        let t = self.time();
        self.current.work(|| self.known_work(t).unwrap_or_else(|| self.clone().work_with_dense_output(t)))
    }

    /// The same with the dense output of the step prepared before: preparing it leaves independent coordinates with
    /// another first guess, which the last bits of the first state would show.
    fn work_with_dense_output(&mut self, t: f64) -> f64 {
        let Self { mechanism, integrator, scratch, .. } = self;
        let middle = integrator.last().t - 0.5 * integrator.last().h;
        integrator.interpolate(mechanism, middle, scratch);
        self.work_of_last_step(t)
    }

    /// The same where no evaluation is needed.
    fn known_work(&self, t: f64) -> Option<f64> {
        let start = self.integrator.last().t - self.integrator.last().h;
        if self.conservative || t <= start {
            return Some(0.0);
        }
        self.integrator.work_to(t)
    }
}

/// Work over a step whose states `state(t)` writes, J.
pub fn work(
    mechanism: &mut Mechanism,
    (start, end): (f64, f64),
    scratch: &mut [f64],
    mut state: impl FnMut(&mut Mechanism, f64, &mut [f64]),
) -> f64 {
    let mut work = 0.0;
    for (node, weight) in NODES {
        let t = start + node * (end - start);
        state(mechanism, t, scratch);
        work += weight * (end - start) * power(&mechanism.accelerations(t, scratch).multipliers);
    }
    work
}
