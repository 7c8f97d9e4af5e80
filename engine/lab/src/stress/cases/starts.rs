//! Starts that are wrong: to be corrected with a note where that is possible, refused where it is not.

use crate::stress::build::{DOWN, GROUND, distance, pin, rod, scene};
use crate::stress::case::{StressCase, StressOutcome, StressVerdict, TrialMethod};
use crate::stress::trial::Trial;
use crate::stress::trial::must_be_refused;
use triad_engine::run::Simulation;
use triad_scene::{Orientation, Scene};

/// The family in reports, and what `--case` may name.
const FAMILY: &str = "wrong starts";

/// The cases, in the order of the report.
pub(super) const CASES: &[StressCase] = &[
    StressCase {
        name: "points-off",
        family: FAMILY,
        summary: "A double pendulum whose points miss each other by up to 30 % of a link",
        expected: StressVerdict::Survived,
        quick: true,
        run: points_off,
    },
    StressCase {
        name: "velocities-off",
        family: FAMILY,
        summary: "A double pendulum whose velocities contradict its hinges",
        expected: StressVerdict::Survived,
        quick: true,
        run: velocities_off,
    },
    StressCase {
        name: "not-orthonormal",
        family: FAMILY,
        summary: "Directors that are 10 % from orthonormal",
        expected: StressVerdict::Survived,
        quick: true,
        run: not_orthonormal,
    },
    StressCase {
        name: "left-handed",
        family: FAMILY,
        summary: "Directors u, v and w of which the third points the wrong way",
        expected: StressVerdict::Refused,
        quick: true,
        run: left_handed,
    },
    StressCase {
        name: "not-at-all-orthonormal",
        family: FAMILY,
        summary: "Directors that are parallel",
        expected: StressVerdict::Refused,
        quick: true,
        run: parallel,
    },
    StressCase {
        name: "unreachable",
        family: FAMILY,
        summary: "A double pendulum whose last point is held twice as far as it reaches",
        expected: StressVerdict::Refused,
        quick: true,
        run: unreachable,
    },
];

fn double_pendulum() -> Scene {
    let mut scene = scene("double-pendulum", DOWN, 2.0, 1e-9);
    scene.bodies.push(rod("upper", 1.0, [0.0; 2], [0.6, -0.8], [0.0; 2], 0.0));
    scene.bodies.push(rod("lower", 1.0, [0.6, -0.8], [1.6, -0.8], [0.0; 2], 0.0));
    for (name, i, j, ends) in [
        ("shoulder", GROUND, "upper", ([0.0, 0.0, 0.0], [-0.5, 0.0, 0.0])),
        ("elbow", "upper", "lower", ([0.5, 0.0, 0.0], [-0.5, 0.0, 0.0])),
    ] {
        let mut joint = pin(name, i, j, [0.0; 2]);
        joint.point = None;
        (joint.point_i, joint.point_j) = (Some(ends.0), Some(ends.1));
        scene.joints.push(joint);
    }
    scene
}

/// The corrected start must be named in a note, be consistent, and stay near what was given; from there energy holds.
fn corrected(scene: Scene, far: f64, word: &str, method: &TrialMethod) -> StressOutcome {
    let given: Vec<_> = scene.bodies.iter().map(|b| b.position).collect();
    let has_note =
        Simulation::new(&scene).is_ok_and(|run| run.notes().iter().any(|note| note.contains(word)));
    let mut first = true;
    let mut outcome = Trial::new(scene, method)
        .against("the start stays near the given one", (0.0, 0.0), move |run| {
            let frame = run.frame();
            let moved = (0..given.len()).map(|k| distance(&frame, k, given[k])).fold(0.0, f64::max);
            let too_far = std::mem::take(&mut first) && moved > far;
            if too_far { moved } else { 0.0 }
        })
        .conserving((1e-6, 1e-3))
        .run();
    if !has_note && outcome.verdict == StressVerdict::Survived {
        outcome.verdict = StressVerdict::Wrong;
        "the start was corrected, and nothing is said about it".clone_into(&mut outcome.reason);
    }
    outcome
}

fn points_off(method: &TrialMethod, _: bool) -> StressOutcome {
    [0.01, 0.1, 0.2]
        .into_iter()
        .map(|by| {
            let mut scene = double_pendulum();
            scene.bodies[0].position[0] += by;
            scene.bodies[1].position[1] -= by;
            scene.bodies[1].position[2] += 0.5 * by;
            corrected(scene, 2.0 * by, "positions", method)
        })
        .fold(StressOutcome::nothing(StressVerdict::Survived, String::new()), StressOutcome::and)
}

fn velocities_off(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = double_pendulum();
    scene.bodies[0].velocity = [3.0, -1.0, 2.0];
    scene.bodies[0].angular_velocity = [1.0, -1.0, 2.0];
    scene.bodies[1].velocity = [-3.0, 1.0, 0.5];
    corrected(scene, 1e-9, "velocities", method)
}

fn not_orthonormal(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = double_pendulum();
    scene.bodies[1].orientation = Some(Orientation::directors([1.1, 0.05, 0.0], [-0.05, 0.93, 0.02]));
    corrected(scene, 0.2, "orthonormal", method)
}

fn left_handed(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = double_pendulum();
    let (u, v) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    scene.bodies[1].orientation = Some(Orientation::Directors { u, v, w: Some([0.0, 0.0, -1.0]) });
    must_be_refused(&scene, method, "orientation-invalid", &["\"lower\""])
}

fn parallel(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = double_pendulum();
    scene.bodies[0].orientation = Some(Orientation::directors([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]));
    must_be_refused(&scene, method, "orientation-invalid", &["\"upper\""])
}

fn unreachable(method: &TrialMethod, _: bool) -> StressOutcome {
    let mut scene = double_pendulum();
    let mut hand = pin("hand", GROUND, "lower", [0.0; 2]);
    hand.point = None;
    (hand.point_i, hand.point_j) = (Some([4.0, 0.0, 0.0]), Some([0.5, 0.0, 0.0]));
    scene.joints.push(hand);
    must_be_refused(&scene, method, "assembly-failed|start-too-far", &["\"hand\""])
}
