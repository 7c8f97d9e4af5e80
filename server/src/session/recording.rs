//! A simulation and its recording, kept in step.
//!
//! Samples are taken at the scene's own output times and wait unencoded until somebody watches; they are kept, so that
//! forces can be drawn in another way. Where they become too many the older ones are thinned.

use std::sync::Arc;
use std::time::{Duration, Instant};

use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use crate::problem::Problem;
use crate::stream::{
    Arrows, Camera, Hub, JointVisual, Pattern, Pose, RecordError, Recorder, Sample, SampledReaction, Scale,
    SceneDescription, Track,
};

/// Samples of one simulation, kept, and on their way to its watchers.
pub(crate) struct Recording {
    description: SceneDescription,
    arrows: Arrows,
    camera: Camera,
    hub: Arc<Hub>,
    /// The samples as the page draws them itself.
    track: Track,
    id: String,
    /// Incremented by each reset, so that viewers do not join a recording to the one before.
    generation: u64,
    recorder: Option<Recorder>,
    samples: Vec<Sample>,
    /// How many of the samples are encoded.
    samples_encoded: usize,
    /// Bytes of the samples, and how many there may be.
    bytes: usize,
    limit: usize,
    /// Samples taken since the start, kept or not.
    recorded: u64,
    encoded: u64,
    /// Bytes of arrows that were drawn again.
    redrawn: usize,
    /// The scale of forces was taken from the recording.
    fitted: bool,
    /// When blocks were last made.
    encoded_at: Instant,
    /// When frames were last packed.
    packed_at: Instant,
    /// How long to wait until the next blocks.
    pace: Duration,
}

/// Time between two ticks of a playing session: about thirty a second, as smooth as a page draws.
pub(super) const TICK: Duration = Duration::from_millis(33);

/// Between two blocks of frames: less than what a page draws behind the newest state, so that none is missing there.
const TRACK_PACE: Duration = Duration::from_millis(66);
/// Entities that are streamed at each tick; larger scenes are streamed less often. A block costs some kilobytes for
/// each entity, whatever it holds.
const ENTITIES_AT_FULL_RATE: usize = 16;
/// The longest wait between two blocks.
const MAX_WAIT: Duration = Duration::from_millis(500);
/// Samples from which the scale of forces can be taken.
const SAMPLES_FOR_SCALE: usize = 32;
/// Where arrows that were drawn again fill the bound divided by this, the recording is written anew without the old
/// ones.
const REDRAWN_PART: usize = 16;

impl Recording {
    /// The recording of session `id`, which holds about `limit` bytes of samples at most.
    pub(crate) fn new(
        id: &str,
        description: SceneDescription,
        hub: Arc<Hub>,
        track: Arc<Hub>,
        limit: usize,
    ) -> Self {
        let entities = description.bodies.len() + 2 * description.joints.len() + 2;
        let ticks = u32::try_from(entities / ENTITIES_AT_FULL_RATE).unwrap_or(u32::MAX);
        Self {
            encoded_at: Instant::now(),
            packed_at: Instant::now(),
            pace: TICK.saturating_mul(ticks).min(MAX_WAIT),
            track: Track::new(track, description.joints.len()),
            description,
            arrows: Arrows::default(),
            camera: Camera::default(),
            hub,
            id: id.to_owned(),
            generation: 0,
            recorder: None,
            samples: Vec::new(),
            samples_encoded: 0,
            bytes: 0,
            limit,
            recorded: 0,
            encoded: 0,
            redrawn: 0,
            fitted: false,
        }
    }

    /// Records the simulation at its present time, unless that is recorded already; returns whether it was not. Errors
    /// if the viewer's library refuses the scale of forces.
    pub(crate) fn record(&mut self, simulation: &Simulation) -> Result<bool, Problem> {
        if self.samples.last().is_some_and(|last| simulation.time() <= last.time) {
            return Ok(false);
        }
        let sample = sample(simulation);
        self.bytes += sample.size();
        self.samples.push(sample);
        self.recorded += 1;
        if self.bytes > self.limit {
            self.thin();
        }
        if !self.fitted && self.samples.len() >= SAMPLES_FOR_SCALE {
            self.fit(false)?;
        }
        Ok(true)
    }

    /// Drops every second sample of the older half.
    fn thin(&mut self) {
        let half = self.samples.len() / 2;
        let goes = |index: usize| index < half && index % 2 == 1;
        let dropped = |of: usize| (0..of).filter(|&index| goes(index)).count();
        self.samples_encoded -= dropped(self.samples_encoded);
        self.track.thinned(dropped);
        let mut index = 0;
        self.samples.retain(|_| {
            index += 1;
            !goes(index - 1)
        });
        self.bytes = self.samples.iter().map(Sample::size).sum();
    }

