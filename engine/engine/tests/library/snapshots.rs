//! A state that is kept tells what was told then.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::catalogue;
use triad_engine::run::Simulation;

#[test]
fn a_snapshot_tells_what_was_told_then() {
    let mut run = Simulation::new(&catalogue::scene("spatial-slider-crank").unwrap()).unwrap();
    run.advance_to(0.3).unwrap();
    let snapshot = run.snapshot();
    let (then, matrix) = (run.multipliers(), run.jacobian());
    run.advance_to(0.7).unwrap();
    let now = run.multipliers();
    assert_ne!(now, then);
    let looked = run.at_snapshot(&snapshot).unwrap();
    assert_eq!(looked.time(), 0.3);
    let again = looked.multipliers();
    for (a, b) in again.iter().zip(&then) {
        for k in 0..3 {
            assert!((a.force[k] - b.force[k]).abs() < 1e-9 * (1.0 + b.force[k].abs()), "{a:?} {b:?}");
        }
    }
    assert_eq!(looked.jacobian().entries, matrix.entries);
    assert_eq!(run.multipliers(), now, "looking back changes nothing");
    let other = Simulation::new(&catalogue::scene("free-body").unwrap()).unwrap();
    assert!(other.at_snapshot(&snapshot).is_none());
}
