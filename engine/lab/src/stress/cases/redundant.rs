//! Redundant rows, which must not disturb the motion, and contradictory ones, which must be refused.

use crate::stress::build::{DOWN, GROUND, body, distance, hinged, joint, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::oracle::OneDegree;
use crate::stress::trial::Trial;
use crate::stress::trial::must_be_refused;
use triad_linalg::larger_or_nan;
use triad_scene::{AxisRows, Driver, JointKind, Motion, Scene, VectorMotion};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "redundant";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "bricard",
        family: FAMILY,
        summary: "Bricard's loop of six hinges, which counting says cannot move",
        expected: StressVerdict::Survived,
        quick: true,
        run: bricard,
    },
    StressCase {
        name: "coaxial-hinges",
        family: FAMILY,
        summary: "A door on 1 to 12 hinges in line",
        expected: StressVerdict::Survived,
        quick: true,
        run: coaxial,
    },
    StressCase {
        name: "bookshelf",
        family: FAMILY,
        summary: "A board on nine parallel uprights: eight loops where one would do",
        expected: StressVerdict::Survived,
        quick: true,
        run: bookshelf,
    },
    StressCase {
        name: "rows-twice",
        family: FAMILY,
        summary: "Every joint of a double pendulum written three times, with both kinds of rows",
        expected: StressVerdict::Survived,
        quick: true,
        run: twice,
    },
    StressCase {
        name: "contradiction",
        family: FAMILY,
        summary: "Two ball joints hold one rigid body at points that are too far apart",
        expected: StressVerdict::Refused,
        quick: true,
        run: contradiction,
    },
    StressCase {
        name: "contradiction-in-loop",
        family: FAMILY,
        summary: "A closed loop whose bars are too short to close",
        expected: StressVerdict::Refused,
        quick: true,
        run: open_loop,
    },
    StressCase {
        name: "contradictory-drivers",
        family: FAMILY,
        summary: "Two drivers turn one hinge at different rates",
        expected: StressVerdict::Refused,
        quick: true,
        run: drivers,
    },
    StressCase {
        name: "driver-past-reach",
        family: FAMILY,
        summary: "A driver pulls the end of an arm farther than the arm reaches",
        expected: StressVerdict::Refused,
        quick: true,
        run: past_reach,
    },
];

/// A uniform rod of 1 m and 1 kg on a hinge: θ̈ = −(3/2) g sin θ from the downward vertical.
pub(super) fn swinging(run_scene: Scene, body: usize, start: f64, method: &TrialMethod) -> StressOutcome {
    let mut exact = OneDegree::new(start, 0.0, |a: f64, _| -1.5 * 9.81 * libm::sin(a));
    Trial::new(run_scene, method)
        .against("exact motion of a physical pendulum", (1e-6, 1e-3), move |run| {
            let (angle, _) = exact.at(run.time());
            distance(&run.frame(), body, [0.5 * libm::sin(angle), -0.5 * libm::cos(angle), 0.0])
        })
        .conserving((1e-7, 1e-3))
        .run()
}

fn bricard(method: &TrialMethod, _: bool) -> StressOutcome {
    match triad_scene::catalogue::scene("bricard") {
        // The loop starts at rest in a closed form; energy and closure are its invariants, and it must move.
        Ok(mut scene) => {
            scene.simulation.duration = 10.0;
            Trial::new(scene, method).conserving((1e-6, 1e-3)).run()
        }
        Err(error) => StressOutcome::nothing(StressVerdict::Wrong, error.to_string()),
    }
}

