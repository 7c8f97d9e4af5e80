//! What leaves a gradebook and comes into one: copies of the whole, of one course, of one person's data.

mod backup;
mod export;
mod import;
mod person;
mod tables;
#[cfg(test)]
pub(in crate::store) mod tests;

pub use backup::{Copied, restore};
pub use export::Pieces;
pub use import::Imported;
pub use person::OwnEvent;
#[cfg(test)]
pub(in crate::store) use tables::{LEFT, OF_COURSE};
