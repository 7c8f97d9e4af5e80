//! Whole turns of joint angles where only positions are known.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::json;
use triad_engine::constraints::turns;
use triad_engine::equations;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_engine::state::State;

/// A motor turns a wheel, a gear another one, that a third one, and a nut runs on a screw that is the first one's.
#[test]
fn screws_gears_and_drivers_tell_how_often_joints_have_turned() {
    let wheel = |name: &str, x: f64| json!({ "name": name, "mass": 1, "position": [x, 0, 0], "inertia": { "principal": [0.1, 0.1, 0.2] } });
    let joint = |name: &str, kind: &str, other: &str, wheel: &str, x: f64| json!({ "name": name, "type": kind, "body_i": other, "body_j": wheel, "point": [x, 0, 0], "axis": [0, 0, 1] });
    let mut thread = joint("thread", "screw", "ground", "nut", 5.0);
    thread["pitch"] = json!(0.3);
    let scene = json!({
        "name": "turns", "gravity": [0, 0, 0],
        "bodies": [wheel("a", 0.0), wheel("b", 1.0), wheel("c", 2.0), wheel("d", 3.0), wheel("e", 4.0), {
            "name": "nut", "mass": 1, "position": [5, 0, 0], "inertia": { "principal": [0.1, 0.1, 0.2] }, "angular_velocity": [0, 0, -9],
            "velocity": [0, 0, -2.7]
        }],
        "joints": [
            joint("pin-a", "revolute", "ground", "a", 0.0), joint("pin-b", "revolute", "ground", "b", 1.0),
            joint("pin-c", "revolute", "ground", "c", 2.0), joint("pin-d", "revolute", "ground", "d", 3.0),
            joint("pin-e", "revolute", "ground", "e", 4.0), thread,
            { "name": "ab", "type": "gear", "joints": ["pin-a", "pin-b"], "ratio": 1.544_742_842_9 },
            { "name": "bc", "type": "gear", "joints": ["pin-b", "pin-c"], "ratio": -0.7 },
            { "name": "de", "type": "gear", "joints": ["pin-d", "pin-e"], "ratio": 0.618_033_988_7 }
        ],
        "drivers": [{ "name": "motor", "type": "angle", "joint": "pin-a", "motion": { "kind": "ramp", "start": 0.0, "rate": 7.0 } }],
        "simulation": { "duration": 10 }
    });
    let mut scene: Scene = Scene::from_json(&scene.to_string()).unwrap();
    for body in &mut scene.bodies {
        if body.name() == "d" {
            body.angular_velocity = [0.0, 0.0, 11.0];
        }
    }
    let mut run = Simulation::new(&scene).unwrap();
    let mut off = 0.0f64;
    for time in [0.3, 1.7, 4.1, 10.0] {
        run.advance_to(time).unwrap();
        let system = run.system();
        let mut state = State::at(system, time, run.q(), run.q_dot());
        let largest = |state: &State| {
            equations::constraints(system, state).into_iter().fold(0.0f64, |most, x| most.max(x.abs()))
        };
        off = off.max(largest(&state));
        turns::count(system, &mut state);
        state.set(system, time, run.q(), run.q_dot());
        assert!(largest(&state) < 1e-9, "{time}: {:.1e}", largest(&state));
        let motor = system.angle_joints.iter().position(|joint| joint == "pin-a").unwrap();
        assert!((state.angles()[motor].value - 7.0 * time).abs() < 1e-9, "{:?}", state.angles()[motor]);
    }
    assert!(off > 1.0, "{off}: turns need counting");
}
