//! Places of a run from which it can be taken up again.

use crate::error::EngineError;
use crate::run::Simulation;
use triad_dynamics::model::Model;

/// Greatest number of checkpoints times bodies that are kept. Measured: 12 kB a body with dop853 to 33 kB with a series, so 70 MB.
const MAX_CHECKPOINT_BODIES: usize = 2048;
/// Least number of checkpoints that are kept. Measured: 18 kB a body of large mechanisms, so 360 MB for the 5000 bodies of the largest.
const MIN_CHECKPOINTS: usize = 4;

/// A run as it stood after one of its steps.
#[derive(Clone, Debug)]
pub(super) struct Checkpoint {
    /// Start of that step, s.
    from: f64,
    pub run: Simulation,
}

impl Checkpoint {
    /// Whether the way to time t is shorter from here than from another place.
    pub fn is_nearer(&self, other: &Self, t: f64) -> bool {
        other.from >= t || other.from < self.from
    }

    /// Goes on to the step that covers time t.
    ///
    /// # Errors
    ///
    /// [`EngineError`]: the run cannot go on.
    pub fn cover(&mut self, t: f64) -> Result<(), EngineError> {
        while self.run.reached() < t {
            self.from = self.run.reached();
            self.run.take_step(self.run.duration())?;
        }
        Ok(())
    }
}

/// Checkpoints of a run, one at each of so many steps. When there are too many, every second one is given up.
#[derive(Clone, Debug)]
pub(super) struct Checkpoints {
    /// Where the run starts.
    first: Checkpoint,
    /// The checkpoints after the first.
    later: Vec<Checkpoint>,
    stride: u64,
    steps: u64,
    most: usize,
}

impl Checkpoints {
    /// With one checkpoint, where the run starts.
    pub fn new(run: &Simulation) -> Self {
        let most = (MAX_CHECKPOINT_BODIES / run.model().bodies.len().max(1)).max(MIN_CHECKPOINTS);
        let first = Checkpoint { from: f64::NEG_INFINITY, run: run.clone() };
        Self { first, later: Vec::new(), stride: 1, steps: 0, most }
    }

    /// The model of the run.
    pub fn model(&self) -> &Model {
        self.first.run.model()
    }

    /// Takes note of a step that the run has taken, from time `from`.
    pub fn keep(&mut self, from: f64, run: &Simulation) {
        self.steps += 1;
        // A run that went back shows what it then passes a second time from the steps that it took first.
        if self.later.last().is_some_and(|last| from < last.from) {
            return;
        }
        if !self.steps.is_multiple_of(self.stride) {
            return;
        }
        self.later.push(Checkpoint { from, run: run.clone() });
        if self.later.len() > self.most {
            self.stride *= 2;
            let mut step = 0;
            self.later.retain(|_| {
                step += 1;
                step % 2 == 0
            });
        }
    }

    /// The last checkpoint whose step begins before time t: a run that comes to t shows it from the step that reaches t.
    pub fn before(&self, t: f64) -> &Checkpoint {
        let after = self.later.partition_point(|checkpoint| checkpoint.from < t);
        after.checked_sub(1).map_or(&self.first, |last| &self.later[last])
    }
}
