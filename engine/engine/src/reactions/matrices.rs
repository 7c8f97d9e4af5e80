//! The matrices of the equations of motion as pictures: the augmented one of eq. (6.6) and S of eq. (7.6), with the
//! places that a factorization fills.
//!
//! Not used by the solver; written for those who want to see what it works with.

use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use triad_dynamics::dynamics::elimination::Elimination;
use triad_dynamics::equations::augmented::for_mass_entries;
use triad_dynamics::equations::jacobian::Jacobian;
use triad_dynamics::equations::{column_names, row_names};
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::index::{ConstraintId, IncidenceId};

/// What stands at a place of a symmetric matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "MatrixPart")]
pub enum EntryKind {
    /// A number of M or S.
    Own,
    /// A number of Φ_q that never changes.
    Constant,
    /// A number of Φ_q that changes with q.
    Changing,
    /// Zero in the matrix, but not in its factor.
    Fill,
}

/// A number of a symmetric matrix on or below the diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MatrixEntry {
    /// Row.
    pub row: usize,
    /// Column, at most the row.
    pub column: usize,
    /// Value at this state; zero for fill.
    pub value: f64,
    /// What it is.
    pub part: EntryKind,
}

/// A symmetric matrix whose rows, and columns alike, have names: [`StateView::augmented`](crate::run::StateView::augmented)
/// and [`StateView::schur`](crate::run::StateView::schur) give it.
///
/// ```
/// use triad_engine::prelude::*;
///
/// let run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
/// let (augmented, s) = (run.state().augmented(), run.state().schur());
/// assert_eq!(augmented.names[0], "bob.rx");
/// assert!(s.names.len() < augmented.names.len() && s.fill() == 0);
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Symmetric {
    /// Names of the rows, which are those of the columns too.
    pub names: Vec<String>,
    /// Numbers on and below the diagonal, by row and column.
    pub places: Vec<MatrixEntry>,
}

impl Symmetric {
    /// How many places a factorization fills on or below the diagonal.
    pub fn fill(&self) -> usize {
        self.places.iter().filter(|place| place.part == EntryKind::Fill).count()
    }
}

#[doc(hidden)]
/// The augmented matrix [M Φ_qᵀ; Φ_q 0] with the fill of eliminating coordinates first: Φ_q M⁻¹ Φ_qᵀ stands where the
/// zeros are.
pub fn augmented(system: &System, at: &State) -> Symmetric {
    let n = system.coordinates;
    let mut names = column_names(system);
    names.extend(row_names(system).into_iter().map(|name| format!("λ {name}")));
    let mut mass = BTreeMap::<(usize, usize), f64>::new();
    for_mass_entries(system, at, |row, column, value| {
        if column <= row {
            *mass.entry((row, column)).or_default() += value;
        }
    });
    let mut places: BTreeMap<(usize, usize), (f64, EntryKind)> =
        mass.into_iter().map(|(at, value)| (at, (value, EntryKind::Own))).collect();
    let jacobian = Jacobian::new(system, at);
    for entry in &jacobian.entries {
        let part = if entry.constant { EntryKind::Constant } else { EntryKind::Changing };
        places.insert((n + entry.row, entry.column), (entry.value, part));
    }
    // Rows of Φ_q that act on the same body meet once its coordinates are eliminated.
    let body_of = columns_by_body(system);
    let mut acting = vec![BTreeSet::new(); system.bodies.len()];
    for entry in &jacobian.entries {
        acting[body_of[entry.column]].insert(entry.row);
    }
    for rows in acting {
        for &i in &rows {
            for &j in rows.range(..=i) {
                places.entry((n + i, n + j)).or_insert((0.0, EntryKind::Fill));
            }
        }
    }
    Symmetric { names, places: listed(places) }
}

/// For each coordinate, the body whose block of M it belongs to: bodies that share a director share its columns, and
/// the first of them counts.
fn columns_by_body(system: &System) -> Vec<usize> {
    let mut body_of = vec![usize::MAX; system.coordinates];
    for (index, body) in system.bodies.iter().enumerate() {
        let directors = body.layout.directors.iter().filter_map(|director| director.column());
        for first in std::iter::once(body.layout.first).chain(directors.map(|(column, _)| column)) {
            for column in first..first + 3 {
                if body_of[column] == usize::MAX {
                    body_of[column] = index;
                }
            }
        }
    }
    body_of
}

