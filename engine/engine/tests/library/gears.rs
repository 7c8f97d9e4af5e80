//! Gears, and where the angles of joints are counted from.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use serde_json::{Value, json};
use triad_engine::analysis::check::check;
use triad_engine::analysis::kinematics;
use triad_engine::reactions::report::Convention;
use triad_engine::run::{Outputs, Simulation};
use triad_engine::scene::Scene;

const PINS: [&str; 4] = ["a", "b", "c", "d"];

/// Wheels on pins a, b, … beside each other, with what `add` writes into their joints, and gears between neighbours.
fn wheels(add: &[Value], gears: &[Value]) -> Value {
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    for (k, more) in add.iter().enumerate() {
        let name = PINS[k];
        bodies.push(json!({
            "name": format!("wheel-{name}"), "mass": 1, "position": [k, 0, 0], "inertia": { "principal": [0.1, 0.1, 0.2] }
        }));
        let mut joint = json!({
            "name": name, "type": "revolute", "body_i": "ground", "body_j": format!("wheel-{name}"), "point": [k, 0, 0],
            "axis": [0, 0, 1]
        });
        for (key, value) in more.as_object().unwrap() {
            joint[key] = value.clone();
        }
        joints.push(joint);
    }
    for (k, gear) in gears.iter().enumerate() {
        let mut joint =
            json!({ "name": format!("mesh-{k}"), "type": "gear", "joints": [PINS[k], PINS[k + 1]] });
        for (key, value) in gear.as_object().unwrap() {
            joint[key] = value.clone();
        }
        joints.push(joint);
    }
    json!({
        "name": "wheels", "gravity": [0, 0, 0], "bodies": bodies, "joints": joints,
        "simulation": { "duration": 2, "every": 0.5, "outputs": ["joints"] }
    })
}

fn scene(scene: &Value) -> Scene {
    Scene::from_json(&scene.to_string()).unwrap()
}

/// The angles of joints at the current time.
fn angles(run: &Simulation, joints: &[&str]) -> Vec<f64> {
    let (outputs, mut row) = (Outputs::new(run), Vec::new());
    outputs.write(run, &mut row);
    let column = |joint: &&str| {
        let name = format!("{joint}.angle");
        row[outputs.columns().iter().position(|column| column.name == name).unwrap()]
    };
    joints.iter().map(column).collect()
}

fn near(found: &[f64], expected: &[f64], what: &str) {
    let apart = found.iter().zip(expected).any(|(a, b)| (a - b).abs() > 1e-9 * (1.0 + b.abs()));
    assert!(!apart && found.len() == expected.len(), "{what}: {found:?} instead of {expected:?}");
}

#[test]
fn a_gear_starts_wherever_its_leader_does() {
    for ratio in [2.0, -0.5, 0.25, -3.0] {
        for start in [0.3, 2.0, 3.0, 7.0, -40.0] {
            let what = format!("ratio {ratio} from {start}");
            let leads = json!({ "start": { "angle": start, "rate": 1.5 } });
            let text = wheels(&[leads, json!({})], &[json!({ "ratio": ratio })]);
            let mut run = Simulation::new(&scene(&text)).unwrap_or_else(|error| panic!("{what}: {error}"));
            near(&angles(&run, &["a", "b"]), &[start, ratio * start], &what);
            for _ in 0..2 {
                run.advance_to(2.0).unwrap();
                near(&angles(&run, &["a", "b"]), &[start + 3.0, ratio * (start + 3.0)], &what);
                run.reset();
            }
            assert_eq!(check(&scene(&text)).unwrap().degrees_of_freedom, 1, "{what}");
            // The same driven, by geometry alone; and led by the follower.
            let mut driven = text.clone();
            driven["drivers"] = json!([{
                "name": "motor", "type": "angle", "joint": "a", "motion": { "kind": "ramp", "start": start, "rate": 1.5 }
            }]);
            let found = kinematics(&scene(&driven), Convention::default());
            let found = found.unwrap_or_else(|error| panic!("{what}: {error}"));
            let last = &found.states.last().unwrap().bodies[1];
            let turned = ratio * (start + 3.0);
            near(&[last.u[0], last.u[1]], &[libm::cos(turned), libm::sin(turned)], &what);
            let text =
                wheels(&[json!({}), json!({ "start": { "angle": start } })], &[json!({ "ratio": ratio })]);
            near(
                &angles(&Simulation::new(&scene(&text)).unwrap(), &["a", "b"]),
                &[start / ratio, start],
                &what,
            );
        }
    }
}

