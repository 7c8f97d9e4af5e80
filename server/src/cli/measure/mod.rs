//! Commands that measure: benchmarks, the tables of the paper, stress.

pub(in crate::cli) mod bench;
pub(in crate::cli) mod paper;
pub(in crate::cli) mod raster;
pub(in crate::cli) mod stress;
pub(in crate::cli) mod sweep;
