//! Rank of the joint rows, degrees of freedom and dependent rows — THEORY section 8.
//!
//! The rank is taken at a consistent position a little away from the given one: a mechanism often starts in a
//! singular position, where it would mislead. The dependent rows are those that the factorization of S has to drop.

use crate::constraints::ConstraintError;
use crate::dynamics::elimination::{Elimination, ProjectableState};
use crate::newton::{DEPENDENT, find_dependent_rows};
use crate::state::State;
use crate::system::System;
use crate::system::index::SolverRow;
use crate::system::islands;

/// What the pivots say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Rank of the joint rows that the solver keeps.
    pub rank: usize,
    /// The same exactly at the start: less where that is a singular position.
    pub at_start: usize,
    /// The solver rows that depend on others.
    pub dependent: Vec<SolverRow>,
}

/// Finds the rank near the consistent position q; `state` and `elimination` are left elsewhere.
pub fn analyze(system: &System, state: &mut State, elimination: &mut Elimination, q: &[f64]) -> Rank {
    let was_redundant = elimination.is_redundant();
    elimination.set_redundant(true);
    state.set_positions(system, q);
    let lost = elimination.dependent_rows(system, state, DEPENDENT).len();
    let mut dependent = Vec::new();
    // Rows that are independent somewhere are so nearly everywhere.
    if lost > 0 {
        let (mut q, mut q_dot) = (q.to_vec(), vec![0.0; q.len()]);
        let mut on = ProjectableState { system, state, elimination, q: &mut q, q_dot: &mut q_dot };
        dependent = find_dependent_rows(&mut on, system.length);
    }
    elimination.set_redundant(was_redundant);
    Rank { rank: system.solver_rows - dependent.len(), at_start: system.solver_rows - lost, dependent }
}

/// Rows of a tree of joints are independent whatever the position: if rounding finds them dependent, the masses are to
/// blame, and what would be computed has nothing to do with the mechanism.
///
/// # Errors
///
/// [`ConstraintError::MassesTooDifferent`], with the lightest and the heaviest body.
pub fn check(system: &System, rank: &Rank) -> Result<(), ConstraintError> {
    let System { constraints, bodies, model, .. } = system;
    let Some(row) = rank.dependent.first() else { return Ok(()) };
    let tree = model.drivers.is_empty() && model.joints.iter().all(|joint| joint.coupled_joints().is_none());
    if !tree || islands::has_loops(model) {
        return Ok(());
    }
    let by_mass = || bodies.iter().zip(&model.bodies).map(|(body, named)| (body.mass, named.name.clone()));
    let light = by_mass().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let heavy = by_mass().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let joint = constraints
        .iter()
        .position(|constraint| constraint.solver.contains(&row.index()))
        .unwrap_or_default();
    Err(ConstraintError::MassesTooDifferent {
        joint: constraints[joint].name.clone(),
        pointer: format!("/joints/{joint}"),
        light: light.1,
        light_mass: light.0,
        heavy: heavy.1,
        heavy_mass: heavy.0,
    })
}
