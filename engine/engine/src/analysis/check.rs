//! `check`: what a scene amounts to, before it is run.

use super::{AnalysisError, Wanted};
use crate::error::EngineError;
use crate::run::{Simulation, start};
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::model::Model;
use triad_dynamics::system::System;
use triad_dynamics::system::index::{ConstraintId, EquationId, RowId, SolverRow};

/// Bodies, coordinates, rows, rank, degrees of freedom and redundant rows of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CheckReport {
    /// Name of the scene.
    pub name: String,
    /// Moving bodies.
    pub bodies: usize,
    /// Generalized coordinates.
    pub coordinates: usize,
    /// Constraint rows, those of rigid bodies included.
    pub rows: usize,
    /// Rank of those rows near the start.
    pub rank: usize,
    /// Degrees of freedom: coordinates less rank.
    pub degrees_of_freedom: usize,
    /// Rows that depend on others, joint by joint.
    pub redundant: Vec<RedundantRows>,
    /// What was found or corrected.
    pub notes: Vec<String>,
}

/// Dependent rows of one joint.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct RedundantRows {
    /// The joint.
    pub joint: String,
    /// Labels of its dependent rows.
    pub rows: Vec<String>,
}

/// Equations of one row form of which some depend on others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DependentSet {
    /// The joint or driver.
    pub constraint: ConstraintId,
    /// The row form.
    pub row: RowId,
    /// Its equations among all rows, those of rigid bodies first.
    pub equations: Vec<EquationId>,
    /// How many of them are too many.
    pub dependent: usize,
}

/// The equations that repeat what others state.
pub fn dependent_sets(system: &System, rank: &Rank) -> Vec<DependentSet> {
    let mut sets = Vec::new();
    for constraint in system.constraint_ids() {
        for id in system[constraint].row_ids().filter(|&id| !system[id].implied) {
            let row = &system[id];
            let dropped = (row.solver..row.solver + row.form.independent())
                .filter(|&solver| rank.dependent.contains(&SolverRow(solver)))
                .count();
            // Three equations of a common vector hold two directions: one of them always depends on the others.
            let dependent = dropped + row.form.equations() - row.form.independent();
            if dependent > 0 {
                let first = system.rigid_rows + row.equation;
                let equations = (first..first + row.form.equations()).map(EquationId).collect();
                sets.push(DependentSet { constraint, row: id, equations, dependent });
            }
        }
    }
    sets
}

/// Checks, assembles and counts.
///
/// # Errors
///
/// [`EngineError`]: a scene that cannot be, or constraints that cannot be met at the start.
///
/// ```
/// use triad_engine::{analysis::check::check, prelude::*};
///
/// let found = check(&catalogue::scene("n-four-bar:1")?)?;
/// assert_eq!(found.degrees_of_freedom, 1);
/// # Ok::<(), EngineError>(())
/// ```
pub fn check(scene: &Scene) -> Result<CheckReport, EngineError> {
    Ok(report(scene, &Simulation::from_model(Model::new(scene)?)?))
}

/// As [`check`], as long as it is wanted.
///
/// # Errors
///
/// As [`check`], and [`AnalysisError::NoLongerWanted`].
pub fn check_while(scene: &Scene, wanted: &Wanted) -> Result<CheckReport, AnalysisError> {
    let still = || wanted.is_still();
    let model = Model::new(scene).map_err(EngineError::from)?;
    let assembled = start::assemble(model, &still);
    // What ended early says nothing of the scene.
    wanted.check()?;
    let (mut mechanism, mut begin, mut notes) = assembled.map_err(EngineError::from)?;
    let rank = start::analyze_rank(&mut mechanism, &mut begin, &mut notes, &still);
    wanted.check()?;
    let rank = rank.map_err(EngineError::from)?;
    Ok(report(scene, &Simulation::assembled(mechanism, begin, rank, notes)?))
}

/// Whether a factorization of the constraints of a scene takes at most `most` products of blocks; also of one that cannot be.
pub fn products_within(scene: &Scene, most: usize) -> bool {
    Model::new(scene)
        .map_or(true, |model| triad_dynamics::dynamics::products_within(&System::new(model), most))
}

fn report(scene: &Scene, simulation: &Simulation) -> CheckReport {
    let system = simulation.system();
    let rank = simulation.rank();
    let mut redundant: Vec<RedundantRows> = Vec::new();
    for set in dependent_sets(system, rank) {
        let label = system[set.row].label;
        let words =
            if set.dependent == 1 { label.to_owned() } else { format!("{} of {label}", set.dependent) };
        let joint = &system[set.constraint].name;
        match redundant.last_mut().filter(|last| last.joint == *joint) {
            Some(last) => last.rows.push(words),
            None => redundant.push(RedundantRows { joint: joint.clone(), rows: vec![words] }),
        }
    }
    let rows = system.rigid_rows + system.equations;
    // f = n − n_RB − rank A, and n − n_RB is six for each body — eq. (8.1).
    let degrees_of_freedom = 6 * system.bodies.len() - rank.rank;
    CheckReport {
        name: scene.name.clone(),
        bodies: system.bodies.len(),
        coordinates: system.coordinates,
        rows,
        rank: system.coordinates - degrees_of_freedom,
        degrees_of_freedom,
        redundant,
        notes: simulation.notes().to_vec(),
    }
}
