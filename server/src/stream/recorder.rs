//! Writes samples into a recording of the rerun viewer, in batches.

use std::collections::HashSet;
use std::path::Path;
use std::time::Duration;

use re_sdk_types::archetypes::{Arrows3D, LineStrips3D, Scalars, Transform3D};
use rerun::log::TimeColumn;
use rerun::sink::BinaryStreamStorage;
use rerun::{
    EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamError, RecordingStreamResult,
};
use triad_session::drawing::{Arrows, Camera};
use triad_session::picture::{Glyphs, Piece, Sample, Scale, SceneDescription};

use super::geometry::{self, FREE_BODY, MARK, color_of, path, single};
use super::{APPLICATION, TIMELINE, layout};

/// Why a recording could not be written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The viewer's library refused.
    #[error("the recording could not be written: {0}")]
    Stream(#[from] RecordingStreamError),
    /// The encoder did not finish in time.
    #[error("the recording could not be flushed: {0}")]
    Flush(String),
}

/// Where a recording goes.
enum Sink {
    /// Blocks for somebody to take.
    Blocks(BinaryStreamStorage),
    /// A file or a viewer, written by the library itself.
    Elsewhere,
}

/// One recording being written.
pub struct Recorder {
    recording: RecordingStream,
    sink: Sink,
    description: SceneDescription,
    arrows: Arrows,
    /// Entities of arrows that have something written.
    used: HashSet<EntityPath>,
    encoded: u64,
}

impl Recorder {
    /// A recording whose blocks are taken with [`Recorder::block`]. `id` tells it from others in one viewer.
    ///
    /// Errors if the viewer's library refuses it.
    pub fn to_blocks(id: &str, description: SceneDescription) -> Result<Self, RecordError> {
        let recording = builder(id, &description).buffered()?;
        let sink = Sink::Blocks(recording.binary_stream());
        Self::start(recording, sink, description)
    }

    /// A recording in a file.
    ///
    /// Errors if the file cannot be written.
    pub fn to_file(file: &Path, id: &str, description: SceneDescription) -> Result<Self, RecordError> {
        let recording = builder(id, &description).save(file)?;
        Self::start(recording, Sink::Elsewhere, description)
    }

    /// A recording in a native viewer that listens at `url`, like `rerun+http://127.0.0.1:9876/proxy`.
    ///
    /// Errors if the address cannot be understood.
    pub fn to_viewer(url: &str, id: &str, description: SceneDescription) -> Result<Self, RecordError> {
        let recording = builder(id, &description).connect_grpc_opts(url)?;
        Self::start(recording, Sink::Elsewhere, description)
    }

    fn start(
        recording: RecordingStream,
        sink: Sink,
        description: SceneDescription,
    ) -> Result<Self, RecordError> {
        layout::send(&recording, &description, Camera::default())?;
        // Layout and data travel by two queues of the library: whichever is handed on first comes first.
        flush(&recording)?;
        geometry::log_static(&recording, &description)?;
        Ok(Self { recording, sink, description, arrows: Arrows::default(), used: HashSet::new(), encoded: 0 })
    }

    /// How many samples have been encoded.
    pub fn encoded(&self) -> u64 {
        self.encoded
    }

    /// Writes samples, which must be in the order of time.
    ///
    /// Errors if the viewer's library refuses them.
    pub fn write(&mut self, samples: &[Sample]) -> Result<(), RecordError> {
        if samples.is_empty() {
            return Ok(());
        }
        self.write_bodies(samples)?;
        self.write_joints(samples)?;
        self.write_arrows(samples)?;
        self.write_mark(samples)?;
        self.write_series("plots/energy", samples, |s| [s.energy])?;
        self.write_series("plots/violation", samples, |s| [s.position_violation, s.velocity_violation])?;
        self.encoded += samples.len() as u64;
        Ok(())
    }

    fn write_bodies(&self, samples: &[Sample]) -> RecordingStreamResult<()> {
        for (index, body) in self.description.bodies.iter().enumerate() {
            let poses = || samples.iter().map(|sample| sample.poses[index]);
            let columns = Transform3D::update_fields()
                .with_many_translation(poses().map(|pose| single(pose.position)))
                .with_many_mat3x3(poses().map(|pose| pose.axes.map(single)))
                .columns_of_unit_batches()?;
            self.recording.send_columns(path(&["world", "bodies", &body.name]), [times(samples)], columns)?;
        }
        Ok(())
    }

    fn write_joints(&self, samples: &[Sample]) -> RecordingStreamResult<()> {
        let joints = &self.description.joints;
        let known: Vec<&Sample> = samples.iter().filter(|s| s.reactions.len() == joints.len()).collect();
        if known.is_empty() {
            return Ok(());
        }
        let time = || TimeColumn::new_duration_secs(TIMELINE, known.iter().map(|sample| sample.time));
        for (index, joint) in joints.iter().enumerate() {
            let reactions = || known.iter().map(|sample| &sample.reactions[index]);
            let rows = joint.rows.len();
            let values = reactions()
                .flat_map(|r| (0..rows).map(|k| r.multipliers.get(k).copied().unwrap_or(f64::NAN)));
            let columns = Scalars::new(values).columns(vec![rows; known.len()])?;
            self.recording.send_columns(path(&["plots", "multipliers", &joint.name]), [time()], columns)?;
        }
        Ok(())
    }

