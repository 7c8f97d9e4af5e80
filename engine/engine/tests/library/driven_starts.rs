//! Drivers that start at speed, beside joints whose rates are given for the start: all others rest.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::prelude::*;

fn run(written: &Value) -> Simulation {
    Simulation::new(&Scene::from_json(&written.to_string()).unwrap()).unwrap()
}

fn body(name: &str, position: [f64; 3], hangs: f64) -> Value {
    json!({ "name": name, "mass": 1.0, "inertia": { "principal": [0.1, 0.1, 0.1] }, "position": position,
        "center_of_mass": [0, -hangs, 0] })
}

fn hinge(name: &str, [i, j]: [&str; 2], point: [f64; 3], start: Value) -> Value {
    let mut joint = json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": point, "axis": [0, 0, 1] });
    if !start.is_null() {
        joint["start"] = start;
    }
    joint
}

fn driver(kind: &str, joint: &str, rate: f64) -> Value {
    json!({ "name": "motor", "type": kind, "joint": joint, "motion": { "kind": "ramp", "rate": rate } })
}

/// A cart on a rail, driven at 2 m/s, with a load on a pin and a tip on that.
fn crane(pin: Value, elbow: Value) -> Value {
    json!({
        "name": "crane", "bodies": [body("cart", [0.0; 3], 0.0), body("load", [0.0; 3], 1.0), body("tip", [0.0, -1.0, 0.0], 0.5)],
        "joints": [
            { "name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "cart", "point": [0, 0, 0], "axis": [1, 0, 0] },
            hinge("pin", ["cart", "load"], [0.0; 3], pin),
            hinge("elbow", ["load", "tip"], [0.0, -1.0, 0.0], elbow),
        ],
        "drivers": [driver("slide", "rail", 2.0)],
    })
}

fn of_changed(run: &Simulation) -> Vec<&String> {
    run.notes().iter().filter(|note| note.contains("velocities violated the constraints")).collect()
}

fn near(found: &[f64], expected: &[f64]) {
    let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{found:?} instead of {expected:?}");
}

fn spins(run: &Simulation) -> Vec<f64> {
    run.frame().bodies.iter().map(|body| body.angular_velocity[2]).collect()
}

/// What hangs on a driven joint moves with it, and other joints rest, given or not.
#[test]
fn what_hangs_on_a_driven_joint_is_carried_along() {
    let rest = run(&crane(json!({ "rate": 0.0 }), json!({ "rate": 1.0 })));
    for written in
        [crane(Value::Null, json!({ "rate": 1.0 })), crane(Value::Null, json!({ "angle": 0.0, "rate": 1.0 }))]
    {
        let run = run(&written);
        near(&spins(&run), &[0.0, 0.0, 1.0]);
        near(&run.frame().bodies[1].velocity, &[2.0, 0.0, 0.0]);
        near(&run.frame().bodies[2].velocity, &rest.frame().bodies[2].velocity);
        assert!(of_changed(&run).is_empty(), "{:?}", run.notes());
    }
    // An angle alone is a start as well.
    let angle = run(&crane(json!({ "angle": 0.4 }), Value::Null));
    near(&spins(&angle), &[0.0; 3]);
    assert!(of_changed(&angle).is_empty(), "{:?}", angle.notes());
}

/// A driven turntable turns all that stands on it, at the places that the starts give.
#[test]
fn what_stands_on_a_driven_turntable_turns_with_it() {
    let written = json!({
        "name": "turntable", "bodies": [body("table", [0.0; 3], 0.0), body("arm", [0.0; 3], 1.0), body("hand", [0.0, -1.0, 0.0], 0.5)],
        "joints": [
            hinge("axle", ["ground", "table"], [0.0; 3], Value::Null),
            hinge("shoulder", ["table", "arm"], [1.0, 0.0, 0.0], json!({ "angle": 0.5 })),
            hinge("wrist", ["arm", "hand"], [0.0, -1.0, 0.0], json!({ "rate": -2.0 })),
        ],
        "drivers": [driver("angle", "axle", 3.0)],
    });
    let run = run(&written);
    near(&spins(&run), &[3.0, 3.0, 1.0]);
    let arm = &run.frame().bodies[1];
    near(&arm.velocity[..2], &[-3.0 * arm.position[1], 3.0 * arm.position[0]]);
    assert!(of_changed(&run).is_empty(), "{:?}", run.notes());
}

/// A driver goes before the rate that is given for its joint, for all that hangs on it, and passes its rate through gears.
#[test]
fn the_rate_of_a_driver_goes_before_a_given_one_and_through_gears() {
    let written = |ratio: Option<f64>| {
        let mut joints = vec![
            hinge("first", ["ground", "wheel"], [0.0; 3], json!({ "rate": 1.0 })),
            hinge("second", ["ground", "other"], [2.0, 0.0, 0.0], Value::Null),
            hinge("pin", ["other", "load"], [3.0, 0.0, 0.0], Value::Null),
        ];
        if let Some(ratio) = ratio {
            joints[0].as_object_mut().unwrap().remove("start");
            joints.push(
                json!({ "name": "gear", "type": "gear", "joints": ["first", "second"], "ratio": ratio }),
            );
            joints.push(hinge("elsewhere", ["ground", "free"], [9.0, 0.0, 0.0], json!({ "rate": 0.5 })));
        }
        let mut bodies = vec![
            body("wheel", [0.0; 3], 0.0),
            body("other", [2.0, 0.0, 0.0], 0.0),
            body("load", [3.0, 0.0, 0.0], 1.0),
        ];
        bodies.extend(ratio.map(|_| body("free", [9.0, 0.0, 0.0], 1.0)));
        json!({ "name": "geared", "bodies": bodies, "joints": joints, "drivers": [driver("angle", "first", 4.0)] })
    };
    let replaced = run(&written(None));
    near(&spins(&replaced), &[4.0, 0.0, 0.0]);
    assert!(replaced.notes().iter().any(|note| note.contains("but driver \"motor\" prescribes 4 rad/s")));
    near(&spins(&run(&written(Some(-0.5)))), &[4.0, -2.0, -2.0, 0.5]);
}

/// A screw that is driven along its axis turns what hangs on it.
#[test]
fn a_driven_screw_turns_what_hangs_on_it() {
    let mut written = crane(Value::Null, json!({ "rate": 1.0 }));
    written["joints"][0] = json!({ "name": "rail", "type": "screw", "pitch": 0.5, "body_i": "ground", "body_j": "cart", "point": [0, 0, 0],
        "axis": [1, 0, 0] });
    written["drivers"][0] = driver("angle", "rail", 4.0 * std::f64::consts::PI);
    let run = run(&written);
    let rate = 4.0 * std::f64::consts::PI;
    for body in &run.frame().bodies[..2] {
        near(&body.angular_velocity, &[rate, 0.0, 0.0]);
    }
    near(&run.frame().bodies[1].velocity, &[1.0, 0.0, rate * run.frame().bodies[1].position[1]]);
    assert!(of_changed(&run).is_empty(), "{:?}", run.notes());
}

/// Where joints cannot stay at rest, in loops and where a driver moves a point, all velocities change as little as they can, and that is told.
#[test]
fn where_other_joints_must_move_it_is_told() {
    let mut point = crane(Value::Null, json!({ "rate": 1.0 }));
    point["drivers"] = json!([{ "name": "motor", "type": "point", "body": "load", "point": [0, -1, 0],
        "motion": { "kind": "components", "x": { "kind": "ramp", "rate": 2.0 }, "y": -1.0, "z": 0.0 } }]);
    let run_of_point = run(&point);
    assert_eq!(of_changed(&run_of_point).len(), 1, "{:?}", run_of_point.notes());
    // A crank that drives a bar between it and a rocker: these turn.
    let four_bar = json!({
        "name": "four-bar",
        "bodies": [body("crank", [0.0; 3], 0.0), body("coupler", [0.0, 1.0, 0.0], 0.0), body("rocker", [2.0, 0.0, 0.0], 0.0),
            body("load", [2.0, 1.5, 0.0], 1.0)],
        "joints": [
            hinge("O", ["ground", "crank"], [0.0; 3], Value::Null),
            hinge("A", ["crank", "coupler"], [0.0, 1.0, 0.0], Value::Null),
            hinge("B", ["coupler", "rocker"], [2.0, 1.5, 0.0], Value::Null),
            hinge("C", ["rocker", "ground"], [2.0, 0.0, 0.0], Value::Null),
            hinge("pin", ["rocker", "load"], [2.0, 1.5, 0.0], json!({ "rate": 1.0 })),
        ],
        "drivers": [driver("angle", "O", 2.0)],
    });
    let run_of_loop = run(&four_bar);
    near(&spins(&run_of_loop)[..1], &[2.0]);
    near(&[spins(&run_of_loop)[3] - spins(&run_of_loop)[2]], &[1.0]);
    assert_eq!(of_changed(&run_of_loop).len(), 1, "{:?}", run_of_loop.notes());
    // What the author says of a body stays, as far as that can be.
    let mut stated = crane(Value::Null, json!({ "rate": 1.0 }));
    stated["bodies"][1]["velocity"] = json!([2.0, 0.0, 0.0]);
    stated["bodies"][1]["angular_velocity"] = json!([0.0, 0.0, 0.7]);
    let run_of_stated = run(&stated);
    near(&spins(&run_of_stated), &[0.0, 0.7, 1.7]);
    assert!(of_changed(&run_of_stated).is_empty(), "{:?}", run_of_stated.notes());
}

/// Directors tell nothing of whole turns: a driver that begins some turns away does, to gears, screws, springs and events.
#[test]
fn whole_turns_of_a_driver_count() {
    let tau = std::f64::consts::TAU;
    let turning = |start: f64| json!([{ "name": "motor", "type": "angle", "joint": "a", "motion": { "kind": "ramp", "start": start, "rate": tau } }]);
    let geared_from = |ratio: f64, start: f64, given: Value| {
        let run = run(&json!({
            "name": "geared", "gravity": [0, 0, 0],
            "bodies": [body("wheel", [0.0; 3], 0.0), body("other", [1.0, 0.0, 0.0], 0.0)],
            "joints": [
                hinge("a", ["ground", "wheel"], [0.0; 3], given), hinge("b", ["ground", "other"], [1.0, 0.0, 0.0], Value::Null),
                { "name": "mesh", "type": "gear", "joints": ["a", "b"], "ratio": ratio }
            ],
            "drivers": turning(start),
            "loads": [{ "name": "spring", "type": "torsion", "joint": "a", "stiffness": 1 }],
            "events": [{ "name": "twice", "of": { "type": "angle", "joint": "a" }, "value": 2.0 * tau }],
            "simulation": { "duration": 2 }
        }));
        let u = run.frame().bodies[1].u;
        (libm::atan2(u[1], u[0]), run)
    };
    let geared = |ratio: f64, start: f64| geared_from(ratio, start, Value::Null);
    let (angle, mut run_on) = geared(0.5, tau + 0.4);
    near(&[angle], &[0.5 * 0.4 - 0.5 * tau]);
    run_on.advance_to(2.0).unwrap();
    let passed: Vec<f64> = run_on.events().iter().map(|event| event.time).collect();
    near(&passed, &[1.0 - 0.4 / tau]);
    assert!(run_on.notes().is_empty(), "{:?}", run_on.notes());
    // Within half a turn bodies are stated as before.
    near(&[geared(0.5, 0.0).0], &[0.0]);
    // What is given instead is told.
    let (angle, given) = geared_from(0.5, tau + 0.4, json!({ "angle": 0.1 }));
    near(&[angle], &[0.5 * 0.4 - 0.5 * tau]);
    let told = given.notes().iter().filter(|note| {
        note.contains("0.1 rad are given for the start, but driver \"motor\" prescribes 6.68")
    });
    assert_eq!(told.count(), 1, "{:?}", given.notes());

    let screw = run(&json!({
        "name": "screw", "gravity": [0, 0, 0], "bodies": [body("nut", [0.0; 3], 0.0)],
        "joints": [{ "name": "a", "type": "screw", "body_i": "ground", "body_j": "nut", "point": [0, 0, 0], "axis": [0, 0, 1], "pitch": 0.1 }],
        "drivers": turning(3.0 * tau)
    }));
    near(&[screw.frame().bodies[0].position[2]], &[0.3]);
}

/// An angle whose cosine is prescribed ends the run where it comes to zero, also where it turns back there within a step.
#[test]
fn an_angle_that_turns_back_at_zero_ends_the_run() {
    for way in [IntegratorKind::Taylor, IntegratorKind::Dop853] {
        for (formula, ends) in [("0.5*(1-2*t)^2", true), ("0.5*(1-2*t)^2+0.01", false), ("0.5-t", true)] {
            let written = json!({
                "name": "held", "bodies": [{ "name": "arm", "mass": 1, "inertia": { "principal": [0.01, 0.1, 0.1] }, "center_of_mass": [0.5, 0, 0],
                    "orientation": { "axis": [0, 0, 1], "angle": 0.5 } }],
                "joints": [hinge("pin", ["ground", "arm"], [0.0; 3], Value::Null)],
                "drivers": [{ "name": "held", "type": "angle-cosine", "body_i": "ground", "vector_i": [1, 0, 0], "body_j": "arm", "vector_j": [1, 0, 0],
                    "motion": { "kind": "expression", "value": formula } }],
                "simulation": { "duration": 1, "integrator": way.to_string(), "tolerance": 1e-5 }
            });
            let mut run = run(&written);
            let result = run.advance_to(1.0);
            assert_eq!(result.is_err(), ends, "{way} {formula}");
            if let Err(error) = result {
                assert_eq!(error.code(), "angle-lost", "{way} {formula}: {error}");
                assert!(run.time() < 0.5, "{way} {formula}: {}", run.time());
            }
        }
    }
}

/// The row of a driven angle holds half a turn away as well: such a start would drive everything the wrong way round.
#[test]
fn a_driver_that_begins_half_a_turn_from_the_bodies_is_refused() {
    let started = |angle: f64| {
        let text = format!(
            r#"{{"name": "crank", "gravity": [0, 0, 0], "bodies": [{{"name": "crank", "mass": 1, "center_of_mass": [0.5, 0, 0],
                "inertia": {{"principal": [0.01, 0.02, 0.02]}}}}], "joints": [{{"name": "pin", "type": "revolute", "body_i": "ground",
                "body_j": "crank", "point": [0, 0, 0], "axis": [0, 0, 1]}}], "drivers": [{{"type": "angle", "name": "motor",
                "joint": "pin", "motion": {{"kind": "ramp", "start": {angle}, "rate": 1}}}}]}}"#
        );
        Simulation::new(&Scene::from_json(&text).unwrap()).map(|run| run.frame().bodies[0].u)
    };
    for near in [0.1, -0.1, 6.2, 12.5] {
        let u = started(near).unwrap();
        assert!(
            (u[0] - libm::cos(near)).abs() < 1e-9 && (u[1] - libm::sin(near)).abs() < 1e-9,
            "{near}: {u:?}"
        );
    }
    for far in [3.0, 3.2, -3.1, 9.4] {
        let refused = started(far).unwrap_err();
        assert_eq!(refused.code(), "start-too-far");
        assert!(refused.to_string().contains("driver \"motor\""), "{refused}");
    }
}

