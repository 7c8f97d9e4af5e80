//! Rank of the joint rows, degrees of freedom and dependent rows — THEORY section 8.
//!
//! The rank is taken at a consistent position a little away from the given one: a mechanism often starts in a
//! singular position, where it would mislead. The dependent rows are those that the factorization of S has to drop.

use crate::constraints::ConstraintError;
use crate::dynamics::elimination::Elimination;
use crate::state::State;
use crate::system::System;
use crate::system::islands;

/// A relative pivot below this belongs to a dependent row.
const DEPENDENT: f64 = 1e-10;
/// How far the position is moved away from the given one, relative to the size of the mechanism.
const AWAY: f64 = 0.03;

/// What the pivots say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Rank of the joint rows that the solver keeps.
    pub rank: usize,
    /// The same exactly at the start: less where that is a singular position.
    pub at_start: usize,
    /// The solver rows that depend on others.
    pub dependent: Vec<usize>,
}

/// Finds the rank near the consistent position q; `state` and `elimination` are left elsewhere.
pub fn analyze(system: &System, state: &mut State, elimination: &mut Elimination, q: &[f64]) -> Rank {
    let was_redundant = elimination.is_redundant();
    elimination.set_redundant(true);
    state.set_positions(system, q);
    let lost =
        elimination.pivots(system, state, DEPENDENT).iter().filter(|(_, pivot)| *pivot <= DEPENDENT).count();
    if lost == 0 {
        // Rows that are independent somewhere are so nearly everywhere.
        elimination.set_redundant(was_redundant);
        return Rank { rank: system.solver_rows, at_start: system.solver_rows, dependent: Vec::new() };
    }
    let mut nearby = moved_away(system, state, elimination, q);
    state.set_positions(system, &nearby);
    if state.position_violation(system) > 1e-9 {
        nearby.copy_from_slice(q);
        state.set_positions(system, &nearby);
    }
    let pivots = elimination.pivots(system, state, DEPENDENT);
    elimination.set_redundant(was_redundant);
    let dependent: Vec<usize> =
        pivots.iter().filter(|(_, pivot)| *pivot <= DEPENDENT).map(|(row, _)| *row).collect();
    let mut dependent = dependent;
    dependent.sort_unstable();
    Rank { rank: system.solver_rows - dependent.len(), at_start: system.solver_rows - lost, dependent }
}

/// Rows of a tree of joints are independent whatever the position: if rounding finds them dependent, the masses are to
/// blame, and what would be computed has nothing to do with the mechanism.
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
    let joint = constraints.iter().position(|constraint| constraint.solver.contains(row)).unwrap_or_default();
    Err(ConstraintError::MassesTooDifferent {
        joint: constraints[joint].name.clone(),
        pointer: format!("/joints/{joint}"),
        light: light.1,
        light_mass: light.0,
        heavy: heavy.1,
        heavy_mass: heavy.0,
    })
}

/// A consistent position a little away from q, along an arbitrary admissible velocity.
fn moved_away(system: &System, state: &mut State, elimination: &mut Elimination, q: &[f64]) -> Vec<f64> {
    let mut q = q.to_vec();
    state.set_positions(system, &q);
    let mut velocity = vec![0.0; q.len()];
    // Any fixed direction that no mechanism is built along will do; this one has no symmetry.
    for (i, v) in velocity.iter_mut().enumerate() {
        *v = (1.0 + i as f64 * 0.754_877_666_2).sin();
    }
    state.set_velocities(system, &velocity);
    elimination.linearize(system, state);
    for _ in 0..2 {
        elimination.correct_velocities(system, state, &mut velocity);
        state.set_velocities(system, &velocity);
    }
    let largest = velocity.iter().fold(0.0f64, |a, v| a.max(v.abs()));
    if largest < 1e-9 {
        return q;
    }
    let scale = AWAY * system.length / largest;
    for (q, v) in q.iter_mut().zip(&velocity) {
        *q += scale * v;
    }
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        state.set_positions(system, &q);
        elimination.linearize(system, state);
        let step = elimination.correct_positions(system, state, &mut q);
        // Close enough for a rank, or no longer shrinking.
        if step < 1e-14 || (step < 1e-10 * system.length && step > 0.5 * last) {
            break;
        }
        last = step;
    }
    q
}
