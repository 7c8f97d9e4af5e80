//! The formulation and its equations: fully Cartesian coordinates with a generic rigid body.
//!
//! The modules stand in reading order; each imports only what stands before it.
//! Equation numbers refer to `THEORY.md`.

pub use triad_scene as scene;

pub mod model;

pub mod system;

pub mod state;

pub mod equations;

pub mod newton;

pub mod dynamics;

pub mod ode;

pub mod constraints;
