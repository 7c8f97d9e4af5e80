//! Singular positions: the mobility jumps on the way, and the motion has to stay on its smooth branch.

use crate::stress::build::{DOWN, GROUND, distance, hinged, joint, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use triad_linalg::larger_or_nan;
use triad_scene::{JointKind, Scene};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "singular";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "four-bars",
        family: FAMILY,
        summary: "N-four-bars through every crossing; N = 1 to 40 for 100 s, quick: four of them for 10 s",
        expected: StressVerdict::Survived,
        quick: true,
        run: four_bars,
    },
    StressCase {
        name: "four-bar-horizontal",
        family: FAMILY,
        summary: "Three windows started exactly in the singular position, moving along the branch",
        expected: StressVerdict::Survived,
        quick: true,
        run: horizontal,
    },
    StressCase {
        name: "four-bar-unequal",
        family: FAMILY,
        summary: "Four windows on bent levers with unequal arms: each is singular at another moment",
        expected: StressVerdict::Survived,
        quick: true,
        run: unequal,
    },
    StressCase {
        name: "slider-crank-equal",
        family: FAMILY,
        summary: "Crank and rod of equal length: the slider passes through the crank's pivot",
        expected: StressVerdict::Survived,
        quick: true,
        run: slider_crank,
    },
    StressCase {
        name: "branch-point-at-rest",
        family: FAMILY,
        summary: "A parallelogram let go at rest in its branch point, to which it returns: no branch is determined, and that is told",
        expected: StressVerdict::Warned,
        quick: true,
        run: at_rest,
    },
];

/// Windows: uprights i = 0 … N at x = i, all at the angle θ from the vertical towards +x.
///
/// All couplers only translate, so that with unit masses and lengths ½ ((N+1)/3 + N) θ̇² + g ((N+1)/2 + N) cos θ is
/// the energy: θ̈ = κ sin θ with κ = g ((3N+1)/2) / ((4N+1)/3).
fn windows(count: usize, angle: f64, rate: f64) -> Scene {
    let mut scene = scene("windows", DOWN, 10.0, 1e-9);
    let (dx, dy) = (libm::sin(angle), libm::cos(angle));
    let tip = [rate * dy, -rate * dx];
    for i in 0..=count {
        let x = i as f64;
        let name = format!("upright-{i}");
        scene.bodies.push(rod(&name, 1.0, [x, 0.0], [x + dx, dy], [0.0; 2], -rate));
        scene.joints.push(pin(&format!("A{i}"), GROUND, &name, [x, 0.0]));
    }
    for i in 0..count {
        let x = i as f64 + dx;
        let name = format!("coupler-{i}");
        scene.bodies.push(rod(&name, 1.0, [x, dy], [x + 1.0, dy], tip, 0.0));
        scene.joints.push(pin(&format!("B{i}"), &format!("upright-{i}"), &name, [x, dy]));
        scene.joints.push(pin(&format!("C{i}"), &name, &format!("upright-{}", i + 1), [x + 1.0, dy]));
    }
    scene
}

fn kappa(count: usize) -> f64 {
    let n = count as f64;
    9.81 * 0.5 * (3.0 * n + 1.0) / ((4.0 * n + 1.0) / 3.0)
}

fn against_pendulum(
    mut scene: Scene,
    count: usize,
    start: (f64, f64),
    seconds: f64,
    method: &TrialMethod,
) -> StressOutcome {
    scene.simulation.duration = seconds;
    let k = kappa(count);
    let mut exact = OneDegree::new(start.0, start.1, move |a: f64, _| k * libm::sin(a));
    // It passes the upright slowly, where its energy is a hundredth of that at the bottom: an error of energy counts a
    // hundredfold in the phase, and adds up from turn to turn.
    let good = 1e-6 * seconds.max(10.0);
    Trial::new(scene, method)
        .against("exact motion of one degree of freedom", (good, 1e-2), move |run| {
            let (angle, _) = exact.at(run.time());
            let frame = run.frame();
            (0..=count)
                .map(|i| {
                    distance(&frame, i, [i as f64 + 0.5 * libm::sin(angle), 0.5 * libm::cos(angle), 0.0])
                })
                .chain((0..count).map(|i| {
                    distance(
                        &frame,
                        count + 1 + i,
                        [i as f64 + 0.5 + libm::sin(angle), libm::cos(angle), 0.0],
                    )
                }))
                .fold(0.0, larger_or_nan)
        })
        .sampled(100)
        .conserving((1e-6, 1e-3))
        .run()
}

