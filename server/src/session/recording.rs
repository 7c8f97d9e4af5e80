//! A run on its way to its watchers.
//!
//! Samples wait unencoded until somebody watches. What is wanted drawn in another way is sent again.

use std::sync::Arc;
use std::time::{Duration, Instant};

use triad_session::Streamed;
use triad_session::drawing::{Arrows, Camera};
use triad_session::picture::{Samples, Scale};

use crate::problem::Problem;
use crate::stream::{Hub, RecordError, Recorder, Track};

/// What was sent of one run's samples, to whoever watches.
pub(crate) struct Recording {
    hub: Arc<Hub>,
    /// The samples as the page draws them itself.
    track: Track,
    id: String,
    /// Incremented by each start, so that viewers do not join a recording to the one before.
    generation: u64,
    /// The epoch of the samples that are sent.
    epoch: u64,
    recorder: Option<Recorder>,
    /// How the recorder draws forces.
    drawn: (Arrows, Scale),
    /// From where the recorder looks.
    camera: Camera,
    /// How many of all samples taken are encoded.
    taken: u64,
    encoded: u64,
    /// Bytes of arrows that were drawn again.
    redrawn: usize,
    /// Bytes that what is told in brief may take, and of arrows that were drawn again before the recording is written anew.
    limit: usize,
    /// Of so many samples one is told in brief.
    told_every: usize,
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

impl Recording {
    /// The recording called `id` of samples. What the hub forgets is told in at most about `limit` bytes to who comes later; where
    /// arrows that were drawn again take more, the recording is written anew without the old ones.
    pub(crate) fn new(id: &str, samples: &Samples, hub: Arc<Hub>, track: Arc<Hub>, limit: usize) -> Self {
        let description = samples.description();
        let entities = description.bodies.len() + 2 * description.joints.len() + 2;
        let ticks = u32::try_from(entities / ENTITIES_AT_FULL_RATE).unwrap_or(u32::MAX);
        Self {
            encoded_at: Instant::now(),
            packed_at: Instant::now(),
            pace: TICK.saturating_mul(ticks).clamp(TRACK_PACE, MAX_WAIT),
            track: Track::new(track),
            hub,
            id: id.to_owned(),
            generation: 0,
            epoch: samples.epoch(),
            recorder: None,
            drawn: (samples.arrows().clone(), description.scale),
            camera: samples.camera(),
            taken: 0,
            encoded: 0,
            redrawn: 0,
            limit,
            told_every: 1,
        }
    }

    /// Encodes what waits, if anybody watches and it is time.
    pub(crate) fn encode_in_turn(&mut self, samples: &Samples) -> Result<(), Problem> {
        self.follow(samples)?;
        if self.packed_at.elapsed() >= TRACK_PACE {
            self.packed_at = Instant::now();
            self.track.pack(samples);
        }
        if self.encoded_at.elapsed() < self.pace { Ok(()) } else { self.encode_recording(samples) }
    }

    /// Encodes what waits, if anybody watches.
    pub(crate) fn encode(&mut self, samples: &Samples) -> Result<(), Problem> {
        self.follow(samples)?;
        self.track.pack(samples);
        self.encode_recording(samples)
    }

    /// Begins anew where the samples did, and draws what is encoded as it is wanted now.
    fn follow(&mut self, samples: &Samples) -> Result<(), Problem> {
        if samples.epoch() != self.epoch {
            self.epoch = samples.epoch();
            self.track.restart();
            self.rewrite();
        }
        let scale = samples.description().scale;
        let drawn_alike = self.drawn.0 == *samples.arrows() && self.drawn.1 == scale;
        let looked_at_alike = self.camera == samples.camera();
        self.drawn = (samples.arrows().clone(), scale);
        self.camera = samples.camera();
        let Some(recorder) = &mut self.recorder else { return Ok(()) };
        if !drawn_alike && self.redrawn > self.limit {
            self.rewrite();
            return Ok(());
        }
        if !looked_at_alike {
            recorder.look_from(self.camera).map_err(unrecorded)?;
        }
        if !drawn_alike {
            let sent = samples.among_first(self.taken);
            recorder.redraw(samples.arrows().clone(), scale, sent).map_err(unrecorded)?;
            self.redrawn += self.send(samples)?;
        } else if !looked_at_alike {
            self.send(samples)?;
        }
        Ok(())
    }

