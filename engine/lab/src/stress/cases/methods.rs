//! The methods that are compared with each other, and the cases on which they are.

use super::redundant::swinging;
use super::singular::against_windows;
use crate::stress::build::{DOWN, GROUND, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use triad_scene::{ConstraintMethod, IntegratorKind};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "treatments";
/// Greatest number of steps of a compared run: a method that needs more is of no use.
const STEPS: u64 = 60_000;
/// The same for a method whose steps are expensive.
const DEAR_STEPS: u64 = 12_000;
/// Greatest number of bodies for a method with dense matrices: more takes hours.
const BODIES: usize = 50;

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "pendulum-100-s",
        family: FAMILY,
        summary: "A physical pendulum swings for 100 s: what drifts has time to",
        expected: StressVerdict::Survived,
        quick: true,
        run: pendulum,
    },
    StressCase {
        name: "four-bar-10-s",
        family: FAMILY,
        summary: "Two four-bar windows through ten singular positions",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| against_windows(2, 10.0, method),
    },
];

/// Names of the compared cases: regular, singular, redundant, stiff and fast.
pub const COMPARED: [&str; 12] = [
    "pendulum-100-s",
    "four-bar-10-s",
    "four-bar-horizontal",
    "slider-crank-equal",
    "branch-point-at-rest",
    "bricard",
    "bookshelf",
    "spring-1e6",
    "spring-damped",
    "top",
    "driver-1-khz",
    "friction-smooth",
];

fn pendulum(method: &TrialMethod, _: bool) -> StressOutcome {
    let start = 1.0f64;
    let mut scene = scene("pendulum", DOWN, 100.0, 1e-9);
    scene.bodies.push(rod("rod", 1.0, [0.0; 2], [libm::sin(start), -libm::cos(start)], [0.0; 2], 0.0));
    scene.joints.push(pin("pin", GROUND, "rod", [0.0; 2]));
    swinging(scene, 0, start, method)
}

/// Which method survives what, each with its name: every integrator with projection, then every other method, feedback
/// from weak to strong.
pub fn comparison() -> Vec<(String, TrialMethod)> {
    let projected = [
        IntegratorKind::Taylor,
        IntegratorKind::Dop853,
        IntegratorKind::Dopri5,
        IntegratorKind::Ode45,
        IntegratorKind::Radau,
        IntegratorKind::Rattle,
    ];
    let mut list: Vec<(String, TrialMethod)> = projected
        .into_iter()
        .map(|kind| (format!("{kind}, projection"), with(kind, ConstraintMethod::Projection, STEPS)))
        .collect();
    let explicit = IntegratorKind::Dop853;
    for strength in [0.0, 1.0, 5.0, 20.0, 100.0] {
        let feedback = ConstraintMethod::Baumgarte { alpha: strength, beta: strength };
        list.push((format!("Baumgarte α = β = {strength}/s"), with(explicit, feedback, STEPS)));
    }
    let overdamped = ConstraintMethod::Baumgarte { alpha: 20.0, beta: 5.0 };
    list.push(("Baumgarte α = 20/s, β = 5/s".to_owned(), with(explicit, overdamped, STEPS)));
    for alpha in [1e4, 1e7] {
        let penalty = ConstraintMethod::Penalty { alpha, omega: 10.0, mu: 1.0 };
        list.push((format!("penalty α = {alpha:.0e} kg"), with(explicit, penalty, DEAR_STEPS)));
    }
    let augmented = ConstraintMethod::AugmentedLagrangian { alpha: 1e9 };
    list.push(("augmented Lagrangian".to_owned(), with(IntegratorKind::Trapezoidal, augmented, STEPS)));
    let partitioning = ConstraintMethod::Partitioning;
    list.push(("partitioning, dop853".to_owned(), with(explicit, partitioning, STEPS)));
    list.push(("partitioning, radau".to_owned(), with(IntegratorKind::Radau, partitioning, STEPS)));
    list
}

fn with(integrator: IntegratorKind, constraint_method: ConstraintMethod, steps: u64) -> TrialMethod {
    let sparse =
        matches!(constraint_method, ConstraintMethod::Projection | ConstraintMethod::Baumgarte { .. });
    TrialMethod {
        integrator: Some(integrator),
        constraint_method: Some(constraint_method),
        max_steps: Some(steps),
        max_bodies: (!sparse || integrator == IntegratorKind::Radau).then_some(BODIES),
    }
}
