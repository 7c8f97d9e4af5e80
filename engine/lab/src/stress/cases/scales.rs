//! Masses, lengths and inertias of very different sizes.

use super::redundant::swinging;
use crate::stress::build::{DOWN, GROUND, body, distance, joint, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use triad_linalg::larger_or_nan;
use triad_scene::{Inertia, JointKind};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "scales";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "mass-ratios-down",
        family: FAMILY,
        summary: "A chain of ten, each body a hundred times lighter than the one above: 1 to 1e-18 kg",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| chain(1e-2, method),
    },
    StressCase {
        name: "mass-ratios-up",
        family: FAMILY,
        // The heavy end makes the light links vibrate at megahertz: no explicit method can follow.
        summary: "A chain of ten, each body a hundred times heavier than the one above: 1e-9 to 1e9 kg",
        expected: StressVerdict::Refused,
        quick: true,
        run: |method, _| chain(1e2, method),
    },
    StressCase {
        name: "micrometre",
        family: FAMILY,
        summary: "A pendulum of one micrometre and one picogram",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| pendulum(1e-6, 1e-15, method),
    },
    StressCase {
        name: "kilometre",
        family: FAMILY,
        summary: "A pendulum of ten kilometres and a million tonnes",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| pendulum(1e4, 1e9, method),
    },
    StressCase {
        name: "all-sizes",
        family: FAMILY,
        summary: "Pendulums from a micrometre to a kilometre side by side in one scene",
        expected: StressVerdict::Survived,
        quick: true,
        run: all_sizes,
    },
    StressCase {
        name: "massless-axes",
        family: FAMILY,
        summary: "A lamina, a slender rod without axial inertia and a point mass, each as a pendulum",
        expected: StressVerdict::Survived,
        quick: true,
        run: thin,
    },
    StressCase {
        name: "triangle-limit",
        family: FAMILY,
        summary: "Free bodies whose moments are at the limit of the triangle inequality, spinning",
        expected: StressVerdict::Survived,
        quick: true,
        run: triangle,
    },
];

/// A chain of ten rods let go from the horizontal; the ratio of successive masses is given.
///
/// Half a second: later the whip of light tails is chaotic. At 0.8 s runs still agree to a thousand tolerances, at 1 s
/// two integrators at a tolerance of 1e-13 differ by metres at the tip.
fn chain(ratio: f64, method: &TrialMethod) -> StressOutcome {
    let mut scene = scene("chain", DOWN, 0.5, 1e-9);
    let first = if ratio > 1.0 { 1e-9 } else { 1.0 };
    for i in 0..10 {
        let x = f64::from(i);
        let name = format!("rod-{i}");
        scene.bodies.push(rod(
            &name,
            first * libm::pow(ratio, f64::from(i)),
            [x, 0.0],
            [x + 1.0, 0.0],
            [0.0; 2],
            0.0,
        ));
        let above = if i == 0 { GROUND.to_owned() } else { format!("rod-{}", i - 1) };
        scene.joints.push(pin(&format!("pin-{i}"), &above, &name, [x, 0.0]));
    }
    // In light tails the whip of the lightest does not show in the energy: compare with the reduced form too.
    let mut reduced = scene.clone();
    reduced.coordinates = triad_scene::Coordinates::Reduced;
    // The series lift both forms alike: only another integrator makes the comparison mean something.
    reduced.simulation.integrator = triad_scene::IntegratorKind::Dop853;
    let mut other = triad_engine::run::Simulation::new(&reduced).ok();
    Trial::new(scene, method)
        .against("the same in reduced coordinates by another integrator", (1e-5, 1e-2), move |run| {
            let Some(other) = other.as_mut() else { return f64::NAN };
            other.set_step_limit(200_000);
            if other.advance_to(run.time()).is_err() {
                return f64::NAN;
            }
            let (a, b) = (run.frame(), other.frame());
            (0..10).map(|k| distance(&a, k, b.bodies[k].position)).fold(0.0, larger_or_nan) / 10.0
        })
        .conserving((1e-6, 1e-2))
        .run()
}

/// A uniform rod on a hinge: θ̈ = −(3 g / 2 l) sin θ; for two periods of about 2π √(2 l / 3 g).
fn pendulum(length: f64, mass: f64, method: &TrialMethod) -> StressOutcome {
    let start = 1.0f64;
    let pace = (1.5 * 9.81 / length).sqrt();
    let mut scene = scene("pendulum", DOWN, 15.0 / pace, 1e-9);
    let end = [length * libm::sin(start), -length * libm::cos(start)];
    scene.bodies.push(rod("rod", mass, [0.0; 2], end, [0.0; 2], 0.0));
    scene.joints.push(pin("pin", GROUND, "rod", [0.0; 2]));
    // In the time pace · t.
    let mut exact = OneDegree::new(start, 0.0, |a: f64, _| -libm::sin(a));
    Trial::new(scene, method)
        .against("exact motion of a physical pendulum", (1e-6, 1e-3), move |run| {
            let (angle, _) = exact.at(pace * run.time());
            let center = [0.5 * length * libm::sin(angle), -0.5 * length * libm::cos(angle), 0.0];
            distance(&run.frame(), 0, center) / length
        })
        .conserving((1e-6, 1e-3))
        .run()
}

