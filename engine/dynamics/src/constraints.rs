//! Keeping the constraints, and what can be wrong with them.

mod error;

pub mod violation;

pub mod mechanism;

pub mod rank;

pub mod tangent;

pub use error::{ConstraintError, quoted};
