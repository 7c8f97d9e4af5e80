//! Rigid mechanisms in fully Cartesian coordinates with a generic rigid body: the formulation and its analyses.
//!
//! Pure computation: no clocks, files, threads or logging; the same scene gives the same bits. The modules stand in
//! reading order, from what an author writes to what a run tells. Equation numbers refer to `THEORY.md`.
//!
//! ```
//! use triad_engine::{catalogue, run::Simulation};
//!
//! let scene = catalogue::scene("simple-pendulum")?;
//! let mut pendulum = Simulation::new(&scene)?;
//! pendulum.advance_to(1.0)?;
//! assert!(pendulum.summary().energy_drift.abs() < 1e-7);
//! # Ok::<(), triad_engine::EngineError>(())
//! ```

pub use triad_dynamics::{constraints, dynamics, equations, model, state, system};
pub use triad_scene as scene;
pub use triad_scene::catalogue;

pub mod reactions;

pub mod integrate;

pub mod run;

pub mod analysis;

mod error;

pub use error::{Cause, EngineError, LastGood};
pub use scene::Scene;

/// Version of the engine, recorded with every grade.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
