//! Numbers that arithmetic does not carry are refused; those next to them give the results of ordinary ones.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use serde_json::{Value, json};
use triad_engine::prelude::*;
use triad_engine::reactions::report::Convention;

/// Two bars of mass m and length L, one behind the other, let go.
fn bars(mass: f64, length: f64) -> Value {
    let inertia = mass * length * length / 12.0;
    let bar = |name: &str, place: f64| {
        json!({
            "name": name, "mass": mass, "position": [place * length, 0, 0], "inertia": { "principal": [0, inertia, inertia] }
        })
    };
    let pin = |name: &str, bodies: [&str; 2], place: f64| {
        json!({
            "name": name, "type": "revolute", "body_i": bodies[0], "body_j": bodies[1], "point": [place * length, 0, 0],
            "axis": [0, 0, 1]
        })
    };
    json!({
        "name": "bars", "gravity": [0, -9.81 * length, 0], "bodies": [bar("a", 0.5), bar("b", 1.5)],
        "joints": [pin("first", ["ground", "a"], 0.0), pin("second", ["a", "b"], 1.0)],
        "simulation": { "duration": 0.1 }
    })
}

fn read(scene: &Value) -> Scene {
    Scene::from_json(&scene.to_string()).unwrap()
}

#[test]
fn what_arithmetic_does_not_carry_is_refused_with_its_place_and_bounds() {
    for (pointer, number, bound) in [
        ("/bodies/0/mass", json!(1e61), "1e60"),
        ("/bodies/0/mass", json!(1e160), "1e60"),
        ("/bodies/1/mass", json!(1e-61), "1e-60"),
        ("/bodies/0/inertia/principal", json!([1e101, 1e101, 1e101]), "1e100"),
        ("/bodies/0/position", json!([0, 1e31, 0]), "1e30"),
        ("/bodies/0/velocity", json!([0, -1e31, 0]), "1e30"),
        ("/bodies/0/angular_velocity", json!([0, 0, 1e31]), "1e30"),
        ("/bodies/0/center_of_mass", json!([0, 0, 1e31]), "1e30"),
        ("/joints/0/point", json!([1e31, 0, 0]), "1e30"),
        ("/gravity", json!([0, -1e31, 0]), "1e30"),
    ] {
        let mut scene = bars(1.0, 1.0);
        let key = pointer.rsplit_once('/').unwrap();
        scene.pointer_mut(key.0).unwrap()[key.1] = number.clone();
        let error = Simulation::new(&read(&scene)).unwrap_err();
        let (told, hint) = (error.to_string(), error.hint());
        assert_eq!(error.code(), "out-of-range", "{told}");
        assert!(told.contains(pointer) && told.contains(bound) && hint.contains(bound), "{told} {hint}");
        assert!(told.len() < 120, "no rows of zeros: {told}");
    }
}

#[test]
fn within_the_bounds_results_are_those_of_ordinary_numbers() {
    let forces = |mass: f64, length: f64| {
        let mut run = Simulation::new(&read(&bars(mass, length))).unwrap();
        run.advance_to(0.1).unwrap();
        let report = run.reactions(Convention::default()).unwrap();
        let forces =
            report.reactions.iter().flat_map(|reaction| reaction.force[..2].iter().map(|part| part.value));
        forces.map(|force| force / (mass * length)).collect::<Vec<f64>>()
    };
    let expected = forces(1.0, 1.0);
    for (mass, length) in [(1e60, 1.0), (1e-60, 1.0), (1e60, 1e3), (1e-30, 1e-6)] {
        let found = forces(mass, length);
        let apart = found.iter().zip(&expected).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(apart < 1e-6, "{mass:e} kg, {length:e} m: {found:?} instead of {expected:?}");
    }
}
