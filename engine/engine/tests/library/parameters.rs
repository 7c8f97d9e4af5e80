//! Scenes with changed numbers, and runs that go on with them.

use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::constraints::ConstraintError;
use triad_engine::run::Simulation;
use triad_engine::scene::{Scene, SceneError};

#[allow(clippy::unwrap_used)] // a helper of tests
fn scene(text: &str) -> Scene {
    Scene::from_json(text).unwrap()
}

#[allow(clippy::unwrap_used)] // a helper of tests
fn pendulum() -> Scene {
    let mut value: serde_json::Value =
        serde_json::from_str(&catalogue::scene("simple-pendulum").unwrap().to_json()).unwrap();
    value["parameters"] = serde_json::json!([
        { "name": "g", "label": "Gravity", "pointer": { "pointer": "/gravity/1", "factor": -1 }, "low": 0, "high": 20,
          "on_change": "continue" },
        { "name": "speed", "label": "Speed", "pointer": "/bodies/0/velocity/1", "low": -5, "high": 5 }
    ]);
    scene(&value.to_string())
}

#[test]
fn a_changed_scene_differs_where_it_was_changed() {
    let changed = pendulum().changed([("g", 1.62), ("speed", 2.0)], []).unwrap();
    assert_eq!(changed.gravity, [0.0, -1.62, 0.0]);
    assert_eq!(changed.bodies[0].velocity, [0.0, 2.0, 0.0]);
    let tolerance = serde_json::json!(1e-6);
    let reduced = serde_json::json!("reduced");
    let places = [("/simulation/tolerance", &tolerance), ("/coordinates", &reduced)];
    let changed = pendulum().changed([], places).unwrap();
    assert_eq!(changed.simulation.tolerance, 1e-6);
    assert!(Simulation::new(&changed).unwrap().q().len() == 9);
}

