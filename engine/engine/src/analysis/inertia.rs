//! Which small motions have inertia, and coordinates in which their mass matrix is the identity.
//!
//! A thin rod that spins about its own axis, or a point mass that turns, moves without kinetic energy: the mass matrix of the
//! small motions is singular, and a factorization of it would pass or fail by rounding. The decision is therefore taken
//! body by body, in lengths: a motion is without inertia if it moves no centre of mass and turns no body about an axis
//! about which it has a radius of gyration.

use nalgebra::{DMatrix, Matrix3, SymmetricEigen, Vector3};
use schemars::JsonSchema;
use serde::Serialize;
use triad_linalg::null_and_rest;

use crate::analysis::{Stage, idle::moment};

/// Displacement of centres of mass and of points at the radii of gyration, as a part of the displacement of the motion
/// with arcs at the mechanism's length, below which a motion has no inertia: radii of gyration below a nanometre for a
/// mechanism of one metre.
const NO_INERTIA: f64 = 1e-9;
/// Part of an orthonormal set that a body takes, squared, below which it takes none.
const NO_PART: f64 = 1e-9;

/// A body that can turn without inertia.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TurnsWithoutInertia {
    /// The body.
    pub body: String,
    /// Axes about which it can turn without moving anything that has inertia, unit vectors in the world's axes.
    pub axes: Vec<[f64; 3]>,
}

/// Small motions split by their inertia.
pub struct Inertia {
    /// Motions with inertia as columns, in which the mass matrix is the identity.
    pub inertial: DMatrix<f64>,
    /// Motions without, orthonormal.
    pub massless: DMatrix<f64>,
}

impl Inertia {
    /// Splits a basis of small motions, columns of (v, ω) body by body.
    pub fn new(stage: &Stage, basis: &DMatrix<f64>) -> Self {
        let gyration = weighted(stage, basis, |_, k2| (1.0, k2));
        let (massless, rest) = null_and_rest(&gyration, NO_INERTIA);
        let (massless, rest) = (basis * massless, basis * rest);
        // M = (S B)ᵀ (S B) = Rᵀ R: the factor of S B is exact to rounding where that of M loses half the digits.
        let factor = weighted(stage, &rest, |mass, k2| (mass.sqrt(), mass * k2)).qr().r();
        let inertial = factor
            .transpose()
            .solve_lower_triangular(&rest.transpose())
            .map_or_else(|| rest.clone(), |columns| columns.transpose());
        Self { inertial, massless }
    }
}

/// Rows (a v, √b k·ω) of each body about its principal axes, where `weights` gives a and b of its mass and its squared
/// radius of gyration.
fn weighted(stage: &Stage, basis: &DMatrix<f64>, weights: impl Fn(f64, f64) -> (f64, f64)) -> DMatrix<f64> {
    let mut out = basis.clone();
    let mechanism = &stage.mechanism;
    for (index, (body, at)) in mechanism.system.bodies.iter().zip(mechanism.state.bodies()).enumerate() {
        let axes = Matrix3::from_columns(&at.q.e);
        for mut column in out.column_iter_mut() {
            let turning = axes.tr_mul(&column.fixed_rows::<3>(6 * index + 3));
            for k in 0..3 {
                let (a, b) = weights(body.mass, moment(&body.principal, k) / body.mass);
                column[6 * index + k] *= a;
                column[6 * index + 3 + k] = b.sqrt() * turning[k];
            }
        }
    }
    out
}

/// The bodies that take part in motions without inertia, and the axes about which they do.
pub fn turning_bodies(stage: &Stage, motions: &DMatrix<f64>) -> Vec<TurnsWithoutInertia> {
    let length = stage.mechanism.system.length;
    let mut list = Vec::new();
    for (index, body) in stage.mechanism.system.model.bodies.iter().enumerate() {
        let turns: Vec<Vector3<f64>> =
            motions.column_iter().map(|column| column.fixed_rows::<3>(6 * index + 3) * length).collect();
        let spread: Matrix3<f64> = turns.iter().map(|turn| turn * turn.transpose()).sum();
        let eigen = SymmetricEigen::new(spread);
        let axes: Vec<[f64; 3]> = (0..3)
            .filter(|&k| eigen.eigenvalues[k] > NO_PART)
            .map(|k| eigen.eigenvectors.column(k).into_owned().into())
            .collect();
        if !axes.is_empty() {
            list.push(TurnsWithoutInertia { body: body.name.clone(), axes });
        }
    }
    list
}
