//! When an exercise of a class can be handed in, what an attempt is then worth, and what its verdict tells.
//!
//! All of it follows from what is kept by pure functions, so that it can be asked for any person and any time: whoever
//! edits a policy sees what it does before it counts.

mod admission;
mod moment;
mod rules;
mod standing;
#[cfg(test)]
mod tests;

pub use admission::{Refusal, admit};
pub use moment::Moment;
pub use rules::{Extension, InvalidPolicy, LateStep, Policy, Reveal, Times, When, wrong_date};
pub use standing::{Case, Credit, Decided, Handed, Phase, Revealed, Score, Standing, Turn, standing};
