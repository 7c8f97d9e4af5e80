//! Whole turns of joint angles: two rotors that turn against each other leave no trace in accelerations, and steps become as long as their own
//! turning allows, in which the angle between them goes farther than half a turn.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::run::{Outputs, Simulation};
use triad_engine::scene::Scene;

/// Inertia of the rotors about their axis.
const INERTIA: [f64; 2] = [0.07, 0.01];

/// A rotor on the ground that turns at the given rate, and one on it that turns back twice as fast.
fn rotors(rate: f64, settings: &Value) -> Value {
    let body = |name: &str, inertia: f64| json!({"name": name, "mass": 1, "inertia": {"principal": [0.05, 0.05, inertia]}});
    let joint = |name: &str, i: &str, j: &str, rate: f64| {
        json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [0, 0, 0], "axis": [0, 0, 1],
               "start": {"rate": rate}})
    };
    let mut scene = json!({
        "name": "rotors", "gravity": [0, 0, -9.81],
        "bodies": [body("b", INERTIA[0]), body("c", INERTIA[1])],
        "joints": [joint("j", "ground", "b", rate), joint("k", "b", "c", -2.0 * rate)],
        "loads": [],
        "simulation": {"duration": 2, "outputs": ["joints"]},
    });
    for (key, value) in settings.as_object().unwrap() {
        scene["simulation"][key] = value.clone();
    }
    scene
}

fn start(scene: &Value) -> Simulation {
    Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap()
}

/// The angle of joint k at the current time.
fn angle(run: &Simulation) -> f64 {
    let (outputs, mut row) = (Outputs::new(run), Vec::new());
    outputs.write(run, &mut row);
    row[outputs.columns().iter().position(|column| column.name == "k.angle").unwrap()]
}

/// Every method, with what it keeps the constraints by.
fn methods() -> Vec<Value> {
    let method =
        |integrator: &str, kind: &str| json!({"integrator": integrator, "stabilization": {"kind": kind}});
    let mut methods: Vec<Value> = ["taylor", "dop853", "dopri5", "ode45", "radau", "rattle"]
        .into_iter()
        .map(|integrator| method(integrator, "projection"))
        .collect();
    for integrator in ["dop853", "dopri5", "ode45"] {
        methods.extend(["penalty", "partitioning"].map(|kind| method(integrator, kind)));
        methods.push(json!({"integrator": integrator,
            "stabilization": {"kind": "baumgarte", "alpha": 10, "beta": 10}}));
    }
    methods.push(method("radau", "partitioning"));
    methods.push(method("trapezoidal", "augmented-lagrangian"));
    methods
}

/// Whether the method loses the motion itself where rotors are fast, on the way to another solution of the constraints: no count tells turns
/// then.
fn takes_another_branch(method: &Value) -> bool {
    method["integrator"] == "radau" && method["stabilization"]["kind"] == "partitioning"
}

/// The method with further settings.
fn with(method: &Value, further: &Value) -> Value {
    let mut settings = method.clone();
    let further = further.as_object().unwrap().clone();
    settings.as_object_mut().unwrap().extend(further);
    settings
}

/// Largest distance of the angle k from what it is, at many times; infinite where the run stops.
fn off(scene: &Value, exact: impl Fn(f64) -> f64) -> f64 {
    let mut run = start(scene);
    let mut off: f64 = 0.0;
    for i in 1..=57 {
        let t = run.duration() * f64::from(i) / 57.0;
        if run.advance_to(t).is_err() {
            return f64::INFINITY;
        }
        off = off.max((angle(&run) - exact(t)).abs());
    }
    off
}

