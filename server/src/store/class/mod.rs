//! What people of a class set, allow and decide: assignments, decisions, regrades.

pub(super) mod assignments;
mod decisions;
pub(super) mod members;
mod regrades;

pub use assignments::Assignment;
pub use decisions::{Decision, DecisionKind, HandedRow, Said};
pub use regrades::{NewRegrade, NewVerdict, RegradeRow, Regraded, Ruled, VerdictHistory};