    /// Encodes what waits, if anybody watches and it is time.
    pub(crate) fn encode_in_turn(&mut self) -> Result<(), Problem> {
        if self.packed_at.elapsed() >= TRACK_PACE {
            self.packed_at = Instant::now();
            self.track.pack(&self.samples);
        }
        if self.encoded_at.elapsed() < self.pace { Ok(()) } else { self.encode_recording() }
    }

    /// Encodes what waits, if anybody watches.
    pub(crate) fn encode(&mut self) -> Result<(), Problem> {
        self.track.pack(&self.samples);
        self.encode_recording()
    }

    fn encode_recording(&mut self) -> Result<(), Problem> {
        let waiting = &self.samples[self.samples_encoded..];
        if self.hub.watchers() == 0 || (waiting.is_empty() && self.recorder.is_some()) {
            return Ok(());
        }
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            empty => {
                let id = format!("{}-{}", self.id, self.generation);
                let mut new = Recorder::to_blocks(&id, self.description.clone()).map_err(unrecorded)?;
                new.redraw(self.arrows.clone(), self.description.scale, &[]).map_err(unrecorded)?;
                if self.camera != Camera::default() {
                    new.look_from(self.camera).map_err(unrecorded)?;
                }
                // A block of its own: the viewer has the layout before any data.
                if let Some(block) = new.block().map_err(unrecorded)? {
                    self.hub.push(block);
                }
                empty.insert(new)
            }
        };
        self.encoded_at = Instant::now();
        recorder.write(waiting).map_err(unrecorded)?;
        self.encoded += waiting.len() as u64;
        self.samples_encoded = self.samples.len();
        self.send()
    }

    /// Hands out what the recorder has written.
    fn send(&mut self) -> Result<(), Problem> {
        if let Some(recorder) = &self.recorder
            && let Some(block) = recorder.block().map_err(unrecorded)?
        {
            self.hub.push(block);
        }
        Ok(())
    }

    /// Draws forces in another way, at all times.
    pub(crate) fn draw(&mut self, arrows: Arrows) -> Result<(), Problem> {
        if arrows == self.arrows {
            return Ok(());
        }
        self.arrows = arrows;
        self.redraw()
    }

    /// Takes the scale of forces from the recording, unless it would hardly change and is not `wanted`.
    pub(crate) fn fit(&mut self, wanted: bool) -> Result<(), Problem> {
        let scale = self.description.scale.fitted(self.samples.iter(), self.description.size);
        self.fitted = true;
        if scale == self.description.scale || (!wanted && scale.is_near(self.description.scale)) {
            return Ok(());
        }
        self.description.scale = scale;
        self.redraw()
    }

    fn redraw(&mut self) -> Result<(), Problem> {
        let Some(recorder) = &mut self.recorder else { return Ok(()) };
        if self.redrawn > self.limit / REDRAWN_PART {
            self.rewrite();
            return self.encode();
        }
        let before = self.hub.bytes();
        recorder
            .redraw(self.arrows.clone(), self.description.scale, &self.samples[..self.samples_encoded])
            .map_err(unrecorded)?;
        self.send()?;
        self.redrawn += self.hub.bytes().saturating_sub(before);
        Ok(())
    }

    /// Looks at the mechanism from another side.
    pub(crate) fn look_from(&mut self, camera: Camera) -> Result<(), Problem> {
        self.camera = camera;
        let Some(recorder) = &self.recorder else { return Ok(()) };
        recorder.look_from(camera).map_err(unrecorded)?;
        self.send()
    }

    /// Follows a simulation that goes on with other numbers: the recording goes on too, unless what it shows looks
    /// different from now on. The scale of forces stays.
    pub(crate) fn follow(&mut self, mut description: SceneDescription) {
        description.scale = self.description.scale;
        if description.bodies != self.description.bodies || description.joints != self.description.joints {
            self.restart_with(description);
        }
    }

    /// Starts another recording of a changed scene. Its forces are to be compared with those before: they keep their
    /// scale until the recording says otherwise.
    pub(crate) fn restart_with(&mut self, description: SceneDescription) {
        let scale = if self.fitted { self.description.scale } else { description.scale };
        self.description = SceneDescription { scale, ..description };
        self.fitted = false;
        self.restart();
    }

    /// Starts another recording from nothing.
    pub(crate) fn restart(&mut self) {
        self.samples.clear();
        self.bytes = 0;
        self.recorded = 0;
        self.track.restart(self.description.joints.len());
        self.rewrite();
    }

    /// Starts another recording of the samples that there are.
    fn rewrite(&mut self) {
        self.generation += 1;
        self.recorder = None;
        self.samples_encoded = 0;
        self.encoded = 0;
        self.redrawn = 0;
        self.hub.restart();
    }

    /// Frames recorded, and those of them encoded.
    pub(crate) fn counts(&self) -> (u64, u64) {
        (self.recorded, self.encoded)
    }

    /// How forces are drawn.
    pub(crate) fn arrows(&self) -> (&Arrows, Scale) {
        (&self.arrows, self.description.scale)
    }

    /// From where the mechanism is looked at.
    pub(crate) fn camera(&self) -> Camera {
        self.camera
    }

    /// Who watches.
    pub(crate) fn watchers(&self) -> usize {
        self.hub.watchers() + self.track.watchers()
    }
}

