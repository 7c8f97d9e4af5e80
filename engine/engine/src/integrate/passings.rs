//! Steps that are short where points of springs pass each other: far from there nothing that a method evaluates knows of it, and it would step
//! over it, its error estimate with it.

use super::step::StepRecord;
use triad_dynamics::system::System;
use triad_dynamics::system::passing::{Approach, longest_step, shortest_step};

/// Part of the way to where the points pass, in time and in the complex plane, that a step may go. On the way back it counts too: what stages
/// see of it within a step may be nothing.
const PART: f64 = 0.6;

/// How points of springs approached each other at the starts of the last two steps.
#[derive(Clone, Debug, Default)]
pub struct Passings {
    now: Vec<Approach>,
    before: Vec<Approach>,
    /// When the earlier one was, s.
    then: f64,
}

impl Passings {
    /// Where the next step of a run to `end` ends at the latest.
    pub fn end_of_step(&mut self, system: &System, last: &StepRecord, end: f64) -> f64 {
        std::mem::swap(&mut self.now, &mut self.before);
        system.approaches(&last.y, &mut self.now);
        // Points that go straight on have l² = a + b t + v² t²; those that turn show how b changes.
        let between = last.t - self.then;
        let known = between > 0.0 && self.before.len() == self.now.len();
        let steps = self.now.iter().enumerate().map(|(i, now)| {
            let bend =
                if known { 0.5 * (now.rate - self.before[i].rate) / between } else { now.speed_square };
            longest_step([now.square, now.rate, bend], false, PART, system.met())
        });
        let longest = steps.fold(f64::INFINITY, f64::min);
        self.then = last.t;
        end.min(last.t + longest.max(shortest_step(last.t, system.model.settings.duration)))
    }
}
