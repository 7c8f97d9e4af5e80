//! Rank of the joint rows, degrees of freedom and dependent rows — THEORY section 8.
//!
//! The rank is taken at a consistent position a little away from the given one: a mechanism often starts in a
//! singular position, where it would mislead. The dependent rows are those that the factorization of S, in a measure of lengths,
//! has to drop.

use crate::constraints::ConstraintError;
use crate::constraints::geometry::Geometry;
use crate::dynamics::elimination::{Elimination, ProjectableState};
use crate::newton::{DEPENDENT, find_dependent_rows};
use crate::state::State;
use crate::system::System;
use crate::system::index::SolverRow;
use crate::system::islands::is_tree;

pub use crate::constraints::geometry::Rank;

/// Finds the rank near the consistent position q; `state` is left elsewhere.
pub fn analyze(system: &System, state: &mut State, q: &[f64]) -> Rank {
    analyze_while(system, state, q, &|| true)
}

/// As [`analyze`], as long as that is wanted; what is said of it afterwards means nothing.
pub fn analyze_while(system: &System, state: &mut State, q: &[f64], wanted: &dyn Fn() -> bool) -> Rank {
    if is_tree(&system.model) {
        let rank = system.solver_rows;
        return Rank { rank, dependent_at_start: Vec::new(), dependent: Vec::new(), inexact: None };
    }
    Geometry::new(system).analyze(state, q, wanted)
}

/// Rows of a tree of joints are independent: if rounding finds them dependent in the measure of the masses, with which the
/// motion is computed, the masses are to blame, and what would be computed has nothing to do with the mechanism. `state` and
/// `elimination` are left elsewhere.
///
/// # Errors
///
/// [`ConstraintError::MassesTooDifferent`], with the lightest and the heaviest body.
pub fn check_masses(
    system: &System,
    state: &mut State,
    elimination: &mut Elimination,
    q: &[f64],
) -> Result<(), ConstraintError> {
    if !is_tree(&system.model) {
        return Ok(());
    }
    state.set_positions(system, q);
    if elimination.dependent_rows(system, state, DEPENDENT).is_empty() {
        return Ok(());
    }
    elimination.set_redundant(true);
    let (mut q, mut q_dot) = (q.to_vec(), vec![0.0; q.len()]);
    let mut on = ProjectableState { system, state, elimination, q: &mut q, q_dot: &mut q_dot };
    let dependent = find_dependent_rows(&mut on, system.length);
    elimination.set_redundant(false);
    dependent.first().map_or(Ok(()), |&row| Err(masses_too_different(system, row)))
}

fn masses_too_different(system: &System, row: SolverRow) -> ConstraintError {
    let System { constraints, bodies, model, .. } = system;
    let by_mass = || bodies.iter().zip(&model.bodies).map(|(body, named)| (body.mass, named.name.clone()));
    let light = by_mass().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let heavy = by_mass().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let joint = constraints
        .iter()
        .position(|constraint| constraint.solver.contains(&row.index()))
        .unwrap_or_default();
    ConstraintError::MassesTooDifferent {
        joint: constraints[joint].name.clone(),
        pointer: format!("/joints/{joint}"),
        light: light.1,
        light_mass: light.0,
        heavy: heavy.1,
        heavy_mass: heavy.0,
    }
}
