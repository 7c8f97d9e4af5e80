//! Springs of no length: what their small motions are.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use serde_json::json;
use triad_engine::analysis::{Modes, ModesAbout, modes};
use triad_engine::scene::Scene;

/// A pendulum that hangs, with a torsion spring and a spring between a point of the ground and that of the pendulum which is there.
fn sprung_pendulum(from: [f64; 3], free: f64, damping: f64) -> Modes {
    let scene = json!({"name": "pendulum", "gravity": [0, -9.81, 0],
        "bodies": [{"name": "bob", "mass": 1, "position": [0, -1, 0]}],
        "joints": [{"name": "pin", "type": "revolute", "body_i": "ground", "body_j": "bob", "point": [0, 0, 0],
            "axis": [0, 0, 1]}],
        "loads": [{"type": "torsion", "name": "turn", "joint": "pin", "stiffness": 2},
            {"type": "spring", "name": "spring", "body_i": "ground", "point_i": from, "body_j": "bob",
                "point_j": [0, 1.0 + from[1], 0], "stiffness": 100, "free_length": free, "damping": damping}]});
    modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Start).unwrap()
}

/// ω² = (m g l + k)/(m l²): a spring between points that a hinge keeps together does no work, whatever its length without force.
#[test]
fn a_spring_whose_ends_a_hinge_keeps_together_acts_with_nothing() {
    for (free, damping) in [(0.5, 0.0), (0.5, 3.0), (0.0, 3.0), (1e-3, 0.0)] {
        let found = sprung_pendulum([0.0; 3], free, damping);
        let omega = std::f64::consts::TAU * found.modes[0].frequency;
        assert!((omega * omega - 11.81).abs() < 1e-8, "free length {free}: {omega}");
        assert!(found.modes[0].growth.abs() < 1e-9 && found.notes.is_empty(), "{found:?}");
    }
}

/// Where its ends part from no length, a spring with a free length of zero pulls as k x; with another one its force jumps, and a
/// damper has no direction: neither has a linear law, which is told.
#[test]
fn a_spring_that_passes_no_length_has_no_linear_law() {
    let omega_2 = |found: &Modes| {
        let omega = std::f64::consts::TAU * found.modes[0].frequency;
        omega * omega
    };
    let linear = sprung_pendulum([0.0, -1.0, 0.0], 0.0, 0.0);
    assert!((omega_2(&linear) - 111.81).abs() < 1e-7 && linear.notes.is_empty(), "{linear:?}");
    let jumps = sprung_pendulum([0.0, -1.0, 0.0], 0.01, 0.0);
    assert!((omega_2(&jumps) - 11.81).abs() < 1e-8, "{jumps:?}");
    assert!(jumps.notes.iter().any(|note| note.contains("spring \"spring\" has no length")), "{jumps:?}");
}

/// A turn without inertia that a spring holds is a freedom without a mode, which is told.
#[test]
fn what_a_spring_holds_without_inertia_is_told() {
    let scene = json!({"name": "massless turn", "bodies": [{"name": "rod", "mass": 1, "inertia": {"principal": [0, 0.1, 0.1]}}],
        "joints": [{"name": "pin", "type": "revolute", "body_i": "ground", "body_j": "rod", "point": [0, 0, 0], "axis": [1, 0, 0]}],
        "loads": [{"type": "torsion", "name": "spring", "joint": "pin", "stiffness": 10}]});
    let found = modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Start).unwrap();
    assert!(found.freedoms == 1 && found.modes.is_empty() && found.left_out == 0, "{found:?}");
    assert!(found.notes.iter().any(|note| note.contains("that springs hold: 1;")), "{found:?}");
}
