//! Snapshots: states of a run that are kept, and can be restored after the run has gone on.

use super::{Simulation, StateView};
use crate::integrate::Integrator;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// What an allocator adds to a list, bytes: its own notes, and up to the next size that it has.
const PER_LIST: usize = 16;

/// A state of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// q and q̇.
    pub(super) state: Vec<f64>,
    /// Angles with their whole turns, rad.
    pub(super) angles: Vec<f64>,
}

impl Snapshot {
    /// Bytes that it takes, with what an allocator adds to each of its lists.
    pub fn size(&self) -> usize {
        size_of::<Self>() + list_size(&self.state) + list_size(&self.angles)
    }
}

/// Bytes that a list takes beside itself, with what an allocator adds; none where nothing was put into it.
pub fn list_size<T>(list: &Vec<T>) -> usize {
    if list.capacity() == 0 { 0 } else { PER_LIST + size_of::<T>() * list.capacity() }
}

impl Simulation {
    /// The current state, to be restored with [`Simulation::at_snapshot`].
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.keep(&mut snapshot);
        snapshot
    }

    /// Puts the current state in the place of another snapshot.
    pub(super) fn keep(&self, snapshot: &mut Snapshot) {
        snapshot.time = self.time();
        self.current.y().clone_into(&mut snapshot.state);
        let angles = self.current.angles(self.system());
        snapshot.angles.clear();
        snapshot.angles.extend(angles.iter().map(|angle| angle.value));
    }

    /// A copy that cannot go on and takes little room.
    pub(super) fn without_integrator(&self) -> Self {
        let integrator = Integrator::ended(self.time(), self.current.y());
        Self { integrator, companion: None, before_branching: None, ..self.clone() }
    }

    /// The state of a snapshot, with all that can be computed from it. `None` if the snapshot belongs to other coordinates.
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
        if state.len() != self.current.y().len() || angles.len() != self.system().angles.len() {
            return None;
        }
        let state = self.current.at(self.system(), *time, state, angles);
        Some(StateView::new(self, Cow::Owned(state)))
    }
}
