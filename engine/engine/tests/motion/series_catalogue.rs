//! Every motion, driver, load and row of the catalogue by its recurrence, against DOP853, which knows none of them.

#![allow(clippy::unwrap_used)]

use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

/// Two asymmetric bodies on a revolute and a cylindrical joint, a third one on the joint given, all oblique.
fn machine(joint: &Value, more: &[(&str, Value)]) -> Value {
    let body = |name: &str, mass: f64, at: [f64; 3], spin: [f64; 3]| {
        json!({ "name": name, "mass": mass, "inertia": { "principal": [0.3, 0.5, 0.7] }, "position": at,
            "center_of_mass": [0.1, -0.2, 0.15], "orientation": { "axis": [1, 2, 3], "angle": 0.7 + mass },
            "angular_velocity": spin })
    };
    let mut scene = json!({
        "name": "machine", "gravity": [1, -2, -5],
        "bodies": [body("a", 2.0, [0.5, 0.2, 0.1], [0.3, 0.6, 0.0]), body("b", 1.5, [1.0, 0.5, -0.3], [0.5, 0.6, -0.2]),
                   body("c", 1.0, [1.5, 0.1, 0.4], [0.2, 0.4, -0.3])],
        "joints": [
            { "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 1, 1] },
            { "name": "tube", "type": "cylindrical", "body_i": "a", "body_j": "b", "point": [1, 0, 0], "axis": [1, 0.2, 0.3] },
        ],
    });
    let mut third = joint.clone();
    third["name"] = "third".into();
    if third["type"] != "gear" {
        third["body_j"] = "c".into();
        if third.get("body_i").is_none() {
            third["body_i"] = "b".into();
        }
    }
    scene["joints"].as_array_mut().unwrap().push(third);
    for (key, value) in more {
        scene[key] = value.clone();
    }
    scene
}

fn ball() -> Value {
    json!({ "type": "spherical", "point": [1.2, 0.3, 0.2] })
}

fn with_loads(loads: &Value) -> Value {
    machine(&ball(), &[("loads", loads.clone())])
}

fn with_drivers(drivers: &Value) -> Value {
    machine(&ball(), &[("drivers", drivers.clone())])
}

/// All kinds of motion that begin at zero with the given rate.
fn motions(rate: f64) -> Vec<(&'static str, Value)> {
    vec![
        ("ramp", json!({ "kind": "ramp", "rate": rate })),
        ("polynomial", json!({ "kind": "polynomial", "coefficients": [0, rate, -0.4, 0.3, 0.05] })),
        ("harmonic", json!({ "kind": "harmonic", "amplitude": rate / 3.0, "frequency": 3 })),
        (
            "smooth-step",
            json!({ "kind": "smooth-step", "from": 0, "to": 2.5 * rate, "start": 0.3, "end": 1.4 }),
        ),
        (
            "table",
            json!({ "kind": "table", "times": [0, 0.4, 0.9, 1.1, 1.7], "values": [0, 0.3, 0.2, -0.3, 0.1] }),
        ),
    ]
}

fn scene(mut value: Value, coordinates: &str, tolerance: f64, integrator: IntegratorKind) -> Scene {
    value["coordinates"] = if coordinates == "mixed" { "full" } else { coordinates }.into();
    if coordinates == "mixed" {
        value["bodies"][0]["coordinates"] = "reduced".into();
    }
    let mut scene = Scene::from_json(&value.to_string()).unwrap();
    scene.simulation.tolerance = tolerance;
    scene.simulation.integrator = integrator;
    scene.simulation.duration = 2.0;
    scene
}

fn places(simulation: &Simulation) -> Vec<f64> {
    let bodies = simulation.frame().bodies;
    bodies
        .iter()
        .flat_map(|b| [b.position, b.u, b.v, b.w, b.velocity, b.angular_velocity].into_iter().flatten())
        .collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |largest, (a, b)| largest.max((a - b).abs()))
}

