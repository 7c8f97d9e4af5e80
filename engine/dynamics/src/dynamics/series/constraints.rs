//! The rows of joints and drivers on series, and the matrix S that their multipliers follow from.

mod vectors;

mod commons;

mod points;

mod rows;

mod angles;

mod prescribed;

mod terms;

mod schur;

pub use angles::{AngleSeries, Angles};
pub use points::{JointPoints, NOWHERE};
pub use prescribed::Prescribed;
pub use rows::Rows;
pub use schur::{CommonPointProduct, Schur};