/// The reference of an angle is a direction: its length does not matter, and one that changes is refused.
#[test]
fn a_direction_that_is_followed_is_made_a_unit_vector_or_refused() {
    let scene = |reference: Value| {
        let scene = json!({
            "name": "hand", "bodies": [{"name": "c", "mass": 1, "inertia": {"principal": [0.02, 0.03, 0.035]}}],
            "joints": [{"name": "h", "type": "revolute", "body_i": "ground", "body_j": "c", "point": [0, 0, 0], "axis": [0, 0, 1]}],
            "drivers": [{"name": "a", "type": "angle-to-world", "body": "c", "vector": [1, 0, 0], "reference": reference,
                "motion": {"kind": "ramp", "start": std::f64::consts::FRAC_PI_4, "rate": 0.2}}]
        });
        Scene::from_json(&scene.to_string()).unwrap()
    };
    for length in [1.0, 3.0, 0.5] {
        let mut run = Simulation::new(&scene(json!([length, length, 0]))).unwrap();
        run.advance_to(1.0).unwrap();
        let [x, y, _] = run.frame().bodies[0].u;
        assert!((libm::atan2(y, x) + 0.2).abs() < 1e-9, "{length}: {x}, {y}");
    }
    let growing =
        json!({"kind": "components", "x": {"kind": "ramp", "start": 1, "rate": 0.1}, "y": 0, "z": 0});
    let error = Simulation::new(&scene(growing)).unwrap_err();
    assert_eq!((error.code(), error.pointer().as_deref()), ("driver-invalid", Some("/drivers/0/reference")));
    assert!(error.hint().contains("Divide"), "{}", error.hint());
}

