//! The cases, one file a family.

mod redundant;

mod singular;

mod scales;

mod stiff;

mod long;

mod large;

mod starts;

mod methods;

pub use methods::{COMPARED, comparison};

use crate::stress::case::StressCase;

/// All cases, in the order of the report.
pub fn all() -> Vec<StressCase> {
    [
        singular::CASES,
        redundant::CASES,
        scales::CASES,
        stiff::CASES,
        long::CASES,
        large::CASES,
        starts::CASES,
        methods::CASES,
    ]
    .concat()
}
