//! How far a state is from its constraints, each row measured by its own size.
//!
//! A distance is compared with the length of the mechanism, a product of unit vectors with one: so a mechanism of
//! micrometres is held as strictly as one of kilometres.

use crate::elimination::Elimination;
use crate::error::{EngineError, LastGood};
use crate::row::{Difference, Form};
use crate::scene::Stabilization;
use crate::system::System;

/// The rows that are violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Largest |Φ| relative to the size of its row, rigid-body rows included.
    pub relative: f64,
    /// Joints and drivers that are open, the worst first: index of the group and relative |Φ|.
    pub groups: Vec<(usize, f64)>,
}

/// Most joints that an error names.
const NAMED: usize = 4;

impl Opening {
    /// Name of the joint that is open most, and of those open with it.
    pub fn names(&self, system: &System) -> (String, Vec<String>) {
        let name = |&(index, _): &(usize, f64)| system.groups.get(index).map(|g| g.name.clone());
        let mut names = self.groups.iter().take(NAMED).filter_map(name);
        (names.next().unwrap_or_default(), names.collect())
    }

    /// JSON pointer of the element that is open most: rows are written by joints, then by drivers.
    pub fn pointer(&self, system: &System) -> String {
        let index = self.groups.first().map_or(0, |&(index, _)| index);
        match index.checked_sub(system.model.joints.len()) {
            Some(driver) => format!("/drivers/{driver}"),
            None => format!("/joints/{index}"),
        }
    }
}

/// A joint counts as open with the worst one if it is violated by more than this part of it.
const SHARE: f64 = 0.05;

/// A relative |Φ| above which a run with projection has lost its constraints.
const LOST: f64 = 1e-6;
/// The same with Baumgarte's stabilization or penalties, which keep a bounded violation by design.
const LOST_BY_FEEDBACK: f64 = 0.1;

/// Refuses positions in place that are off the constraints: they are no result.
pub fn check(system: &System, at: &Elimination, time: f64) -> Result<(), EngineError> {
    let limit = match system.model.settings.stabilization {
        Stabilization::Projection
        | Stabilization::Partitioning
        | Stabilization::AugmentedLagrangian { .. } => LOST,
        Stabilization::Baumgarte { .. } | Stabilization::Penalty { .. } => LOST_BY_FEEDBACK,
    };
    if relative(system, at) <= limit {
        return Ok(());
    }
    let opening = opening(system, at);
    if !opening.relative.is_finite() {
        return Err(EngineError::Diverged { time, last: LastGood::default() });
    }
    let (joint, with) = opening.names(system);
    let (violation, last) = (opening.relative, LastGood::default());
    Err(EngineError::ConstraintsLost { time, joint, with, violation, last })
}

/// Largest |Φ| of the positions in place, relative to the size of its row; allocates nothing.
pub fn relative(system: &System, at: &Elimination) -> f64 {
    let rows = system.rows.iter().map(|row| row_opening(system, at, &row.form));
    rows.fold(rigid_opening(at), larger)
}

fn row_opening(system: &System, at: &Elimination, form: &Form) -> f64 {
    at.row_violation(system, form).0 / row_size(system, form)
}

/// Measures the positions in place.
pub fn opening(system: &System, at: &Elimination) -> Opening {
    let mut groups: Vec<(usize, f64)> = Vec::new();
    let mut relative = rigid_opening(at);
    let mut worst = 0.0f64;
    for (index, group) in system.groups.iter().enumerate() {
        let rows = system.rows[group.forms.clone()].iter().map(|row| row_opening(system, at, &row.form));
        let open = rows.fold(0.0, larger);
        relative = larger(relative, open);
        // The list stays short: only what can still be of the worst's size.
        if open > SHARE * worst || open.is_nan() {
            worst = larger(worst, open);
            groups.push((index, open));
        }
    }
    groups.retain(|&(_, open)| open > SHARE * worst || open.is_nan());
    groups.sort_by(|a, b| b.1.total_cmp(&a.1));
    Opening { relative, groups }
}

/// Largest violation of a rigid-body row.
fn rigid_opening(at: &Elimination) -> f64 {
    let mut largest = 0.0;
    for state in &at.bodies {
        for k in 0..3 {
            for l in 0..=k {
                let unit = if k == l { 1.0 } else { 0.0 };
                largest = larger(largest, (state.q.e[k].dot(&state.q.e[l]) - unit).abs());
            }
        }
    }
    largest
}

/// What a row's Φ is measured in: m for each point in it.
fn row_size(system: &System, form: &Form) -> f64 {
    let points = |d: Difference| {
        if system.features[d.plus].point { system.length } else { 1.0 }
    };
    match *form {
        Form::Coincidence { .. } => system.length,
        Form::Product { a, b, .. } => points(a) * points(b),
        Form::Relation { slide: Some((_, _, factor)), .. } => (system.length * factor.abs()).max(1.0),
        Form::CommonVector { .. } | Form::Relation { .. } => 1.0,
    }
}

/// The larger of two numbers; NaN is larger than any.
fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