/// Without any given start too.
#[test]
fn what_hangs_on_a_driven_joint_is_carried_along_where_no_start_is_given() {
    let (given, plain) =
        (run(&crane(Value::Null, json!({ "rate": 0.0 }))), run(&crane(Value::Null, Value::Null)));
    near(&spins(&plain), &[0.0; 3]);
    for (body, other) in plain.frame().bodies.iter().zip(given.frame().bodies) {
        near(&body.velocity, &[2.0, 0.0, 0.0]);
        near(&body.velocity, &other.velocity);
    }
    assert_eq!(of_changed(&plain), Vec::<&String>::new());
    // Velocities that are stated stay: the load and the tip turn about the pin.
    let mut stated = crane(Value::Null, Value::Null);
    for (body, speed) in [(1, 2.0), (2, 3.0)] {
        stated["bodies"][body]["velocity"] = json!([speed, 0, 0]);
        stated["bodies"][body]["angular_velocity"] = json!([0, 0, 1]);
    }
    near(&spins(&run(&stated)), &[0.0, 1.0, 1.0]);
}

/// A four-bar that is stated open, with a crank of that angle.
fn open_four_bar(crank: f64, start: Value) -> Value {
    let at = |angle: f64| json!({ "axis": [0, 0, 1], "angle": angle });
    let bar = |name: &str, position: [f64; 3], angle: f64, half: f64| {
        json!({ "name": name, "mass": 1.0, "inertia": { "principal": [0.001, 0.1, 0.1] }, "center_of_mass": [half, 0, 0],
            "position": position, "orientation": at(angle) })
    };
    let hinge = |name: &str, [i, j]: [&str; 2], point_i: [f64; 3], point_j: [f64; 3]| {
        json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point_i": point_i, "point_j": point_j,
            "axis_i": [0, 0, 1], "axis_j": [0, 0, 1] })
    };
    let mut joints = vec![
        hinge("A", ["ground", "c"], [0.0; 3], [0.0; 3]),
        hinge("B", ["c", "k"], [0.5, 0.0, 0.0], [0.0; 3]),
        hinge("C", ["k", "r"], [1.5, 0.0, 0.0], [1.0, 0.0, 0.0]),
        hinge("D", ["ground", "r"], [1.5, 0.0, 0.0], [0.0; 3]),
        hinge("own", ["ground", "o"], [5.0, 0.0, 0.0], [0.0; 3]),
    ];
    joints[0]["start"] = start;
    if joints[0]["start"].is_null() {
        joints[0].as_object_mut().unwrap().remove("start");
    }
    json!({ "name": "open", "bodies": [bar("c", [0.0; 3], crank, 0.25), bar("k", [0.2, 0.45, 0.0], 0.3, 0.75),
        bar("r", [1.5, 0.0, 0.0], 1.3, 0.5), bar("o", [5.0, 0.0, 0.0], 0.0, 0.5)], "joints": joints })
}

