//! What a program that simulates needs: `use triad_engine::prelude::*`.
//!
//! ```
//! use triad_engine::prelude::*;
//!
//! let motion = catalogue::scene("heavy-top")?.simulate(0.0..0.1)?;
//! assert_eq!(motion.end(), 0.1);
//! # Ok::<(), EngineError>(())
//! ```

pub use crate::catalogue;
pub use crate::error::EngineError;
pub use crate::model::{CustomLoad, LoadState, Wrench};
pub use crate::run::Simulation;
pub use crate::scene::{
    Body, Coordinates, Driver, Event, Friction, Ground, Inertia, IntegratorKind, Joint, JointKind, Load,
    LoadFrame, Marker, Motion, Quantity, Scene, VectorMotion,
};
pub use crate::solution::{JointReaction, Simulate, Solution, SolutionState};
