//! What a picture of a run is made from: what stays (bodies, joints, scales), and what is recorded of each instant.

mod vector;

mod sample;

mod scale;

mod description;

mod arrows;
mod block;
mod samples;

pub use arrows::{ArrowKind, Glyphs, Piece};
pub use block::{block, frame_size, joints_told};
pub use description::{BodyVisual, JointVisual, MarkerVisual, Pattern, SceneDescription, describe};
pub use sample::{Pose, Sample, SampledReaction, sample};
pub use samples::Samples;
pub use scale::Scale;
