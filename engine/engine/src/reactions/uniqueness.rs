//! Which reactions the equations of motion determine — THEORY section 9.
//!
//! Multipliers that differ by a vector n with Aᵀ n = 0 give the same motion. A reaction W λ is unique if W n = 0 for all
//! such n, whatever the loads. The rows of A are those of the joints after the rigid-body rows have been eliminated;
//! null vectors of the whole Φ_qᵀ that are not among them trade the multiplier of a common vector along that vector
//! against rigid-body multipliers, and no reaction feels them.

mod remedy;

pub use remedy::Remedy;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::geometry::Geometry;
use triad_dynamics::dynamics::elimination::TwistJacobian;
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::index::{ConstraintId, IncidenceId, SolverRow};
use triad_dynamics::system::islands::is_tree;

/// Greatest square of the number of rows times the number of those that are too many: what finding the joints that share them
/// costs, a second or two at most.
pub const MAX_WORK: usize = 1_000_000_000;
/// A component that a unit null vector changes by less than this part of its own size is unique.
pub const TOLERANCE: f64 = 1e-7;

/// Why uniqueness is not determined.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UniquenessError {
    /// Too many redundant rows.
    #[error(
        "which reactions are unique is not found for {redundant} redundant rows among {rows}: the work grows with the square of \
         the one times the other"
    )]
    TooLarge {
        /// Rows of the scene.
        rows: usize,
        /// How many of them are too many.
        redundant: usize,
    },
    /// The state is not finite.
    #[error("the rows of the joints hold numbers that are not finite")]
    NotFinite,
}

impl UniquenessError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::TooLarge { .. } => "uniqueness-too-large",
            Self::NotFinite => "uniqueness-not-finite",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::TooLarge { .. } => "Look at a part of the mechanism as a scene of its own.".to_owned(),
            Self::NotFinite => "Reset the run and stop it before the state diverges.".to_owned(),
        }
    }
}

/// A set of joints and drivers whose rows repeat each other.
///
/// ```
/// use triad_engine::prelude::*;
/// use triad_engine::reactions::report::Convention;
///
/// let report = Simulation::new(&catalogue::scene("n-four-bar:1")?)?.reactions(Convention::default())?;
/// let set = &report.redundancies[0];
/// assert_eq!((set.rows, set.joints.len()), (3, 4), "four hinges hold the plane three times too often");
/// assert!(!set.remedies.is_empty());
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Redundancy {
    /// How many rows are too many.
    pub rows: usize,
    /// The joints and drivers that share them; none of them alone is to blame.
    pub joints: Vec<String>,
    /// Changes that together remove the redundancy and keep the mobility, if the usual ones do.
    pub remedies: Vec<Remedy>,
}

#[doc(hidden)]
/// All multipliers that do nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct NullSpace {
    /// A basis as columns, one row for each solver row; orthonormal in scaled rows.
    pub basis: DMatrix<f64>,
    /// The same for rows scaled to unit length.
    scaled: DMatrix<f64>,
    /// Length of each solver row: see [`lengths`].
    lengths: Vec<f64>,
}

impl NullSpace {
    /// Of the rows A at a position.
    ///
    /// # Errors
    ///
    /// [`UniquenessError`]: too many redundant rows, or rows that are not finite.
    pub fn new(system: &System, state: &State, jacobian: &TwistJacobian) -> Result<Self, UniquenessError> {
        let lengths = lengths(system, jacobian);
        if lengths.iter().any(|length| !length.is_finite()) {
            return Err(UniquenessError::NotFinite);
        }
        let rows = system.solver_rows;
        if is_tree(&system.model) {
            let none = DMatrix::zeros(rows, 0);
            return Ok(Self { basis: none.clone(), scaled: none, lengths });
        }
        let mut geometry = Geometry::new(system);
        geometry.place(state);
        let redundant = geometry.dependent().len();
        if rows * rows * redundant > MAX_WORK {
            return Err(UniquenessError::TooLarge { rows, redundant });
        }
        let mut scaled = geometry.idle_multipliers();
        // Rows between bodies that cannot move have no length, and multipliers without any effect.
        let sizes: Vec<f64> = lengths.iter().map(|&length| if length > 0.0 { length } else { 1.0 }).collect();
        for (mut row, size) in scaled.row_iter_mut().zip(&sizes) {
            row *= *size;
        }
        if redundant > 0 {
            scaled = scaled.qr().q();
        }
        let mut basis = scaled.clone();
        for (mut row, size) in basis.row_iter_mut().zip(&sizes) {
            row /= *size;
        }
        Ok(Self { basis, scaled, lengths })
    }

    /// Number of rows that are too many.
    pub fn dimension(&self) -> usize {
        self.basis.ncols()
    }

