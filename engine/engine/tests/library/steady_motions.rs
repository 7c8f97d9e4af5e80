//! Which motions are steady, and how many modes they have, whatever way their axes point and however large their loads are.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use nalgebra::{Rotation3, Vector3};
use serde_json::{Value, json};
use triad_engine::analysis::{AnalysisError, Modes, ModesAbout, modes};
use triad_engine::scene::Scene;

fn steady(scene: &Value) -> Result<Modes, AnalysisError> {
    modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Steady)
}

/// What each mode does, in alphabetical order.
fn kinds(scene: &Value) -> Vec<&'static str> {
    let found = steady(scene).unwrap();
    let mut kinds: Vec<_> = found.modes.iter().map(|mode| mode.kind).collect();
    kinds.sort_unstable();
    kinds
}

/// Axes that point anywhere, with a direction across each.
fn axes() -> impl Iterator<Item = [Vector3<f64>; 2]> {
    (0..12).map(|k| {
        let k = f64::from(k);
        let turn = Rotation3::from_euler_angles(0.3 + 1.7 * k, 0.1 + 0.9 * k, 2.3 * k);
        [turn * Vector3::z(), turn * Vector3::x()]
    })
}

/// A body with its third axis along `axis`, turning about it.
fn body(name: &str, moments: [f64; 3], [axis, across]: [Vector3<f64>; 2], (at, rate): (f64, f64)) -> Value {
    json!({"name": name, "mass": 1.0 + at, "inertia": {"principal": moments},
        "position": (axis * at).as_slice(), "angular_velocity": (axis * rate).as_slice(),
        "orientation": {"u": across.as_slice(), "v": axis.cross(&across).as_slice()}})
}

/// A rotor on a hinge has one freedom and one mode: its turn, which nothing resists.
#[test]
fn a_rotor_on_an_oblique_hinge_only_drifts() {
    for frame in axes() {
        let scene = json!({"name": "rotor", "gravity": (frame[0] * -9.81).as_slice(),
            "bodies": [body("rotor", [0.2, 0.3, 0.4], frame, (0.0, 7.0))],
            "joints": [{"name": "hinge", "type": "revolute", "body_i": "ground", "body_j": "rotor",
                "point": [0, 0, 0], "axis": frame[0].as_slice()}]});
        assert_eq!(kinds(&scene), ["drifts"], "{frame:?}");
    }
}

/// A free body about its middle axis: one motion grows, its counterpart decays; its turn about the axis and three translations
/// drift. What Ω keeps in balance swings with the frame.
#[test]
fn a_free_body_about_its_middle_axis_has_seven_modes() {
    for frame in axes() {
        let mut tumbling = body("body", [0.6, 0.2, 0.5], frame, (0.0, 5.0));
        tumbling["velocity"] = json!([1, 2, 3]);
        let scene = json!({"name": "tumbling", "gravity": [0, 0, 0], "bodies": [tumbling]});
        let expected = ["decays", "drifts", "drifts", "drifts", "drifts", "grows", "oscillates"];
        assert_eq!(kinds(&scene), expected, "{frame:?}");
    }
}
