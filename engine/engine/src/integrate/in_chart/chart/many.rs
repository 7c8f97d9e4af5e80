//! Evaluations at several states at once, where a tree alone decides how the mechanism moves.

use super::Chart;
use crate::integrate::in_chart::guess::Guess;
use crate::integrate::in_chart::tree_lanes::TreeLanes;
use triad_dynamics::ode::Many;
use triad_dynamics::system::System;

impl Chart {
    /// Writes what is asked for. False if the mechanism must be put into each state for it.
    pub fn evaluate_many(&mut self, system: &System, of: &mut Many) -> bool {
        let (open, f) = (self.is_open(), self.freedoms());
        let Self { numbers, base, basis, functionals, start, .. } = self;
        let Some((tree, lanes)) = numbers.lanes().filter(|_| open) else { return false };
        let (width, count) = (TreeLanes::width(), of.states.len());
        for first in (0..count).step_by(width) {
            // Idle lanes repeat the last state.
            for lane in 0..width {
                let state = (first + lane).min(count - 1);
                lanes.at.times[lane] = of.times[state];
                let (eta, eta_dot) = of.states[state].split_at(f);
                for i in 0..f {
                    lanes.at.places[i][lane] = base[i] + basis[(i, i)] * eta[i];
                    lanes.at.rates[i][lane] = basis[(i, i)] * eta_dot[i];
                }
            }
            lanes.evaluate(system);
            for (lane, state) in (first..count.min(first + width)).enumerate() {
                let rate = &mut of.rates[state];
                rate[..f].copy_from_slice(&of.states[state][f..]);
                for i in 0..f {
                    rate[f + i] = functionals[(i, i)] * lanes.at.accelerations[i][lane];
                    start[i] = lanes.at.places[i][lane];
                }
                of.power[state] = lanes.at.power[lane];
                if !tree.reaches(start.as_slice()) {
                    // A step that leaves the chart is too long.
                    rate.fill(f64::NAN);
                }
            }
        }
        true
    }

    /// Notes in a guess where a state is that was evaluated so.
    pub fn note(&self, x: &[f64], guess: &mut Guess) {
        let (eta, eta_dot) = x.split_at(self.freedoms());
        guess.eta.copy_from_slice(eta);
        for i in 0..eta.len() {
            guess.p[i] = self.base[i] + self.basis[(i, i)] * eta[i];
            guess.p_dot[i] = self.basis[(i, i)] * eta_dot[i];
        }
    }
}
