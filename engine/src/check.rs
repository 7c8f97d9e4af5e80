//! `check`: what a scene amounts to, before it is run.

use crate::error::EngineError;
use crate::model::Model;
use crate::scene::Scene;
use crate::simulation::Simulation;
use serde::Serialize;

/// Bodies, coordinates, rows, rank, degrees of freedom and redundant rows of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RedundantRows {
    /// The joint.
    pub joint: String,
    /// Labels of its dependent rows.
    pub rows: Vec<String>,
}

/// Checks, assembles and counts.
pub fn check(scene: &Scene) -> Result<CheckReport, EngineError> {
    let simulation = Simulation::from_model(Model::new(scene)?)?;
    let system = simulation.system();
    let rank = simulation.rank();
    let mut redundant = Vec::new();
    for group in &system.groups {
        let mut rows = Vec::new();
        for row in system.rows[group.forms.clone()].iter().filter(|row| !row.implied) {
            let dependent = (row.solver..row.solver + row.form.independent())
                .filter(|solver| rank.dependent.contains(solver))
                .count()
                + row.form.equations()
                - row.form.independent();
            match dependent {
                0 => {}
                1 => rows.push(row.label.to_owned()),
                n => rows.push(format!("{n} of {}", row.label)),
            }
        }
        if !rows.is_empty() {
            redundant.push(RedundantRows { joint: group.name.clone(), rows });
        }
    }
    let rows = system.rigid_rows + system.equations;
    let degrees_of_freedom = 6 * system.bodies.len() - rank.rank;
    Ok(CheckReport {
        name: scene.name.clone(),
        bodies: system.bodies.len(),
        coordinates: system.coordinates,
        rows,
        rank: system.coordinates - degrees_of_freedom,
        degrees_of_freedom,
        redundant,
        notes: simulation.notes().to_vec(),
    })
}