    fn encode_recording(&mut self, samples: &Samples) -> Result<(), Problem> {
        if self.hub.watchers() == 0 {
            // Whoever comes next receives all that is kept; until then nothing is, and no threads encode it.
            if self.recorder.is_some() {
                self.rewrite();
            }
            return Ok(());
        }
        let waiting = samples.after(self.taken);
        if waiting.is_empty() && self.recorder.is_some() {
            return Ok(());
        }
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            empty => {
                let new = begun(&self.id, self.generation, samples)?;
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
        self.taken = samples.recorded();
        self.send(samples).map(|_| ())
    }

    /// Hands out what the recorder has written, and says how many bytes that is.
    fn send(&mut self, samples: &Samples) -> Result<usize, Problem> {
        let Some(recorder) = &self.recorder else { return Ok(0) };
        let Some(block) = recorder.block().map_err(unrecorded)? else { return Ok(0) };
        if self.hub.is_full_with(block.len()) {
            let brief = self.brief(samples)?;
            self.hub.shorten(brief);
        }
        let bytes = block.len();
        self.hub.push(block);
        Ok(bytes)
    }

    /// The whole recording so far as one block, in a few large messages; of its samples as many as fit.
    fn brief(&mut self, samples: &Samples) -> Result<Vec<u8>, Problem> {
        loop {
            let told = samples.among_first(self.taken);
            let told: Vec<_> = told.iter().step_by(self.told_every).cloned().collect();
            let mut recorder = begun(&self.id, self.generation, samples)?;
            recorder.write(&told).map_err(unrecorded)?;
            let block = recorder.block().map_err(unrecorded)?.unwrap_or_default();
            if block.len() <= self.limit || told.len() <= 1 {
                return Ok(block);
            }
            self.told_every *= 2;
        }
    }

    /// Starts another recording of the samples that there are.
    fn rewrite(&mut self) {
        self.generation += 1;
        self.recorder = None;
        self.taken = 0;
        self.encoded = 0;
        self.redrawn = 0;
        self.told_every = 1;
        self.hub.restart();
    }

    /// How much is encoded, and who watches.
    pub(crate) fn streamed(&self) -> Streamed {
        Streamed { frames_encoded: self.encoded, watchers: self.hub.watchers() + self.track.watchers() }
    }
}

/// A recording without samples yet that looks as it is wanted.
fn begun(id: &str, generation: u64, samples: &Samples) -> Result<Recorder, Problem> {
    let (id, description) = (format!("{id}-{generation}"), samples.description().clone());
    let scale = description.scale;
    let mut new = Recorder::to_blocks(&id, description).map_err(unrecorded)?;
    new.redraw(samples.arrows().clone(), scale, &[]).map_err(unrecorded)?;
    if samples.camera() != Camera::default() {
        new.look_from(samples.camera()).map_err(unrecorded)?;
    }
    Ok(new)
}

fn unrecorded(error: RecordError) -> Problem {
    Problem::internal(error)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use axum::body::Bytes;
    use rerun::external::re_log_encoding::DecoderApp;
    use rerun::external::re_log_types::StoreKind;
    use rerun::log::{Chunk, LogMsg, TimeColumn};
    use triad_engine::run::Simulation;
    use triad_engine::scene::catalogue;
    use triad_session::change::SceneChange;
    use triad_session::picture::describe;
    use triad_session::{Run, SceneSource};

    use super::*;
    use crate::stream::{Delivery, TIMELINE, Total};

    /// At which times the bodies are told in these blocks, s.
    fn told(blocks: &[impl AsRef<[u8]>]) -> Vec<f64> {
        let mut times = Vec::new();
        for block in blocks {
            for message in DecoderApp::decode_lazy(block.as_ref()) {
                let LogMsg::ArrowMsg(_, chunk) = message.expect("whole") else { continue };
                let chunk = Chunk::from_arrow_msg(&chunk).expect("a chunk");
                let of_bodies = chunk.entity_path().to_string().starts_with("/world/bodies");
                let found = chunk.timelines().get(&TIMELINE.into()).filter(|_| of_bodies);
                times.extend(found.into_iter().flat_map(TimeColumn::times_raw).map(|at| *at as f64 / 1e9));
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    #[test]
    fn who_opens_the_viewer_late_has_the_whole_run_with_fewer_samples() {
        let total = Total::default();
        let [hub, track] = [400_000, 1000].map(|bytes| Arc::new(Hub::new(bytes, total.part())));
        let scene = catalogue::scene("simple-pendulum").expect("built in");
        let source = SceneSource::Builtin("simple-pendulum".into());
        let mut run =
            Run::start("run".into(), scene, &SceneChange::default(), source, 1 << 30).expect("a pendulum");
        let mut recording = Recording::new("run", run.samples(), Arc::clone(&hub), track, 200_000);
        let mut first = hub.watch();
        let mut seen = Vec::new();
        for k in 1..=200 {
            while run.advance(0.05 * f64::from(k)).expect("runs") {}
            recording.encode(run.samples()).expect("encoded");
            if let Some(Delivery::Blocks(blocks)) = first.poll() {
                seen.extend(blocks);
            }
        }
        // The viewer counts nanoseconds.
        let mut all: Vec<f64> =
            run.samples().after(0).iter().map(|sample| (sample.time * 1e9).round() / 1e9).collect();
        all.dedup();
        assert_eq!(told(&seen), all, "who watched from the beginning has every sample");
        let Some(Delivery::Blocks(blocks)) = hub.watch().poll() else { panic!("a recording") };
        let late = told(&blocks);
        let sent: usize = blocks.iter().map(Bytes::len).sum();
        assert!(hub.bytes() == sent && sent < 700_000, "{sent} bytes");
        assert_eq!((late.first(), late.last()), (Some(&0.0), Some(&10.0)));
        let gap = late.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(gap < 0.2 && late.len() < all.len(), "{gap} s apart, {} of {}", late.len(), all.len());
    }

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
