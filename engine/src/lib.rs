//! Rigid mechanisms in fully Cartesian coordinates with a generic rigid body: the formulation and its analyses.
//!
//! Pure computation: no clocks, files, threads or logging; the same scene gives the same bits. The modules stand in
//! reading order, from what an author writes to what a run tells. Equation numbers refer to `THEORY.md`.
//!
//! ```
//! use triad_engine::{catalogue, simulation::Simulation};
//!
//! let scene = catalogue::scene("simple-pendulum")?;
//! let mut pendulum = Simulation::new(&scene)?;
//! pendulum.advance_to(1.0)?;
//! assert!(pendulum.summary().energy_drift.abs() < 1e-7);
//! # Ok::<(), triad_engine::EngineError>(())
//! ```

pub use triad_scene as scene;
pub use triad_scene::catalogue;

pub mod motion;

pub mod model;

pub mod lift;

pub mod sharing;

pub mod feature;

pub mod angle;

pub mod row;

pub mod writer;

pub mod joint;

pub mod driver;

pub mod load;

pub mod body;

pub mod system;

pub mod pace;

pub mod elimination;

pub mod equations;

pub mod jacobian;

pub mod literal;

pub mod parts;

pub mod plane;

pub mod matrices;

pub mod series;

pub mod constraints;

pub mod rank;

pub mod tangent;

pub mod uniqueness;

pub mod reaction;

pub mod trust;

pub mod integrate;

pub mod mechanism;

pub mod balance;

pub mod event;
pub mod passage;

pub mod simulation;

pub mod check;

pub mod analysis;

mod error;

pub use error::{Cause, EngineError, LastGood};
pub use scene::Scene;

/// Version of the engine, recorded with every grade.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
