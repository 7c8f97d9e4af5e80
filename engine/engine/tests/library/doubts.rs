//! Runs that are right are not doubted, wherever their energies begin and end.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::prelude::*;
use triad_engine::run::Summary;

fn summary(written: &Value) -> Summary {
    let scene = Scene::from_json(&written.to_string()).unwrap();
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(run.duration()).unwrap();
    run.summary()
}

/// A body on a rail.
fn slider(name: &str) -> Value {
    json!({
        "name": name, "gravity": [0, 0, 0], "bodies": [{ "name": "m", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] } }],
        "joints": [{ "name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "m", "point": [0, 0, 0], "axis": [1, 0, 0] }],
        "simulation": { "duration": 1, "every": 0.05 },
    })
}

fn undoubted(written: &Value) {
    let summary = summary(written);
    assert!(
        summary.doubts.is_empty(),
        "{}: {} J, {:?}",
        written["name"],
        summary.energy_drift,
        summary.doubts
    );
}

/// One step leads from rest to rest: its ends have no kinetic energy, and the work is zero.
#[test]
fn motions_from_rest_to_rest_are_not_doubted() {
    for integrator in ["auto", "dop853", "radau"] {
        let mut driven = slider("smooth step");
        driven["drivers"] = json!([{ "name": "d", "type": "slide", "joint": "rail",
            "motion": { "kind": "smooth-step", "from": 0, "to": 1, "start": 0.2, "end": 0.8 } }]);
        let mut pushed = slider("there and stop");
        pushed["loads"] = json!([{ "name": "f", "type": "slider", "joint": "rail", "force": { "kind": "expression", "value": "t-0.5" } }]);
        let mut back = slider("there and back");
        back["loads"] = json!([{ "name": "f", "type": "slider", "joint": "rail",
            "force": { "kind": "expression", "value": "cos(2*pi*t)" } }]);
        for mut written in [driven, pushed, back] {
            written["simulation"]["integrator"] = json!(integrator);
            undoubted(&written);
        }
    }
}

/// A block that friction holds creeps: it gives all of its weight's work away, and never has any speed to speak of.
#[test]
fn a_block_that_creeps_is_not_doubted() {
    for tolerance in [1e-3, 1e-5, 1e-9] {
        let mut written = slider("rest on a slope");
        written["gravity"] = json!([-1.948_946_135_099_550_7, 0, -9.614_453_128_622_58]);
        written["loads"] = json!([{ "name": "f", "type": "slider", "joint": "rail",
            "friction": { "coefficient": 0.3, "smoothing": 1e-7 } }]);
        written["simulation"]["tolerance"] = json!(tolerance);
        undoubted(&written);
    }
}

/// Weights above and below the zero of heights, whose potential energies cancel, barely move: the drift is their rounding.
#[test]
fn rounding_of_energies_that_cancel_is_not_doubted() {
    let pendulum = |name: &str, height: f64| {
        let body = json!({ "name": name, "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] }, "position": [0, height - 1.0, 0] });
        let joint = json!({ "name": format!("pin of {name}"), "type": "revolute", "body_i": "ground", "body_j": name, "point": [0, height, 0],
            "axis": [0, 0, 1], "start": { "rate": 1e-6 } });
        (body, joint)
    };
    let ((upper, first), (lower, second)) = (pendulum("upper", 101.0), pendulum("lower", -99.0));
    for integrator in ["taylor", "dop853"] {
        undoubted(&json!({
            "name": integrator, "gravity": [0, -9.81, 0], "bodies": [upper, lower], "joints": [first, second],
            "simulation": { "duration": 3, "integrator": integrator },
        }));
    }
}

/// What comes from nowhere is still told.
#[test]
fn energy_from_nowhere_is_told() {
    let mut written = slider("swinging");
    written["gravity"] = json!([0, -9.81, 0]);
    written["joints"][0]["type"] = json!("revolute");
    written["joints"][0]["axis"] = json!([0, 0, 1]);
    written["joints"][0]["point"] = json!([-1, 0, 0]);
    for damping in [0.0, 0.01] {
        let mut written = written.clone();
        written["loads"] =
            json!([{ "name": "f", "type": "torsion", "joint": "rail", "friction": { "viscous": damping } }]);
        written["simulation"] = json!({ "duration": 5, "integrator": "dop853", "step": 0.25 });
        let summary = summary(&written);
        let told =
            summary.doubts.iter().any(|doubt| doubt.contains("of the energy in play came from nowhere"));
        assert!(told, "{} J, {:?}", summary.energy_drift, summary.doubts);
    }
}
