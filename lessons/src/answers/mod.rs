//! What a student hands in, and how it is read: numbers, units, formulas, tables, and how close is close enough.
//!
//! The engine's `expression` puts whatever is typed into one plain notation and reads formulas. [`number`] and [`units`] read
//! what is typed into a field (`factors`: calculations with units), `array` a whole vector or matrix (`enclosed`: what stands around its
//! brackets), `table` a file of numbers; [`tolerance`] decides whether numbers are right, and [`submission`] is the whole of it as JSON.

pub(crate) mod array;
pub mod diagram;
mod dimension;
mod enclosed;
mod factors;
pub mod number;
pub mod submission;
pub(crate) mod table;
pub mod tolerance;
pub mod units;

pub use diagram::Arrow;
pub use submission::{Answer, RunSettings, Submission, SubmissionError, TypedValue};