    /// The multipliers that give the same motion and are smallest: forces as they are, moments divided by the
    /// mechanism's length.
    pub fn smallest(&self, multipliers: &[f64]) -> Vec<f64> {
        let scaled = DVector::from_iterator(
            multipliers.len(),
            multipliers.iter().zip(&self.lengths).map(|(lambda, length)| lambda * length),
        );
        let idle = &self.basis * self.scaled.tr_mul(&scaled);
        multipliers.iter().zip(idle.iter()).map(|(lambda, idle)| lambda - idle).collect()
    }

    /// Whether a quantity Σ wₖ λₖ of the solver rows of a constraint is unique — eq. (9.2).
    pub fn is_unique(&self, first: SolverRow, weights: &[f64]) -> bool {
        let size: f64 = weights
            .iter()
            .zip(&self.lengths[first.index()..])
            .map(|(w, l)| w / l.max(1e-300))
            .map(|d| d * d)
            .sum();
        self.basis.column_iter().all(|column| {
            let change: f64 = weights
                .iter()
                .zip(column.rows(first.index(), weights.len()).iter())
                .map(|(w, n)| w * n)
                .sum();
            change.abs() <= TOLERANCE * size.sqrt()
        })
    }

    /// The sets of joints that share redundant rows, with what would remove them.
    pub fn redundancies(&self, system: &System, at: &State) -> Vec<Redundancy> {
        if self.dimension() == 0 {
            return Vec::new();
        }
        let mut sets: Vec<Vec<ConstraintId>> = Vec::new();
        let projector = &self.scaled * self.scaled.transpose();
        let coupled = |i: ConstraintId, j: ConstraintId| {
            let (p, q) = (&system[i].solver, &system[j].solver);
            projector.view((p.start, q.start), (p.len(), q.len())).iter().any(|x| x.abs() > TOLERANCE)
        };
        let mut seen = vec![false; system.constraints.len()];
        for start in system.constraint_ids() {
            if seen[start.index()] || !coupled(start, start) {
                continue;
            }
            let mut set = vec![start];
            seen[start.index()] = true;
            let mut next = 0;
            while next < set.len() {
                for other in system.constraint_ids() {
                    if !seen[other.index()] && coupled(set[next], other) {
                        seen[other.index()] = true;
                        set.push(other);
                    }
                }
                next += 1;
            }
            set.sort_unstable();
            sets.push(set);
        }
        sets.into_iter()
            .map(|set| {
                let rows: Vec<SolverRow> = set.iter().flat_map(|&id| system[id].solver_rows()).collect();
                let trace: f64 = rows.iter().map(|&row| projector[(row.index(), row.index())]).sum();
                Redundancy {
                    rows: (0..=rows.len())
                        .min_by(|a, b| distance(*a, trace).total_cmp(&distance(*b, trace)))
                        .unwrap_or(0),
                    joints: set.iter().map(|&id| system[id].name.clone()).collect(),
                    remedies: remedy::find(system, at, &set, &self.within(&rows)),
                }
            })
            .collect()
    }

    /// A basis of the null vectors that live on the given rows alone, all rows kept.
    fn within(&self, rows: &[SolverRow]) -> DMatrix<f64> {
        // Of the scaled basis, restricted to these rows, all directions have length one or zero.
        let part = self.scaled.select_rows(rows.iter().map(|row| &row.0));
        let eigen = SymmetricEigen::new(part.tr_mul(&part));
        let own: Vec<usize> = (0..part.ncols()).filter(|&k| eigen.eigenvalues[k] > 0.5).collect();
        &self.basis * eigen.eigenvectors.select_columns(&own)
    }
}

/// Length of each solver row: of the force that a multiplier of one makes, or of its moment, over the mechanism's length, where it makes none.
/// That of the force is the same for all rows of a point, however the scene lies in the world.
fn lengths(system: &System, jacobian: &TwistJacobian) -> Vec<f64> {
    let mut squares = vec![[0.0; 2]; system.solver_rows];
    for (index, incidence) in system.incidences.iter().enumerate() {
        let first = system[incidence.constraint].solver.start;
        let rows = jacobian.rows_on(system, IncidenceId(index)).chunks_exact(6);
        for (row, square) in rows.zip(&mut squares[first..]) {
            let part = |numbers: &[f64]| numbers.iter().map(|x| x * x).sum::<f64>();
            square[0] += part(&row[..3]);
            square[1] += part(&row[3..]) / (system.length * system.length);
        }
    }
    squares.into_iter().map(|[force, moment]| if force > 0.0 { force } else { moment }.sqrt()).collect()
}

fn distance(count: usize, to: f64) -> f64 {
    (count as f64 - to).abs()
}
