//! What several tests share: random scenes and reference tables.
#![allow(dead_code, reason = "each test uses some of it")]
#![allow(clippy::expect_used, clippy::missing_panics_doc, reason = "tests may panic")]

use triad_engine::Scene;
use triad_engine::elimination::Elimination;
use triad_engine::model::Model;
use triad_engine::simulation::Simulation;
use triad_engine::system::System;

/// A small generator of random numbers, so that a seed means the same on every machine.
pub struct Random(u64);

impl Random {
    /// Starts from a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// Uniform in (−1, 1).
    pub fn number(&mut self) -> f64 {
        (self.bits() as f64) / f64::from(1u32 << 30) - 1.0
    }

    /// Three numbers in (−1, 1).
    pub fn triple(&mut self) -> [f64; 3] {
        [self.number(), self.number(), self.number()]
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (0..n).nth((self.bits() % n as u64).try_into().unwrap_or(0)).unwrap_or(0)
    }
}

/// A scene of `bodies` bodies on a tree of random joints, with one loop if that fits; consistent positions, arbitrary
/// velocities, no redundant joint. `coordinates` gives each body's.
pub fn random_scene(seed: u64, bodies: usize, coordinates: impl Fn(usize) -> &'static str) -> Scene {
    let mut random = Random::new(seed);
    let mut list = Vec::new();
    let mut joints = Vec::new();
    for index in 0..bodies {
        let moments: Vec<f64> = (0..3).map(|_| 1.2 + 0.5 * random.number()).collect();
        list.push(serde_json::json!({
            "name": format!("b{index}"),
            "mass": 1.5 + random.number(),
            "inertia": {"principal": moments},
            "center_of_mass": random.triple(),
            "position": random.triple(),
            "orientation": {"axis": random.triple(), "angle": 3.0 * random.number()},
            "velocity": random.triple(),
            "angular_velocity": random.triple(),
            "coordinates": coordinates(index),
        }));
        let parent = if index == 0 { "ground".to_owned() } else { format!("b{}", random.below(index)) };
        let mut joint = serde_json::json!({
            "name": format!("j{index}"), "body_i": parent, "body_j": format!("b{index}"), "point": random.triple(),
        });
        match random.below(4) {
            0 => joint["type"] = "spherical".into(),
            1 => {
                joint["type"] = "universal".into();
                let a = random.triple();
                let b = random.triple();
                let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                joint["axes"] = serde_json::json!([a, cross]);
            }
            rows => {
                joint["type"] = "revolute".into();
                joint["axis"] = serde_json::json!(random.triple());
                joint["rows"] = if rows == 2 { "cp-cv" } else { "cp-2car" }.into();
            }
        }
        joints.push(joint);
    }
    if bodies > 3 {
        joints.push(serde_json::json!({
            "name": "loop", "type": "spherical", "body_i": format!("b{}", bodies - 1), "body_j": "ground",
            "point": random.triple(),
        }));
    }
    let scene = serde_json::json!({
        "name": "random", "gravity": random.triple(), "bodies": list, "joints": joints,
    });
    let mut scene = Scene::from_json(&scene.to_string()).expect("the scene reads well");
    // A loop that only repeats what other joints demand, or locks the mechanism, is no random scene any more.
    let fits = |scene: &Scene| Simulation::new(scene).is_ok_and(|s| s.rank().dependent.is_empty());
    if bodies > 3 && !fits(&scene) {
        scene.joints.pop();
    }
    scene
}

/// The system of a scene and its start (q, q̇), not assembled.
pub fn start(scene: &Scene) -> (System, Elimination, Vec<f64>, Vec<f64>) {
    let system = System::new(Model::new(scene).expect("the scene is sound"));
    let elimination = Elimination::new(&system);
    let mut q = vec![0.0; system.coordinates];
    let mut q_dot = vec![0.0; system.coordinates];
    system.start(&mut q, &mut q_dot);
    (system, elimination, q, q_dot)
}

/// Numbers of a CSV text whose comments begin with `#`; its first other line names the columns.
pub fn table(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names = lines.next().expect("a header").split(',').collect();
    let rows = lines.map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    (names, rows)
}