#[test]
fn a_train_of_gears_passes_its_start_on() {
    let none = json!({});
    let middle = json!({ "start": { "angle": 5.0 } });
    let text = wheels(
        &[none.clone(), none.clone(), middle, none],
        &[json!({ "ratio": -2 }), json!({ "ratio": -2 }), json!({ "ratio": 3, "offset": -0.5 })],
    );
    let run = Simulation::new(&scene(&text)).unwrap();
    near(&angles(&run, &["a", "b", "c", "d"]), &[1.25, -2.5, 5.0, 14.5], "train");
    // An offset alone turns the follower.
    let text = wheels(&[json!({}), json!({})], &[json!({ "ratio": 2, "offset": 4.0 })]);
    let run = Simulation::new(&scene(&text)).unwrap();
    near(&angles(&run, &["a", "b"]), &[0.0, 4.0], "offset");
}

#[test]
fn starts_that_a_gear_contradicts_are_refused_with_both_numbers() {
    let at = |angle: f64| json!({ "start": { "angle": angle } });
    let text = wheels(&[at(2.0), at(4.0 - std::f64::consts::TAU)], &[json!({ "ratio": 2 })]);
    let error = Simulation::new(&scene(&text)).unwrap_err();
    let told = error.to_string();
    assert!(
        told.contains("\"a\" at 2 rad") && told.contains("is at 4 rad") && told.contains("offset"),
        "{told}"
    );
    let text = wheels(&[at(2.0), at(4.0)], &[json!({ "ratio": 2 })]);
    near(&angles(&Simulation::new(&scene(&text)).unwrap(), &["a", "b"]), &[2.0, 4.0], "both told");
}

#[test]
fn an_angle_is_counted_from_what_it_is_where_the_bodies_are_stated() {
    for stated in [0.4, -2.5, 9.0] {
        let told = json!({ "stated_angle": stated });
        let mut text = wheels(&[told.clone(), json!({})], &[json!({ "ratio": 2, "offset": -2.0 * stated })]);
        text["bodies"][0]["angular_velocity"] = json!([0, 0, 1.5]);
        text["bodies"][1]["angular_velocity"] = json!([0, 0, 3]);
        let mut run = Simulation::new(&scene(&text)).unwrap();
        near(&run.frame().bodies[0].u, &[1.0, 0.0, 0.0], "the body stands where it is stated");
        near(&angles(&run, &["a", "b"]), &[stated, 0.0], "start");
        run.advance_to(2.0).unwrap();
        near(&angles(&run, &["a", "b"]), &[stated + 3.0, 6.0], "end");
        // A start carries the body from there.
        let text = wheels(&[json!({ "stated_angle": stated, "start": { "angle": stated + 1.0 } })], &[]);
        let run = Simulation::new(&scene(&text)).unwrap();
        near(&angles(&run, &["a"]), &[stated + 1.0], "carried");
        near(&run.frame().bodies[0].u, &[libm::cos(1.0), libm::sin(1.0), 0.0], "carried");
        // Drivers count likewise.
        let mut text = wheels(&[told], &[]);
        text["drivers"] = json!([{
            "name": "motor", "type": "angle", "joint": "a", "motion": { "kind": "ramp", "start": stated, "rate": 2.0 }
        }]);
        let mut run = Simulation::new(&scene(&text)).unwrap();
        run.advance_to(2.0).unwrap();
        near(&angles(&run, &["a"]), &[stated + 4.0], "driven");
    }
}

/// Three arms in a chain, of which a gear couples the first hinge with the last one: what lies between is at rest relative to the first.
#[test]
fn a_gear_passes_the_rate_of_its_joints_on() {
    let arm = |name: &str, at: f64| {
        json!({ "name": name, "mass": 1, "position": [at, 0, 0], "center_of_mass": [0.5, 0, 0],
        "inertia": { "principal": [0.1, 0.1, 0.1] } })
    };
    let hinge = |name: &str, [i, j]: [&str; 2], at: f64, start: Value| json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [at, 0, 0], "axis": [0, 0, 1], "start": start });
    let rates_of = |starts: [Value; 3]| {
        let [a, b, c] = starts;
        let text = json!({
            "name": "train", "gravity": [0, 0, 0], "bodies": [arm("first", 0.0), arm("second", 1.0), arm("third", 2.0)],
            "joints": [
                hinge("a", ["ground", "first"], 0.0, a), hinge("b", ["first", "second"], 1.0, b), hinge("c", ["second", "third"], 2.0, c),
                { "name": "mesh", "type": "gear", "joints": ["a", "c"], "ratio": 3 }
            ]
        });
        let run = Simulation::new(&scene(&text)).unwrap();
        let spins: Vec<f64> = run.frame().bodies.iter().map(|body| body.angular_velocity[2]).collect();
        [spins[0], spins[1] - spins[0], spins[2] - spins[1]]
    };
    near(&rates_of([json!({ "rate": 2 }), json!({}), json!({})]), &[2.0, 0.0, 6.0], "by the first");
    near(&rates_of([json!({}), json!({}), json!({ "rate": 6 })]), &[2.0, 0.0, 6.0], "by the last");
    near(
        &rates_of([json!({ "angle": 1.0, "rate": 2 }), json!({ "rate": -1 }), json!({})]),
        &[2.0, -1.0, 6.0],
        "with an angle",
    );
}
