//! The paper's own runs, with its own settings: the counts of its Table 1.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use triad_lab::paper::{CASES, LinearAlgebra, PaperCase, PaperSystem, correlation, reference, run};
use triad_scene::Coordinates::{Full, Reduced};

fn case(bodies: usize, withheld: bool) -> &'static PaperCase {
    CASES.iter().find(|c| c.bodies == bodies && c.withheld.is_some() == withheld).unwrap()
}

/// Steps, of which one may fail or not by the last bit of a power in the control of steps.
const ONE_STEP: u64 = 1;

/// Where the paper gives all data, our counts are its counts, but for one step.
fn counts_are_equal(bodies: usize) {
    let case = case(bodies, false);
    for (coordinates, wanted) in [(Reduced, case.published.reduced), (Full, case.published.full)] {
        let ours = run(case, coordinates, LinearAlgebra::Sparse).unwrap().counts;
        let near = |a: u64, b: u64, most: u64| a.abs_diff(b) <= most;
        assert!(
            near(ours.steps, wanted.steps, ONE_STEP)
                && near(ours.failed, wanted.failed, ONE_STEP)
                && near(ours.evaluations, wanted.evaluations, 6 * ONE_STEP),
            "{}: {ours:?} {wanted:?}",
            case.name
        );
    }
}

#[test]
fn the_simple_pendulum_takes_the_papers_steps() {
    counts_are_equal(1);
}

#[test]
fn the_double_four_bar_takes_the_papers_steps() {
    counts_are_equal(5);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "a minute without optimization: cargo test --release")]
fn thirty_nine_bodies_take_the_papers_steps() {
    counts_are_equal(39);
}

/// Leaving out zeros changes not a bit, and the engine's own elimination gives the same accelerations.
#[test]
fn all_linear_algebra_agrees() {
    let case = case(5, false);
    for coordinates in [Full, Reduced] {
        let [dense, sparse, own] = [LinearAlgebra::Dense, LinearAlgebra::Sparse, LinearAlgebra::Elimination]
            .map(|algebra| {
                let mut plant = PaperSystem::new(case, coordinates, algebra).unwrap();
                let y = plant.start().to_vec();
                let mut rate = vec![0.0; y.len()];
                assert!(plant.rate(&y, &mut rate));
                rate
            });
        assert_eq!(dense, sparse);
        let largest = dense.iter().zip(&own).fold(0.0f64, |a, (x, y)| a.max((x - y).abs()));
        assert!(largest < 1e-10, "{largest}");
    }
}

/// Full, reduced and reference agree in the paper's sense, and not more than its loose tolerance allows.
#[test]
fn the_pendulum_correlates_with_its_reference() {
    let case = case(1, false);
    let [full, reduced] =
        [Full, Reduced].map(|coordinates| run(case, coordinates, LinearAlgebra::Sparse).unwrap().tracked);
    let reference = reference(case).unwrap();
    assert_eq!((full.len(), reduced.len(), reference.len()), (1001, 1001, 1001));
    let found = correlation(&[&full, &reduced, &reference]).unwrap();
    assert!(found.agreement > 0.999 && found.agreement < 1.0 - 1e-9, "{found:?}");
}
