//! What a run has cost and how far it can be trusted.

use super::{ErrorEstimate, Simulation, SingularConfiguration};
use crate::integrate::PenaltyParameters;
use crate::scene::{ConstraintMethod, IntegratorKind};
use serde::Serialize;
use triad_dynamics::constraints::violation;
use triad_dynamics::system::System;

/// The part of the energy at the start that counts as kinetic where nothing moves.
const STANDING: f64 = 1e-3;
/// Part of the length of the mechanism by which positions may be off before a result is doubted: a hundredth shows in a plot.
const DOUBTFUL: f64 = 0.01;

/// What a run has cost and how far it can be trusted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Time, s.
    pub time: f64,
    /// Kinetic plus potential energy, J.
    pub energy: f64,
    /// Work of drivers and of loads without potential since the start, J.
    pub work: f64,
    /// Energy less that of the start and the work since, J: zero but for errors. Where drivers leave nothing to integrate, it is that of
    /// their work, which is as exact as the tolerance asks.
    pub energy_drift: f64,
    /// Largest |Φ|.
    pub position_violation: f64,
    /// Largest |Φ̇|.
    pub velocity_violation: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Size of the last step, s.
    pub step_size: f64,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Factorizations.
    pub factorizations: u64,
    /// Back-solves.
    pub solves: u64,
    /// Projections onto the constraints.
    pub projections: u64,
    /// The integrator at work.
    pub integrator: IntegratorKind,
    /// Why it is this one.
    pub reason: String,
    /// Singular configurations passed, where the mobility jumps for a moment.
    #[serde(rename = "passages")]
    pub singularities: Vec<SingularConfiguration>,
    /// Estimated errors of the current state, where they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorEstimate>,
    /// The second solution that they are read off, where the method does not carry its error along.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_method: Option<String>,
    /// From when on they are not known, s: they have grown beyond what can be called small.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_unknown_from: Option<f64>,
    /// What speaks against the result, in words, with what to use instead.
    pub doubts: Vec<String>,
    /// Whether the end of the run is reached.
    pub finished: bool,
}

/// Part of the lightest mass that is lost in the rounding of penalties.
fn swallowed(system: &System) -> f64 {
    let ConstraintMethod::Penalty { alpha, omega, mu } = system.model.settings.constraint_method else {
        return 0.0;
    };
    PenaltyParameters { alpha, omega, mu }.min_tolerance(system)
}

/// Kinetic energy below which a mechanism rests: of all its mass, moving by no more than the rounding of its length in the whole run, J.
fn resting_energy(system: &System) -> f64 {
    let speed = f64::EPSILON * system.length / system.model.settings.duration;
    0.5 * system.model.mass() * speed * speed
}

/// Energy that the weight of a mechanism has over its length, J.
fn weighing_energy(system: &System) -> f64 {
    system.model.mass() * system.model.gravity.norm() * system.length
}

impl Simulation {
    /// Cost and accuracy up to the current state.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
    /// run.advance_to(1.0)?;
    /// let summary = run.summary();
    /// assert!(summary.energy_drift.abs() < 1e-6 && summary.steps > 0);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn summary(&self) -> Summary {
        let work = self.work + self.work_up_to_current();
        let system = &self.mechanism.system;
        let current = self.current.state(system);
        let energy = current.energy(system);
        let position_violation = current.position_violation(system);
        let velocity_violation = current.velocity_violation(system);
        let energy_drift = energy - self.start_energy - work;
        let (counters, projections) = self.integrator.work(&self.mechanism);
        let steps = self.integrator.last().steps;
        let singularities = self.singularities.configurations(system);
        let error = self.error_estimate();
        let mut doubts = self.doubts(&singularities, [energy_drift, work]);
        doubts.extend(self.doubts_of_error(error));
        Summary {
            time: self.time(),
            energy,
            work,
            energy_drift,
            position_violation,
            velocity_violation,
            steps: steps.accepted,
            rejected: steps.rejected,
            step_size: self.integrator.last().h,
            evaluations: counters.evaluations,
            factorizations: counters.factorizations,
            solves: counters.solves,
            projections,
            integrator: self.kind,
            reason: self.reason.clone(),
            singularities,
            error,
            error_method: self.error_method().map(|(kind, tolerance)| format!("{kind} at {tolerance:.0e}")),
            error_unknown_from: self.error_unknown_from(),
            doubts,
            finished: self.finished(),
        }
    }

    /// What the estimated error speaks against.
    fn doubts_of_error(&self, error: Option<ErrorEstimate>) -> Option<String> {
        let instead = match self.model().settings.step {
            None => "tighten the tolerance, or look at a shorter time",
            Some(_) => "use shorter steps, or leave their size to the tolerance",
        };
        if let Some(time) = self.error_unknown_from().filter(|&time| time <= self.time()) {
            return Some(format!(
                "from t = {time:.6} s on nothing is known of the error: {}; {instead}",
                self.why_unknown()
            ));
        }
        let off = error?.position;
        let length = self.system().length;
        (off > DOUBTFUL * length).then(|| {
            format!(
                "positions are off by about {off:.1e} m, more than a hundredth of the mechanism's length of {length:.3} m; \
                 {instead}"
            )
        })
    }

    /// Whether joints and drivers leave a motion: where they leave none, velocities are rounding.
    fn moves(&self) -> bool {
        let system = &self.mechanism.system;
        self.rank.rank < 6 * system.bodies.len()
            || system.constraints.iter().any(|constraint| constraint.driver)
    }

    /// The energy that a drift is measured by, J; `energies` is the sum of the sizes of all at the start and now.
    fn energy_in_play(&self, [drift, work]: [f64; 2], energies: f64) -> f64 {
        let system = &self.mechanism.system;
        let start = self.start_energy.abs();
        let series = self.kind == IntegratorKind::Taylor;
        // A series is measured by what moves now, but what it loses is no more than its tolerance promises of what has moved before.
        let promised = drift.abs() <= system.model.settings.tolerance * self.seen.kinetic;
        let seen = if series && !promised { 0.0 } else { self.seen.kinetic };
        let kinetic = seen.max(self.current.state(system).kinetic_energy(system)).max(resting_energy(system));
        // A slow motion gives away what was worked on it without ever having much of it. A Taylor series passes singular positions: only
        // what it has brought in or lost beside the whole of its energy speaks against it.
        let moved = kinetic.max(self.seen.work).max(work.abs());
        let moved = moved.max(if series { start } else { STANDING * start });
        if self.moves() { moved } else { moved.max(energies).max(weighing_energy(system)) }
    }

    /// What speaks against the current state.
    fn doubts(&self, singularities: &[SingularConfiguration], [drift, work]: [f64; 2]) -> Vec<String> {
        let mut doubts = self.branching();
        doubts
            .extend(self.without_inertia().map(|cause| format!("{cause}; give them some about every axis")));
        let system = &self.mechanism.system;
        let current = self.current.state(system);
        let energies = self.start_energy.abs() + current.energies(system).map(f64::abs).sum::<f64>();
        let left = self.seen.beyond_rounding(drift, energies);
        let series = self.kind == IntegratorKind::Taylor;
        let signs = violation::Signs {
            passed: singularities.first().map(|passed| passed.time).filter(|_| !series),
            drift: if left == 0.0 { 0.0 } else { left / self.energy_in_play([drift, work], energies) },
            open: violation::relative(system, current),
            swallowed: swallowed(system),
        };
        doubts.extend(violation::doubts(&system.model.settings, &signs));
        doubts
    }
}
