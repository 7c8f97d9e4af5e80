//! Changes of joints that remove a redundancy.
//!
//! A joint that gives up some of its reactions drops the functionals d · λ that give them. If the values of these
//! functionals on the null vectors form a regular square matrix, exactly the redundant rows are gone: every reaction
//! becomes unique, and no freedom of motion is gained.

use crate::scene::{AxisRows, JointKind};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::model::{BodyRef, JointGeometry, ModelJoint};
use triad_dynamics::state::State;
use triad_dynamics::system::index::{ConstraintId, SolverRow};
use triad_dynamics::system::{Row, System};

/// A functional is independent of others if its component orthogonal to them is larger than this, relative to itself.
const INDEPENDENT: f64 = 1e-4;

/// A change of one joint.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Remedy {
    /// The joint.
    pub joint: String,
    /// What it would become.
    pub becomes: JointKind,
    /// What it would no longer hold, in words.
    pub gives_up: &'static str,
}

/// A kind of joint with less rows, and the functionals of λ that it drops, as rows over all solver rows.
struct Relaxation {
    becomes: JointKind,
    gives_up: &'static str,
    dropped: Vec<Vec<(SolverRow, f64)>>,
}

/// Greedy: at each turn the change that drops most without taking more than is redundant. Empty if some rows remain.
pub fn find(system: &System, at: &State, constraints: &[ConstraintId], basis: &DMatrix<f64>) -> Vec<Remedy> {
    let mut basis = basis.clone();
    let mut remedies = Vec::new();
    let mut changed = vec![false; constraints.len()];
    while basis.ncols() > 0 {
        let mut best: Option<(usize, Relaxation, DMatrix<f64>)> = None;
        for (k, &constraint) in constraints.iter().enumerate() {
            if changed[k] {
                continue;
            }
            for relaxation in relaxations(system, at, constraint) {
                let better =
                    best.as_ref().is_none_or(|(_, old, _)| relaxation.dropped.len() > old.dropped.len());
                if better && let Some(rest) = without(&basis, &relaxation.dropped) {
                    best = Some((k, relaxation, rest));
                }
            }
        }
        let Some((k, relaxation, rest)) = best else { return Vec::new() };
        changed[k] = true;
        basis = rest;
        remedies.push(Remedy {
            joint: system[constraints[k]].name.clone(),
            becomes: relaxation.becomes,
            gives_up: relaxation.gives_up,
        });
    }
    remedies
}

/// The null vectors on which all dropped functionals vanish, if each functional takes away one dimension.
fn without(basis: &DMatrix<f64>, dropped: &[Vec<(SolverRow, f64)>]) -> Option<DMatrix<f64>> {
    let mut basis = basis.clone();
    for functional in dropped {
        let values: Vec<f64> = basis
            .column_iter()
            .map(|column| functional.iter().map(|&(row, weight)| weight * column[row.index()]).sum())
            .collect();
        let pivot = (0..values.len()).max_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()))?;
        if values[pivot].abs() <= INDEPENDENT * basis.column(pivot).amax() {
            return None;
        }
        let removed = basis.column(pivot).into_owned();
        for (k, mut column) in basis.column_iter_mut().enumerate() {
            if k != pivot {
                column.axpy(-values[k] / values[pivot], &removed, 1.0);
            }
        }
        basis = basis.remove_column(pivot);
        for mut column in basis.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }
    }
    Some(basis)
}

/// The usual kinds of joint that a joint can be weakened to.
fn relaxations(system: &System, at: &State, constraint: ConstraintId) -> Vec<Relaxation> {
    let Some(joint) = system.model.joints.iter().find(|j| j.name == system[constraint].name) else {
        return Vec::new();
    };
    let rows = &system.rows[system[constraint].forms.clone()];
    let of = |from: usize| -> Vec<Vec<(SolverRow, f64)>> {
        rows.iter()
            .skip(from)
            .flat_map(|row| {
                (row.solver..row.solver + row.form.independent()).map(|k| vec![(SolverRow(k), 1.0)])
            })
            .collect()
    };
    let relaxed = |becomes, gives_up, dropped| Relaxation { becomes, gives_up, dropped };
    match joint.geometry {
        JointGeometry::Revolute { rows: written } => {
            revolute(written, &of(1), axial_force(at, joint, &rows[0]))
        }
        JointGeometry::Prismatic => vec![
            relaxed(JointKind::Cylindrical, "the moment about its axis", of(4)),
            relaxed(JointKind::PointOnLine, "all moments", of(2)),
        ],
        JointGeometry::Cylindrical => {
            vec![relaxed(JointKind::PointOnLine, "the moments across its axis", of(2))]
        }
        JointGeometry::Fixed => vec![
            relaxed(JointKind::Revolute, "the moment about one axis", of(3)),
            relaxed(JointKind::Spherical, "all moments", of(1)),
        ],
        JointGeometry::Universal => {
            vec![relaxed(JointKind::Spherical, "the moment across its two axes", of(1))]
        }
        JointGeometry::Planar => {
            vec![relaxed(JointKind::PointInPlane, "the moments across its normal", of(1))]
        }
        JointGeometry::Spherical
        | JointGeometry::Screw { .. }
        | JointGeometry::Rod { .. }
        | JointGeometry::PointOnLine
        | JointGeometry::PointInPlane
        | JointGeometry::Gear { .. } => Vec::new(),
    }
}

/// Those of a revolute joint: `tilting` gives its moments across the axis, `axial` its force along the axis.
fn revolute(
    rows: AxisRows,
    tilting: &[Vec<(SolverRow, f64)>],
    axial: Vec<(SolverRow, f64)>,
) -> Vec<Relaxation> {
    let relaxed = |becomes, gives_up, dropped| Relaxation { becomes, gives_up, dropped };
    let mut list = vec![
        relaxed(JointKind::Spherical, "the moments across its axis", tilting.to_vec()),
        relaxed(JointKind::Cylindrical, "the force along its axis", vec![axial.clone()]),
    ];
    if rows == AxisRows::TwoCar {
        for one in tilting {
            let gives_up = "one of the moments across its axis";
            list.push(relaxed(JointKind::Universal, gives_up, vec![one.clone()]));
        }
    }
    let both = tilting.iter().cloned().chain([axial]).collect();
    list.push(relaxed(JointKind::PointOnLine, "the force along its axis and the moments across it", both));
    list
}

/// The part along the axis of the force of a common point.
fn axial_force(at: &State, joint: &ModelJoint, row: &Row) -> Vec<(SolverRow, f64)> {
    let axis = match joint.bodies[0] {
        BodyRef::Ground => joint.axes[0],
        BodyRef::Moving(body) => at.bodies()[body].q.arm(&joint.axes[0]),
    };
    (0..3).map(|k| (SolverRow(row.solver + k), axis[k])).collect()
}
