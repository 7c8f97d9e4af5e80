//! A state of a run, kept so that it can be looked at again after the run has gone on.

use super::{Simulation, StateView};
use std::borrow::Cow;

/// A state of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// q and q̇.
    state: Vec<f64>,
    /// Angles with their whole turns, rad.
    angles: Vec<f64>,
}

impl Snapshot {
    /// About how many bytes it takes.
    pub fn size(&self) -> usize {
        size_of::<Self>() + size_of::<f64>() * (self.state.len() + self.angles.len())
    }
}

impl Simulation {
    /// The state that is shown, to be looked at again with [`Simulation::at_snapshot`].
    pub fn snapshot(&self) -> Snapshot {
        let angles = self.shown.state().angles().iter().map(|angle| angle.value).collect();
        Snapshot { time: self.time(), state: self.shown.y().to_vec(), angles }
    }

    /// The state of a snapshot, with all that can be asked of it. `None` if the snapshot belongs to other coordinates.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut run = Simulation::new(&catalogue::scene("free-fall")?)?;
    /// let start = run.snapshot();
    /// run.advance_to(0.5)?;
    /// assert_eq!(run.at_snapshot(&start).map(|state| state.time()), Some(0.0));
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn at_snapshot(&self, snapshot: &Snapshot) -> Option<StateView<'_>> {
        let Snapshot { time, state, angles } = snapshot;
        if state.len() != self.shown.y().len() || angles.len() != self.shown.state().angles().len() {
            return None;
        }
        let shown = self.shown.at(self.system(), *time, state, angles);
        Some(StateView::new(self, Cow::Owned(shown)))
    }
}
