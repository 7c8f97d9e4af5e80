//! A simulation and its recording, kept in step.
//!
//! Samples are taken at the scene's own output times and wait unencoded until somebody watches.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use triad_engine::scene::Scene;
use triad_engine::simulation::Simulation;

use super::worker::BEAT;
use crate::problem::Problem;
use crate::stream::{Cast, Hub, Pattern, Pose, Reaction, RecordError, Recorder, Sample, Tie};

/// Samples of one simulation on their way to its watchers.
pub(crate) struct Film {
    cast: Cast,
    hub: Arc<Hub>,
    id: String,
    /// Counts recordings: a viewer must not join one after a reset to the one before.
    take: u64,
    recorder: Option<Recorder>,
    waiting: Vec<Sample>,
    waiting_bytes: usize,
    limit: usize,
    frames: u64,
    encoded: u64,
    last: f64,
    /// When blocks were last made, and how long to wait until the next.
    developed: Instant,
    pace: Duration,
}

/// A block costs some kilobytes an entity whatever it holds: so many entities are streamed at the full rate,
/// larger scenes more seldom.
const ENTITIES_AT_FULL_RATE: usize = 16;
/// The longest wait between two blocks.
const SLOWEST: Duration = Duration::from_millis(500);

impl Film {
    /// The film of session `id`, which holds at most `limit` bytes.
    pub(crate) fn new(id: &str, cast: Cast, hub: Arc<Hub>, limit: usize) -> Self {
        let entities = cast.bodies.len() + 2 * cast.joints.len() + 2;
        let beats = u32::try_from(entities / ENTITIES_AT_FULL_RATE).unwrap_or(u32::MAX);
        Self {
            developed: Instant::now(),
            pace: BEAT.saturating_mul(beats).min(SLOWEST),
            cast,
            hub,
            id: id.to_owned(),
            take: 0,
            recorder: None,
            waiting: Vec::new(),
            waiting_bytes: 0,
            limit,
            frames: 0,
            encoded: 0,
            last: f64::NEG_INFINITY,
        }
    }

    /// Records the simulation as it stands, unless that instant is recorded already.
    pub(crate) fn take(&mut self, simulation: &mut Simulation) -> Result<(), Problem> {
        if simulation.time() <= self.last {
            return Ok(());
        }
        let sample = sample(simulation);
        self.waiting_bytes += sample.size();
        if self.waiting_bytes + self.hub.bytes() > self.limit {
            return Err(full(self.limit));
        }
        self.last = sample.time;
        self.waiting.push(sample);
        self.frames += 1;
        Ok(())
    }

    /// Encodes what waits, if anybody watches and it is time.
    pub(crate) fn develop_in_turn(&mut self) -> Result<(), Problem> {
        if self.developed.elapsed() < self.pace { Ok(()) } else { self.develop() }
    }

    /// Encodes what waits, if anybody watches.
    pub(crate) fn develop(&mut self) -> Result<(), Problem> {
        if self.hub.watchers() == 0 || (self.waiting.is_empty() && self.recorder.is_some()) {
            return Ok(());
        }
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            empty => {
                let id = format!("{}-{}", self.id, self.take);
                empty.insert(Recorder::to_blocks(&id, self.cast.clone()).map_err(unrecorded)?)
            }
        };
        self.developed = Instant::now();
        recorder.write(&self.waiting).map_err(unrecorded)?;
        self.encoded += self.waiting.len() as u64;
        self.waiting.clear();
        self.waiting_bytes = 0;
        if let Some(block) = recorder.block().map_err(unrecorded)? {
            self.hub.push(block);
        }
        Ok(())
    }

    /// Follows a simulation that goes on with other numbers: the recording goes on too, unless what it shows looks
    /// different from now on. The scale of forces stays.
    pub(crate) fn follow(&mut self, mut cast: Cast) {
        cast.force_scale = self.cast.force_scale;
        if cast.bodies != self.cast.bodies || cast.joints != self.cast.joints {
            self.restart_with(cast);
        }
    }

    /// Starts another recording of a changed scene.
    pub(crate) fn restart_with(&mut self, cast: Cast) {
        self.cast = cast;
        self.restart();
    }

    /// Starts another recording from nothing.
    pub(crate) fn restart(&mut self) {
        self.take += 1;
        self.recorder = None;
        self.waiting.clear();
        self.waiting_bytes = 0;
        self.frames = 0;
        self.encoded = 0;
        self.last = f64::NEG_INFINITY;
        self.hub.restart();
    }

    /// Frames recorded, and those of them encoded.
    pub(crate) fn counts(&self) -> (u64, u64) {
        (self.frames, self.encoded)
    }

    /// Length of a reaction's arrow, m/N.
    pub(crate) fn force_scale(&self) -> f64 {
        self.cast.force_scale
    }

    /// Who watches.
    pub(crate) fn watchers(&self) -> usize {
        self.hub.watchers()
    }
}

/// The cast of a simulation at its start.
pub(crate) fn cast(scene: &Scene, simulation: &mut Simulation) -> Cast {
    let joints = simulation
        .multipliers()
        .into_iter()
        .map(|joint| Tie { name: joint.joint, rows: joint.rows.into_iter().map(|row| row.label).collect() });
    let jacobian = simulation.jacobian();
    let pattern = Pattern {
        rows: jacobian.rows.len(),
        columns: jacobian.columns.len(),
        entries: jacobian.entries.iter().map(|e| (e.row, e.column, e.constant)).collect(),
    };
    Cast::new(scene, simulation.model(), joints.collect(), pattern)
}

/// The simulation at its current time, as it is recorded.
pub(crate) fn sample(simulation: &mut Simulation) -> Sample {
    let frame = simulation.frame();
    let summary = simulation.summary();
    let reactions = simulation.multipliers_between_steps().into_iter().map(|joint| Reaction {
        at: joint.about,
        force: joint.force,
        multipliers: joint.rows.iter().map(|row| row.value).collect(),
    });
    Sample {
        time: simulation.time(),
        poses: frame.bodies.iter().map(|b| Pose { position: b.position, axes: [b.u, b.v, b.w] }).collect(),
        reactions: reactions.collect(),
        energy: summary.energy,
        position_violation: summary.position_violation,
        velocity_violation: summary.velocity_violation,
    }
}

fn full(limit: usize) -> Problem {
    Problem::new(
        StatusCode::INSUFFICIENT_STORAGE,
        "recording-full",
        format!("the recording of this session has reached its {} MiB", limit >> 20),
        "reset the session, or choose a larger simulation.every so that fewer frames are recorded",
    )
}

fn unrecorded(error: RecordError) -> Problem {
    Problem::internal(error)
}
