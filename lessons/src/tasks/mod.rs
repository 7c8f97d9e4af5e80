//! Questions that are answered by work: what a program is given and what it sends, and motions as tables.
//!
//! `instances` are the states of a student, `instances_view` is what a program is given of them, `program_output`
//! reads what it sends, `misconceptions` recognises what went wrong (`wrong_parts` lists it), [`starter`] is a program to begin with;
//! `trajectory` is the reference of a table, `wrong_motions` what usual mistakes make of it, `harmonic` how much of it
//! swings evenly; `authors_model` is what a scene of one's own is compared with.

pub(crate) mod authors_model;
pub(crate) mod grid;
pub(crate) mod harmonic;
pub(crate) mod instances;
pub(crate) mod instances_view;
mod least;
pub(crate) mod misconceptions;
pub(crate) mod program_output;
mod rows;
pub mod starter;
pub(crate) mod trajectory;
pub(crate) mod wrong_motions;
mod wrong_parts;

pub use instances::InstanceError;
pub use instances_view::{
    InstanceBody, InstanceFeature, InstanceNumber, InstanceRow, InstanceState, InstancesView,
};
