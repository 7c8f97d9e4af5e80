//! Random mechanisms: a seed is a case.
//!
//! A tree of bodies on random joints, closed by random loops, with random loads and drivers. Positions are consistent
//! by construction, velocities are not. There is no reference solution; there are invariants that every mechanism has.

mod draw;
mod invariants;

pub use draw::scene;
pub use invariants::judge;

use super::case::{CaseReport, RANDOM_FAMILY, StressVerdict, TrialMethod, judged};

/// Draws, runs and judges the mechanism of a seed. A panic is caught and counts as wrong.
pub fn run(seed: u64, method: &TrialMethod) -> CaseReport {
    let scene = scene(seed);
    let outcome = judged(|| judge(&scene, method));
    CaseReport {
        case: format!("seed-{seed}"),
        family: RANDOM_FAMILY.to_owned(),
        summary: format!(
            "{} bodies, {} joints, {} drivers, {} loads",
            scene.bodies.len(),
            scene.joints.len(),
            scene.drivers.len(),
            scene.loads.len()
        ),
        // A driver may ask for more than drawn loops allow.
        expected: if scene.drivers.is_empty() { StressVerdict::Degraded } else { StressVerdict::Refused },
        outcome,
    }
}
