//! Equilibria and modes of mechanisms of any size: what is nothing is decided beside the mechanism, never by rounding beside itself.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use serde_json::{Value, json};
use std::f64::consts::TAU;
use triad_engine::analysis::{Modes, ModesAbout, equilibrium, modes};
use triad_engine::catalogue;
use triad_engine::scene::Scene;

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string()).unwrap()
}

fn kinds(found: &Modes) -> Vec<&'static str> {
    found.modes.iter().map(|mode| mode.kind).collect()
}

fn oscillating(found: &Modes) -> Vec<f64> {
    found.modes.iter().filter(|mode| mode.kind == "oscillates").map(|mode| TAU * mode.frequency).collect()
}

fn near(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < relative, "{found} instead of {expected}");
    }
}

/// A door on a vertical axis meets no stiffness; its only one is rounding.
#[test]
fn a_door_of_any_size_stands_anywhere() {
    let path =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/scenes/lesson-18-redundant-constraints.json");
    let door: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    // Each mass has a rounding of its own.
    for mass in std::iter::successors(Some(20.0), |mass| Some(mass * 1.37)).take(40) {
        let mut scene_of = door.clone();
        scene_of.as_object_mut().unwrap().remove("parameters");
        scene_of["gravity"] = json!([0, 0, -9.81]);
        let body = &mut scene_of["bodies"][0];
        body["mass"] = json!(mass);
        body["inertia"] =
            json!({ "principal": ([6.669_333_333, 8.333_333_333, 1.669_333_333].map(|j| j * mass / 20.0)) });
        let found = equilibrium(&scene(&scene_of)).unwrap();
        assert_eq!(found.stable, None, "a door of {mass} kg: {}", found.least_stiffness);
    }
}

/// A point on four springs that cross in it: m ω² = 2 k + 2 k (1 − l₀/l) along one pair, and across both 2 k (1 − l₀/l) of each. Its turns
/// have neither inertia nor stiffness.
#[test]
fn a_point_on_springs_swings_in_three_directions() {
    for length in [1.0, 1e-1, 1e-2, 1e-3, 1e3] {
        let spring = |name: &str, [x, y]: [f64; 2], free: f64| {
            json!({ "name": name, "type": "spring", "body_i": "ground", "point_i": [x * length, y * length, 0], "body_j": "m",
                "point_j": [0, 0, 0], "stiffness": 100, "free_length": free * length })
        };
        let springs = [
            spring("a", [1.0, 0.0], 0.5),
            spring("b", [-1.0, 0.0], 0.5),
            spring("c", [0.0, 1.0], 0.3),
            spring("d", [0.0, -1.0], 0.3),
        ];
        let found = modes(
            &scene(&json!({ "name": "star", "gravity": [0, 0, 0], "bodies": [{ "name": "m", "mass": 1 }], "loads": springs })),
            ModesAbout::Equilibrium,
        )
        .unwrap();
        near(&oscillating(&found), &[240f64.sqrt(), 300f64.sqrt(), 340f64.sqrt()], 1e-9);
        assert_eq!((found.modes.len(), found.left_out), (3, 3), "{length} m: {:?}", kinds(&found));
    }
}

/// A rod of one metre hangs by its pin, and a taut spring that is far shorter pulls its end along: J ω² = m g l/2 + T l (1 + l/s), s the
/// spring's length and T its pull.
#[test]
fn a_short_taut_spring_has_its_geometric_stiffness() {
    for short in [1e-1_f64, 1e-2, 1e-3] {
        let pull: f64 = 3.0;
        let found = modes(
            &scene(&json!({
                "name": "taut", "gravity": [0, -9.81, 0],
                "bodies": [{ "name": "rod", "mass": 1, "inertia": { "principal": [0.0, 1.0 / 12.0, 1.0 / 12.0] },
                    "center_of_mass": [0.5, 0, 0], "orientation": { "axis": [0, 0, 1], "angle": -TAU / 4.0 } }],
                "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "point_i": [0, 0, 0], "body_j": "rod",
                    "point_j": [0, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1] }],
                "loads": [{ "name": "wire", "type": "spring", "body_i": "ground", "point_i": [0, -1.0 - short, 0], "body_j": "rod",
                    "point_j": [1, 0, 0], "force": pull }]
            })),
            ModesAbout::Equilibrium,
        )
        .unwrap();
        let exact = ((9.81 / 2.0 + pull * (1.0 + 1.0 / short)) * 3.0).sqrt();
        near(&oscillating(&found), &[exact], 1e-9);
    }
}

/// Three bodies in a row, damped in their joints but for the last, which may spin about the weight: one drift, and nothing grows.
#[test]
fn what_drifts_in_a_small_mechanism_is_told_once() {
    for length in std::iter::successors(Some(1e3), |length| Some(length * 0.55)).take(36) {
        let mass = length * length;
        let (force, moment) = (mass * length, mass * length * length);
        let body = |name: &str, m: f64, place: [f64; 3], angle: f64| {
            json!({ "name": name, "mass": m * mass, "inertia": { "principal": ([0.3, 0.5, 0.7].map(|j| j * moment)) },
                "position": place.map(|x| x * length), "center_of_mass": ([0.1, -0.2, 0.15].map(|x| x * length)),
                "orientation": { "axis": [1, 2, 3], "angle": angle } })
        };
        let joint = |name: &str, kind: &str, [i, j]: [&str; 2], point: [f64; 3]| json!({ "name": name, "type": kind, "body_i": i, "body_j": j, "point": point.map(|x| x * length) });
        let mut pin = joint("pin", "revolute", ["ground", "a"], [0.0; 3]);
        pin["axis"] = json!([0, 1, 1]);
        let mut tube = joint("tube", "cylindrical", ["a", "b"], [1.0, 0.0, 0.0]);
        tube["axis"] = json!([1, 0.2, 0.3]);
        let found = modes(
            &scene(&json!({
                "name": "row", "gravity": ([1.0, -2.0, -5.0].map(|x| x * length)),
                "bodies": [body("a", 2.0, [0.5, 0.2, 0.1], 2.7), body("b", 1.5, [1.0, 0.5, -0.3], 2.2), body("c", 1.0, [1.5, 0.1, 0.4], 1.7)],
                "joints": [pin, tube, joint("ball", "spherical", ["b", "c"], [1.2, 0.3, 0.2])],
                "loads": [
                    { "name": "p", "type": "torsion", "joint": "pin", "stiffness": 15.0 * moment, "free_angle": 0.2, "damping": 4.8 * moment },
                    { "name": "t", "type": "torsion", "joint": "tube", "stiffness": 5.0 * moment, "damping": 4.3 * moment },
                    { "name": "s", "type": "slider", "joint": "tube", "stiffness": 20.0 * force / length, "damping": 4.8 * force / length }]
            })),
            ModesAbout::Equilibrium,
        )
        .unwrap();
        let drifting = kinds(&found).iter().filter(|kind| **kind == "drifts").count();
        let none = found.modes.iter().filter(|mode| mode.growth > -1e-9 && mode.kind != "drifts").count();
        assert_eq!((drifting, none), (1, 0), "{length} m, {mass} kg: {:?}", kinds(&found));
    }
}

/// About a start that is no equilibrium K is not symmetric, and pairs of what rounding left of zero were told to grow and decay.
#[test]
fn what_meets_no_stiffness_at_a_start_drifts() {
    let found = modes(&catalogue::scene("spatial-double-pendulum").unwrap(), ModesAbout::Start).unwrap();
    assert_eq!(kinds(&found), ["drifts"; 6], "{:?}", found.modes);
}