fn four_bars(method: &TrialMethod, quick: bool) -> StressOutcome {
    let (counts, seconds): (Vec<usize>, f64) =
        if quick { (vec![1, 2, 5, 12], 10.0) } else { ((1..=40).collect(), 100.0) };
    counts
        .into_iter()
        .map(|n| against_windows(n, seconds, method))
        .reduce(StressOutcome::and)
        .unwrap_or_else(|| StressOutcome::nothing(StressVerdict::Wrong, "nothing was run".to_owned()))
}

/// So many windows from the upright for so long.
pub(super) fn against_windows(count: usize, seconds: f64, method: &TrialMethod) -> StressOutcome {
    against_pendulum(windows(count, 0.0, 1.0), count, (0.0, 1.0), seconds, method)
}

fn horizontal(method: &TrialMethod, _: bool) -> StressOutcome {
    let start = (FRAC_PI_2, 3.0);
    against_pendulum(windows(3, start.0, start.1), 3, start, 10.0, method)
}

/// Levers turn together by θ; arm k of lever k and lever k + 1 stands at the angle β_k and has the length a_k, and a
/// massive coupler joins the two. Singular where θ + β_k is 0 or π.
fn unequal(method: &TrialMethod, _: bool) -> StressOutcome {
    let arms = [(1.0, 0.0), (0.7, 0.8), (1.3, 1.9), (0.5, 2.7)];
    let (start, rate) = (0.4, 1.5);
    let mut scene = scene("unequal-windows", DOWN, 20.0, 1e-9);
    let tip = |k: usize| {
        let (a, beta): (f64, f64) = arms[k];
        [a * libm::cos(start + beta), a * libm::sin(start + beta)]
    };
    for i in 0..=arms.len() {
        let x = 2.0 * i as f64;
        let name = format!("lever-{i}");
        let mut lever = rod(&name, 1.0, [x - 0.5, 0.0], [x + 0.5, 0.0], [0.0, -0.5 * rate], rate);
        lever.velocity = [0.0; 3];
        scene.bodies.push(lever);
        scene.joints.push(pin(&format!("A{i}"), GROUND, &name, [x, 0.0]));
    }
    for k in 0..arms.len() {
        let [dx, dy] = tip(k);
        let x = 2.0 * k as f64 + dx;
        let name = format!("coupler-{k}");
        scene.bodies.push(rod(&name, 1.0, [x, dy], [x + 2.0, dy], [-rate * dy, rate * dx], 0.0));
        scene.joints.push(pin(&format!("B{k}"), &format!("lever-{k}"), &name, [x, dy]));
        scene.joints.push(pin(&format!("C{k}"), &name, &format!("lever-{}", k + 1), [x + 2.0, dy]));
    }
    let inertia = 5.0 / 12.0 + arms.iter().map(|(a, _)| a * a).sum::<f64>();
    let mut exact = OneDegree::new(start, rate, move |angle: f64, _| {
        -9.81 * arms.iter().map(|(a, beta)| a * libm::cos(angle + beta)).sum::<f64>() / inertia
    });
    Trial::new(scene, method)
        .against("exact motion of one degree of freedom", (1e-5, 1e-2), move |run| {
            let (angle, _) = exact.at(run.time());
            let frame = run.frame();
            (0..arms.len())
                .map(|k| {
                    let (a, beta) = arms[k];
                    let center = [
                        2.0 * k as f64 + 1.0 + a * libm::cos(angle + beta),
                        a * libm::sin(angle + beta),
                        0.0,
                    ];
                    distance(&frame, arms.len() + 1 + k, center)
                })
                .fold(0.0, larger_or_nan)
        })
        .conserving((1e-6, 1e-3))
        .run()
}

