//! The motion in numbers on its way to whoever draws it: blocks of frames, each packed once, from the beginning of the run.

use std::sync::Arc;

use triad_session::picture::{Samples, block, joints_told};

use super::hub::Hub;

/// The frames of one run on their way to whoever draws them.
pub struct Track {
    hub: Arc<Hub>,
    /// How many of all samples taken are packed.
    packed: u64,
}

impl Track {
    /// For the watchers of `hub`.
    pub fn new(hub: Arc<Hub>) -> Self {
        Self { hub, packed: 0 }
    }

    /// Packs those of a run's samples that nobody has received yet, if anybody watches. Who comes later than the packed ones are
    /// kept receives the samples that are.
    pub fn pack(&mut self, samples: &Samples) {
        if self.hub.watchers() == 0 {
            // Whoever comes next receives all that is kept.
            if self.packed > 0 {
                self.restart();
            }
            return;
        }
        let waiting = samples.after(self.packed);
        if waiting.is_empty() {
            return;
        }
        let joints = joints_told(samples.description().joints.len());
        let new = block(waiting, joints);
        if self.hub.is_full_with(new.len()) {
            self.hub.shorten(block(samples.among_first(self.packed), joints));
        }
        self.hub.push(new);
        self.packed = samples.recorded();
    }

    /// The samples begin anew.
    pub fn restart(&mut self) {
        self.packed = 0;
        self.hub.restart();
    }

    /// Who draws.
    pub fn watchers(&self) -> usize {
        self.hub.watchers()
    }
}
