//! From samples to pictures: one track of numbers and one recording a session, encoded once however many watch. The
//! samples themselves are made in `triad_session::picture`.
//!
//! ```text
//! Sample ─▶ Track ─────▶ blocks ─▶ Hub ─▶ Watcher, Watcher, …   (the page's own drawing, over our own socket)
//!        └▶ Recorder ──▶ blocks ─▶ Hub ─▶ Watcher, …            (the rerun viewer in the page)
//!                     └▶ a file, or a native viewer
//! ```

mod total;

mod hub;

mod geometry;
mod layout;

mod recorder;
mod track;

pub use hub::{Delivery, Hub, Watcher};
pub use recorder::{RecordError, Recorder};
pub use total::{Part, Total};
pub use track::Track;

/// Name under which the viewer knows the recordings.
pub const APPLICATION: &str = "triad";
/// The time line: simulated time.
pub const TIMELINE: &str = "time";
