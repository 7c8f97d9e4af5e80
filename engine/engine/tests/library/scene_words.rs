//! What an author may write shorter, and points with names.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::prelude::*;
use triad_engine::run::MarkerFrame;
use triad_engine::scene::Scene;

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string()).unwrap()
}

/// A tumbling body whose frame is neither in its centre of mass nor along its principal axes.
fn tumbling(coordinates: &str) -> Scene {
    scene(&json!({
        "name": "tumbling", "coordinates": coordinates, "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "body", "mass": 2, "center_of_mass": [0.1, -0.2, 0.3], "position": [1, 2, 3],
            "inertia": { "tensor": [[1, 0.1, 0], [0.1, 2, -0.2], [0, -0.2, 2.5]] },
            "orientation": { "axis": [1, 1, 0], "angle": 0.7 },
            "velocity": [0.5, 0, 0], "angular_velocity": [1, -2, 3] }],
        "markers": [{ "name": "corner", "body": "body", "point": [0.4, 0.5, -0.6] }, { "name": "frame", "body": "body" },
            { "name": "post", "body": "ground", "point": [1, 0, 0] }],
        "events": [{ "name": "low", "of": { "type": "marker", "marker": "corner", "direction": [0, 1, 0] }, "value": 1.5 },
            { "name": "same", "of": { "type": "coordinate", "body": "body", "point": [0.4, 0.5, -0.6], "direction": [0, 1, 0] }, "value": 1.5 }],
        "simulation": { "tolerance": 1e-12 }
    }))
}

#[test]
fn a_marker_moves_as_the_point_of_its_body() {
    for coordinates in ["full", "reduced"] {
        let scene = tumbling(coordinates);
        let motion = scene.simulate(0.0..1.0).unwrap();
        let start = motion.at(0.0).unwrap();
        let frame = start.marker("frame").unwrap();
        assert!((0..3).all(|k| (frame.position[k] - [1.0, 2.0, 3.0][k]).abs() < 1e-14));
        assert!((0..3).all(|k| (frame.velocity[k] - [0.5, 0.0, 0.0][k]).abs() < 1e-14));
        assert_eq!(
            start.marker("post").unwrap(),
            MarkerFrame { position: [1.0, 0.0, 0.0], velocity: [0.0; 3] }
        );
        // Where it is, and the differences of that, at some moment.
        let (t, h) = (0.6, 1e-4);
        let at = |t: f64| motion.at(t).unwrap();
        let [before, here, after] = [t - h, t, t + h].map(|t| at(t).marker("corner").unwrap());
        assert_eq!(here.position, at(t).point("body", [0.4, 0.5, -0.6]).unwrap());
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(t).unwrap();
        let acceleration = run.marker_accelerations();
        assert_eq!(acceleration[2], [0.0; 3], "the ground's");
        for k in 0..3 {
            let rate = (after.position[k] - before.position[k]) / (2.0 * h);
            assert!((rate - here.velocity[k]).abs() < 1e-5, "{coordinates}: {rate} and {}", here.velocity[k]);
            let rate = (after.velocity[k] - before.velocity[k]) / (2.0 * h);
            assert!(
                (rate - acceleration[0][k]).abs() < 1e-4,
                "{coordinates}: {rate} and {}",
                acceleration[0][k]
            );
        }
        assert_eq!(motion.times_of("low").unwrap(), motion.times_of("same").unwrap());
        assert_eq!(motion.times_of("low").unwrap().len(), 1);
        let error = at(t).marker("corer").unwrap_err();
        assert_eq!(
            (&*error.to_string(), &*error.hint()),
            ("there is no marker \"corer\"", "Did you mean \"corner\"?")
        );
    }
}