fn coaxial(method: &TrialMethod, _: bool) -> StressOutcome {
    let start = 1.0f64;
    [1usize, 2, 3, 12]
        .into_iter()
        .map(|hinges| {
            let mut scene = scene("door", DOWN, 10.0, 1e-9);
            scene.bodies.push(rod(
                "door",
                1.0,
                [0.0; 2],
                [libm::sin(start), -libm::cos(start)],
                [0.0; 2],
                0.0,
            ));
            for i in 0..hinges {
                let point = [0.0, 0.0, 0.1 * i as f64];
                let mut hinge = hinged(
                    &format!("hinge-{i}"),
                    JointKind::Revolute,
                    GROUND,
                    "door",
                    point,
                    [0.0, 0.0, 1.0],
                );
                hinge.rows = Some(if i % 2 == 0 { AxisRows::TwoCar } else { AxisRows::Cv });
                scene.joints.push(hinge);
            }
            swinging(scene, 0, start, method)
        })
        .fold(StressOutcome::nothing(StressVerdict::Survived, String::new()), StressOutcome::and)
}

fn bookshelf(method: &TrialMethod, _: bool) -> StressOutcome {
    let (count, start) = (9usize, 0.3f64);
    let mut scene = scene("bookshelf", DOWN, 10.0, 1e-9);
    let (s, c) = (libm::sin(start), libm::cos(start));
    for i in 0..count {
        let x = i as f64;
        let name = format!("book-{i}");
        scene.bodies.push(rod(&name, 1.0, [x, 0.0], [x + s, -c], [0.0; 2], 0.0));
        scene.joints.push(pin(&format!("A{i}"), GROUND, &name, [x, 0.0]));
    }
    scene.bodies.push(rod("board", 2.0, [s, -c], [s + 8.0, -c], [0.0; 2], 0.0));
    for i in 0..count {
        scene.joints.push(pin(&format!("B{i}"), &format!("book-{i}"), "board", [i as f64 + s, -c]));
    }
    let n = count as f64;
    let k = 9.81 * (0.5 * n + 2.0) / (n / 3.0 + 2.0);
    let mut exact = OneDegree::new(start, 0.0, move |a: f64, _| -k * libm::sin(a));
    Trial::new(scene, method)
        .against("exact motion of one degree of freedom", (1e-6, 1e-3), move |run| {
            let (angle, _) = exact.at(run.time());
            distance(&run.frame(), count, [4.0 + libm::sin(angle), -libm::cos(angle), 0.0])
        })
        .conserving((1e-7, 1e-3))
        .run()
}

/// The same double pendulum with each joint once, in reduced coordinates, is the reference.
fn twice(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("twice", DOWN, 3.0, 1e-10);
    scene.bodies.push(rod("upper", 1.0, [0.0; 2], [1.0, 0.0], [0.0; 2], 0.0));
    scene.bodies.push(rod("lower", 1.0, [1.0, 0.0], [2.0, 0.0], [0.0; 2], 0.0));
    scene.joints.push(pin("A", GROUND, "upper", [0.0; 2]));
    scene.joints.push(pin("B", "upper", "lower", [1.0, 0.0]));
    let mut once = scene.clone();
    once.coordinates = triad_scene::Coordinates::Reduced;
    for copy in 0..2 {
        for original in 0..2 {
            let mut joint = scene.joints[original].clone();
            joint.name = format!("{}-again-{copy}", joint.name);
            joint.rows = Some(if copy == 0 { AxisRows::Cv } else { AxisRows::TwoCar });
            scene.joints.push(joint);
        }
    }
    let Ok(mut other) = triad_engine::run::Simulation::new(&once) else {
        return StressOutcome::nothing(StressVerdict::Wrong, "the reference does not start".to_owned());
    };
    Trial::new(scene, method)
        .against("the same with each joint once, in reduced coordinates", (1e-6, 1e-3), move |run| {
            if other.advance_to(run.time()).is_err() {
                return f64::NAN;
            }
            let (a, b) = (run.frame(), other.frame());
            (0..2).map(|k| distance(&a, k, b.bodies[k].position)).fold(0.0, larger_or_nan)
        })
        .conserving((1e-7, 1e-3))
        .run()
}

