//! What a student hands in, and how it is read: numbers, units, formulas, tables, and how close is close enough.
//!
//! Formulas are read by `triad_scene::expression`, which also replaces the signs of word processors for all of them.
//! [`number`] and [`units`] read what is typed into a field, `table` reads a file of numbers, [`tolerance`] decides whether numbers are right, and
//! [`submission`] is the whole of it as JSON.

mod dimension;
pub mod number;
pub mod submission;
pub(crate) mod table;
pub mod tolerance;
mod unit_table;
pub mod units;

pub use submission::{Answer, RunSettings, Submission, SubmissionError, TypedValue};
