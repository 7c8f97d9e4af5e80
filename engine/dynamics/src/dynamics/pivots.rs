//! What small pivots of S mean: a nearly singular position, or masses that are far apart.

use crate::system::System;
use crate::system::islands::is_tree;

/// Relative pivot of S below which it is regularized although its rows were found independent: the position is nearly
/// singular. In a tree no position is: there masses make it small, and the solution is refined.
const NEAR_SINGULAR: f64 = 1e-9;
/// The same in a tree, and where a step is to be decided by rows that hardly hold: rounding is just below.
const LOST: f64 = 1e-15;

/// The least pivots of S.
#[derive(Clone, Copy, Debug)]
pub struct Pivots {
    tree: bool,
    /// Whether one of the current factor is so small that what is solved with it is to be refined.
    pub small: bool,
}

impl Pivots {
    /// Of a system, before S is factored.
    pub fn new(system: &System) -> Self {
        Self { tree: is_tree(&system.model), small: false }
    }

    /// Takes note of the least one. Returns whether S is to be regularized; `resolving` is whether rows that hardly hold are kept.
    pub fn are_lost(&mut self, smallest: f64, resolving: bool) -> bool {
        self.small = smallest < NEAR_SINGULAR;
        smallest < if resolving || self.tree { LOST } else { NEAR_SINGULAR }
    }
}
