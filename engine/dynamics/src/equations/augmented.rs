//! The equations of motion as the formulation first writes them — THEORY section 6.
//!
//! M(q) q̈ + Φ_qᵀ λ = g, Φ_q q̈ = γ in the generalized coordinates of each body, rigid-body rows included, solved as
//! one dense system. This is far slower than the elimination and shares with it only the row forms: an independent
//! check of it, the way to the multipliers of the rigid-body rows, and what `triad paper` integrates.

mod normal;

pub use normal::{Normal, RankOne, RightSides};

use crate::equations;
use crate::equations::jacobian::Jacobian;
use crate::scene::Coordinates;
use crate::state::{AppliedForces, State};
use crate::system::System;
use crate::system::body::RigidBody;
use crate::system::natural::NaturalCoordinates;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use triad_linalg::{independent_rows, left_null_space};

/// A row depends on others if its component orthogonal to them, relative to the longest row, is smaller than this.
pub const DEPENDENT: f64 = 1e-9;

/// M, g, Φ, Φ_q and γ at one state.
#[derive(Clone, Debug, PartialEq)]
pub struct AugmentedSystem {
    /// Mass matrix M(q): diagonal and constant for full bodies, VᵀMV for reduced ones.
    pub mass: DMatrix<f64>,
    /// Generalized forces g, with −VᵀM V̇q̇ for reduced bodies.
    pub force: DVector<f64>,
    /// Φ of all rows, rigid-body rows first.
    pub constraints: DVector<f64>,
    /// Φ_q.
    pub jacobian: DMatrix<f64>,
    /// γ, the right-hand side of Φ_q q̈ = γ.
    pub gamma: DVector<f64>,
}

/// Accelerations and multipliers.
#[derive(Clone, Debug, PartialEq)]
pub struct AugmentedSolution {
    /// q̈.
    pub acceleration: DVector<f64>,
    /// λ of all rows, of least norm where rows are redundant.
    pub multipliers: DVector<f64>,
}

impl AugmentedSystem {
    /// Writes the equations at a state.
    pub fn new(system: &System, at: &State) -> Self {
        let n = system.coordinates;
        let mut mass = DMatrix::zeros(n, n);
        for_mass_entries(system, at, |row, column, value| mass[(row, column)] += value);
        let rows = system.rigid_rows + system.equations;
        let mut jacobian = DMatrix::zeros(rows, n);
        for entry in Jacobian::new(system, at).entries {
            jacobian[(entry.row, entry.column)] = entry.value;
        }
        Self {
            mass,
            force: force(system, at),
            constraints: equations::constraints(system, at).into(),
            jacobian,
            gamma: equations::gamma(system, at).into(),
        }
    }

    /// Solves the augmented system of M, Φ_q, g and γ.
    ///
    /// A largest set of independent rows is kept for the accelerations; the multipliers of all rows are then those of
    /// least norm that give the same constraint forces. `None` if a body without inertia is left free to turn.
    pub fn solve(&self) -> Option<AugmentedSolution> {
        let kept = independent_rows(&self.jacobian, DEPENDENT);
        let AugmentedSolution { acceleration, multipliers } = self.solve_with(&kept)?;
        let null = left_null_space(&self.jacobian, DEPENDENT);
        let idle = &null * null.tr_mul(&multipliers);
        Some(AugmentedSolution { acceleration, multipliers: multipliers - idle })
    }

    /// Solves the augmented system with the given rows alone; other rows get no multiplier.
    pub fn solve_with(&self, kept: &[usize]) -> Option<AugmentedSolution> {
        let n = self.mass.nrows();
        let mut matrix = DMatrix::zeros(n + kept.len(), n + kept.len());
        matrix.view_mut((0, 0), (n, n)).copy_from(&self.mass);
        let mut right = DVector::zeros(n + kept.len());
        right.rows_mut(0, n).copy_from(&self.force);
        for (k, &row) in kept.iter().enumerate() {
            let gradient = self.jacobian.row(row);
            matrix.view_mut((n + k, 0), (1, n)).copy_from(&gradient);
            matrix.view_mut((0, n + k), (n, 1)).tr_copy_from(&gradient);
            right[n + k] = self.gamma[row];
        }
        let solution = matrix.lu().solve(&right)?;
        let mut multipliers = DVector::zeros(self.gamma.len());
        for (k, &row) in kept.iter().enumerate() {
            multipliers[row] = solution[n + k];
        }
        let acceleration = solution.rows(0, n).into_owned();
        acceleration.iter().all(|a| a.is_finite()).then_some(AugmentedSolution { acceleration, multipliers })
    }
}

/// Calls `put` with each part of an entry of M(q) that is not a structural zero — eq. (6.3). Bodies that share a
/// director add to the same entries.
pub fn for_mass_entries(system: &System, at: &State, mut put: impl FnMut(usize, usize, f64)) {
    for (body, state) in system.bodies.iter().zip(at.bodies()) {
        let first = body.layout.first;
        for axis in 0..3 {
            put(first + axis, first + axis, body.mass);
        }
        match body.coordinates {
            Coordinates::Full | Coordinates::Shared => {
                for (k, director) in body.layout.directors.iter().enumerate() {
                    // A director along a fixed direction has no coordinates.
                    let Some((column, _)) = director.column() else { continue };
                    for axis in 0..3 {
                        put(column + axis, column + axis, body.ibar[k]);
                    }
                }
            }
            Coordinates::Reduced => {
                for (k, row) in reduced_mass(body, &state.q).iter().enumerate() {
                    for (l, block) in row.iter().enumerate() {
                        for (i, j) in (0..9).map(|at| (at / 3, at % 3)) {
                            put(first + 3 + 3 * k + i, first + 3 + 3 * l + j, block[(i, j)]);
                        }
                    }
                }
            }
        }
    }
}

/// The blocks of u and v of VᵀMV, V having −ṽ and ũ in its rows of w.
fn reduced_mass(body: &RigidBody, q: &NaturalCoordinates) -> [[Matrix3<f64>; 2]; 2] {
    let [a, b, c] = [body.ibar[0], body.ibar[1], body.ibar[2]];
    let [u, v, _] = q.e;
    let across = |e: &Vector3<f64>| Matrix3::from_diagonal_element(e.norm_squared()) - e * e.transpose();
    let mixed = u * v.transpose() - Matrix3::from_diagonal_element(u.dot(&v));
    [
        [Matrix3::from_diagonal_element(a) + across(&v) * c, mixed * c],
        [mixed.transpose() * c, Matrix3::from_diagonal_element(b) + across(&u) * c],
    ]
}

/// g = Vᵀ(G − M V̇q̇), G being the applied forces at the state — eq. (6.5) — without dry friction, which follows from λ.
pub fn force(system: &System, at: &State) -> DVector<f64> {
    force_of(system, at, AppliedForces::new(system, at).bodies)
}

/// The same of given applied forces G.
pub fn force_of(
    system: &System,
    at: &State,
    applied: impl IntoIterator<Item = NaturalCoordinates>,
) -> DVector<f64> {
    let mut out = DVector::zeros(system.coordinates);
    for ((body, state), mut natural) in system.bodies.iter().zip(at.bodies()).zip(applied) {
        if body.coordinates == Coordinates::Reduced {
            natural.e[2] -= state.q_dot.e[0].cross(&state.q_dot.e[1]) * (2.0 * body.ibar[2]);
        }
        body.layout.pull_back(&state.q, &natural, |column, value| out[column] += value);
    }
    out
}
