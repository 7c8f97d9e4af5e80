//! What happens during a run: the events that its scene watches for.

use super::Simulation;
use crate::event::{self, Happening};
use crate::mechanism::Mechanism;

impl Simulation {
    /// Events up to the shown time, in the order of time.
    pub fn events(&self) -> &[Happening] {
        let count = self.happened.partition_point(|h| h.time <= self.time);
        &self.happened[..count]
    }

    /// Forgets what has happened; numbers that events look at are counted from the start of the integrator on, whose
    /// state must be in place.
    pub(super) fn watching(mut self) -> Self {
        self.watch_anew();
        self
    }

    pub(super) fn watch_anew(&mut self) {
        self.happened.clear();
        self.end = self.duration();
        let Mechanism { system, elimination, .. } = &mut self.mechanism;
        if system.watches.is_empty() {
            return;
        }
        elimination.set_time(system, self.integrator.time());
        let (q, q_dot) = self.integrator.state().split_at(system.coordinates);
        elimination.place(system, q);
        elimination.set_velocity(system, q_dot);
        for watch in &mut system.watches {
            watch.begin(elimination);
        }
    }

    /// Finds what has happened in the last step.
    pub(super) fn look_for_events(&mut self) {
        if self.mechanism.system.watches.is_empty() {
            return;
        }
        let Self { mechanism, integrator, scratch, happened, .. } = self;
        let (before, end) = (happened.len(), integrator.time());
        let step = (end - integrator.last_step(), end);
        let mut watches = std::mem::take(&mut mechanism.system.watches);
        let state = &mut scratch[..integrator.state().len()];
        let see = |t: f64, watch: &event::Watch| {
            integrator.interpolate(mechanism, t, state);
            mechanism.set_state(t, state);
            watch.look(&mechanism.elimination)
        };
        event::find(&mut watches, step, see, happened);
        mechanism.system.watches = watches;
        if let Some(last) = happened[before..].iter().position(|h| h.stop) {
            happened.truncate(before + last + 1);
            self.end = happened[before + last].time;
        }
    }
}
