//! The stress suite: scenes that try to break the engine, each judged against a reference or an invariant of its own.
//!
//! A run that merely ends proves nothing. A case counts as *survived* only if what it computed agrees with a solution
//! that was found without this engine (a motion of one degree of freedom, a closed form), or keeps an invariant of the
//! mechanism (energy, momentum, equal answers in other coordinates, the way back in time). Pure, like the rest of the
//! engine: bounded by steps instead of clocks, and the same on every machine.

mod build;

mod case;

mod oracle;

mod trial;

mod cases;

pub mod random;

pub mod shrink;

pub use case::{CaseReport, StressCase, StressOutcome, StressVerdict, TrialMethod};
pub use cases::{all as cases, comparison};
pub use trial::Trial;

use case::judged;

/// The cases on which methods are compared.
pub fn compared() -> Vec<StressCase> {
    let all = cases();
    let named = |name: &&str| all.iter().find(|case| case.name == *name).copied();
    cases::COMPARED.iter().filter_map(named).collect()
}

/// Runs a case. A panic is caught and counts as wrong.
pub fn run(case: &StressCase, method: &TrialMethod, quick: bool) -> CaseReport {
    let outcome = judged(|| (case.run)(method, quick));
    CaseReport {
        case: case.name.to_owned(),
        family: case.family.to_owned(),
        summary: case.summary.to_owned(),
        expected: case.expected,
        outcome,
    }
}