    /// Draws forces and the mark in another way, also those that were drawn already: what is written last counts.
    ///
    /// Errors as [`Self::write`] does.
    pub fn redraw(&mut self, arrows: Arrows, scale: Scale, samples: &[Sample]) -> Result<(), RecordError> {
        let alike = self.arrows.draw_as(&arrows) && self.description.scale == scale;
        self.description.scale = scale;
        self.arrows = arrows;
        if !alike {
            self.write_arrows(samples)?;
        }
        self.write_mark(samples)?;
        Ok(())
    }

    /// Looks at the mechanism from another side.
    ///
    /// Errors as [`Self::write`] does.
    pub fn look_from(&self, camera: Camera) -> Result<(), RecordError> {
        layout::send(&self.recording, &self.description, camera)?;
        flush(&self.recording)
    }

    fn write_arrows(&mut self, samples: &[Sample]) -> RecordingStreamResult<()> {
        for index in 0..self.description.joints.len() {
            let drawn: Vec<Glyphs> =
                samples.iter().map(|sample| self.arrows.of_joint(&self.description, index, sample)).collect();
            let (pieces, circles): (Vec<_>, Vec<_>) =
                drawn.into_iter().map(|glyphs| (glyphs.pieces, glyphs.circles)).unzip();
            let name = self.description.joints[index].name.clone();
            self.write_pieces(path(&["world", "joints", &name]), samples, &pieces)?;
            self.write_circles(path(&["world", "joints", &name, "moment"]), samples, circles)?;
        }
        let of_body: Vec<_> =
            samples.iter().map(|sample| self.arrows.of_body(&self.description, sample)).collect();
        self.write_pieces(FREE_BODY.into(), samples, &of_body)
    }

    fn write_mark(&mut self, samples: &[Sample]) -> RecordingStreamResult<()> {
        let drawn = samples.iter().map(|sample| self.arrows.mark(&self.description, sample)).collect();
        self.write_circles(MARK.into(), samples, drawn)
    }

    /// Whether there is nothing to write of an entity: no sample, or nothing now and nothing before that would stay.
    fn is_idle<T>(&mut self, entity: &EntityPath, drawn: &[Vec<T>]) -> bool {
        if drawn.iter().any(|of_sample| !of_sample.is_empty()) {
            self.used.insert(entity.clone());
        }
        drawn.is_empty() || !self.used.contains(entity)
    }

    fn write_circles(
        &mut self,
        entity: EntityPath,
        samples: &[Sample],
        drawn: Vec<Vec<Vec<[f64; 3]>>>,
    ) -> RecordingStreamResult<()> {
        if self.is_idle(&entity, &drawn) {
            return Ok(());
        }
        let counts: Vec<usize> = drawn.iter().map(Vec::len).collect();
        let strips =
            drawn.into_iter().flatten().map(|points| points.into_iter().map(single).collect::<Vec<_>>());
        let columns = LineStrips3D::update_fields().with_strips(strips).columns(counts)?;
        self.recording.send_columns(entity, [times(samples)], columns)
    }

    fn write_pieces(
        &mut self,
        entity: EntityPath,
        samples: &[Sample],
        drawn: &[Vec<Piece>],
    ) -> RecordingStreamResult<()> {
        if self.is_idle(&entity, drawn) {
            return Ok(());
        }
        let counts: Vec<usize> = drawn.iter().map(Vec::len).collect();
        let all = || drawn.iter().flatten();
        let columns = Arrows3D::update_fields()
            .with_origins(all().map(|piece| single(piece.from)))
            .with_vectors(all().map(|piece| single(piece.vector)))
            .with_colors(all().map(|piece| color_of(piece.kind)))
            .columns(counts)?;
        self.recording.send_columns(entity, [times(samples)], columns)
    }

    /// One value or several of each sample, as lines of one plot.
    fn write_series<const N: usize>(
        &self,
        entity: &str,
        samples: &[Sample],
        values: impl Fn(&Sample) -> [f64; N],
    ) -> RecordingStreamResult<()> {
        let columns = Scalars::new(samples.iter().flat_map(values)).columns(vec![N; samples.len()])?;
        self.recording.send_columns(entity, [times(samples)], columns)
    }

    /// Everything written since the last call, as one complete block; nothing if the recording goes elsewhere.
    ///
    /// Errors if the encoder does not finish in time.
    pub fn block(&self) -> Result<Option<Vec<u8>>, RecordError> {
        self.flush()?;
        Ok(match &self.sink {
            Sink::Blocks(storage) => storage.read(),
            Sink::Elsewhere => None,
        })
    }

    /// Waits until everything written has left this process or reached the disk.
    ///
    /// Errors if that takes longer than ten seconds.
    pub fn flush(&self) -> Result<(), RecordError> {
        flush(&self.recording)
    }
}

fn flush(recording: &RecordingStream) -> Result<(), RecordError> {
    recording
        .flush_with_timeout(Duration::from_secs(10))
        .map_err(|error| RecordError::Flush(error.to_string()))
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if let Sink::Blocks(storage) = &self.sink {
            // Blocks that nobody will take; the library would complain about them.
            if self.recording.flush_with_timeout(Duration::from_secs(1)).is_ok() {
                storage.read();
            }
        }
    }
}

fn builder(id: &str, description: &SceneDescription) -> RecordingStreamBuilder {
    RecordingStreamBuilder::new(APPLICATION).recording_id(id).recording_name(description.title.clone())
}

fn times(samples: &[Sample]) -> TimeColumn {
    TimeColumn::new_duration_secs(TIMELINE, samples.iter().map(|sample| sample.time))
}
