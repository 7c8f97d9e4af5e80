//! Motion, forces and analyses of mechanisms of rigid bodies, in fully Cartesian coordinates with a generic rigid body.
//!
//! ```
//! use triad_engine::prelude::*;
//!
//! fn main() -> Result<(), EngineError> {
//!     let mut scene = Scene::new("pendulum").gravity([0.0, -9.81, 0.0]);
//!     let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
//!     let pin = scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
//!     let motion = scene.simulate(0.0..5.0)?;
//!     for t in motion.every(0.01) {
//!         println!("{t} {:?} {:?}", motion.at(t)?.position(&rod)?, motion.reaction(&pin, t)?.force);
//!     }
//!     println!("energy drift {:.1e} J", motion.energy_drift());
//! #   assert!(motion.energy_drift().abs() < 1e-7);
//!     Ok(())
//! }
//! ```
//!
//! # Where to begin
//!
//! | task | where |
//! |---|---|
//! | write a mechanism, in Rust or JSON | [`scene`], examples in [`catalogue`] |
//! | know why a scene cannot be | [`model`] and [`EngineError`] |
//! | run it and ask about any moment | [`solution`] |
//! | run it step by step, change it, stop it | [`run`] |
//! | forces in joints, and which are unique | [`reactions`] |
//! | equilibrium, vibrations, driven motion, assembly | [`analysis`] |
//! | the equations | [`theory`] |
//!
//! SI units, radians, right-handed axes; equation numbers, as in eq. (7.3), refer to [`theory`]. Pure computation: no
//! clocks, files, threads or logging; the same scene gives the same bits. The modules stand in reading order, from what
//! an author writes to what a run tells. Those that are not listed here serve the project's own pictures and tests, and
//! may change at any time.

#[doc(hidden)]
pub use triad_dynamics::{constraints, dynamics, equations, newton, ode, state, system};

#[doc(inline)]
pub use triad_dynamics::model;
#[doc(inline)]
pub use triad_scene as scene;
#[doc(inline)]
pub use triad_scene::catalogue;

pub mod reactions;

#[doc(hidden)]
pub mod integrate;

mod error;

pub mod run;

pub mod solution;

pub mod analysis;

pub mod prelude;

pub mod theory;

pub use error::{Cause, EngineError, LastGood};
pub use scene::Scene;
pub use solution::{Simulate, Solution};

/// Version of the engine, recorded with every grade.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
