//! Pivots at several times of a step at once are those one after another.

use serde_json::json;
use triad_engine::catalogue;
use triad_engine::dynamics::series::{IslandSeries, StepPlan};
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_engine::system::planar;

const ORDER: usize = 12;

#[allow(clippy::unwrap_used)] // a helper of tests
/// Three bodies between two points of the ground, all on balls.
fn balls() -> Scene {
    let body = |name: &str, x: f64, spin: [f64; 3]| {
        json!({"name": name, "mass": 1.0 + x, "position": [x, 0.2 * x, 0.1], "center_of_mass": [0.1, 0.3, -0.2],
            "inertia": {"principal": [0.5, 0.6, 0.7 + 0.1 * x]}, "angular_velocity": spin})
    };
    let ball = |name: &str, i: &str, j: &str, at: [f64; 3]| json!({"name": name, "type": "spherical", "body_i": i, "body_j": j, "point": at});
    let scene = json!({"name": "balls", "bodies": [body("a", 0.0, [0.3, 0.0, 1.0]), body("b", 1.0, [0.0, 0.5, 0.2]),
            body("c", 2.0, [0.1, 0.2, 0.0])],
        "joints": [ball("O", "ground", "a", [0.0, 0.0, 0.0]), ball("A", "a", "b", [0.7, 0.9, 0.2]),
            ball("B", "b", "c", [1.6, -0.4, 0.5]), ball("C", "c", "ground", [2.5, 0.3, 0.0])]});
    Scene::from_json(&scene.to_string()).unwrap()
}

/// Largest difference of pivot products at four times of a first step, in a plane or in space, and their least; `None` if they are
/// found one after another.
#[allow(clippy::unwrap_used)] // a helper of tests
fn compare(scene: &Scene, in_plane: bool) -> Option<(f64, f64)> {
    let run = Simulation::new(scene).unwrap();
    let system = run.system();
    let flat = in_plane
        .then(|| planar::recognize(system, run.q()).unwrap().reduce(system.clone(), run.q()).unwrap());
    let solved = flat.as_ref().unwrap_or(system);
    let mut series = if in_plane {
        IslandSeries::in_plane(solved, ORDER, &[])
    } else {
        IslandSeries::in_space(solved, ORDER, &[])
    };
    series.place(system, 0.0, &[run.q(), run.q_dot()].concat());
    series.enable_probes(solved);
    series.linearize();
    let plan =
        StepPlan { order: ORDER, tolerance: 1e-6, length: system.length, end: f64::INFINITY, dry_run: false };
    let step = series.step(plan);
    let times = [0.1, 0.4, 0.6, 1.05].map(|part| part * step.h);
    let at_once = series.pivot_products_at(&times, step.order)?.to_vec();
    let (mut off, mut least) = (0.0f64, 1.0f64);
    for (k, tau) in times.into_iter().enumerate() {
        series.place_probe(0.0, tau, step.order);
        let one_by_one = series.probe_pivot_products();
        assert_eq!(one_by_one.len(), at_once.len());
        for (product, at_once) in one_by_one.iter().zip(&at_once) {
            off = off.max((product - at_once[k]).abs());
            least = least.min(*product);
        }
    }
    Some((off, least))
}

#[test]
fn pivots_at_several_times_at_once_are_those_one_after_another() {
    for (scene, in_plane) in [
        (balls(), false),
        (catalogue::scene("n-four-bar:3").unwrap(), true),
        (catalogue::scene("squeezer").unwrap(), true),
    ] {
        let (off, least) = compare(&scene, in_plane).unwrap();
        assert!(off < 1e-12 && least < 0.9, "{}: off by {off:e}, the least is {least}", scene.name);
    }
    // Hinges in space are more than common points.
    assert_eq!(compare(&catalogue::scene("bricard").unwrap(), false), None);
}
