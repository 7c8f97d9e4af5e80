//! How far a state is from its constraints, each row relative to its own size, and what else makes a result doubtful.
//!
//! A distance is compared with the length of the mechanism, a product of unit vectors with one: so a mechanism of
//! micrometres is held as strictly as one of kilometres.

use crate::constraints::ConstraintError;
use crate::scene::{ConstraintMethod, Settings};
use crate::state::State;
use crate::system::index::ConstraintId;
use crate::system::row::Form;
use crate::system::{Row, System};
use triad_linalg::larger_or_nan;

/// The rows that are violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintViolation {
    /// Largest |Φ| relative to the size of its row, rigid-body rows included.
    pub relative: f64,
    /// Joints and drivers that are open, the worst first, with their relative |Φ|.
    pub constraints: Vec<(ConstraintId, f64)>,
}

/// |Φ| of each row relative to its size up to which a start satisfies the constraints.
const CLOSED: f64 = 1e-9;
/// Greatest number of joints that an error names.
pub const MAX_NAMED: usize = 4;

impl ConstraintViolation {
    /// Name of the joint that is open most, and of those open with it.
    pub fn names(&self, system: &System) -> (String, Vec<String>) {
        let name = |&(id, _): &(ConstraintId, f64)| system[id].name.clone();
        let mut names = self.constraints.iter().take(MAX_NAMED).map(name);
        (names.next().unwrap_or_default(), names.collect())
    }

    /// JSON pointer of the element that is open most.
    pub fn pointer(&self, system: &System) -> String {
        pointer(system, self.constraints.first().map_or(ConstraintId(0), |&(id, _)| id))
    }
}

/// JSON pointer of a joint or driver.
pub fn pointer(system: &System, constraint: ConstraintId) -> String {
    match constraint.index().checked_sub(system.model.joints.len()) {
        Some(driver) => format!("/drivers/{driver}"),
        None => format!("/joints/{}", constraint.index()),
    }
}

/// An error names a joint beside the most violated one if its own violation is more than this fraction of that one's.
const SHARE: f64 = 0.05;

/// Relative |Φ| above which a run has lost its constraints: chosen above what projection leaves at any
/// tolerance and below what a picture shows.
const MAX_VIOLATION: f64 = 1e-6;
/// The same with Baumgarte's stabilization or penalties, which keep a violation within bounds but not near zero.
const MAX_VIOLATION_WITH_FEEDBACK: f64 = 0.1;

/// Refuses positions that are off the constraints: they are no result.
///
/// # Errors
///
/// [`ConstraintError`]: the constraints are lost, or the state is not finite.
pub fn check(system: &System, at: &State, time: f64) -> Result<(), ConstraintError> {
    let limit = match system.model.settings.constraint_method {
        ConstraintMethod::Projection
        | ConstraintMethod::Partitioning
        | ConstraintMethod::AugmentedLagrangian { .. } => MAX_VIOLATION,
        ConstraintMethod::Baumgarte { .. } | ConstraintMethod::Penalty { .. } => MAX_VIOLATION_WITH_FEEDBACK,
    };
    if relative(system, at) <= limit {
        return Ok(());
    }
    let measured = measure(system, at);
    if !measured.relative.is_finite() {
        return Err(ConstraintError::NotFinite { time });
    }
    let (joint, with) = measured.names(system);
    Err(ConstraintError::Lost { time, joint, with, violation: measured.relative })
}

/// Largest |Φ| of the positions of a state, relative to the size of its row; allocates nothing.
pub fn relative(system: &System, at: &State) -> f64 {
    let rows = system.rows.iter().map(|row| relative_row_violation(system, at, &row.form));
    rows.fold(rigid_violation(at), larger_or_nan)
}

fn relative_row_violation(system: &System, at: &State, form: &Form) -> f64 {
    at.row_violation(form) / system.row_size(form)
}

/// Whether a position satisfies the constraints as far as a start has to; false where it is no number.
pub fn is_closed(system: &System, at: &State) -> bool {
    relative(system, at) <= CLOSED
}

