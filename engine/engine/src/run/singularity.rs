//! Singular configurations that a run passes, found from the pivots of the factorization — THEORY section 8.
//!
//! The product of a joint's relative pivots in S is the square of a number that passes through zero at a singular
//! configuration. The factorizations of the run give it at the ends of steps. Inside a step, S is evaluated if its rows turn so
//! far that one of these numbers may reach zero and come back. Mechanisms without loops have no such step.

mod found;
mod history;
mod probe;
mod search;

pub use found::SingularConfiguration;

use crate::integrate::{Integrator, IslandStep};
use crate::scene::ConstraintMethod;
use found::Found;
use history::IslandHistory;
use probe::Probe;
use search::{SAMPLES, Search};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::constraints::violation;
use triad_dynamics::system::System;
use triad_dynamics::system::islands::has_loops;

/// Part of a joint's largest pivot product that counts as zero: what rounding leaves at a singular configuration.
const ZERO: f64 = 1e-8;
/// Distance of the computed motion from a singular configuration, in tolerances (as an angle) and in violations of the
/// constraints (as a pivot product).
const ERRORS: f64 = 10.0;

/// Watches the pivots of a run.
#[derive(Clone, Debug)]
pub struct SingularityMonitor {
    /// Evaluates S inside steps, if the mechanism has loops.
    probe: Option<Probe>,
    tolerance: f64,
    /// Whether no projection closes the constraints at the ends of steps.
    violated: bool,
    /// Part of a joint's largest pivot product that counts as zero.
    zero: f64,
    islands: Vec<IslandHistory>,
    found: Found,
    /// Pivot products at times of the last step: its start, its end, and those of the probes.
    samples: Vec<Vec<f64>>,
    /// Pivot products at the singular configuration that was found last in the step.
    at_found: Vec<f64>,
}

impl SingularityMonitor {
    /// For a mechanism whose rank is known.
    pub fn new(mechanism: &mut Mechanism, rank: &Rank) -> Self {
        let Mechanism { system, state, elimination, .. } = mechanism;
        let probe = has_loops(&system.model).then(|| Probe::new(system, state, elimination, &rank.dependent));
        let constraints = if probe.is_some() { system.constraints.len() } else { 0 };
        let settings = &system.model.settings;
        Self {
            probe,
            tolerance: settings.tolerance,
            violated: settings.constraint_method != ConstraintMethod::Projection,
            zero: zero(settings.tolerance, 0.0),
            islands: Vec::new(),
            found: Found::new(constraints),
            samples: (0..SAMPLES).map(|_| Vec::with_capacity(constraints)).collect(),
            at_found: Vec::with_capacity(constraints),
        }
    }

    /// Forgets the run so far.
    pub fn reset(&mut self) {
        self.islands.clear();
        self.found.clear();
        if let Some(probe) = &mut self.probe {
            probe.count = 0;
        }
    }

    /// Singular configurations that were passed so far, in the order of time.
    pub fn configurations(&self, system: &System) -> Vec<SingularConfiguration> {
        self.found.list(system)
    }

    /// Evaluations of S inside steps so far.
    pub fn probes(&self) -> u64 {
        self.probe.as_ref().map_or(0, |probe| probe.count)
    }

    /// Searches the step that was taken last.
    pub fn step(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator) {
        let Self { probe: Some(probe), found, samples, at_found, .. } = self else { return };
        if found.is_full() {
            return;
        }
        if self.violated {
            self.zero = zero(self.tolerance, violation::relative(&mechanism.system, &mechanism.state));
        }
        let Some(step) = integrator.island_step(mechanism) else { return };
        let IslandStep { island, start, end, pace, pivot_products } = step;
        if self.islands.len() <= island {
            self.islands.resize(island + 1, IslandHistory::default());
        }
        let history = &mut self.islands[island];
        std::mem::swap(&mut history.pivot_products, &mut samples[0]);
        let known = pivot_products.map(|products| probe::copy(products, &mut samples[1])).is_some();
        if !known {
            probe.pivot_products(mechanism, integrator, end, &mut samples[1]);
        }
        if history.is_new() {
            probe.pivot_products(mechanism, integrator, start, &mut samples[0]);
            history.begin(&samples[0], pace);
        }
        history.note_largest(&samples[1]);
        at_found.clear();
        let fastest = pace.max(history.pace);
        let mut search = Search {
            probe,
            found,
            mechanism,
            integrator,
            history,
            zero: self.zero,
            pace: fastest,
            samples,
            at_found,
        };
        search.within((start, 0), (end, 1), 2);
        history.note_change(&samples[0], &samples[1], (end - start) * fastest);
        std::mem::swap(&mut history.pivot_products, &mut samples[1]);
        history.pace = pace;
    }
}

/// What counts as zero, as a part of the largest pivot product. Where constraints are violated, nothing brings bodies nearer
/// to the singular configuration than the root of the violation: there it is of second order.
fn zero(tolerance: f64, violation: f64) -> f64 {
    let error = ERRORS * tolerance;
    ZERO.max(error * error).max(ERRORS * violation)
}
