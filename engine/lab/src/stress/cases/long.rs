//! Long runs: what drifts, and how fast.

use crate::stress::build::{DOWN, GROUND, body, distance, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use nalgebra::Vector3;
use triad_engine::run::Simulation;

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "long";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "pendulum-2000-s",
        family: FAMILY,
        summary: "A rod swings for 2000 s; quick: 100 s",
        expected: StressVerdict::Survived,
        quick: true,
        run: pendulum,
    },
    StressCase {
        name: "free-body-turns",
        family: FAMILY,
        summary: "A free asymmetric body turns about a general axis 1e5 times; quick: a thousand times",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, quick| free_body([1.0, 2.0, 0.5], quick, method),
    },
    StressCase {
        name: "intermediate-axis-turns",
        family: FAMILY,
        summary: "The same about its intermediate axis: it flips over and over",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, quick| free_body([1e-3, 2.0, 1e-3], quick, method),
    },
    StressCase {
        name: "chain-of-ten",
        family: FAMILY,
        summary: "A chain of ten rods for 1000 s; quick: 5 s",
        expected: StressVerdict::Survived,
        quick: true,
        run: chain,
    },
];

fn pendulum(method: &TrialMethod, quick: bool) -> StressOutcome {
    let seconds = if quick { 100.0 } else { 2000.0 };
    let start = 2.0f64;
    let mut scene = scene("pendulum", DOWN, seconds, 1e-10);
    scene.bodies.push(rod("rod", 1.0, [0.0; 2], [libm::sin(start), -libm::cos(start)], [0.0; 2], 0.0));
    scene.joints.push(pin("pin", GROUND, "rod", [0.0; 2]));
    let mut exact = OneDegree::new(start, 0.0, |a: f64, _| -1.5 * 9.81 * libm::sin(a));
    Trial::new(scene, method)
        .against("exact motion of a physical pendulum", (1e-8 * seconds, 1e-2), move |run| {
            let (angle, _) = exact.at(run.time());
            distance(&run.frame(), 0, [0.5 * libm::sin(angle), -0.5 * libm::cos(angle), 0.0])
        })
        .conserving((1e-10 * seconds.max(1e3), 1e-3))
        .within(2_000_000)
        .run()
}

fn free_body(omega: [f64; 3], quick: bool, method: &TrialMethod) -> StressOutcome {
    let turns = if quick { 1e3 } else { 1e5 };
    let speed = Vector3::from(omega).norm();
    let mut scene = scene("free-body", [0.0; 3], turns * std::f64::consts::TAU / speed, 1e-10);
    let principal = [1.0, 2.0, 2.8];
    let mut free = body("body", 1.0, principal, [0.0; 3]);
    free.angular_velocity = omega;
    free.velocity = [1e-3, 0.0, 0.0];
    scene.bodies.push(free);
    let mut start = None;
    let momentum = move |run: &Simulation| -> Vector3<f64> {
        let shown = run.frame().bodies[0];
        let omega = Vector3::from(shown.angular_velocity);
        [shown.u, shown.v, shown.w]
            .iter()
            .zip(principal)
            .map(|(axis, moment)| {
                let axis = Vector3::from(*axis);
                axis * (moment * axis.dot(&omega))
            })
            .sum()
    };
    Trial::new(scene, method)
        .against("angular momentum in the world", (1e-9 * turns, 1e-2), move |run| {
            let now = momentum(run);
            let start = start.get_or_insert(now);
            (now - *start).norm() / start.norm()
        })
        .conserving((1e-9 * turns, 1e-2))
        .within(10_000_000)
        .run()
}

fn chain(method: &TrialMethod, quick: bool) -> StressOutcome {
    let seconds = if quick { 5.0 } else { 1000.0 };
    let mut scene = scene("chain", DOWN, seconds, 1e-9);
    for i in 0..10 {
        let x = f64::from(i);
        let name = format!("rod-{i}");
        scene.bodies.push(rod(&name, 1.0, [x, 0.0], [x + 1.0, 0.0], [0.0; 2], 0.0));
        let above = if i == 0 { GROUND.to_owned() } else { format!("rod-{}", i - 1) };
        scene.joints.push(pin(&format!("pin-{i}"), &above, &name, [x, 0.0]));
    }
    // Chaotic: no two solutions agree for long. Energy and closure are what remains.
    Trial::new(scene, method).conserving((1e-8 * seconds.max(10.0), 1e-2)).within(3_000_000).run()
}
