//! Equilibria and modes of mechanisms of any size: what is nothing is decided beside the mechanism, never by rounding beside itself.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use serde_json::{Value, json};
use std::f64::consts::TAU;
use triad_engine::analysis::{Modes, ModesAbout, check, equilibrium, modes};
use triad_engine::catalogue;
use triad_engine::prelude::Simulation;
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

/// A wheel about its centre has no arms, whatever rounding leaves of the place of its hub: small beside a radius of gyration is no length.
#[test]
fn a_hub_is_no_length_of_a_wheel() {
    let wheel = |x: f64| {
        scene(&json!({
            "name": "wheel", "gravity": [0, 0, -9.81], "simulation": { "duration": 2 },
            "bodies": [{ "name": "wheel", "mass": 2, "inertia": { "principal": [0.02, 0.03, 0.04] }, "position": [x, 0.1, 0],
                "angular_velocity": [0, 0, 3] }],
            "joints": [{ "name": "hub", "type": "revolute", "body_i": "ground", "body_j": "wheel", "point": [0.3, 0.1, 0], "axis": [0, 0, 1] }],
            "loads": [{ "name": "spring", "type": "torsion", "joint": "hub", "stiffness": 1 }]
        }))
    };
    for x in [0.3, 0.1 + 0.2] {
        let mut run = Simulation::new(&wheel(x)).unwrap();
        let radius = (0.04_f64 / 2.0).sqrt();
        assert!((run.system().length / radius - 1.0).abs() < 1e-12, "{} m", run.system().length);
        run.advance_to(2.0).unwrap();
        let summary = run.summary();
        assert!(summary.doubts.is_empty(), "{:?}", summary.doubts);
        let found = modes(&wheel(x), ModesAbout::Equilibrium).unwrap();
        near(&oscillating(&found), &[5.0], 1e-9);
    }
}

/// Points have neither arms nor inertia: what they are tied to is as long as their mechanism.
#[test]
fn points_on_springs_doubt_errors_of_their_own_size() {
    for length in [1.0, 1e-3] {
        // x'' = −ω² x with ω = 10 rad/s, whatever the unit of length.
        let oscillator = json!({
            "name": "oscillator", "gravity": [0, 0, 0], "simulation": { "duration": 5, "tolerance": 1e-4, "integrator": "dopri5" },
            "bodies": [{ "name": "m", "mass": 1, "position": [0.5 * length, 0, 0] }],
            "loads": [{ "name": "s", "type": "spring", "body_i": "ground", "point_i": [-length, 0, 0], "body_j": "m",
                "point_j": [0, 0, 0], "stiffness": 100, "free_length": length }]
        });
        let mut run = Simulation::new(&scene(&oscillator)).unwrap();
        assert!((run.system().length / (1.5 * length) - 1.0).abs() < 1e-12, "{} m", run.system().length);
        run.advance_to(5.0).unwrap();
        let summary = run.summary();
        let off = summary.error.is_none_or(|error| error.position > 0.01 * run.system().length);
        assert_eq!(off, !summary.doubts.is_empty(), "{length} m: {:?}, {:?}", summary.error, summary.doubts);
        assert_eq!(off, length == 1e-3, "a tenth of a millimetre is much of one: {:?}", summary.error);
    }
}

/// How far a start may be off is a part of the mechanism, not of a metre: a rod that is found a length and a half beside its hinge was
/// meant to stand elsewhere.
#[test]
fn a_start_that_is_far_off_is_refused_in_any_unit() {
    for length in [1.0, 1e-3, 1e3] {
        let rod = |off: f64| {
            scene(&json!({
                "name": "rod", "gravity": [0, 0, -9.81 * length],
                "bodies": [{ "name": "rod", "mass": 1, "inertia": { "principal": ([0.01, 0.09, 0.09].map(|j| j * length * length)) },
                    "position": [(0.5 + off) * length, 0, 0] }],
                "joints": [{ "name": "hinge", "type": "revolute", "body_i": "ground", "body_j": "rod", "point_i": [0, 0, 0],
                    "point_j": [-0.5 * length, 0, 0], "axis": [0, 1, 0] }]
            }))
        };
        assert!(check::check(&rod(0.2)).is_ok(), "{length} m");
        let refused = check::check(&rod(1.5)).unwrap_err();
        assert_eq!(refused.code(), "start-too-far", "{length} m: {refused}");
    }
}