/// The description of a simulation at its start.
pub(crate) fn describe(scene: &Scene, simulation: &Simulation) -> SceneDescription {
    let bodies: Vec<String> = simulation.model().bodies.iter().map(|body| body.name.clone()).collect();
    let body = |name: &str| bodies.iter().position(|body| body == name);
    let joints = simulation.multipliers().into_iter().map(|joint| JointVisual {
        on: body(&joint.on),
        by: body(&joint.by),
        name: joint.joint,
        rows: joint.rows.into_iter().map(|row| row.label).collect(),
    });
    let jacobian = simulation.jacobian();
    let pattern = Pattern {
        rows: jacobian.rows.len(),
        columns: jacobian.columns.len(),
        entries: jacobian.entries.iter().map(|e| (e.row, e.column, e.constant)).collect(),
    };
    SceneDescription::new(scene, simulation.model(), joints.collect(), pattern)
}

/// The simulation at its current time, as it is recorded.
pub(crate) fn sample(simulation: &Simulation) -> Sample {
    let frame = simulation.frame();
    let summary = simulation.summary();
    let accelerations = simulation.mass_accelerations();
    let model = simulation.model();
    let weights = model.bodies.iter().map(|body| (model.gravity * body.mass).into()).collect();
    let inertia =
        model.bodies.iter().zip(accelerations).map(|(body, a)| a.map(|part| part * body.mass)).collect();
    let reactions = simulation.multipliers_between_steps().into_iter().map(|joint| SampledReaction {
        at: joint.about,
        force: joint.force,
        moment: joint.moment,
        multipliers: joint.rows.iter().map(|row| row.value).collect(),
    });
    Sample {
        time: simulation.time(),
        poses: frame.bodies.iter().map(|b| Pose { position: b.position, axes: [b.u, b.v, b.w] }).collect(),
        weights,
        inertia,
        reactions: reactions.collect(),
        energy: summary.energy,
        position_violation: summary.position_violation,
        velocity_violation: summary.velocity_violation,
    }
}

fn unrecorded(error: RecordError) -> Problem {
    Problem::internal(error)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use rerun::external::re_log_encoding::DecoderApp;
    use rerun::external::re_log_types::StoreKind;
    use rerun::log::LogMsg;
    use triad_engine::scene::catalogue;

    use super::*;

    /// A viewer that has data and no layout yet lays them out by itself.
    #[test]
    fn the_layout_comes_before_all_data_also_on_a_busy_machine() {
        let scene = catalogue::scene("simple-pendulum").expect("built in");
        let simulation = Simulation::new(&scene).expect("a pendulum");
        let description = describe(&scene, &simulation);
        let done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            for _ in 0..6 {
                scope.spawn(|| {
                    while !done.load(Ordering::Relaxed) {
                        std::hint::spin_loop();
                    }
                });
            }
            let blocks = (0..50).map(|turn| {
                let recorder = Recorder::to_blocks(&turn.to_string(), description.clone())?;
                recorder.block()
            });
            let blocks: Vec<_> = blocks.collect();
            // Whatever fails from here on, the threads end.
            done.store(true, Ordering::Relaxed);
            for block in blocks {
                let block = block.expect("in time").expect("a block");
                let messages =
                    DecoderApp::decode_lazy(block.as_slice()).map(|message| message.expect("whole"));
                let data: Vec<bool> = messages
                    .filter(|message| !matches!(message, LogMsg::SetStoreInfo(_)))
                    .map(|message| message.store_id().kind() == StoreKind::Recording)
                    .collect();
                assert!(data.iter().any(|&data| data), "{data:?}");
                assert!(data.is_sorted(), "{data:?}");
            }
        });
    }
}
