//! Run time against error: scenes × integrators × constraint methods × kinds of bodies × tolerances, measured in turns, with
//! references of their own.
//!
//! Times are of integration on one thread, with the estimate of its error unless a scene leaves it out, without assembly and
//! output. Every run is repeated and the repeats of all runs are interleaved, so that a disturbance of the machine falls on all of
//! them alike.

mod measure;
mod plan;
mod plot;
mod reference;
mod report;

pub use measure::{LeftOut, Measured, measure};
pub use plan::{BenchCase, BenchPlan, Method, Wish};
pub use plot::svg;
pub use report::{by_scene, csv, html, table};