#[doc(hidden)]
/// S = A D⁻¹ Aᵀ in the order in which the solver eliminates joints, with the fill of its factor.
pub fn schur(system: &System, state: &State, at: &mut Elimination) -> Symmetric {
    at.linearize(system, state);
    let order = at.elimination_order();
    let mut first = vec![0; system.constraints.len()];
    let mut names = Vec::with_capacity(system.solver_rows);
    for &constraint in &order {
        first[constraint.index()] = names.len();
        names.extend(solver_names(system, constraint));
    }
    let mut values = BTreeMap::<(usize, usize), f64>::new();
    let mut joined: BTreeSet<(ConstraintId, ConstraintId)> = BTreeSet::new();
    for incidences in &system.incidences_of_body {
        for p in incidences.iter().map(|&p| IncidenceId(p)) {
            for q in incidences.iter().map(|&q| IncidenceId(q)) {
                let [gp, gq] = [p, q].map(|id| system[id].constraint);
                if first[gp.index()] < first[gq.index()] {
                    continue;
                }
                joined.insert((gp, gq));
                for (i, a) in at.jacobian().rows_on(system, p).chunks_exact(6).enumerate() {
                    for (j, b) in at.weighted_rows_on(system, q).chunks_exact(6).enumerate() {
                        let (row, column) = (first[gp.index()] + i, first[gq.index()] + j);
                        if column <= row {
                            *values.entry((row, column)).or_default() +=
                                a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                        }
                    }
                }
            }
        }
    }
    let mut places: BTreeMap<(usize, usize), (f64, EntryKind)> =
        values.into_iter().map(|(at, value)| (at, (value, EntryKind::Own))).collect();
    for (i, j) in filled(&order, &joined) {
        for row in first[i.index()]..first[i.index()] + system[i].solver.len() {
            for column in first[j.index()]..first[j.index()] + system[j].solver.len() {
                places.entry((row, column)).or_insert((0.0, EntryKind::Fill));
            }
        }
    }
    Symmetric { names, places: listed(places) }
}

/// Names of a joint's rows in the solver: two for a common vector, one for each equation of the other forms.
fn solver_names(system: &System, constraint: ConstraintId) -> Vec<String> {
    let constraint = &system[constraint];
    let rows = system.rows[constraint.forms.clone()].iter();
    rows.flat_map(|row| {
        let count = row.form.independent();
        (1..=count).map(move |k| match count {
            1 => format!("{}: {}", constraint.name, row.label),
            _ => format!("{}: {}.{k}", constraint.name, row.label),
        })
    })
    .collect()
}

/// Pairs of joints, the later one first, that meet while joints are eliminated in that order although S has nothing
/// there.
fn filled(
    order: &[ConstraintId],
    joined: &BTreeSet<(ConstraintId, ConstraintId)>,
) -> Vec<(ConstraintId, ConstraintId)> {
    let mut rank = vec![0; order.len()];
    for (place, &joint) in order.iter().enumerate() {
        rank[joint.index()] = place;
    }
    let mut later = vec![BTreeSet::new(); order.len()];
    for &(i, j) in joined {
        if i != j {
            later[rank[j.index()]].insert(rank[i.index()]);
        }
    }
    let mut fill = Vec::new();
    for place in 0..order.len() {
        let meeting: Vec<usize> = later[place].iter().copied().collect();
        for (k, &i) in meeting.iter().enumerate() {
            for &j in &meeting[k + 1..] {
                if later[i].insert(j) {
                    fill.push((order[j], order[i]));
                }
            }
        }
    }
    fill
}

fn listed(places: BTreeMap<(usize, usize), (f64, EntryKind)>) -> Vec<MatrixEntry> {
    places
        .into_iter()
        .map(|((row, column), (value, part))| MatrixEntry { row, column, value, part })
        .collect()
}
