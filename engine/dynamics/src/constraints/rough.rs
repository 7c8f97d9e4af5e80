//! Positions from anywhere moved onto the constraints.

use crate::constraints::mechanism::Mechanism;
use crate::dynamics::elimination::ProjectableState;
use crate::newton::{Projectable, project_positions, rules};

/// Longest step of Newton's method, m or, of directors, without a unit: a rotation that is cut short stays near a rotation only
/// if the step is short.
const MAX_STEP: f64 = 0.3;

/// A rough start, which is moved onto the constraints by steps no longer than [`MAX_STEP`].
struct Damped<'a> {
    on: ProjectableState<'a>,
    /// Whether somebody still waits for it.
    wanted: &'a dyn Fn() -> bool,
    /// q before a step.
    from: Vec<f64>,
}

impl Projectable for Damped<'_> {
    fn linearize(&mut self) {
        self.on.linearize();
    }

    /// q ← q + min(1, MAX_STEP/|Δq|) Δq; the size of the whole Δq.
    fn correct_positions(&mut self) -> f64 {
        if !(self.wanted)() {
            // What is no number ends the search.
            return f64::NAN;
        }
        let ProjectableState { system, state, elimination, q, .. } = &mut self.on;
        self.from.copy_from_slice(q);
        let step = elimination.correct_positions(system, state, q);
        let part = if step > MAX_STEP { MAX_STEP / step } else { 1.0 };
        for (q, from) in q.iter_mut().zip(&self.from) {
            *q = from + part * (*q - from);
        }
        state.set_positions(system, q);
        step
    }

    fn correct_velocities(&mut self) -> f64 {
        self.on.correct_velocities()
    }
}

/// Newton's method with short steps from y = (q, q̇), whose state is in place. Returns the violation at the start, the steps
/// taken and what is left. It ends where it stands as soon as it is not `wanted` any more.
pub fn close(mechanism: &mut Mechanism, y: &mut [f64], wanted: &dyn Fn() -> bool) -> (f64, usize, f64) {
    mechanism.elimination.set_redundant(true);
    let violation = mechanism.state.position_violation(&mechanism.system);
    let length = mechanism.system.length;
    let from = vec![0.0; mechanism.system.coordinates];
    let mut damped = Damped { on: mechanism.projectable(y), wanted, from };
    let projected = project_positions(&mut damped, &rules::ROUGH_POSITIONS, length);
    (violation, projected.corrections, mechanism.state.position_violation(&mechanism.system))
}
