//! The formulation: rows, Jacobians, accelerations, multipliers and reactions, at single states.

#[path = "../common/mod.rs"]
mod common;

mod augmented;
mod check_vectors;
mod in_plane;
mod matrices;
mod newton;
mod prescribed;
mod reactions;
mod rows;
mod shared;
mod steps;
mod turns;
