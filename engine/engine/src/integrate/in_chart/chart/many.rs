//! Evaluations at several states at once, where a tree alone decides how the mechanism moves.

use super::Chart;
use crate::integrate::in_chart::guess::Guess;
use crate::integrate::in_chart::tree_lanes::{LaneStates, TreeLanes};
use crate::integrate::wide::MOST_LANES;
use triad_dynamics::ode::Many;
use triad_dynamics::system::System;

impl Chart {
    /// Writes what is asked for. False if the mechanism must be put into each state for it.
    pub fn evaluate_many(&mut self, system: &System, of: &mut Many) -> bool {
        let (open, f) = (self.is_open(), self.freedoms());
        let Self { numbers, base, basis, functionals, .. } = self;
        let Some((tree, lanes)) = numbers.lanes().filter(|_| open) else { return false };
        let (width, count) = (TreeLanes::width(), of.states.len());
        for first in (0..count).step_by(width) {
            // Idle lanes repeat the last state.
            let places: [usize; MOST_LANES] = std::array::from_fn(|lane| (first + lane).min(count - 1));
            let states = places.map(|place| of.states[place].split_at(f));
            let LaneStates { times, places: p, rates: p_dot, .. } = &mut lanes.at;
            *times = places.map(|place| of.times[place]);
            for i in 0..f {
                let (from, by) = (base[i], basis[(i, i)]);
                p[i] = states.map(|(eta, _)| from + by * eta[i]);
                p_dot[i] = states.map(|(_, eta_dot)| by * eta_dot[i]);
            }
            lanes.evaluate(system);
            let LaneStates { places: p, accelerations, power, .. } = &lanes.at;
            for lane in 0..width.min(count - first) {
                let (velocity, acceleration) = of.rates[first + lane].split_at_mut(f);
                velocity.copy_from_slice(states[lane].1);
                for (i, (out, found)) in acceleration.iter_mut().zip(accelerations).enumerate() {
                    *out = functionals[(i, i)] * found[lane];
                }
                of.power[first + lane] = power[lane];
                if !tree.reaches(|place| p[place][lane]) {
                    // A step that leaves the chart is too long.
                    of.rates[first + lane].fill(f64::NAN);
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