#[test]
fn what_cannot_be_changed_is_named() {
    let word = serde_json::json!("heavy");
    let refused = |places: &[(&'static str, &serde_json::Value)]| {
        pendulum().changed([], places.iter().copied()).unwrap_err().to_string()
    };
    assert!(refused(&[("/bodies/0/mas", &word)]).contains("/bodies/0 has the keys"));
    assert!(refused(&[("/bodies/3/mass", &word)]).contains("/bodies is a list of 1"));
    assert!(refused(&[("/bodies/0/mass", &word)]).contains("is none"));
    assert!(refused(&[("/name", &word)]).contains("simple-pendulum"));
    assert!(matches!(pendulum().changed([("h", 1.0)], []), Err(SceneError::UnknownParameter { .. })));
    assert!(matches!(pendulum().changed([("g", 30.0)], []), Err(SceneError::OutsideParameter { .. })));
    assert!(matches!(pendulum().changed([("g", f64::NAN)], []), Err(SceneError::OutsideParameter { .. })));
}

#[test]
fn an_author_learns_where_a_parameter_is_wrong() {
    let wrong = |key: &str, value: serde_json::Value| {
        let mut written: serde_json::Value = serde_json::from_str(&pendulum().to_json()).unwrap();
        written["parameters"][0][key] = value;
        let error = Simulation::new(&scene(&written.to_string())).unwrap_err();
        assert_eq!(error.code(), "parameter-invalid");
        (error.pointer().unwrap(), error.to_string())
    };
    assert!(wrong("pointer", serde_json::json!("/gravity")).1.contains("name one of its entries"));
    assert!(wrong("pointer", serde_json::json!([])).1.contains("no place"));
    assert_eq!(wrong("low", serde_json::json!(20)).0, "/parameters/0/low");
    assert!(wrong("high", serde_json::json!(5)).1.contains("outside its range"));
    let two = serde_json::json!([{ "pointer": "/gravity/1", "factor": -1 }, "/bodies/0/mass"]);
    assert!(wrong("pointer", two).1.contains("at the first"));
}

#[test]
fn a_run_that_goes_on_unchanged_is_the_same_run() {
    let scene = catalogue::scene("n-four-bar:2").unwrap();
    let mut whole = Simulation::new(&scene).unwrap();
    let mut first = Simulation::new(&scene).unwrap();
    first.advance_to(0.7).unwrap();
    let mut second = Simulation::new(&scene).unwrap();
    second.continue_from(&first).unwrap();
    assert_eq!(second.time(), 0.7);
    assert!(second.summary().energy_drift == 0.0);
    second.advance_to(1.5).unwrap();
    whole.advance_to(1.5).unwrap();
    for (a, b) in whole.q().iter().zip(second.q()) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    second.reset();
    assert_eq!(second.q(), Simulation::new(&scene).unwrap().q());
    assert_eq!(second.time(), 0.0);
}

#[test]
fn gravity_may_vanish_in_flight() {
    let mut before = Simulation::new(&pendulum()).unwrap();
    before.advance_to(0.5).unwrap();
    let speed = |run: &Simulation| {
        let v = run.frame().bodies[0].velocity;
        v.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let then = speed(&before);
    let mut after = Simulation::new(&pendulum().changed([("g", 0.0)], []).unwrap()).unwrap();
    after.continue_from(&before).unwrap();
    after.advance_to(3.0).unwrap();
    assert!((speed(&after) - then).abs() < 1e-9);
}

#[test]
fn a_driven_angle_keeps_its_turns() {
    let text = r#"{"name":"wheel","gravity":[0,0,0],
        "bodies":[{"name":"wheel","mass":1,"inertia":{"principal":[1,1,1]},"angular_velocity":[0,0,5]}],
        "joints":[{"name":"axle","type":"revolute","body_i":"ground","body_j":"wheel","point":[0,0,0],"axis":[0,0,1]}],
        "drivers":[{"type":"angle","name":"motor","joint":"axle","motion":{"kind":"ramp","start":0,"rate":5}}]}"#;
    let mut before = Simulation::new(&scene(text)).unwrap();
    before.advance_to(4.0).unwrap();
    let mut after = Simulation::new(&scene(text)).unwrap();
    after.continue_from(&before).unwrap();
    after.advance_to(5.0).unwrap();
    assert!((after.frame().bodies[0].u[0] - libm::cos(25.0f64)).abs() < 1e-7);
}

#[test]
fn a_state_that_no_longer_fits_is_refused() {
    let mut before = Simulation::new(&pendulum()).unwrap();
    before.advance_to(0.5).unwrap();
    let far = serde_json::json!(9.0);
    let moved = pendulum().changed([], [("/bodies/0/position/0", &far)]).unwrap();
    let mut after = Simulation::new(&moved).unwrap();
    assert!(matches!(
        after.continue_from(&before),
        Err(EngineError::Constraint { error, .. }) if matches!(*error, ConstraintError::StartTooFar { .. })
    ));
}

#[test]
fn a_run_that_goes_on_elsewhere_tells_what_was_corrected_there() {
    let mut value = serde_json::to_value(catalogue::scene("crank-rocker").unwrap()).unwrap();
    value["bodies"][0]["inertia"] =
        serde_json::json!({ "tensor": [[0.2, 0.05, 0], [0.05, 0.2, 0], [0, 0, 0.3]] });
    let scene = scene(&value.to_string());
    let faster = scene.changed([], [("/drivers/0/motion/rate", &5.4.into())]).unwrap();
    let mut before = Simulation::new(&scene).unwrap();
    before.advance_to(1.0).unwrap();
    let mut after = Simulation::new(&faster).unwrap();
    let at_start = after.notes().to_vec();
    assert!(at_start[0].contains("principal moments"), "{at_start:?}");
    assert!(at_start.iter().any(|note| note.contains("are given for the start")), "{at_start:?}");
    let corrected = after.continue_from(&before).unwrap();
    assert!(corrected[0].contains("bodies were moved by up to "), "{corrected:?}");
    let told = corrected
        .iter()
        .map(|note| format!("at t = 1.000 s, when the numbers of the run were changed: {note}"));
    let expected: Vec<String> = at_start[..1].iter().cloned().chain(told).collect();
    assert_eq!(after.notes(), expected);
    after.reset();
    assert_eq!(after.notes(), at_start);
}

#[test]
fn a_run_does_not_go_on_in_one_that_ends_before() {
    let mut before = Simulation::new(&pendulum()).unwrap();
    before.advance_to(1.5).unwrap();
    let mut after = Simulation::new(&pendulum().duration(1.0)).unwrap();
    let error = after.continue_from(&before).unwrap_err();
    assert!(matches!(error, EngineError::TimeOutside { time: 1.5, to: 1.0, .. }), "{error}");
    assert_eq!(after.time(), 0.0);
}

#[test]
fn a_constant_that_is_stated_shortly_is_changed_where_it_stands() {
    let mut value: serde_json::Value =
        serde_json::from_str(&catalogue::scene("simple-pendulum").unwrap().to_json()).unwrap();
    let body = value["bodies"][0]["name"].clone();
    value["loads"] = serde_json::json!([{ "name": "push", "type": "force", "body": body, "force": [1, 2, 3] },
        { "name": "twist", "type": "torsion", "joint": "pin", "torque": 4.0 }]);
    let short = scene(&value.to_string());
    let (five, six) = (serde_json::json!(5.0), serde_json::json!(6.0));
    let changed = short.changed([], [("/loads/0/force/2", &five), ("/loads/1/torque", &six)]).unwrap();
    let written = serde_json::to_value(&changed).unwrap();
    assert_eq!(written["loads"][0]["force"]["vector"], serde_json::json!([1.0, 2.0, 5.0]));
    assert_eq!(written["loads"][1]["torque"]["value"], 6.0);
    let long =
        short.changed([], [("/loads/0/force/vector/2", &five), ("/loads/1/torque/value", &six)]).unwrap();
    assert_eq!(changed, long);
    let beyond = short.changed([], [("/loads/0/force/3", &five)]).unwrap_err().to_string();
    assert!(beyond.contains("there is nothing"), "{beyond}");
}
