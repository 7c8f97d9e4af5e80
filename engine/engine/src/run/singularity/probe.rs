//! Evaluations of S inside a step.

use crate::integrate::Integrator;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::Elimination;
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::index::SolverRow;

/// Evaluates S at times inside the last step, and leaves the evaluation of the run as it is.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    state: State,
    elimination: Elimination,
    y: Vec<f64>,
    /// Evaluations so far.
    pub count: u64,
}

impl Probe {
    /// For an evaluation with the given dependent rows; from now on it keeps pivot products.
    pub(super) fn new(
        system: &System,
        state: &State,
        elimination: &mut Elimination,
        dependent: &[SolverRow],
    ) -> Self {
        elimination.keep_pivot_products();
        let mut elimination = elimination.clone();
        elimination.set_dependent(dependent);
        Self { state: state.clone(), elimination, y: vec![0.0; 2 * system.coordinates], count: 0 }
    }

    /// Writes the pivot products at time t within the last step.
    pub(super) fn pivot_products(
        &mut self,
        mechanism: &mut Mechanism,
        integrator: &mut Integrator,
        t: f64,
        out: &mut Vec<f64>,
    ) {
        self.count += 1;
        if let Some(products) = integrator.pivot_products_inside(t) {
            return copy(products, out);
        }
        copy(self.evaluate(mechanism, integrator, t), out);
    }

    /// Pivot products at time t within the last step, by an evaluation of its own.
    pub(super) fn evaluate(
        &mut self,
        mechanism: &mut Mechanism,
        integrator: &mut Integrator,
        t: f64,
    ) -> &[f64] {
        integrator.interpolate_island(mechanism, t, &mut self.y);
        let system = &mechanism.system;
        self.state.set_time(system, t);
        self.state.set_positions(system, &self.y[..system.coordinates]);
        self.elimination.pivot_products_at(system, &self.state)
    }
}

/// Replaces the content of `out`.
pub(super) fn copy(products: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.extend_from_slice(products);
}
