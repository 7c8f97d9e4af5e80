//! Springs, spins, drivers and friction that are far faster than the mechanism.

use crate::stress::build::{DOWN, GROUND, body, distance, hinged, joint, pin, rod, scene, spring};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use triad_scene::{Driver, Friction, JointKind, Load, Motion};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "stiff and fast";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "spring-1e6",
        family: FAMILY,
        summary: "A mass of 1 kg on a spring of 1e6 N/m for 160 periods",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| oscillator(1e6, 0.0, 1.0, method),
    },
    StressCase {
        name: "spring-1e10",
        family: FAMILY,
        summary: "A mass of 1 kg on a spring of 1e10 N/m for 160 periods",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| oscillator(1e10, 0.0, 0.01, method),
    },
    StressCase {
        name: "spring-damped",
        family: FAMILY,
        summary: "1e8 N/m and 4e5 N s/m on 1 kg: twenty times overdamped, as in a governor",
        expected: StressVerdict::Survived,
        quick: true,
        run: |method, _| oscillator(1e8, 4e5, 0.1, method),
    },
    StressCase {
        name: "top",
        family: FAMILY,
        summary: "A symmetric top spinning at 1e5 rad/s in regular precession",
        expected: StressVerdict::Survived,
        quick: true,
        run: top,
    },
    StressCase {
        name: "driver-1-khz",
        family: FAMILY,
        summary: "A pendulum whose pivot is shaken at 1 kHz stands on its head (Kapitza)",
        expected: StressVerdict::Survived,
        quick: true,
        run: kapitza,
    },
    StressCase {
        name: "friction-smooth",
        family: FAMILY,
        summary: "A block that friction, smoothed at 1e-6 m/s, brings to rest",
        expected: StressVerdict::Survived,
        quick: true,
        run: friction,
    },
];

/// x = x₀ of a damped oscillator along x, exactly.
fn oscillator(stiffness: f64, damping: f64, seconds: f64, method: &TrialMethod) -> StressOutcome {
    let (amplitude, rest) = (0.01, 1.0);
    let mut scene = scene("oscillator", [0.0; 3], seconds, 1e-9);
    scene.bodies.push(body("mass", 1.0, [0.1; 3], [rest + amplitude, 0.0, 0.0]));
    scene.joints.push(hinged("guide", JointKind::Prismatic, GROUND, "mass", [0.0; 3], [1.0, 0.0, 0.0]));
    scene.loads.push(spring("spring", [0.0; 3], "mass", stiffness, rest, damping));
    let half = 0.5 * damping;
    let square = stiffness - half * half;
    Trial::new(scene, method)
        .against("exact motion of a linear oscillator", (1e-4, 1e-1), move |run| {
            let t = run.time();
            let x = if square > 0.0 {
                let omega = square.sqrt();
                libm::exp(-half * t) * (libm::cos(omega * t) + half / omega * libm::sin(omega * t))
            } else {
                let root = (-square).sqrt();
                // The slow root without cancellation.
                let (fast, slow) = (half + root, stiffness / (half + root));
                (fast * libm::exp(-slow * t) - slow * libm::exp(-fast * t)) / (fast - slow)
            };
            distance(&run.frame(), 0, [rest + amplitude * x, 0.0, 0.0]) / amplitude
        })
        .run()
}

/// With its axis horizontal, a symmetric top precesses steadily at exactly Ω = m g l / (C n).
fn top(method: &TrialMethod, quick: bool) -> StressOutcome {
    let (spin, arm, axial, across) = (1e5, 0.1, 1e-3, 1e-3);
    let precession = 9.81 * arm / (axial * spin);
    let seconds = if quick { 0.02 } else { 0.2 };
    let mut scene = scene("top", [0.0, 0.0, -9.81], seconds, 1e-9);
    let mut wheel = body("wheel", 1.0, [axial, across, across], [arm, 0.0, 0.0]);
    wheel.angular_velocity = [spin, 0.0, precession];
    wheel.velocity = [0.0, precession * arm, 0.0];
    scene.bodies.push(wheel);
    scene.joints.push(joint("tip", JointKind::Spherical, GROUND, "wheel", [0.0; 3]));
    Trial::new(scene, method)
        .against("steady precession at m g l / (C n)", (1e-7, 1e-3), move |run| {
            let (sin, cos) = libm::sincos(precession * run.time());
            distance(&run.frame(), 0, [arm * cos, arm * sin, 0.0]) / arm
        })
        .conserving((1e-6, 1e-3))
        .run()
}