#[test]
fn turns_of_balanced_rotors_are_counted_by_every_method() {
    let mut failed = Vec::new();
    for method in methods() {
        for (rate, tolerance) in [(3.0, 1e-3), (10.0, 1e-3), (10.0, 1e-5), (10.0, 1e-8), (40.0, 1e-4)] {
            let scene = rotors(rate, &with(&method, &json!({"tolerance": tolerance})));
            if rate > 10.0 && takes_another_branch(&method) {
                continue;
            }
            let off = off(&scene, |t| -2.0 * rate * t);
            // The errors of loose tolerances add up, but a turn is far more.
            if off > 2.0 {
                failed.push(format!("{method}, {rate} rad/s, {tolerance:e}: off by {off:.2}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn turns_are_counted_with_steps_of_one_size() {
    let mut failed = Vec::new();
    for method in methods() {
        if ["taylor", "ode45"].iter().any(|free| method["integrator"] == **free) {
            continue;
        }
        for step in [0.02, 0.11] {
            let scene = rotors(14.0, &with(&method, &json!({"tolerance": 1e-6, "step": step})));
            let off = off(&scene, |t| -28.0 * t);
            // Some methods stop at so long steps, and say so, but none loses a turn.
            if off > 3.0 && (off.is_finite() || step < 0.1) {
                failed.push(format!("{method}, {step} s: off by {off:.2}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Steps of parts of a scene that nothing connects know of no angles but those that act.
#[test]
fn turns_are_counted_in_parts_that_nothing_connects() {
    let mut failed = Vec::new();
    for method in methods() {
        let mut scene = rotors(10.0, &with(&method, &json!({"tolerance": 1e-4})));
        scene["joints"][0]["start"]["rate"] = json!(25.0);
        scene["joints"][1]["start"]["rate"] = json!(-50.0);
        scene["bodies"]
            .as_array_mut()
            .unwrap()
            .push(json!({"name": "block", "mass": 1, "position": [0, 3, 0],
            "inertia": {"principal": [0.01, 0.01, 0.01]}}));
        scene["joints"]
            .as_array_mut()
            .unwrap()
            .push(json!({"name": "rail", "type": "prismatic", "body_i": "ground",
            "body_j": "block", "point": [0, 3, 0], "axis": [1, 0, 0], "start": {"speed": 5}}));
        let off = off(&scene, |t| -50.0 * t);
        if off > 2.0 {
            failed.push(format!("{method}: off by {off:.2}"));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A pendulum that goes round on a rotor, slowly above and fast below: rates at the ends of steps differ much.
#[test]
fn turns_are_counted_where_rates_change() {
    let pendulum = |settings: &Value| {
        let mut scene = rotors(-10.0, settings);
        scene["gravity"] = json!([-9.81, 0, 0]);
        scene["bodies"][1]["center_of_mass"] = json!([0.3, 0, 0]);
        scene["joints"][1]["start"]["rate"] = json!(12);
        scene
    };
    let fine = json!({"integrator": "dop853", "step": 0.002, "duration": 6});
    let mut exact = start(&pendulum(&fine));
    let mut angles = vec![0.0];
    for i in 1..=57 {
        exact.advance_to(6.0 * f64::from(i) / 57.0).unwrap();
        angles.push(angle(&exact));
    }
    assert!(angles[57] > 85.0, "{} rad", angles[57]);
    let mut failed = Vec::new();
    for method in methods() {
        for tolerance in [1e-4, 1e-6] {
            let scene = pendulum(&with(&method, &json!({"tolerance": tolerance, "duration": 6})));
            let mut places = angles.iter().skip(1);
            let mut run = start(&scene);
            let mut off: f64 = 0.0;
            for i in 1..=57 {
                run.advance_to(6.0 * f64::from(i) / 57.0).unwrap();
                off = off.max((angle(&run) - places.next().unwrap()).abs());
            }
            if off > 2.0 {
                failed.push(format!("{method}, {tolerance:e}: off by {off:.2}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A spring that is wound up and unwound: what it does depends on whole turns. θ̈ = −c θ (1/I₁ + 1/I₂) = −θ.
#[test]
fn a_spring_is_wound_up_by_whole_turns() {
    let stiffness = 1.0 / (1.0 / INERTIA[0] + 1.0 / INERTIA[1]);
    let mut failed = Vec::new();
    for method in methods() {
        for tolerance in [1e-4, 1e-6] {
            let mut scene = rotors(25.0, &with(&method, &json!({"tolerance": tolerance, "duration": 7})));
            scene["loads"] = json!([{"name": "spring", "type": "torsion", "joint": "k", "stiffness": stiffness, "free_angle": 0}]);
            let off = off(&scene, |t| -50.0 * libm::sin(t));
            if off > 1.0 {
                failed.push(format!("{method}, {tolerance:e}: off by {off:.2}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn events_of_angles_come_when_angles_are_reached() {
    for method in methods().into_iter().filter(|method| !takes_another_branch(method)) {
        let mut scene = rotors(25.0, &with(&method, &json!({"tolerance": 1e-4, "outputs": []})));
        scene["events"] = json!([
            {"name": "third turn", "of": {"type": "angle", "joint": "k"}, "value": -18.85},
            {"name": "never", "of": {"type": "angle", "joint": "k"}, "value": 0.5},
        ]);
        let mut run = start(&scene);
        run.advance_to(2.0).unwrap();
        let met: Vec<_> = run.events().iter().map(|event| event.name.as_str()).collect();
        assert_eq!(met, ["third turn"], "{method}");
        assert!((run.events()[0].time - 0.377).abs() < 2e-3, "{method}: {}", run.events()[0].time);
    }
}

/// Whether angles are written changes no bit of the motion, and no run stops for it.
#[test]
fn angles_that_are_only_written_change_nothing() {
    for method in methods() {
        let mut cases = vec![json!({"tolerance": 1e-4})];
        if !["ode45", "taylor"].iter().any(|free| method["integrator"] == **free) {
            cases.push(json!({"tolerance": 1e-4, "step": 0.1}));
        }
        if method["integrator"] == "radau" && method["stabilization"]["kind"] == "projection" {
            cases.push(json!({"tolerance": 1e-4, "step": 0.5}));
        }
        for further in cases {
            let end = |outputs: Value| {
                let mut settings = with(&method, &further);
                settings["outputs"] = outputs;
                let mut run = start(&rotors(10.0, &settings));
                let stopped = run.advance_to(2.0).err().map(|error| error.to_string());
                let bits: Vec<u64> = run.q().iter().chain(run.q_dot()).map(|x| x.to_bits()).collect();
                (stopped, run.summary().steps, bits)
            };
            assert_eq!(end(json!([])), end(json!(["joints"])), "{method} {further}");
        }
    }
}

/// Coordinates of joints tell turns by themselves, however many a step takes.
#[test]
fn a_step_of_many_turns_is_counted_where_coordinates_tell_them() {
    let method = json!({"integrator": "radau", "tolerance": 1e-6});
    for further in [json!({"step": 0.5}), json!({"step": 2}), json!({})] {
        let mut scene = rotors(30.0, &with(&method, &further));
        scene["loads"] = json!([{"name": "motor", "type": "torsion", "joint": "k", "stiffness": 0, "free_angle": 0,
            "torque": {"kind": "constant", "value": 0.1}}]);
        let gain = 0.05 * (1.0 / INERTIA[0] + 1.0 / INERTIA[1]);
        let off = off(&scene, |t| -60.0 * t + gain * t * t);
        assert!(off < 1e-6, "{further}: off by {off:.1e}");
    }
}

/// Rotors that are set in motion within one step: how often they have turned is not known, and something depends on it.
#[test]
fn a_step_that_hides_turns_is_refused_where_they_count() {
    for integrator in ["dop853", "dopri5"] {
        let settings = json!({"integrator": integrator, "step": 0.5, "tolerance": 1e-6});
        let mut scene = rotors(0.0, &settings);
        scene["loads"] = json!([
            {"name": "one way", "type": "moment", "body": "c", "moment": [0, 0, 13.6 * INERTIA[1]]},
            {"name": "and the other", "type": "moment", "body": "b", "moment": [0, 0, -13.6 * INERTIA[0]]},
        ]);
        let mut free = start(&scene);
        free.advance_to(0.5).unwrap();
        scene["events"] = json!([{"name": "turn", "of": {"type": "angle", "joint": "k"}, "value": 6.3}]);
        let refused = start(&scene).advance_to(0.5).unwrap_err();
        assert_eq!(refused.code(), "turns-unknown", "{integrator}: {refused}");
        // Steps that are chosen are short enough.
        scene["simulation"].as_object_mut().unwrap().remove("step");
        let mut run = start(&scene);
        run.advance_to(2.0).unwrap();
        let met = (2.0 * 6.3 / 27.2f64).sqrt();
        assert!((run.events()[0].time - met).abs() < 1e-5, "{integrator}: {}", run.events()[0].time);
    }
}

/// A wheel that an angle driver turns, and a block on a rail with a stiff damper, which asks for radau: the wheel stands where the driver
/// says, not half a turn away, however long the steps that the damper alone would allow; and no step is too long to go on after.
#[test]
fn radau_keeps_driven_wheels_on_the_side_that_the_driver_says() {
    for (text, angle) in [
        ("5*t", (|t| 5.0 * t) as fn(f64) -> f64),
        ("30*t^2", |t| 30.0 * t * t),
        ("7*sin(3*t)", |t| 7.0 * libm::sin(3.0 * t)),
    ] {
        for tolerance in [1e-3, 1e-4, 1e-6, 1e-9] {
            let value = serde_json::json!({
                "name": "wheel", "gravity": [0, 0, 0],
                "bodies": [
                    {"name": "W", "mass": 1, "inertia": {"principal": [0.1, 0.12, 0.2]}, "center_of_mass": [0.02, 0.01, 0]},
                    {"name": "B", "mass": 1, "inertia": {"principal": [0.1, 0.12, 0.2]}, "position": [0, 3, 0]}
                ],
                "joints": [
                    {"name": "axle", "type": "revolute", "body_i": "ground", "body_j": "W", "point": [0, 0, 0], "axis": [0, 0, 1]},
                    {"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "B", "point": [0, 3, 0], "axis": [1, 0, 0],
                     "start": {"slide": 0, "speed": 0.5}}
                ],
                "drivers": [{"name": "motor", "type": "angle", "joint": "axle", "motion": {"kind": "expression", "value": text}}],
                "loads": [{"name": "damper", "type": "slider", "joint": "rail", "damping": 1e5}],
                "simulation": {"duration": 2, "tolerance": tolerance, "integrator": "radau"}
            });
            let mut run = Simulation::new(&Scene::from_json(&value.to_string()).unwrap()).unwrap();
            for k in 1..=20 {
                let time = 0.1 * f64::from(k);
                run.advance_to(time).unwrap_or_else(|error| panic!("{text}, {tolerance:e}: {error}"));
                let u = run.frame().bodies[0].u;
                let right = [libm::cos(angle(time)), libm::sin(angle(time))];
                let off = (u[0] - right[0]).abs().max((u[1] - right[1]).abs());
                assert!(off < 1e-9, "{text}, {tolerance:e} at {time} s: {off:e}");
            }
        }
    }
}

/// A step of given size leads a bar that stands on its joint off the constraints: the last good state is its start, with the turns of
/// joints there, however far the step that failed has turned them.
#[test]
fn a_step_that_leaves_the_constraints_leaves_no_turns_behind() {
    let scene = json!({
        "name": "off", "gravity": [0, -9.81, 0],
        "bodies": [
            {"name": "b", "mass": 1, "inertia": {"principal": [0.01, 0.01, 0.01]}, "center_of_mass": [0.25, 0, 0]},
            {"name": "c", "mass": 1, "inertia": {"principal": [0.02, 0.02, 0.02]}, "position": [0.5, 0, 0], "center_of_mass": [0, -0.5, 0]},
        ],
        "joints": [
            {"name": "k", "type": "revolute", "body_i": "ground", "body_j": "b", "point": [0, 0, 0], "axis": [0, 0, 1], "start": {"rate": 6.0}},
            {"name": "r", "type": "rod", "body_i": "b", "body_j": "c", "points": [[0.5, 0, 0], [0.5, -0.2, 0]]},
        ],
        "simulation": {"duration": 3, "integrator": "dop853", "step": 0.15, "outputs": ["joints"]},
    });
    let mut run = start(&scene);
    let error = run.advance_to(3.0).unwrap_err();
    assert_eq!(error.code(), "constraints-lost", "{error}");
    let u = run.frame().bodies[0].u;
    let by_directors = libm::atan2(u[1], u[0]);
    assert!((angle(&run) - by_directors).abs() < 1e-12, "{} beside {by_directors}", angle(&run));
}
