//! Matrices of a run at one moment: the Jacobian, the augmented matrix and S, with names, values and fill.

use http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::analysis::check::dependent_sets;
use triad_engine::reactions::matrices::{EntryKind, Symmetric};
use triad_engine::run::StateView;
use triad_engine::system::index::EquationId;

use crate::refusal::Refusal;

/// Rows of the largest matrix that is sent in full.
const MAX_ROWS: usize = 3_000;
/// Largest number of entries that is sent.
const MAX_PLACES: usize = 60_000;

/// The Jacobian of the constraints: a sparse matrix whose rows and columns have names.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Jacobian")]
pub struct JacobianView {
    /// Time, s.
    time: f64,
    /// What each row is: its joint or body, and the row.
    rows: Vec<String>,
    /// What each column is: its body, and the coordinate.
    columns: Vec<String>,
    /// Row, column, value, and whether the entry never changes; entries that are not listed are zero by structure.
    entries: Vec<(usize, usize, f64, bool)>,
    /// Rank near the start.
    rank: usize,
    /// Rows of which some say again what others say.
    redundant: Vec<RedundantSet>,
}

/// Rows of one form of which some say again what others say.
#[derive(Debug, Serialize, JsonSchema)]
struct RedundantSet {
    /// The rows, as indices.
    rows: Vec<usize>,
    /// How many of them are too many.
    dependent: usize,
}

/// A symmetric matrix: what stands on and below its diagonal.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "SymmetricMatrix")]
pub struct SymmetricView {
    /// Time, s.
    time: f64,
    /// What each row is, and each column alike.
    names: Vec<String>,
    /// Row, column, value, and what it is: `own`, `constant`, `changing` or `fill`.
    places: Vec<(usize, usize, f64, EntryKind)>,
    /// Places on or below the diagonal that a factorization fills.
    fill: usize,
}

impl JacobianView {
    /// That of a state.
    pub fn of(run: &StateView) -> Self {
        let sets = dependent_sets(run.system(), run.rank());
        let redundant = sets
            .into_iter()
            .map(|set| RedundantSet {
                rows: set.equations.into_iter().map(EquationId::index).collect(),
                dependent: set.dependent,
            })
            .collect();
        let system = run.system();
        let freedoms = 6 * system.bodies.len() - run.rank().rank;
        let found = run.jacobian();
        Self {
            time: run.time(),
            rows: found.rows.clone(),
            columns: found.columns.clone(),
            entries: found.entries.iter().map(|e| (e.row, e.column, e.value, e.constant)).collect(),
            rank: system.coordinates - freedoms,
            redundant,
        }
    }
}

impl SymmetricView {
    /// A matrix of a state. Errors if it is too large for a picture.
    pub fn of(run: &StateView, matrix: fn(&StateView) -> Symmetric) -> Result<Self, Refusal> {
        let system = run.system();
        let rows = system.coordinates + system.rigid_rows + system.equations;
        if rows > MAX_ROWS {
            return Err(too_large(&format!("{rows} rows, more than {MAX_ROWS}")));
        }
        let found = matrix(run);
        if found.places.len() > MAX_PLACES {
            return Err(too_large(&format!("{} places, more than {MAX_PLACES}", found.places.len())));
        }
        let fill = found.fill();
        let places = found.places.iter().map(|p| (p.row, p.column, p.value, p.part)).collect();
        Ok(Self { time: run.time(), names: found.names, places, fill })
    }
}

fn too_large(how: &str) -> Refusal {
    Refusal::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "matrix-too-large",
        format!("the matrix is too large for a picture: it has {how}"),
        "look at the Jacobian, or at a smaller mechanism of the same kind",
    )
}
