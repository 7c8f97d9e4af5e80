//! A state that elimination moves onto its constraints — eq. (10.2).

use super::Elimination;
use crate::newton::{Movable, Projectable};
use crate::state::State;
use crate::system::System;
use crate::system::index::SolverRow;

/// A state with its numbers, and the evaluation that corrects them. The numbers must be in place in the state.
#[derive(Debug)]
pub struct ProjectableState<'a> {
    /// The system.
    pub system: &'a System,
    /// The state, whose time stays as it is.
    pub state: &'a mut State,
    /// The evaluation.
    pub elimination: &'a mut Elimination,
    /// q.
    pub q: &'a mut [f64],
    /// q̇; needed by projections of velocities alone.
    pub q_dot: &'a mut [f64],
}

impl Projectable for ProjectableState<'_> {
    fn linearize(&mut self) {
        self.elimination.linearize(self.system, self.state);
    }

    fn correct_positions(&mut self) -> f64 {
        let step = self.elimination.correct_positions(self.system, self.state, self.q);
        self.state.set_positions(self.system, self.q);
        step
    }

    fn correct_velocities(&mut self) -> f64 {
        let step = self.elimination.correct_velocities(self.system, self.state, self.q_dot);
        self.state.set_velocities(self.system, self.q_dot);
        step
    }
}

impl Movable for ProjectableState<'_> {
    fn for_each(&mut self, mut change: impl FnMut(&mut f64, &mut f64)) {
        for (x, v) in self.q.iter_mut().zip(&mut *self.q_dot) {
            change(x, v);
        }
        self.state.set_positions(self.system, self.q);
        self.state.set_velocities(self.system, self.q_dot);
    }

    fn dependent_rows(&mut self, least: f64) -> Vec<SolverRow> {
        self.elimination.dependent_rows(self.system, self.state, least)
    }
}
