//! Light links that carry heavy bodies: reactions are large for what they act on.

#![allow(clippy::unwrap_used)]

use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

const WAYS: [IntegratorKind; 3] = [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Radau];

fn run(value: &Value, way: IntegratorKind) -> Simulation {
    run_at(value, way, None, 1.0)
}

fn run_at(value: &Value, way: IntegratorKind, tolerance: Option<f64>, end: f64) -> Simulation {
    let mut scene = Scene::from_json(&value.to_string()).unwrap().integrator(way);
    if let Some(tolerance) = tolerance {
        scene = scene.tolerance(tolerance);
    }
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(end).unwrap();
    run
}

/// A light link with two hinges that cross at right angles in one point, under a heavy body: without mass it is a universal joint. Its mass
/// makes pivots small, which is no singular position.
#[test]
fn a_light_link_carries_a_heavy_body_as_a_universal_joint_does() {
    let scene = |link: Option<f64>| {
        let hinge = |name: &str, i: &str, j: &str, axis: [f64; 3]| json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [0, 0, 0], "axis": axis});
        let inner = [1.0, 0.0, 0.0];
        let outer = [0.0, 0.8, 0.6];
        let mut bodies = vec![json!({
            "name": "weight", "mass": 40, "position": [0.6, -0.3, -0.8],
            "inertia": {"tensor": [[1.1, 0.2, -0.1], [0.2, 1.4, 0.15], [-0.1, 0.15, 0.9]]}
        })];
        let mut joints = Vec::new();
        if let Some(mass) = link {
            let principal = [0.01 * mass, 0.02 * mass, 0.015 * mass];
            bodies.push(json!({"name": "link", "mass": mass, "inertia": {"principal": principal}, "position": [0.05, 0.1, 0.02]}));
            joints.push(hinge("inner", "ground", "link", inner));
            joints.push(hinge("outer", "link", "weight", outer));
        } else {
            joints.push(json!({"name": "both", "type": "universal", "body_i": "ground", "body_j": "weight", "point": [0, 0, 0], "axis_i": inner, "axis_j": outer}));
        }
        json!({"name": "link", "bodies": bodies, "joints": joints, "simulation": {"duration": 1}})
    };
    for way in WAYS {
        let at_end = |link: Option<f64>| {
            let run = run(&scene(link), way);
            let state = run.state();
            let force = state.multipliers()[0].force;
            let worth = run.reaction_errors().unwrap().force;
            (force, state.mass_accelerations()[0], worth)
        };
        let (force, acceleration, _) = at_end(None);
        for mass in [1e-4, 1e-5, 1e-6, 1e-7, 5e-8] {
            let (on_link, with_link, worth) = at_end(Some(mass));
            let near = 0.1 * mass + 1e-6;
            for k in 0..3 {
                let off = (on_link[k] - force[k]).abs();
                assert!(off < 400.0 * near, "{mass:e} kg, {way}: {on_link:?} N for {force:?} N");
                assert!(
                    off < 10.0 * worth + 40.0 * mass,
                    "{mass:e} kg, {way}: off by {off:e} N, told {worth:e} N"
                );
                let off = (with_link[k] - acceleration[k]).abs();
                assert!(
                    off < 10.0 * near,
                    "{mass:e} kg, {way}: {with_link:?} m/s² for {acceleration:?} m/s²"
                );
            }
        }
    }
}

/// A rod on a pin of the ground that a heavy one hangs on.
fn rod_under_load(mass: f64) -> Value {
    json!({
        "name": "rods",
        "bodies": [
            {"name": "rod", "mass": mass, "inertia": {"principal": [8.3e-6 * mass, 8.3e-4 * mass, 8.3e-4 * mass]}, "center_of_mass": [0.05, 0, 0]},
            {"name": "load", "mass": 1000, "inertia": {"principal": [0.83, 83, 83]}, "center_of_mass": [0.5, 0, 0], "position": [0.1, 0, 0]}
        ],
        "joints": [
            {"name": "pin", "type": "revolute", "body_i": "ground", "body_j": "rod", "point_i": [0, 0, 0], "point_j": [0, 0, 0], "axis": [0, 0, 1],
             "start": {"angle": -1.57, "rate": 0}},
            {"name": "hook", "type": "revolute", "body_i": "rod", "body_j": "load", "point_i": [0.1, 0, 0], "point_j": [0, 0, 0], "axis": [0, 0, 1],
             "start": {"angle": 0.07, "rate": 0.3}}
        ],
        "gravity": [0, -9.81, 0], "simulation": {"duration": 3}
    })
}

/// A small ring on a shaft with an arm on a pin across it, whose weight the ring feels as a moment.
fn arm_on_a_ring(mass: f64) -> Value {
    json!({
        "name": "ring",
        "bodies": [
            {"name": "ring", "mass": mass, "inertia": {"principal": [1e-6 * mass, 1.2e-6 * mass, 1.5e-6 * mass]}},
            {"name": "arm", "mass": 10, "inertia": {"principal": [0.1, 0.8, 0.85]}, "center_of_mass": [0.5, 0.02, 0.03]}
        ],
        "joints": [
            {"name": "shaft", "type": "revolute", "body_i": "ground", "body_j": "ring", "point": [0, 0, 0], "axis": [0, 1, 0], "start": {"rate": 0.5}},
            {"name": "pin", "type": "revolute", "body_i": "ring", "body_j": "arm", "point": [0, 0, 0], "axis": [0, 0, 1], "start": {"rate": 1}}
        ],
        "gravity": [0, 0, -9.81], "simulation": {"duration": 3}
    })
}

/// S that was factored a little beside the state turns reactions a little, which is much for a light link: rods were a hundred times as far
/// off as the tolerance allows, arms on rings a thousand times, and nothing was known of the error of these.
#[test]
fn what_a_light_link_carries_moves_as_exactly_as_the_tolerance_asks() {
    for (scene, masses) in [
        (rod_under_load as fn(f64) -> Value, [100.0, 1.0, 0.1, 0.01]),
        (arm_on_a_ring, [10.0, 1.0, 0.3, 0.1]),
    ] {
        for mass in masses {
            let value = scene(mass);
            let exact = run_at(&value, IntegratorKind::Dop853, Some(1e-13), 3.0);
            for tolerance in [1e-6, 1e-8] {
                let found = run_at(&value, IntegratorKind::Taylor, Some(tolerance), 3.0);
                let off =
                    found.q().iter().zip(exact.q()).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                let told = found.error_estimate().unwrap();
                let told = told.position.max(told.turn);
                assert!(off < 2.0 * tolerance, "{value}, {tolerance:e}: off by {off:e}");
                assert!(
                    off < 3.0 * told + 1e-10 && told < 5.0 * off + 1e-10,
                    "{mass} kg, {tolerance:e}: off by {off:e}, told {told:e}"
                );
            }
        }
    }
}