#[test]
fn a_marker_of_no_body_and_an_event_of_no_marker_are_refused() {
    let mut wrong = tumbling("full");
    wrong.markers[0].body = "bodi".to_owned();
    let error = Simulation::new(&wrong).unwrap_err();
    assert_eq!(error.pointer().as_deref(), Some("/markers/0/body"));
    let mut wrong = tumbling("full");
    wrong.markers[0].name = "corne".to_owned();
    let error = Simulation::new(&wrong).unwrap_err();
    assert!(error.to_string().contains("did you mean \"corne\"?"), "{error}");
    assert_eq!(error.pointer().as_deref(), Some("/events/0/of/marker"));
}

/// A plain number is a constant motion, three plain numbers a constant vector.
#[test]
fn plain_numbers_and_vectors_are_constants() {
    let written = |moment: Value, torque: Value, motion: Value| {
        scene(&json!({
            "name": "plain", "bodies": [{ "name": "b", "mass": 1, "inertia": { "principal": [1, 1, 1] } }],
            "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "b", "point": [0, 0, 0], "axis": [0, 0, 1] }],
            "loads": [{ "name": "m", "type": "moment", "body": "b", "moment": moment },
                { "name": "t", "type": "torsion", "joint": "pin", "torque": torque }],
            "drivers": [{ "name": "d", "type": "angle", "joint": "pin", "motion": motion }]
        }))
    };
    let fixed = json!({ "kind": "fixed", "vector": [0, 0, 0.033] });
    let constant = |value: f64| json!({ "kind": "constant", "value": value });
    assert_eq!(
        written(json!([0, 0, 0.033]), json!(-2), json!(0.5)),
        written(fixed.clone(), constant(-2.0), constant(0.5))
    );
    // Both are written as they always were.
    let text = written(json!([0, 0, 0.033]), json!(-2), json!(0.5)).to_json();
    assert!(text.contains("\"kind\": \"fixed\"") && text.contains("\"kind\": \"constant\""), "{text}");
}

#[test]
fn what_is_no_motion_is_told_with_what_is_wanted() {
    let refused = |moment: &str| {
        let text = format!(
            r#"{{"name": "x", "bodies": [{{"name": "b", "mass": 1}}], "loads": [{{"name": "m", "type": "moment", "body": "b", "moment": {moment}}}]}}"#
        );
        Scene::from_json(&text).unwrap_err().to_string()
    };
    assert!(
        refused("\"up\"").contains("expected three numbers, or a motion of a vector"),
        "{}",
        refused("\"up\"")
    );
    assert!(
        refused("[0, 1]").contains("invalid length 2, expected an array of length 3"),
        "{}",
        refused("[0, 1]")
    );
    let wrong = refused(r#"{"kind": "components", "x": "fast", "y": 0, "z": 0}"#);
    assert!(wrong.contains("expected a number, or a motion"), "{wrong}");
    let unknown = refused(r#"{"kind": "components", "x": {"kind": "ramp", "speed": 1}, "y": 0, "z": 0}"#);
    assert!(unknown.contains("speed") && unknown.contains("loads[0]"), "{unknown}");
}

/// The normal of a plane, and the direction of a line, belong to body i alone.
#[test]
fn an_axis_of_body_i_is_enough_for_a_line_or_a_plane() {
    for kind in ["point-in-plane", "point-on-line"] {
        let with = |axis_j: Option<[f64; 3]>| {
            let mut scene = scene(&json!({
                "name": "slide", "gravity": [1, -9.81, 2],
                "bodies": [{ "name": "b", "mass": 1, "inertia": { "principal": [1, 2, 2] }, "angular_velocity": [1, 2, 3] }],
                "joints": [{ "name": "j", "type": kind, "body_i": "ground", "body_j": "b",
                    "point_i": [0, 0, 0], "point_j": [0, 0, 0], "axis_i": [0, 1, 0] }]
            }));
            scene.joints[0].axis_j = axis_j;
            let motion = scene.simulate(0.0..1.0).unwrap();
            motion.at(1.0).unwrap().position("b").unwrap()
        };
        assert_eq!(with(None), with(Some([0.0, 1.0, 0.0])), "{kind}");
    }
}