/// Runs a scene by the series in all coordinates and compares states within steps, multipliers and work with DOP853.
fn agrees(what: &str, value: &Value) {
    let mut exact = Simulation::new(&scene(value.clone(), "full", 1e-13, IntegratorKind::Dop853)).unwrap();
    let times: Vec<f64> = (1..=8).map(|k| f64::from(k) * 0.25 - 0.011).collect();
    let expected: Vec<Vec<f64>> = times
        .iter()
        .map(|&t| {
            exact.advance_to(t).unwrap();
            places(&exact)
        })
        .collect();
    let work = exact.summary().work;
    for coordinates in ["full", "reduced", "mixed"] {
        let mut series =
            Simulation::new(&scene(value.clone(), coordinates, 1e-12, IntegratorKind::Taylor)).unwrap();
        for (&t, expected) in times.iter().zip(&expected) {
            series.advance_to(t).unwrap();
            let error = distance(&places(&series), expected);
            assert!(error < 3e-9, "{what}, {coordinates}, t = {t}: off by {error:e}");
        }
        if series.rank().dependent.is_empty() {
            agrees_on_multipliers(what, &series);
        }
        let summary = series.summary();
        assert_eq!(summary.integrator, IntegratorKind::Taylor);
        // The shaft that is thrown round reaches 8000 J, whose rounding is 1e-12 J each time it is summed.
        let most = 1e-9f64.max(1e-12 * summary.energy.abs());
        assert!(summary.energy_drift.abs() < most, "{what}, {coordinates}: {:e} J", summary.energy_drift);
        assert!((summary.work - work).abs() < 1e-7, "{what}: work {} against {work}", summary.work);
        assert!(summary.steps < 200, "{what}, {coordinates}: {} steps", summary.steps);
    }
}

/// The polynomials of multipliers against an evaluation, within a step: reactions are forces of some newtons.
fn agrees_on_multipliers(what: &str, series: &Simulation) {
    let work = series.summary().evaluations;
    let fast = series.multipliers_between_steps();
    assert_eq!(series.summary().evaluations, work);
    for (fast, exact) in fast.iter().zip(series.multipliers()) {
        let error = distance(&fast.force, &exact.force).max(distance(&fast.moment, &exact.moment));
        assert!(error < 1e-6, "{what}: reaction of {} off by {error:e}", exact.joint);
        for (a, b) in fast.rows.iter().zip(&exact.rows) {
            assert!((a.value - b.value).abs() < 1e-6, "{what}: {} of {}", b.label, exact.joint);
        }
    }
}

#[test]
fn rows_of_every_joint() {
    let at = json!([1.2, 0.3, 0.2]);
    let axis = json!([0.2, 1, -0.4]);
    for joint in [
        json!({ "type": "spherical", "point": at }),
        json!({ "type": "revolute", "point": at, "axis": axis }),
        json!({ "type": "revolute", "point": at, "axis": axis, "rows": "cp-cv" }),
        json!({ "type": "universal", "point": at, "axes": [[0, 1, 0], [1, 0, 0.3]] }),
        json!({ "type": "cylindrical", "point": at, "axis": axis }),
        json!({ "type": "prismatic", "point": at, "axis": axis }),
        json!({ "type": "planar", "point": at, "axis": axis }),
        json!({ "type": "screw", "point": at, "axis": axis, "pitch": 0.6 }),
        json!({ "type": "fixed", "point": at }),
        json!({ "type": "rod", "points": [at, [1.6, 0.5, 0.1]] }),
        json!({ "type": "point-on-line", "point": at, "axis": axis }),
        json!({ "type": "point-in-plane", "point": at, "axis": axis }),
    ] {
        agrees(joint["type"].as_str().unwrap(), &machine(&joint, &[]));
    }
}

#[test]
fn gears_through_several_turns() {
    let mut scene = machine(
        &json!({ "type": "revolute", "body_i": "ground", "point": [1.2, 0.3, 0.2], "axis": [1, 0, 1] }),
        &[(
            "loads",
            json!([{ "type": "torsion", "name": "motor", "joint": "pin", "torque": { "kind": "ramp", "start": 9, "rate": 5 },
            "stiffness": 0.2, "free_angle": 0.3 }]),
        )],
    );
    let gear = json!({ "name": "mesh", "type": "gear", "joints": ["pin", "third"], "ratio": -1.7 });
    scene["joints"].as_array_mut().unwrap().push(gear);
    agrees("gear", &scene);
}

