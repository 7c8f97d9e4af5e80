//! What is told of joints that a scene states in a way that it may not expect.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::prelude::*;

fn scene(written: &Value) -> Scene {
    Scene::from_json(&written.to_string()).unwrap()
}

/// A velocity that gives way to the rate of a joint is told, one that agrees with it is not.
#[test]
fn a_stated_velocity_that_a_start_replaces_is_told() {
    let notes = |velocity: [f64; 3]| {
        let block = |name: &str, velocity: [f64; 3]| json!({ "name": name, "mass": 1, "inertia": { "principal": [1, 1, 1] }, "velocity": velocity });
        let scene = scene(&json!({
            "name": "floating", "bodies": [block("first", [0.0; 3]), block("second", velocity)],
            "joints": [{ "name": "rail", "type": "prismatic", "body_i": "first", "body_j": "second", "point": [0, 0, 0],
                "axis": [1, 0, 0], "start": { "speed": 0.5 } }],
        }));
        let run = Simulation::new(&scene).unwrap();
        let replaced = run.notes().iter().any(|note| note.contains("body \"second\" moves as the \"start\""));
        (replaced, run.frame().bodies[1].velocity)
    };
    assert_eq!(notes([1.0, 2.0, 0.0]), (true, [0.5, 0.0, 0.0]));
    assert_eq!(notes([0.5, 0.0, 0.0]), (false, [0.5, 0.0, 0.0]));
    assert!(!notes([0.0; 3]).0);
}

/// A gear knows the joints before it, and says so.
#[test]
fn a_gear_before_its_joints_is_told_to_stand_after_them() {
    let hinge = |name: &str, body: &str| json!({ "name": name, "type": "revolute", "body_i": "ground", "body_j": body, "point": [0, 0, 0], "axis": [0, 0, 1] });
    let wheel = |name: &str| json!({ "name": name, "mass": 1, "inertia": { "principal": [1, 1, 1] } });
    let gear = json!({ "name": "gear", "type": "gear", "joints": ["a", "b"], "ratio": 2 });
    let wrong = scene(
        &json!({ "name": "order", "bodies": [wheel("x"), wheel("y")], "joints": [hinge("a", "x"), gear, hinge("b", "y")] }),
    );
    let error = Simulation::new(&wrong).unwrap_err().to_string();
    assert!(
        error.contains("there is no joint \"b\" before it; a gear is written after its two joints"),
        "{error}"
    );
}

/// The notes of starts of two hinges in a plane, of which drivers, or a gear of ratio 3, may leave something else.
fn told_of_starts(starts: &[Value; 2], driver: Option<Value>, geared: bool) -> Vec<String> {
    let hinge = |name: &str, body: &str, x: f64, start: &Value| {
        json!({ "name": name, "type": "revolute", "body_i": "ground", "body_j": body, "point": [x, 0, 0], "axis": [0, 0, 1],
            "start": start })
    };
    let wheel = |name: &str, x: f64| json!({ "name": name, "mass": 1, "inertia": { "principal": [1, 1, 1] }, "position": [x, 0, 0] });
    let mut joints = vec![hinge("r", "p", 0.0, &starts[0]), hinge("r2", "q", 1.0, &starts[1])];
    if geared {
        joints.push(json!({ "name": "g", "type": "gear", "joints": ["r", "r2"], "ratio": 3 }));
    }
    let drivers: Vec<Value> = driver
        .map(|motion| json!({ "type": "angle", "name": "m", "joint": "r", "motion": motion }))
        .into_iter()
        .collect();
    let scene = scene(&json!({
        "name": "starts", "bodies": [wheel("p", 0.0), wheel("q", 1.0)], "joints": joints, "drivers": drivers,
    }));
    let run = Simulation::new(&scene).unwrap();
    run.notes().iter().filter(|note| note.contains("are given for the start")).cloned().collect()
}

/// What is given of a joint for the start and the start does not have is told with both numbers, however little it lacks, and what
/// agrees is not.
#[test]
fn a_start_that_another_one_or_a_driver_replaces_is_told() {
    let none = || json!({});
    let ramp = |start: f64, rate: f64| Some(json!({ "kind": "ramp", "start": start, "rate": rate }));
    let by_driver = |given: &str, taken: &str| {
        vec![format!(
            "joint \"r\": {given} are given for the start, but driver \"m\" prescribes {taken} there"
        )]
    };
    for (given, taken) in [(0.1, 0.5), (0.3, 0.1), (0.0, 0.3), (0.3, 0.0), (0.3, 0.299)] {
        let told = told_of_starts(&[json!({ "angle": given }), none()], ramp(taken, 0.0), false);
        assert_eq!(told, by_driver(&format!("{given} rad"), &format!("{taken} rad")));
    }
    let told = told_of_starts(&[json!({ "rate": 5.0 }), none()], ramp(0.0, 5.4), false);
    assert_eq!(told, by_driver("5 rad/s", "5.4 rad/s"));
    // Whole turns count.
    let given = 0.5 + std::f64::consts::TAU;
    let told = told_of_starts(&[json!({ "angle": given }), none()], ramp(0.5, 2.0), false);
    assert_eq!(told, by_driver(&format!("{given} rad"), "0.5 rad"));
    // What agrees, rounding aside.
    for given in [0.5, 0.500_000_3] {
        let told = told_of_starts(&[json!({ "angle": given, "rate": 2.0 }), none()], ramp(0.5, 2.0), false);
        assert!(told.is_empty(), "{told:?}");
    }
    let geared = |rates: [f64; 2]| told_of_starts(&rates.map(|rate| json!({ "rate": rate })), None, true);
    let left = |joint: &str, given: &str, taken: &str| {
        format!(
            "joint \"{joint}\": {given} rad/s are given for the start, but all that is given together leaves {taken} rad/s"
        )
    };
    let told = geared([1.0, 3.25]);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(geared([1.0, 3.0]).is_empty() || geared([1.0, -3.0]).is_empty());
    assert!(told[0].starts_with(&left("r", "1", "")[..60]), "{told:?}");
    assert!(told[1].starts_with(&left("r2", "3.25", "")[..60]), "{told:?}");
}
