//! Keeping the constraints, and what can be wrong with them.

mod error;

pub use error::{ConstraintError, quoted};
