//! The class: who is in it, coming in, and what everybody has reached.

pub(in crate::api) mod analysis;
pub(in crate::api) mod assignments;
pub(in crate::api) mod exchange;
pub(in crate::api) mod glance;
pub(in crate::api) mod grades;
pub(in crate::api) mod people;
pub(in crate::api) mod records;
pub(in crate::api) mod regrades;
pub(in crate::api) mod sign_in;
pub(in crate::api) mod standing;
