//! The stress suite, in release at its full sizes: verdicts are as they have to be, the same seed gives the same bits, and random
//! mechanisms keep their invariants.

use triad_lab::stress::{self, StressVerdict, TrialMethod};

/// Without optimization only the smaller and shorter cases run.
const QUICK: bool = cfg!(debug_assertions);

#[test]
fn every_case_goes_as_it_has_to() {
    for case in &stress::cases() {
        let entry = stress::run(case, &TrialMethod::default(), QUICK);
        assert!(entry.as_expected(), "{}: {:?}: {}", entry.case, entry.outcome.verdict, entry.outcome.reason);
    }
}

#[test]
fn names_of_cases_are_unique() {
    let mut names: Vec<&str> = stress::cases().iter().map(|case| case.name).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn a_seed_means_the_same_bits() {
    let once = stress::random::run(7, &TrialMethod::default());
    let again = stress::random::run(7, &TrialMethod::default());
    assert_eq!(serde_json::to_string(&once).unwrap(), serde_json::to_string(&again).unwrap());
}

#[test]
fn random_mechanisms_are_never_silently_wrong() {
    let seeds = if QUICK { 15 } else { 2000 };
    for seed in 0..seeds {
        let entry = stress::random::run(seed, &TrialMethod::default());
        let outcome = entry.outcome;
        assert!(
            outcome.verdict < StressVerdict::Wrong,
            "seed {seed} ({}): {}",
            entry.summary,
            outcome.reason
        );
    }
}

#[test]
fn no_treatment_is_silently_wrong() {
    let cases = stress::cases();
    for name in ["slider-crank-equal", "micrometre"] {
        let case = cases.iter().find(|case| case.name == name).unwrap();
        for (method, how) in stress::comparison() {
            let outcome = stress::run(case, &how, true).outcome;
            assert!(outcome.verdict < StressVerdict::Wrong, "{name}, {method}: {}", outcome.reason);
        }
    }
}
