//! From samples to what the rerun viewer shows: one recording a session, encoded once however many watch.
//!
//! ```text
//! Sample ─▶ Recorder ─▶ blocks ─▶ Hub ─▶ Watcher, Watcher, …   (the page, over our own socket)
//!                    └▶ a file, or a native viewer
//! ```

mod hub;
mod sample;
mod vector;

mod scale;

mod description;

mod arrows;
mod geometry;
mod layout;

mod recorder;

pub use arrows::{Arrows, DrawnForces, MomentPoint};
pub use description::{BodyVisual, JointVisual, Pattern, SceneDescription};
pub use hub::{Delivery, Hub, Watcher};
pub use layout::Camera;
pub use recorder::{RecordError, Recorder};
pub use sample::{Pose, Sample, SampledReaction};
pub use scale::Scale;

/// Name under which the viewer knows the recordings.
pub const APPLICATION: &str = "triad";
/// The time line: simulated time.
pub const TIMELINE: &str = "time";