fn contradiction(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("contradiction", DOWN, 1.0, 1e-9);
    scene.bodies.push(body("bar", 1.0, [0.1, 0.1, 0.1], [0.5, 0.0, 0.0]));
    let mut left = joint("left", JointKind::Spherical, GROUND, "bar", [0.0; 3]);
    left.point = None;
    (left.point_i, left.point_j) = (Some([0.0; 3]), Some([-0.5, 0.0, 0.0]));
    let mut right = joint("right", JointKind::Spherical, GROUND, "bar", [0.0; 3]);
    right.point = None;
    (right.point_i, right.point_j) = (Some([1.1, 0.0, 0.0]), Some([0.5, 0.0, 0.0]));
    scene.joints = vec![left, right];
    must_be_refused(&scene, method, "assembly-failed", &["\"left\"", "\"right\""])
}

fn open_loop(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("open-loop", DOWN, 1.0, 1e-9);
    for k in 0..3 {
        let x = f64::from(k);
        scene.bodies.push(rod(&format!("bar-{k}"), 1.0, [x, 0.0], [x + 1.0, 0.0], [0.0; 2], 0.0));
    }
    scene.joints.push(pin("A", GROUND, "bar-0", [0.0; 2]));
    scene.joints.push(pin("B", "bar-0", "bar-1", [1.0, 0.0]));
    scene.joints.push(pin("C", "bar-1", "bar-2", [2.0, 0.0]));
    let mut last = pin("D", "bar-2", GROUND, [0.0; 2]);
    last.point = None;
    (last.point_i, last.point_j) = (Some([0.5, 0.0, 0.0]), Some([3.3, 0.0, 0.0]));
    last.axis = Some([0.0, 0.0, 1.0]);
    scene.joints.push(last);
    must_be_refused(&scene, method, "assembly-failed", &["\"A\"", "\"D\""])
}

fn drivers(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("drivers", DOWN, 1.0, 1e-9);
    scene.bodies.push(rod("bar", 1.0, [0.0; 2], [1.0, 0.0], [0.0; 2], 0.0));
    scene.joints.push(pin("A", GROUND, "bar", [0.0; 2]));
    for (name, rate) in [("slow", 1.0), ("fast", 2.0)] {
        scene.drivers.push(Driver::Angle {
            name: name.to_owned(),
            joint: "A".to_owned(),
            motion: Motion::Ramp { start: 0.0, rate },
        });
    }
    must_be_refused(&scene, method, "motion-impossible", &["\"slow\"", "\"fast\""])
}

fn past_reach(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = scene("past-reach", [0.0; 3], 2.0, 1e-9);
    let bend = [0.6, 0.8];
    scene.bodies.push(rod("upper", 1.0, [0.0; 2], bend, [0.0; 2], 0.0));
    scene.bodies.push(rod("lower", 1.0, bend, [1.2, 0.0], [0.0; 2], 0.0));
    scene.joints.push(joint("shoulder", JointKind::Spherical, GROUND, "upper", [0.0; 3]));
    scene.joints.push(joint("elbow", JointKind::Spherical, "upper", "lower", [0.6, 0.8, 0.0]));
    let still = |value| Motion::Constant { value };
    scene.drivers.push(Driver::Point {
        name: "hand".to_owned(),
        body: "lower".to_owned(),
        point: [0.5, 0.0, 0.0],
        motion: VectorMotion::Components {
            x: Motion::Ramp { start: 1.2, rate: 0.8 },
            y: still(0.0),
            z: still(0.0),
        },
    });
    let codes = "motion-impossible|constraints-lost|step-too-small|stalled|no-convergence";
    let mut outcome = must_be_refused(&scene, method, codes, &["driver \"hand\" asks for"]);
    // At t = 1 s the arm is straight; feedback stretches it a little.
    if outcome.verdict == StressVerdict::Refused && !(0.99..1.3).contains(&outcome.reached) {
        outcome.verdict = StressVerdict::Wrong;
        outcome.reason.push_str("; but the arm is straight at t = 1 s");
    }
    outcome
}