fn all_sizes(method: &TrialMethod, _: bool) -> StressOutcome {
    let lengths = [1e-6, 1e-3, 1.0, 1e3];
    let start = 1.0f64;
    let mut scene = scene("all-sizes", DOWN, 0.02, 1e-9);
    for (i, length) in lengths.into_iter().enumerate() {
        let x = i as f64;
        let name = format!("rod-{i}");
        let mass: f64 = 1e3 * length * length * length;
        let end = [x + length * libm::sin(start), -length * libm::cos(start)];
        scene.bodies.push(rod(&name, mass, [x, 0.0], end, [0.0; 2], 0.0));
        scene.joints.push(pin(&format!("pin-{i}"), GROUND, &name, [x, 0.0]));
    }
    let mut exact: Vec<_> =
        lengths.iter().map(|_| OneDegree::new(start, 0.0, |a: f64, _| -libm::sin(a))).collect();
    Trial::new(scene, method)
        .against("exact motion of each pendulum", (1e-5, 1e-1), move |run| {
            let frame = run.frame();
            let mut error = 0.0;
            for (i, (length, exact)) in lengths.into_iter().zip(&mut exact).enumerate() {
                let (angle, _) = exact.at((1.5 * 9.81 / length).sqrt() * run.time());
                let center =
                    [i as f64 + 0.5 * length * libm::sin(angle), -0.5 * length * libm::cos(angle), 0.0];
                error = larger_or_nan(error, distance(&frame, i, center) / length);
            }
            error
        })
        .run()
}

fn thin(method: &TrialMethod, _: bool) -> StressOutcome {
    let start = 1.0f64;
    let moment = 1.0 / 12.0;
    let shapes = [
        ("lamina", [moment, 0.5 * moment, 0.5 * moment], moment * 0.5),
        ("rod", [0.0, moment, moment], moment),
        ("point", [0.0; 3], 0.0),
    ];
    shapes
        .into_iter()
        .map(|(name, principal, about_z)| {
            let mut scene = scene(name, DOWN, 10.0, 1e-9);
            let mut bob = rod("bob", 1.0, [0.0; 2], [libm::sin(start), -libm::cos(start)], [0.0; 2], 0.0);
            bob.inertia = if name == "point" { None } else { Some(Inertia::Principal(principal)) };
            scene.bodies.push(bob);
            scene.joints.push(pin("pin", GROUND, "bob", [0.0; 2]));
            let k = 0.5 * 9.81 / (0.25 + about_z);
            if name == "rod" {
                return swinging(scene, 0, start, method);
            }
            let mut exact = OneDegree::new(start, 0.0, move |a: f64, _| -k * libm::sin(a));
            Trial::new(scene, method)
                .against("exact motion of a physical pendulum", (1e-6, 1e-3), move |run| {
                    let (angle, _) = exact.at(run.time());
                    distance(&run.frame(), 0, [0.5 * libm::sin(angle), -0.5 * libm::cos(angle), 0.0])
                })
                .conserving((1e-7, 1e-3))
                .run()
        })
        .fold(StressOutcome::nothing(StressVerdict::Survived, String::new()), StressOutcome::and)
}

fn triangle(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("triangle", [0.0; 3], 10.0, 1e-10);
    let inertias = [[1.0, 1.0, 1e-9], [1.0, 1.0, 2.0], [1.0, 1e-6, 1.0], [3.0, 1.0, 2.0]];
    for (i, principal) in inertias.into_iter().enumerate() {
        let mut free = body(&format!("body-{i}"), 1.0, principal, [3.0 * i as f64, 0.0, 0.0]);
        free.angular_velocity = [1.0, 2.0, 0.5];
        scene.bodies.push(free);
    }
    scene.bodies.push(body("hung", 1.0, [1e-12, 1.0, 1.0], [0.0, 5.0, 0.0]));
    scene.joints.push(joint("ball", JointKind::Spherical, GROUND, "hung", [-0.5, 5.0, 0.0]));
    let momentum = |run: &triad_engine::run::Simulation| -> Vec<nalgebra::Vector3<f64>> {
        let frame = run.frame();
        let moments = inertias.iter().zip(&frame.bodies).map(|(principal, shown)| {
            let omega = nalgebra::Vector3::from(shown.angular_velocity);
            [shown.u, shown.v, shown.w]
                .iter()
                .zip(principal)
                .map(|(axis, moment)| {
                    let axis = nalgebra::Vector3::from(*axis);
                    axis * (moment * axis.dot(&omega))
                })
                .sum()
        });
        moments.collect()
    };
    let mut start = None;
    Trial::new(scene, method)
        .against("angular momentum of each free body, in the world", (1e-7, 1e-3), move |run| {
            let now = momentum(run);
            let start = start.get_or_insert_with(|| now.clone());
            now.iter().zip(start.iter()).map(|(a, b)| (a - b).norm() / b.norm()).fold(0.0, larger_or_nan)
        })
        .conserving((1e-7, 1e-3))
        .run()
}
