//! What several tests share: random scenes and reference tables.
#![allow(dead_code, reason = "each test uses some of it")]
#![allow(clippy::expect_used, clippy::missing_panics_doc, reason = "tests may panic")]

use triad_engine::Scene;
use triad_engine::model::Model;
use triad_engine::run::Simulation;
use triad_engine::system::System;
pub use triad_linalg::random::Random;

/// A scene of `bodies` bodies on a tree of random joints, with one loop if that fits; consistent positions, arbitrary
/// velocities, no redundant joint. `coordinates` gives each body's.
pub fn random_scene(seed: u64, bodies: usize, coordinates: impl Fn(usize) -> &'static str) -> Scene {
    let mut random = Random::new(seed);
    let mut list = Vec::new();
    let mut joints = Vec::new();
    for index in 0..bodies {
        // No moment of inertia is larger than the two others together.
        let moments: Vec<f64> = (0..3).map(|_| 1.2 + 0.4 * random.between(-1.0, 1.0)).collect();
        list.push(serde_json::json!({
            "name": format!("b{index}"),
            "mass": 1.5 + random.between(-1.0, 1.0),
            "inertia": {"principal": moments},
            "center_of_mass": random.triple(1.0),
            "position": random.triple(1.0),
            "orientation": {"axis": random.triple(1.0), "angle": 3.0 * random.between(-1.0, 1.0)},
            "velocity": random.triple(1.0),
            "angular_velocity": random.triple(1.0),
            "coordinates": coordinates(index),
        }));
        let parent = if index == 0 { "ground".to_owned() } else { format!("b{}", random.below(index)) };
        let mut joint = serde_json::json!({
            "name": format!("j{index}"), "body_i": parent, "body_j": format!("b{index}"), "point": random.triple(1.0),
        });
        match random.below(4) {
            0 => joint["type"] = "spherical".into(),
            1 => {
                joint["type"] = "universal".into();
                let a = random.triple(1.0);
                let b = random.triple(1.0);
                let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                joint["axes"] = serde_json::json!([a, cross]);
            }
            rows => {
                joint["type"] = "revolute".into();
                joint["axis"] = serde_json::json!(random.triple(1.0));
                joint["rows"] = if rows == 2 { "cp-cv" } else { "cp-2car" }.into();
            }
        }
        joints.push(joint);
    }
    if bodies > 3 {
        joints.push(serde_json::json!({
            "name": "loop", "type": "spherical", "body_i": format!("b{}", bodies - 1), "body_j": "ground",
            "point": random.triple(1.0),
        }));
    }
    let scene = serde_json::json!({
        "name": "random", "gravity": random.triple(1.0), "bodies": list, "joints": joints,
    });
    let mut scene = Scene::from_json(&scene.to_string()).expect("the scene reads well");
    // A loop that only repeats what other joints demand, or locks the mechanism, is no random scene any more.
    let fits = |scene: &Scene| Simulation::new(scene).is_ok_and(|s| s.rank().dependent.is_empty());
    if bodies > 3 && !fits(&scene) {
        scene.joints.pop();
    }
    scene
}

/// A scene of `tests/data/problems`.
pub fn problem(name: &str) -> Scene {
    let path = format!("{}/../../tests/data/problems/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Scene::from_json(&std::fs::read_to_string(path).expect("the problem is there")).expect("it reads well")
}

/// The system of a scene and its start (q, q̇), not assembled.
pub fn start(scene: &Scene) -> (System, Vec<f64>, Vec<f64>) {
    let system = System::new(Model::new(scene).expect("the scene is sound"));
    let mut q = vec![0.0; system.coordinates];
    let mut q_dot = vec![0.0; system.coordinates];
    system.start(&mut q, &mut q_dot);
    (system, q, q_dot)
}

/// Numbers of a CSV text whose comments begin with `#`; its first other line names the columns.
pub fn table(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names = lines.next().expect("a header").split(',').collect();
    let rows = lines.map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    (names, rows)
}

/// Largest difference of all positions and directors between two runs at 20 times.
pub fn difference(a: &Scene, b: &Scene) -> f64 {
    difference_until(f64::INFINITY, a, b)
}

/// The same up to this time, s.
pub fn difference_until(end: f64, a: &Scene, b: &Scene) -> f64 {
    let [mut first, mut second] = [a, b].map(|scene| Simulation::new(scene).expect("it starts"));
    let mut largest: f64 = 0.0;
    for k in 1..=20 {
        let t = f64::from(k) / 20.0 * a.simulation.duration.min(end);
        for run in [&mut first, &mut second] {
            run.advance_to(t).expect("it goes on");
        }
        for (x, y) in first.frame().bodies.iter().zip(&second.frame().bodies) {
            for (x, y) in [(x.position, y.position), (x.u, y.u), (x.v, y.v), (x.w, y.w)] {
                largest = largest.max(triad_linalg::largest_difference(&x, &y));
            }
        }
    }
    largest
}

/// Whether numbers are the expected ones, to a part of each.
pub fn same(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
    }
}