/// Measures the positions of a state.
pub fn measure(system: &System, at: &State) -> ConstraintViolation {
    let constraints = worst(&by_constraint(system, |form| relative_row_violation(system, at, form)));
    let relative = constraints.first().map_or(0.0, |&(_, open)| open);
    ConstraintViolation { relative: larger_or_nan(rigid_violation(at), relative), constraints }
}

/// Largest |Φ̇| of each joint and driver at the velocities of a state, relative to the size of its rows, 1/s.
pub fn rates(system: &System, at: &State) -> Vec<f64> {
    by_constraint(system, |form| at.row_rate_violation(form) / system.row_size(form))
}

/// The largest of them; allocates nothing.
pub fn largest_rate(system: &System, at: &State) -> f64 {
    let rows = system.rows.iter();
    rows.map(|row| at.row_rate_violation(&row.form) / system.row_size(&row.form)).fold(0.0, larger_or_nan)
}

/// The largest number of the rows of each constraint.
fn by_constraint(system: &System, of: impl Fn(&Form) -> f64) -> Vec<f64> {
    let largest = |forms: &[Row]| forms.iter().map(|row| of(&row.form)).fold(0.0, larger_or_nan);
    system.constraints.iter().map(|constraint| largest(&system.rows[constraint.forms.clone()])).collect()
}

/// The constraints with the largest numbers, of one for each, the worst first.
pub fn worst(numbers: &[f64]) -> Vec<(ConstraintId, f64)> {
    let worst = numbers.iter().copied().fold(0.0, larger_or_nan);
    let counts = |&(_, open): &(ConstraintId, f64)| open > SHARE * worst || open.is_nan();
    let numbered = numbers.iter().enumerate().map(|(index, &number)| (ConstraintId(index), number));
    let mut constraints: Vec<(ConstraintId, f64)> = numbered.filter(counts).collect();
    constraints.sort_by(|a, b| b.1.total_cmp(&a.1));
    constraints
}

/// Largest violation of a rigid-body row.
fn rigid_violation(at: &State) -> f64 {
    at.bodies().iter().fold(0.0, |largest, body| larger_or_nan(largest, body.q.stretch()))
}

/// What was observed of a run that may make its result doubtful.
#[derive(Clone, Copy, Debug)]
pub struct Signs {
    /// Time at which it first passed a singular configuration, s.
    pub passed: Option<f64>,
    /// Error of the energy balance, relative to the energy in play: see the run's summary.
    pub drift: f64,
    /// Largest |Φ| relative to the size of its row.
    pub open: f64,
    /// Rounding of the penalty terms, relative to the lightest mass.
    pub swallowed: f64,
}

/// Tolerances by which the energy and the constraints may be off before a result is doubted: local errors add up over the
/// steps of a run.
const ALLOWED: f64 = 1e4;
/// Least and greatest value of that bound, relative: tighter is rounding, looser is no result.
const ALLOWED_WITHIN: (f64, f64) = (1e-6, 1e-2);

/// The reasons to doubt the result of a run, in words, with what to use instead.
pub fn doubts(settings: &Settings, signs: &Signs) -> Vec<String> {
    let method = settings.constraint_method;
    let projected = method == ConstraintMethod::Projection;
    let instead = match settings.step {
        _ if !projected => "use projection, with taylor or dop853",
        Some(_) => "use shorter steps, or leave their size to the tolerance",
        None => "tighten the tolerance, or compare with another integrator",
    };
    let mut doubts = Vec::new();
    if let Some(time) = signs.passed.filter(|_| !projected) {
        doubts.push(format!(
            "a singular position was passed at t = {time:.6} s, through which {method} holds neither the constraints nor the \
             branch of the motion: what follows may be wrong; {instead}"
        ));
    }
    let allowed = (ALLOWED * settings.tolerance).clamp(ALLOWED_WITHIN.0, ALLOWED_WITHIN.1);
    for (size, what) in [
        (signs.drift, "of the energy in play came from nowhere or went there"),
        (signs.open, "of the mechanism's size is how far the joints are open"),
        (signs.swallowed, "of the lightest mass is lost in the rounding of the penalties"),
    ] {
        // True for NaN as well.
        if larger_or_nan(size, allowed) != allowed {
            doubts.push(format!(
                "{size:.1e} {what}, more than a tolerance of {:.0e} promises; {instead}",
                settings.tolerance
            ));
        }
    }
    doubts
}
