//! Moments of a run that are kept until their rows are written, by whichever thread.

use super::{Group, Outputs};
use crate::run::{Simulation, Snapshot};

/// The current state of a run at one time, with what its row in a table needs beside it.
#[derive(Clone, Debug, Default)]
pub struct Moment {
    snapshot: Snapshot,
    /// The error of the state, where it is wanted and known.
    error: Vec<f64>,
    error_known: bool,
    /// See [`Simulation::off_at_start`].
    off_at_start: f64,
    /// Work of drivers and of loads without potential since the start, J, where it is wanted.
    work: f64,
}

impl Moment {
    /// Time, s.
    pub fn time(&self) -> f64 {
        self.snapshot.time
    }
}

/// Writes rows of moments: the same numbers as [`Outputs::write`] at their times, in any order and by any thread.
///
/// ```
/// use triad_engine::prelude::*;
/// use triad_engine::run::{Outputs, RowWriter};
///
/// let mut run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
/// let outputs = Outputs::new(&run);
/// let mut writer = RowWriter::new(&run, &outputs);
/// run.advance_to(0.5)?;
/// let (moment, mut now) = (outputs.moment(&run), Vec::new());
/// outputs.write(&run, &mut now);
/// run.advance_to(1.0)?;
/// let mut later = Vec::new();
/// writer.write(&moment, &mut later);
/// assert_eq!(now, later);
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RowWriter {
    outputs: Outputs,
    /// A copy of the run that stands at the moment that was written last.
    run: Simulation,
}

impl RowWriter {
    /// For these columns of a run.
    pub fn new(run: &Simulation, outputs: &Outputs) -> Self {
        Self { outputs: outputs.clone(), run: run.without_integrator() }
    }

    /// Appends the numbers of a moment of this run, one for each column.
    pub fn write(&mut self, moment: &Moment, row: &mut Vec<f64>) {
        let Moment { snapshot, error, error_known, off_at_start, work } = moment;
        let Self { outputs, run } = self;
        run.work = *work;
        run.off_at_start = (*off_at_start).into();
        run.current.take_over(&run.mechanism.system, snapshot, error_known.then_some(error));
        outputs.write(run, row);
    }
}

impl Outputs {
    /// The current state of a run with what its row needs, to be written later: see [`RowWriter`].
    pub fn moment(&self, run: &Simulation) -> Moment {
        let mut moment = Moment::default();
        self.keep(run, &mut moment);
        moment
    }

    /// Puts the current state in the place of another moment, whose memory is used again.
    pub fn keep(&self, run: &Simulation, moment: &mut Moment) {
        let Moment { snapshot, error, error_known, off_at_start, work } = moment;
        let wants = |group: fn(&Group) -> bool| self.groups.iter().any(group);
        run.keep(snapshot);
        *error_known = wants(|group| matches!(group, Group::Errors { .. })) && run.keep_error(error);
        *off_at_start = if *error_known { run.off_at_start() } else { 0.0 };
        *work = if wants(|group| matches!(group, Group::Balance)) {
            run.work + run.work_up_to_current()
        } else {
            0.0
        };
    }
}