/// A rate that is given of one joint says nothing of where bodies are: how far they are moved is told, and refused where it is far.
#[test]
fn a_start_that_gives_no_place_moves_no_body_unsaid() {
    let moved = |run: &Simulation| {
        run.notes().iter().find(|note| note.contains("bodies were moved by up to")).cloned()
    };
    let plain = run(&open_four_bar(1.2, Value::Null));
    let told = moved(&plain).expect("it was open");
    let turning = run(&open_four_bar(1.2, json!({ "rate": 1.0 })));
    assert_eq!(moved(&turning), Some(told.clone()));
    near(&spins(&turning)[..1], &[1.0]);
    // A start of another mechanism changes nothing of this one.
    let mut apart = open_four_bar(1.2, Value::Null);
    apart["joints"][4]["start"] = json!({ "angle": 1.0, "rate": 2.0 });
    let apart = run(&apart);
    assert_eq!(moved(&apart), Some(told));
    for (body, other) in apart.frame().bodies.iter().zip(plain.frame().bodies).take(3) {
        assert_eq!(body.position, other.position);
    }
    // A given angle is closed with, whatever is stated.
    assert_eq!(moved(&run(&open_four_bar(1.2, json!({ "angle": 0.1 })))), None);
    for start in [Value::Null, json!({ "rate": 1.0 })] {
        let mut far = open_four_bar(1.2, start);
        far["bodies"][2]["position"] = json!([1.5, 0, 0]);
        far["bodies"][2]["orientation"] = json!({ "axis": [0, 0, 1], "angle": -1.8 });
        let refused = Simulation::new(&Scene::from_json(&far.to_string()).unwrap()).unwrap_err();
        assert!(refused.to_string().contains("count as a correction"), "{refused}");
    }
}
