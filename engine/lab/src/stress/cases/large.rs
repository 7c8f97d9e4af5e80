//! Many bodies, and bodies with many joints.

use crate::stress::build::{DOWN, GROUND, body, distance, hinged, joint, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use triad_scene::{JointKind, Scene};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "large";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "chain-2000",
        family: FAMILY,
        summary: "A spatial chain of 2000 rods; quick: 200",
        expected: StressVerdict::Survived,
        quick: true,
        run: chain,
    },
    StressCase {
        name: "tree-1023",
        family: FAMILY,
        summary: "A binary tree of 1023 rods on hinges with turned axes; quick: 63",
        expected: StressVerdict::Survived,
        quick: true,
        run: tree,
    },
    StressCase {
        name: "net",
        family: FAMILY,
        summary: "A net of balls and bars, 20 × 20, hung at two corners; quick: 6 × 6",
        expected: StressVerdict::Survived,
        quick: true,
        run: net,
    },
    StressCase {
        name: "four-bar-999",
        family: FAMILY,
        summary: "999 windows, 1999 bodies, through the singular position; quick: 99 windows",
        expected: StressVerdict::Survived,
        quick: true,
        run: four_bar,
    },
    StressCase {
        name: "hub",
        family: FAMILY,
        summary: "One free hub with 200 pendulums; quick: 60",
        expected: StressVerdict::Survived,
        quick: true,
        run: hub,
    },
];

fn chain(method: &TrialMethod, quick: bool) -> StressOutcome {
    let (rods, seconds) = if quick { (200, 0.5) } else { (2000, 1.0) };
    match triad_scene::catalogue::scene(&format!("spatial-chain:{rods}")) {
        Ok(mut scene) => {
            scene.simulation.duration = seconds;
            scene.simulation.tolerance = 1e-8;
            Trial::new(scene, method).conserving((1e-6, 1e-3)).sampled(5).run()
        }
        Err(error) => StressOutcome::nothing(StressVerdict::Wrong, error.to_string()),
    }
}

fn tree(method: &TrialMethod, quick: bool) -> StressOutcome {
    let levels = if quick { 6 } else { 10 };
    let mut scene = scene("tree", DOWN, 1.0, 1e-8);
    for i in 1..(1usize << levels) {
        // Node i hangs below node i / 2; its level sets its height.
        let level = i.ilog2();
        let top = [i as f64 / f64::from(1u32 << level), -f64::from(level), 0.0];
        let name = format!("rod-{i}");
        let moment = 1.0 / 12.0;
        scene.bodies.push(body(&name, 1.0, [moment, 0.1 * moment, moment], [top[0], top[1] - 0.5, 0.0]));
        let above = if i == 1 { GROUND.to_owned() } else { format!("rod-{}", i / 2) };
        let angle = i as f64;
        let axis = [libm::cos(angle), 0.3, libm::sin(angle)];
        scene.joints.push(hinged(&format!("hinge-{i}"), JointKind::Revolute, &above, &name, top, axis));
    }
    Trial::new(scene, method).conserving((1e-6, 1e-3)).sampled(5).run()
}

fn net(method: &TrialMethod, quick: bool) -> StressOutcome {
    let side = if quick { 6 } else { 20 };
    let mut scene = scene("net", [0.0, 0.0, -9.81], 0.5, 1e-8);
    let name = |i: usize, j: usize| format!("ball-{i}-{j}");
    for i in 0..side {
        for j in 0..side {
            // A little out of the plane, so that no bar begins in a singular position.
            let sag = 0.1 * libm::sin((i * i) as f64 * 0.7 + (j * j) as f64 * 1.3);
            scene.bodies.push(body(&name(i, j), 0.1, [1e-3; 3], [i as f64, j as f64, sag]));
        }
    }
    let place = |scene: &Scene, i: usize, j: usize| scene.bodies[i * side + j].position;
    for i in 0..side {
        for j in 0..side {
            for (k, l) in [(i + 1, j), (i, j + 1)] {
                if k < side && l < side {
                    let mut bar = joint(
                        &format!("bar-{i}-{j}-{k}-{l}"),
                        JointKind::Rod,
                        &name(i, j),
                        &name(k, l),
                        [0.0; 3],
                    );
                    bar.point = None;
                    bar.points = Some([place(&scene, i, j), place(&scene, k, l)]);
                    scene.joints.push(bar);
                }
            }
        }
    }
    for (hook, (i, j)) in [("left", (0, 0)), ("right", (0, side - 1))] {
        let at = place(&scene, i, j);
        scene.joints.push(joint(hook, JointKind::Spherical, GROUND, &name(i, j), at));
    }
    Trial::new(scene, method).conserving((1e-6, 1e-3)).sampled(5).run()
}

fn four_bar(method: &TrialMethod, quick: bool) -> StressOutcome {
    let windows = if quick { 99 } else { 999 };
    let n = f64::from(windows);
    let k = 9.81 * 0.5 * (3.0 * n + 1.0) / ((4.0 * n + 1.0) / 3.0);
    let mut exact = OneDegree::new(0.0, 1.0, move |a: f64, _| k * libm::sin(a));
    match triad_scene::catalogue::scene(&format!("n-four-bar:{windows}")) {
        Ok(mut scene) => {
            scene.simulation.duration = 1.5;
            scene.simulation.tolerance = 1e-9;
            Trial::new(scene, method)
                .against("exact motion of one degree of freedom", (1e-5, 1e-2), move |run| {
                    let (angle, _) = exact.at(run.time());
                    distance(&run.frame(), 0, [0.5 * libm::sin(angle), 0.5 * libm::cos(angle), 0.0])
                })
                .conserving((1e-6, 1e-3))
                .sampled(5)
                .run()
        }
        Err(error) => StressOutcome::nothing(StressVerdict::Wrong, error.to_string()),
    }
}

/// All pendulums hang on a free hub that only turns about its axle: with all of them alike, each moves like one on a
/// hub of which it has its share.
fn hub(method: &TrialMethod, quick: bool) -> StressOutcome {
    let count = if quick { 60 } else { 200 };
    let mut scene = scene("hub", [0.0; 3], 2.0, 1e-9);
    let mut hub = body("hub", 10.0, [5.0; 3], [0.0; 3]);
    hub.angular_velocity = [0.0, 0.0, 2.0];
    scene.bodies.push(hub);
    scene.joints.push(pin("axle", GROUND, "hub", [0.0; 2]));
    for i in 0..count {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let (s, c) = libm::sincos(angle);
        let name = format!("arm-{i}");
        let velocity = [-2.0 * s, 2.0 * c];
        scene.bodies.push(rod(&name, 0.1, [c, s], [2.0 * c, 2.0 * s], velocity, 2.5));
        scene.joints.push(pin(&format!("pin-{i}"), "hub", &name, [c, s]));
    }
    // By symmetry all arms keep the same angle to the hub's radius, whose pattern must not break.
    Trial::new(scene, method)
        .against("the symmetry of its arms", (1e-6, 1e-3), move |run| {
            let frame = run.frame();
            let radii = frame.bodies[1..].iter().map(|b| libm::hypot(b.position[0], b.position[1]));
            let (low, high) = radii.fold((f64::MAX, 0.0f64), |(a, b), r| (a.min(r), b.max(r)));
            high - low
        })
        .conserving((1e-7, 1e-3))
        .sampled(10)
        .run()
}
