//! Steps allocate nothing: what a run needs is there before its first step.

#![allow(clippy::unwrap_used, missing_docs)]

use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

/// Two bodies with a gear, a driver with knots, friction, a spring and a turning force.
fn acted() -> Scene {
    let scene = serde_json::json!({
        "name": "acted", "gravity": [1, -2, -5],
        "bodies": [
            { "name": "a", "mass": 2, "inertia": { "principal": [0.3, 0.5, 0.7] }, "position": [0.5, 0.2, 0.1] },
            { "name": "b", "mass": 2, "inertia": { "principal": [0.3, 0.5, 0.7] }, "position": [1.5, 0.2, 0.1] },
            { "name": "c", "mass": 2, "inertia": { "principal": [0.3, 0.5, 0.7] }, "position": [2.5, 0.2, 0.1] },
        ],
        "joints": [
            { "name": "p", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 1, 1] },
            { "name": "q", "type": "revolute", "body_i": "ground", "body_j": "b", "point": [1, 0, 0], "axis": [0, 1, 0] },
            { "name": "mesh", "type": "gear", "joints": ["p", "q"], "ratio": 2 },
            { "name": "r", "type": "revolute", "body_i": "b", "body_j": "c", "point": [2, 0, 0], "axis": [0.3, 1, 0], "rows": "cp-cv" },
        ],
        "drivers": [{ "type": "angle", "name": "d", "joint": "p",
            "motion": { "kind": "table", "times": [0, 0.1, 0.3, 0.8, 1.1], "values": [0, 0.1, 0.3, -0.2, 0.2] } }],
        "loads": [
            { "type": "torsion", "name": "t", "joint": "r", "stiffness": 3, "friction": { "coulomb": 0.3, "smoothing": 0.1 } },
            { "type": "spring", "name": "s", "body_i": "a", "point_i": [0, 0, 1], "body_j": "c", "point_j": [0, 0, 0], "stiffness": 9 },
            { "type": "force", "name": "f", "body": "c", "frame": "body", "force": { "kind": "turning", "start": [1, 0, 0],
                "axis": [0, 1, 0], "angle": { "kind": "harmonic", "amplitude": 2, "frequency": 3 } } },
        ],
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

#[test]
fn steps_allocate_nothing() {
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5] {
        for name in ["spatial-chain:20", "n-four-bar:3", "simple-pendulum", "acted"] {
            // The books that a Runge-Kutta run keeps of what drivers bring in are not part of its steps.
            if name == "acted" && integrator != IntegratorKind::Taylor {
                continue;
            }
            let mut scene = if name == "acted" { acted() } else { catalogue::scene(name).unwrap() };
            scene.simulation.integrator = integrator;
            let mut simulation = Simulation::new(&scene).unwrap();
            simulation.step().unwrap();
            let made = allocation_counter::measure(|| {
                for _ in 0..20 {
                    simulation.step().unwrap();
                }
            });
            assert_eq!(made.count_total, 0, "{name} with {integrator:?}");
        }
    }
}
