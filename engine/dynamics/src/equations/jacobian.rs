//! The sparse Jacobian Φ_q in the generalized coordinates — THEORY section 4.
//!
//! Its pattern and its constant numbers are written once; a new state only rewrites the rows that can change.

use crate::equations::{Source, column_names, equation, row_names, sources};
use crate::state::State;
use crate::system::System;
use crate::system::natural::Director;
use serde::Serialize;
use std::ops::Range;

/// One number of the Jacobian that can be other than zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JacobianEntry {
    /// Row.
    pub row: usize,
    /// Column.
    pub column: usize,
    /// Value at this state.
    pub value: f64,
    /// Whether it is the same at every state.
    pub constant: bool,
}

/// The sparse Jacobian Φ_q with the names of its rows and columns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Jacobian {
    /// Names of the rows, such as `link: uu` or `pin: CP.x`.
    pub rows: Vec<String>,
    /// Names of the columns, such as `link.ux`.
    pub columns: Vec<String>,
    /// Entries in the order of rows, then columns.
    pub entries: Vec<JacobianEntry>,
    /// The rows that can change, with their entries.
    #[serde(skip)]
    changing: Vec<(Source, Range<usize>)>,
}

impl Jacobian {
    /// Writes the pattern and all numbers at the positions of a state.
    pub fn new(system: &System, at: &State) -> Self {
        let mut jacobian = Self {
            rows: row_names(system),
            columns: column_names(system),
            entries: Vec::new(),
            changing: Vec::new(),
        };
        for (row, source) in sources(system).into_iter().enumerate() {
            let first = jacobian.entries.len();
            visit(system, at, source, |column, value, constant| {
                if value != 0.0 || !constant {
                    jacobian.entries.push(JacobianEntry { row, column, value, constant });
                }
            });
            if jacobian.entries[first..].iter().any(|entry| !entry.constant) {
                jacobian.changing.push((source, first..jacobian.entries.len()));
            }
        }
        jacobian
    }

    /// Rewrites the rows that can change; returns how many.
    pub fn refresh(&mut self, system: &System, at: &State) -> usize {
        for (source, range) in &self.changing {
            let mut entries = self.entries[range.clone()].iter_mut();
            visit(system, at, *source, |_, value, constant| {
                if (value != 0.0 || !constant)
                    && let Some(entry) = entries.next()
                {
                    entry.value = value;
                }
            });
        }
        self.changing.len()
    }
}

/// Calls `entry(column, value, constant)` for each number of an equation's row, structural zeros included.
fn visit(system: &System, at: &State, source: Source, mut entry: impl FnMut(usize, f64, bool)) {
    // A director that two bodies share gets what both put on it: columns are collected before they are handed over.
    let mut numbers: Vec<(usize, f64, bool)> = Vec::with_capacity(24);
    for own in equation(system, at, source).gradients {
        let layout = &system.bodies[own.body].layout;
        // In a reduced body what acts on w = u × v acts on u and v, and changes with them.
        let through_w = own.touched[3] && layout.directors[2] == Director::Product;
        let mut place = 0;
        let mut touched = own.touched;
        if through_w {
            touched = [touched[0], true, true, false];
        }
        let blocks = std::iter::once(true).chain(layout.directors.iter().map(|d| d.column().is_some()));
        let blocks: Vec<usize> = blocks.enumerate().filter(|(_, has)| *has).map(|(block, _)| block).collect();
        layout.pull_back(&at.bodies()[own.body].q, &own.gradient, |column, value| {
            let block = blocks[place / 3];
            place += 1;
            if touched[block] {
                numbers.push((column, value, own.constant && !(through_w && block > 0)));
            }
        });
    }
    numbers.sort_by_key(|(column, ..)| *column);
    for same in numbers.chunk_by(|a, b| a.0 == b.0) {
        let value = same.iter().map(|(_, value, _)| value).sum();
        entry(same[0].0, value, same.iter().all(|(.., constant)| *constant));
    }
}
