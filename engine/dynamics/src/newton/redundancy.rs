//! The rows that depend on others wherever the mechanism is — THEORY section 8.
//!
//! A mechanism often starts in a singular position, which would mislead: rows that depend on others only there have small
//! pivots as well. Therefore the pivots are taken at a consistent position a little away from the given one.

use super::{Projectable, project_positions, project_velocities, rules};
use crate::system::index::SolverRow;

/// Relative pivot of S below which a row depends on others — eq. (8.1).
pub const DEPENDENT: f64 = 1e-10;
/// Distance from a state at which the pivots are taken, in lengths of the mechanism.
const AWAY: f64 = 0.03;
/// Largest velocity below which no motion leads away from the state.
const AT_REST: f64 = 1e-9;
/// Phase between the velocities of successive coordinates, rad: the inverse of the plastic number, so that the motion has no
/// symmetry.
const PHASE: f64 = 0.754_877_666_2;

/// A state whose numbers can be changed one by one, with the pivots of S there.
pub trait Movable: Projectable {
    /// Gives each position and its velocity to `change`, in the same order every time, and takes over what they are then.
    fn for_each(&mut self, change: impl FnMut(&mut f64, &mut f64));

    /// The solver rows, in ascending order, that depend on those before them at the positions in place: with pivots of S of
    /// at most the part `least` of its diagonal.
    fn dependent_rows(&mut self, least: f64) -> Vec<SolverRow>;
}

/// The solver rows that depend on others everywhere: rank A in (8.1) is the number of the other rows. Leaves the state
/// elsewhere.
pub fn find_dependent_rows(on: &mut impl Movable, length: f64) -> Vec<SolverRow> {
    on.linearize();
    move_away(on, length);
    on.dependent_rows(DEPENDENT)
}

/// Moves a consistent state by the part `AWAY` of the mechanism's length along an admissible velocity without symmetry,
/// Φ_q q̇ = 0, and back onto Φ = 0; it stays where it is if nothing can move, or if Newton's method does not find back. The factor
/// at hand must be that of the state.
pub fn move_away(on: &mut impl Movable, length: f64) {
    let mut start = Vec::new();
    on.for_each(|x, _| start.push(*x));
    if !has_moved(on, length) {
        let mut start = start.iter();
        on.for_each(|x, _| *x = start.next().copied().unwrap_or(*x));
    }
}

fn has_moved(on: &mut impl Movable, length: f64) -> bool {
    let mut place = 0.0;
    on.for_each(|_, v| {
        *v = libm::sin(1.0 + place * PHASE);
        place += 1.0;
    });
    project_velocities(on, &rules::AWAY_VELOCITIES, length);
    let mut largest = 0.0f64;
    on.for_each(|_, v| largest = largest.max(v.abs()));
    if largest < AT_REST {
        return false;
    }
    let scale = AWAY * length / largest;
    on.for_each(|x, v| *x += scale * *v);
    project_positions(on, &rules::ASSEMBLY_POSITIONS, length).has_converged()
}