#[test]
fn loads_of_every_kind() {
    let wave = json!({ "kind": "harmonic", "mean": 1, "amplitude": 3, "frequency": 4, "phase": 0.3 });
    let step = json!({ "kind": "smooth-step", "from": 2, "to": -3, "start": 0.2, "end": 1.1 });
    let components =
        json!({ "kind": "components", "x": wave, "y": step, "z": { "kind": "ramp", "start": 1, "rate": 2 } });
    let turning = json!({ "kind": "turning", "start": [3, 0, 1], "axis": [1, 1, 0], "angle": wave });
    let friction = json!({ "viscous": 0.3, "coulomb": 0.8, "smoothing": 0.2 });
    for load in [
        json!({ "type": "force", "body": "b", "point": [0.1, 0.2, 0.3], "force": components }),
        json!({ "type": "force", "body": "b", "point": [0.1, 0.2, 0.3], "force": turning, "frame": "body" }),
        json!({ "type": "moment", "body": "b", "moment": turning }),
        json!({ "type": "moment", "body": "c", "moment": components, "frame": "body" }),
        json!({ "type": "spring", "body_i": "a", "point_i": [0, 0.5, 0], "body_j": "c", "point_j": [0.2, 0, 0.1],
            "stiffness": 30, "free_length": 0.8, "damping": 0.7, "force": wave }),
        json!({ "type": "spring", "body_i": "ground", "point_i": [1, 1, 0.3], "body_j": "c", "point_j": [0.2, 0, 0.1],
            "stiffness": 30, "free_length": 0 }),
        json!({ "type": "torsion", "joint": "pin", "stiffness": 15, "free_angle": 0.2, "damping": 0.5, "torque": wave,
            "friction": friction }),
        json!({ "type": "torsion", "joint": "tube", "stiffness": 5, "torque": step, "friction": friction }),
        json!({ "type": "slider", "joint": "tube", "stiffness": 20, "free_length": 0.1, "damping": 0.5, "force": wave,
            "friction": friction }),
    ] {
        let mut named = load.clone();
        named["name"] = "load".into();
        agrees(&load.to_string(), &with_loads(&json!([named])));
    }
}

#[test]
fn drivers_of_every_kind_with_every_motion() {
    for (name, motion) in motions(1.2) {
        agrees(
            name,
            &with_drivers(&json!([{ "type": "angle", "name": "d", "joint": "pin", "motion": motion }])),
        );
        agrees(
            name,
            &with_drivers(&json!([{ "type": "angle", "name": "d", "joint": "tube", "motion": motion }])),
        );
        agrees(
            name,
            &with_drivers(&json!([{ "type": "slide", "name": "d", "joint": "tube", "motion": motion }])),
        );
    }
    let wave = json!({ "kind": "harmonic", "mean": 1.0, "amplitude": 0.3, "frequency": 2 });
    let turn = json!({ "kind": "ramp", "rate": 2.5 });
    let free = |drivers: Value| {
        let mut scene = with_drivers(&drivers);
        // One free body, whose first place is the origin, so that it can follow what is prescribed.
        scene["joints"] = json!([]);
        scene["bodies"] = json!([{ "name": "a", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] },
            "angular_velocity": [0.1, 0.2, 0.5] }]);
        scene
    };
    agrees(
        "point",
        &free(json!([{ "type": "point", "name": "d", "body": "a", "point": [0.3, 0.1, 0.2],
        "motion": { "kind": "components", "x": { "kind": "harmonic", "mean": 0.3, "amplitude": 0.5, "frequency": 2 },
            "y": { "kind": "smooth-step", "from": 0.1, "to": 1, "start": 0.2, "end": 1.3 },
            "z": { "kind": "polynomial", "coefficients": [0.2, 0.1, 0.3] } } }])),
    );
    agrees(
        "vector",
        &free(json!([{ "type": "vector", "name": "d", "body": "a", "vector": [1, 0, 0],
        "motion": { "kind": "turning", "start": [1, 0, 0], "axis": [0, 1, 2], "angle": turn } }])),
    );
    agrees(
        "cosine",
        &free(
            json!([{ "type": "angle-cosine", "name": "d", "body_i": "ground", "vector_i": [0, 0, 1], "body_j": "a",
        "vector_j": [0.841_470_984_807_896_5, 0, 0.540_302_305_868_139_8], "motion": wave }]),
        ),
    );
    agrees(
        "cosine to the world",
        &free(json!([{ "type": "angle-to-world", "name": "d", "body": "a",
        "vector": [0.841_470_984_807_896_5, 0, 0.540_302_305_868_139_8],
        "reference": { "kind": "turning", "start": [0, 0, 1], "axis": [1, 1, 0], "angle": turn }, "motion": wave }])),
    );
}

/// Loads with functions of their own (tanh, square roots, angles): the error follows the tolerance over eight decades.
#[test]
fn errors_follow_the_tolerance() {
    let value = with_loads(&json!([
        { "type": "torsion", "name": "t", "joint": "pin", "stiffness": 15, "friction": { "coulomb": 0.8, "smoothing": 0.2 } },
        { "type": "spring", "name": "s", "body_i": "a", "point_i": [0, 0.5, 0], "body_j": "c", "point_j": [0.2, 0, 0.1],
            "stiffness": 30, "free_length": 0.8, "damping": 0.7 },
    ]));
    let run = |tolerance: f64| {
        let mut run =
            Simulation::new(&scene(value.clone(), "full", tolerance, IntegratorKind::Taylor)).unwrap();
        run.advance_to(1.99).unwrap();
        places(&run)
    };
    let exact = run(1e-14);
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let error = distance(&run(tolerance), &exact);
        assert!(error < 300.0 * tolerance + 1e-12, "{tolerance:e}: {error:e}");
    }
}
