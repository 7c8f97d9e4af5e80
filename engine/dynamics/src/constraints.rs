//! Keeping the constraints, and what can be wrong with them.

mod error;

pub mod violation;

mod changed;

mod given;

pub mod mechanism;

pub mod rough;

pub mod start;

pub mod geometry;

pub mod branch;

pub mod rank;

pub mod tangent;

pub mod turns;

pub use error::{ConstraintError, quoted};
