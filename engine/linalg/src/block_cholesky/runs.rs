//! Runs of pivots that are alike: sweeps through them look nothing up.

use super::{Beside, Pivot};
use std::ops::Range;

/// Widest blocks that are compiled one by one.
const WIDEST: usize = 6;

/// Runs `$call` with the constant `$n` equal to a block's size and `$w` to its stride, or `$other` where that is none of those
/// that joints have.
macro_rules! by_size {
    ($size:expr, $n:ident, $w:ident => $call:expr, $other:expr) => {
        by_size!(@ $size, $n, $w => $call, $other; 1 2 3 4 5 6)
    };
    (@ $size:expr, $n:ident, $w:ident => $call:expr, $other:expr; $($value:literal)*) => {
        match $size {
            $($value => { const $n: usize = $value; const $w: usize = stride($value); $call })*
            _ => $other,
        }
    };
}

pub(super) use by_size;

/// The same for what pivots of a run have in common, with `$beside` equal to the number of blocks beside each: known beforehand in
/// chains, where it is one.
macro_rules! by_kind {
    ($alike:expr, $n:ident, $w:ident, $beside:ident => $call:expr, $other:expr) => {
        match *$alike {
            Some(Alike { size, beside: 1 }) => {
                by_size!(size, $n, $w => { let $beside = 1; $call }, $other)
            }
            Some(Alike { size, beside: $beside }) => by_size!(size, $n, $w => $call, $other),
            None => $other,
        }
    };
}

pub(super) use by_kind;

/// Pivots one after another in the order of elimination.
#[derive(Clone, Debug)]
pub struct Run {
    pub pivots: Range<usize>,
    /// Rows of each of them and of all blocks beside them, which are as many for each; none for a single pivot that is wider
    /// than those of joints, or has blocks of other joints beside it.
    pub alike: Option<Alike>,
}

/// What pivots of a run have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alike {
    pub size: usize,
    /// Blocks beside each.
    pub beside: usize,
}

/// The runs of all pivots that have rows.
pub fn find(pivots: &[Pivot], beside: &[Beside]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (place, pivot) in pivots.iter().enumerate().filter(|(_, pivot)| pivot.size > 0) {
        let own = &beside[pivot.beside.clone()];
        let is_alike = pivot.size <= WIDEST && own.iter().all(|b| b.columns == pivot.size);
        let alike = is_alike.then_some(Alike { size: pivot.size, beside: own.len() });
        match runs.last_mut() {
            Some(run) if alike.is_some() && run.alike == alike && run.pivots.end == place => {
                run.pivots.end += 1;
            }
            _ => runs.push(Run { pivots: place..place + 1, alike }),
        }
    }
    runs
}
