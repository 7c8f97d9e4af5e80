//! The small motions that the joints allow at one position, to rounding, for charts that begin next to a singular one — eq. (10.11).

use crate::dynamics::elimination::Elimination;
use crate::state::State;
use crate::system::System;
use crate::system::index::IncidenceId;
use nalgebra::DMatrix;
use triad_linalg::left_null_space;

/// A row of unit length depends on the others if its component orthogonal to them is shorter than this: chosen far above
/// rounding and far below the rows of a mechanism that is not singular.
const DEPENDENT: f64 = 1e-9;

/// An orthonormal basis of the twists allowed, lengths of arc measured with the mechanism's length: columns of (v, ω)
/// body by body. The positions of the state are linearized.
pub fn twists(system: &System, state: &State, elimination: &mut Elimination) -> DMatrix<f64> {
    let length = system.length;
    elimination.linearize(system, state);
    // Aᵀ with columns of unit length; A ξ = 0 does not mind.
    let mut a = DMatrix::zeros(6 * system.bodies.len(), system.solver_rows);
    for (index, incidence) in system.incidences.iter().enumerate() {
        let first = system[incidence.constraint].solver.start;
        for (k, row) in elimination.jacobian().rows_on(system, IncidenceId(index)).chunks_exact(6).enumerate()
        {
            for c in 0..6 {
                let scale = if c < 3 { 1.0 } else { 1.0 / length };
                a[(6 * incidence.body + c, first + k)] = row[c] * scale;
            }
        }
    }
    for mut column in a.column_iter_mut() {
        let norm = column.norm();
        if norm > 0.0 {
            column /= norm;
        }
    }
    let mut basis = left_null_space(&a, DEPENDENT);
    for (row, mut values) in basis.row_iter_mut().enumerate() {
        if row % 6 >= 3 {
            values /= length;
        }
    }
    basis
}