/// Crank at θ, rod back to the axis, slider at 2 cos θ: ½ M(θ) θ̇² + g sin θ with
/// M = 1/3 + 1/12 + ¼ cos² θ + 9/4 sin² θ + 4 sin² θ, all masses and lengths one.
fn slider_crank(method: &TrialMethod, _: bool) -> StressOutcome {
    let (start, rate): (f64, f64) = (0.5, 4.0);
    let mut scene = scene("slider-crank", DOWN, 20.0, 1e-9);
    let (c, s) = (libm::cos(start), libm::sin(start));
    let tip = [-rate * s, rate * c];
    scene.bodies.push(rod("crank", 1.0, [0.0; 2], [c, s], [0.0; 2], rate));
    scene.bodies.push(rod("rod", 1.0, [c, s], [2.0 * c, 0.0], tip, -rate));
    let mut slider = crate::stress::build::body("slider", 1.0, [0.1; 3], [2.0 * c, 0.0, 0.0]);
    slider.velocity = [-2.0 * rate * s, 0.0, 0.0];
    scene.bodies.push(slider);
    scene.joints.push(pin("A", GROUND, "crank", [0.0; 2]));
    scene.joints.push(joint("B", JointKind::Spherical, "crank", "rod", [c, s, 0.0]));
    scene.joints.push(pin("C", "rod", "slider", [2.0 * c, 0.0]));
    scene.joints.push(hinged("D", JointKind::Prismatic, GROUND, "slider", [0.0; 3], [1.0, 0.0, 0.0]));
    let mut exact = OneDegree::new(start, rate, |a: f64, r: f64| {
        let (s, c) = libm::sincos(a);
        let inertia = 5.0 / 12.0 + 0.25 * c * c + 6.25 * s * s;
        let slope = 12.0 * s * c;
        (-0.5 * slope * r * r - 9.81 * c) / inertia
    });
    Trial::new(scene, method)
        .against("exact motion of one degree of freedom", (1e-5, 1e-2), move |run| {
            let (angle, _) = exact.at(run.time());
            distance(&run.frame(), 2, [2.0 * libm::cos(angle), 0.0, 0.0])
        })
        .conserving((1e-6, 1e-3))
        .run()
}

/// At rest in the horizontal position several branches begin. Any of them is a solution; the result must be one, and
/// a note must say so.
fn at_rest(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = windows(1, FRAC_PI_2, 0.0);
    scene.simulation.duration = 3.0;
    let has_note = triad_engine::run::Simulation::new(&scene)
        .is_ok_and(|run| run.notes().iter().any(|note| note.contains("singular")));
    let mut outcome = Trial::new(scene, method)
        .against("a branch: parallel or crossed", (1e-6, 1e-3), |run| {
            let frame = run.frame();
            let angle = |k: usize| libm::atan2(frame.bodies[k].u[1], frame.bodies[k].u[0]);
            let (left, right, coupler) = (angle(0), angle(1), angle(2));
            // Parallel: both uprights at one angle, the coupler level. Crossed: the coupler turns with the rest.
            let level = |a: f64| (a - TAU * (a / TAU).round()).abs();
            let parallel = level(left - right).max(level(coupler));
            let crossed = level(left + PI - coupler).min(level(left - coupler)).min(level(right));
            parallel.min(crossed)
        })
        .conserving((1e-6, 1e-3))
        .run();
    if !has_note && outcome.verdict == StressVerdict::Survived {
        outcome.verdict = StressVerdict::Wrong;
        "the start is singular, and nothing is said about it".clone_into(&mut outcome.reason);
    }
    outcome
}
