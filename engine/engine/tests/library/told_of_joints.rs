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