/// A rod on a pivot at y = a sin Ω t: θ̈ = (3 / 2 l)(g − a Ω² sin Ω t) sin θ from the upward vertical.
fn kapitza(method: &TrialMethod, _: bool) -> StressOutcome {
    let (amplitude, frequency) = (0.01, 2.0 * std::f64::consts::PI * 1000.0);
    let start = 0.1f64;
    let mut scene = scene("kapitza", DOWN, 0.3, 1e-10);
    // The pivot starts with the speed a Ω, the rod only moves with it along y.
    scene.bodies.push(body("pivot", 1.0, [0.1; 3], [0.0; 3]));
    scene.bodies[0].velocity = [0.0, amplitude * frequency, 0.0];
    let up = [0.0, amplitude * frequency];
    scene.bodies.push(rod("rod", 1.0, [0.0; 2], [libm::sin(start), libm::cos(start)], up, 0.0));
    scene.joints.push(hinged("guide", JointKind::Prismatic, GROUND, "pivot", [0.0; 3], [0.0, 1.0, 0.0]));
    scene.joints.push(pin("pin", "pivot", "rod", [0.0; 2]));
    scene.drivers.push(Driver::Slide {
        name: "shaker".to_owned(),
        joint: "guide".to_owned(),
        motion: Motion::Harmonic { mean: 0.0, amplitude, frequency, phase: 0.0 },
    });
    let mut exact = OneDegree::driven(start, 0.0, 1e-6, move |t: f64, a: f64, _| {
        1.5 * (9.81 - amplitude * frequency * frequency * libm::sin(frequency * t)) * libm::sin(a)
    });
    Trial::new(scene, method)
        .against("exact motion on a shaken pivot", (1e-5, 1e-2), move |run| {
            let t = run.time();
            let (angle, _) = exact.at(t);
            let y = amplitude * libm::sin(frequency * t);
            distance(&run.frame(), 1, [0.5 * libm::sin(angle), y + 0.5 * libm::cos(angle), 0.0])
        })
        .run()
}

/// A block of 1 kg at 1 m/s against 2 N: it stands after 0.5 s and 0.25 m, and stays.
fn friction(method: &TrialMethod, quick: bool) -> StressOutcome {
    let mut scene = scene("friction", [0.0; 3], if quick { 0.505 } else { 1.0 }, 1e-8);
    let mut block = body("block", 1.0, [0.1; 3], [0.0; 3]);
    block.velocity = [1.0, 0.0, 0.0];
    scene.bodies.push(block);
    scene.joints.push(hinged("guide", JointKind::Prismatic, GROUND, "block", [0.0; 3], [1.0, 0.0, 0.0]));
    scene.loads.push(Load::Slider {
        name: "friction".to_owned(),
        joint: "guide".to_owned(),
        stiffness: 0.0,
        free_length: 0.0,
        damping: 0.0,
        force: None,
        friction: Some(Friction { smoothing: 1e-6, ..Friction::new(0.0, 2.0) }),
    });
    // tanh is one but for the last micrometres a second: their effect on the path is 1e-12 m.
    Trial::new(scene, method)
        .against("uniform deceleration, then rest", (1e-5, 1e-2), |run| {
            let t = run.time().min(0.5);
            distance(&run.frame(), 0, [t - t * t, 0.0, 0.0]) / 0.25
        })
        .within(3_000_000)
        .run()
}