/// A steady motion and the small motions about it are found in any units of length and mass.
#[test]
fn steady_motions_are_found_in_any_unit() {
    let plate = |length: f64, mass: f64| {
        let inertia = mass * length * length;
        let scene = scene(&json!({
            "name": "plate", "gravity": [0, 0, 0],
            "bodies": [{ "name": "plate", "mass": 12.0 * mass, "inertia": { "principal": [inertia, 2.0 * inertia, 3.0 * inertia] },
                "angular_velocity": [1, 2, 3] }]
        }));
        modes(&scene, ModesAbout::Steady)
    };
    let usual = plate(1.0, 1.0).unwrap();
    assert!(!oscillating(&usual).is_empty());
    for (length, mass) in [(1e-1, 1.0), (1e-3, 1.0), (1e-3, 1e-6), (1e3, 1e6)] {
        let found = plate(length, mass).unwrap_or_else(|error| panic!("{length} m, {mass} kg: {error}"));
        assert_eq!(kinds(&found), kinds(&usual), "{length} m, {mass} kg");
        near(&oscillating(&found), &oscillating(&usual), 1e-6);
        // It is the same anywhere, and so it is where it was.
        let way = nalgebra::Vector3::from(found.bodies[0].position).norm() / length;
        assert!(way < 1e-6, "{length} m, {mass} kg: moved by {way} lengths");
    }
}

/// A disc that a motor spins on a shaft, which a universal joint carries and springs hold, `away` from the world's origin.
fn rotor(away: f64) -> Scene {
    let at = |[x, y, z]: [f64; 3]| [away + x, 0.7 * away + y, 0.4 * away + z];
    let springs: Vec<Value> = [[30.0, 0.0], [0.0, 30.0], [-30.0, 0.0], [0.0, -30.0]]
        .iter()
        .enumerate()
        .map(|(k, [x, y])| {
            json!({ "type": "spring", "name": format!("s{k}"), "body_i": "ground", "body_j": "shaft", "point_i": at([*x, *y, 9.0]),
                "point_j": [0, 0, 1.5], "stiffness": 300, "damping": 0.1, "free_length": 27 })
        })
        .collect();
    scene(&json!({
        "name": "rotor", "gravity": [0, 0, 0],
        "bodies": [
            { "name": "shaft", "mass": 0.3, "position": at([0.0, 0.0, 7.5]), "inertia": { "principal": [9, 9, 0.45] } },
            { "name": "disc", "mass": 2, "position": at([0.0, 0.0, 15.0]), "inertia": { "principal": [18, 18, 27] } }],
        "joints": [
            { "type": "universal", "name": "u", "body_i": "ground", "body_j": "shaft", "point": at([0.0; 3]), "axes": [[1, 0, 0], [0, 1, 0]] },
            { "type": "revolute", "name": "r", "body_i": "shaft", "body_j": "disc", "point": at([0.0, 0.0, 15.0]), "axis": [0, 0, 1] }],
        "loads": springs,
        "drivers": [{ "type": "angle", "name": "D", "joint": "r", "motion": { "kind": "ramp", "rate": 1000 } }]
    }))
}

/// Nothing depends on where the world's origin is.
#[test]
fn steady_motions_are_the_same_far_from_the_origin() {
    let here = modes(&rotor(0.0), ModesAbout::Steady).unwrap();
    assert_eq!(oscillating(&here).len(), 2);
    for away in [100.0, 1e4] {
        let there = modes(&rotor(away), ModesAbout::Steady).unwrap();
        assert_eq!(kinds(&there), kinds(&here), "{away} m");
        near(&oscillating(&there), &oscillating(&here), 1e-7);
        let steady = there.steady.unwrap();
        assert!(steady.spins.len() == 1 && (steady.spins[0].rate / 1000.0 - 1.0).abs() < 1e-10, "{steady:?}");
        assert_eq!((steady.turning, steady.sliding), ([0.0; 3], [0.0; 3]), "{away} m");
    }
}
