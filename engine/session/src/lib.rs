#![doc = include_str!("../README.md")]
#![allow(clippy::missing_errors_doc)] // said in a sentence: the crate serves the workbench

pub mod refusal;

pub mod bounds;

pub mod drawing;

pub mod picture;

pub mod change;

mod accuracy;

mod history;

mod happened;

mod state;

mod kept;

pub mod matrices;

pub mod forces;

pub mod requests;

mod run;

pub use happened::Happened;
pub use kept::KeptSession;
pub use run::{Run, Streamed};
pub use state::{Drawing, Links, SceneSource, SessionBody, SessionMessage, SessionState};
