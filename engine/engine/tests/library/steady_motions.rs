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

/// Two rotors on one axis with an unstressed torsion spring between them turn on for ever, free or on a bearing: the angle of the
/// spring is rounding, and so is its moment, however stiff it is.
#[test]
fn an_unstressed_spring_between_two_rotors_is_steady() {
    for stiffness in [5.0, 50.0, 5e3, 5e6] {
        for frame in axes() {
            let axis = frame[0].as_slice();
            let bodies = json!([
                body("one", [0.2, 0.2, 0.4], frame, (0.0, 3.0)),
                body("two", [0.1, 0.1, 0.15], frame, (0.5, 3.0))
            ]);
            let hinge = json!({"name": "hinge", "type": "revolute", "body_i": "one", "body_j": "two",
                "point": [0, 0, 0], "axis": axis});
            let bearing = json!({"name": "bearing", "type": "revolute", "body_i": "ground", "body_j": "one",
                "point": [0, 0, 0], "axis": axis});
            for joints in [json!([hinge]), json!([hinge, bearing])] {
                let scene = json!({"name": "two rotors", "gravity": [0, 0, 0], "bodies": bodies, "joints": joints,
                    "loads": [{"type": "torsion", "name": "spring", "joint": "hinge", "stiffness": stiffness}]});
                let found = steady(&scene);
                assert!(found.is_ok(), "{stiffness} {frame:?} {found:?}");
            }
        }
    }
}

/// A cart on rails with a spring, driven by `force` at its joint or by `motion`.
fn cart(force: &Value, motion: Option<&Value>) -> Value {
    let mut scene = json!({"name": "cart", "bodies": [{"name": "cart", "mass": 1}, {"name": "tow", "mass": 1}],
        "joints": [{"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "cart", "point": [0, 0, 0], "axis": [1, 0, 0]},
            {"name": "tows", "type": "prismatic", "body_i": "cart", "body_j": "tow", "point": [0, 0, 0], "axis": [1, 0, 0]}],
        "loads": [{"type": "slider", "name": "spring", "joint": "tows", "stiffness": 1, "force": force}]});
    if let Some(motion) = motion {
        scene["drivers"] = json!([{"type": "slide", "name": "driver", "joint": "rail", "motion": motion}]);
    }
    scene
}

/// Forces and drivers with any period, or that change late, are no part of a steady motion; constant ones are.
#[test]
fn what_is_prescribed_and_changes_is_not_steady() {
    let none = json!({"kind": "constant", "value": 0.0});
    let still = json!({"kind": "constant", "value": 0.0});
    for frequency in [1.0, 2.0, 10.0, 0.7, 1.0 / 0.7, 50.0, 100.0] {
        let omega = std::f64::consts::TAU * frequency;
        let force = json!({"kind": "harmonic", "amplitude": 2.0, "frequency": omega});
        let found = steady(&cart(&force, Some(&still)));
        assert!(matches!(found, Err(AnalysisError::NoSteadyMotion { .. })), "{frequency} Hz: {found:?}");
        let motion = json!({"kind": "expression", "value": format!("0.1*sin({omega}*t)^2")});
        let found = steady(&cart(&none, Some(&motion)));
        assert!(matches!(found, Err(AnalysisError::NoSteadyMotion { .. })), "{frequency} Hz: {found:?}");
    }
    let late = json!({"kind": "smooth-step", "from": 0.0, "to": 2.0, "start": 6.0, "end": 6.5});
    for scene in [cart(&late, Some(&still)), cart(&none, Some(&late))] {
        let found = steady(&scene);
        assert!(matches!(found, Err(AnalysisError::NoSteadyMotion { .. })), "{found:?}");
    }
    let constant = json!({"kind": "constant", "value": 2.0});
    let ramp = json!({"kind": "ramp", "rate": 3.0});
    for scene in [cart(&constant, Some(&still)), cart(&constant, Some(&ramp)), cart(&none, Some(&ramp))] {
        assert!(steady(&scene).is_ok());
    }
}

/// The rockers of a four-bar that moves are in no frame: its steady motion is rest, and its velocities are told to be left out.
#[test]
fn velocities_that_belong_to_no_steady_motion_are_told() {
    let rod = |name: &str, position: [f64; 3]| json!({"name": name, "mass": 1, "position": position});
    let pin = |name: &str, i: &str, j: &str, point: [f64; 3]| json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": point, "axis": [0, 0, 1]});
    let mut scene = json!({"name": "four-bar", "gravity": [0, 0, 0],
        "bodies": [rod("crank", [0.0, 0.5, 0.0]), rod("coupler", [1.0, 1.25, 0.0]), rod("rocker", [2.0, 0.75, 0.0])],
        "joints": [pin("a", "ground", "crank", [0.0, 0.0, 0.0]), pin("b", "crank", "coupler", [0.0, 1.0, 0.0]),
            pin("c", "coupler", "rocker", [2.0, 1.5, 0.0]), pin("d", "ground", "rocker", [2.0, 0.0, 0.0])],
        "loads": [{"type": "torsion", "name": "spring", "joint": "a", "stiffness": 10}]});
    let told = |scene: &Value| {
        steady(scene).unwrap().notes.iter().any(|note| note.contains("steady motion near the start is rest"))
    };
    assert!(!told(&scene));
    scene["joints"][0]["start"] = json!({"rate": 2.0});
    assert!(told(&scene));
}
