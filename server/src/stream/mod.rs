//! From samples to pictures: one track of numbers and one recording a session, encoded once however many watch.
//!
//! ```text
//! Sample ─▶ Track ─────▶ blocks ─▶ Hub ─▶ Watcher, Watcher, …   (the page's own drawing, over our own socket)
//!        └▶ Recorder ──▶ blocks ─▶ Hub ─▶ Watcher, …            (the rerun viewer in the page)
//!                     └▶ a file, or a native viewer
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
mod track;

pub use arrows::{Arrows, DrawnForces, MomentPoint};
pub use description::{BodyVisual, JointVisual, Pattern, SceneDescription};
pub use hub::{Delivery, Hub, Watcher};
pub use layout::Camera;
pub use recorder::{RecordError, Recorder};
pub use sample::{Pose, Sample, SampledReaction};
pub use scale::Scale;
pub use track::{Track, block};

/// Name under which the viewer knows the recordings.
pub const APPLICATION: &str = "triad";
/// The time line: simulated time.
pub const TIMELINE: &str = "time";
