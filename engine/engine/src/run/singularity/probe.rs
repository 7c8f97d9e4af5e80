//! States beside the path of a step, for methods that have no way of their own to evaluate them.

use crate::integrate::{Integrator, Track};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::violation;
use triad_dynamics::dynamics::elimination::{Elimination, ProjectableState};
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::index::SolverRow;

/// A state and a solver beside those of the run.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    state: State,
    elimination: Elimination,
    y: Vec<f64>,
    before: Vec<f64>,
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
        elimination.set_resolving(true);
        let y = vec![0.0; 2 * system.coordinates];
        Self { state: state.clone(), elimination, before: y.clone(), y }
    }
}

/// The path of the last step, from `start` to `end`, by the dense output of an integrator.
pub(super) struct Path<'a> {
    pub probe: &'a mut Probe,
    pub mechanism: &'a mut Mechanism,
    pub integrator: &'a mut Integrator,
    pub start: f64,
    pub end: f64,
}

impl Path<'_> {
    /// The state at a time outside the step, from that at its nearer end and the acceleration there.
    fn extrapolate(&mut self, t: f64) {
        let nearest = t.clamp(self.start, self.end);
        let ahead = t - nearest;
        let Probe { y, before, .. } = &mut *self.probe;
        self.integrator.interpolate(self.mechanism, nearest - ahead, before);
        let n = y.len() / 2;
        for i in 0..n {
            let change = y[n + i] - before[n + i];
            y[i] += ahead * (y[n + i] + 0.5 * change);
            y[n + i] += change;
        }
    }

    /// Puts the state of the probe in place at time t.
    fn set(&mut self, t: f64) {
        let Probe { state, y, .. } = &mut *self.probe;
        let system = &self.mechanism.system;
        let (q, q_dot) = y.split_at(system.coordinates);
        state.set_revolutions(self.mechanism.state.expected_angles(t));
        state.set(system, t, q, q_dot);
    }
}

impl Track for Path<'_> {
    fn numbers(&self) -> usize {
        self.probe.y.len()
    }

    fn length(&self) -> f64 {
        self.mechanism.system.length
    }

    fn place(&mut self, t: f64) {
        self.integrator.interpolate(self.mechanism, t.clamp(self.start, self.end), &mut self.probe.y);
        if t < self.start || t > self.end {
            self.extrapolate(t);
        }
        self.set(t);
    }

    fn place_smoothly(&mut self, t: f64) {
        self.integrator.interpolate_smoothly(
            self.mechanism,
            t.clamp(self.start, self.end),
            &mut self.probe.y,
        );
        self.set(t);
    }

    fn read(&mut self, out: &mut [f64]) {
        out.copy_from_slice(&self.probe.y);
    }

    fn write(&mut self, t: f64, numbers: &[f64]) {
        let Probe { state, y, .. } = &mut *self.probe;
        y.copy_from_slice(numbers);
        let (q, q_dot) = y.split_at(y.len() / 2);
        state.set(&self.mechanism.system, t, q, q_dot);
    }

    fn project(&mut self) -> Option<f64> {
        let system = &self.mechanism.system;
        let Probe { state, elimination, y, .. } = &mut *self.probe;
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        let mut on = ProjectableState { system, state, elimination, q, q_dot };
        let positions = project_positions(&mut on, &rules::PASSAGE_POSITIONS, system.length);
        on.state.set_velocities(system, on.q_dot);
        project_velocities(&mut on, &rules::PASSAGE_VELOCITIES, system.length);
        positions.has_converged().then_some(positions.moved)
    }

    fn open(&mut self) -> f64 {
        violation::relative(&self.mechanism.system, &self.probe.state)
    }

    fn pivot_products(&mut self) -> &[f64] {
        let Probe { state, elimination, .. } = &mut *self.probe;
        elimination.pivot_products_at(&self.mechanism.system, state)
    }

    fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]) {
        self.probe.elimination.raise_shares(joints, shares);
    }
}
