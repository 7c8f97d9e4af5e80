//! Commands on one scene.

pub(in crate::cli) mod analyses;
pub(in crate::cli) mod check;
pub(in crate::cli) mod import;
mod in_order;
mod numbers;
pub(in crate::cli) mod options;
mod report;
pub(in crate::cli) mod run;
pub(in crate::cli) mod source;
mod table;
mod worth;
