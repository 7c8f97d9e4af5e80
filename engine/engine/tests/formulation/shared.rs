//! Directors shared at a joint: the same motion and the same reactions as with the explicit joint, with fewer
//! coordinates and rows.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::analysis::check::check;
use triad_engine::catalogue;
use triad_engine::dynamics::elimination::Elimination;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::model::Model;
use triad_engine::run::Simulation;
use triad_engine::scene::{AxisRows, Coordinates, Scene};
use triad_engine::state::State;
use triad_engine::system::System;

/// A body on a ball joint that carries another on a hinge: the hinge axis turns in space. The axis is v of the first
/// body and the opposite of w of the second.
#[allow(clippy::unwrap_used)] // a helper of tests
fn scene(rows: &str) -> Scene {
    serde_json::from_value(serde_json::json!({
        "name": "hinge-in-space", "gravity": [0, 0, -9.81],
        "bodies": [
            { "name": "a", "mass": 1.2, "inertia": { "principal": [0.2, 0.3, 0.4] }, "center_of_mass": [0.4, 0.1, 0.05],
              "angular_velocity": [0.6, -1.0, 2.0] },
            { "name": "b", "mass": 0.7, "inertia": { "principal": [0.1, 0.15, 0.2] }, "position": [0.8, 0, 0],
              "orientation": { "u": [1, 0, 0], "v": [0, 0, 1] }, "center_of_mass": [0.2, -0.1, 0.3],
              "velocity": [0, 1.6, 0.8], "angular_velocity": [0.6, 0.5, 2.0] },
        ],
        "joints": [
            { "name": "ball", "type": "spherical", "body_i": "ground", "body_j": "a", "point": [0, 0, 0] },
            { "name": "hinge", "type": "revolute", "body_i": "a", "body_j": "b", "point": [0.8, 0, 0],
              "axis": [0, 1, 0], "rows": rows },
        ],
        "simulation": { "duration": 3, "tolerance": 1e-11 },
    }))
    .unwrap()
}

#[test]
fn shared_and_explicit_joints_move_and_react_alike() {
    let mut explicit = Simulation::new(&scene("cp-cv")).unwrap();
    let mut shared = Simulation::new(&scene("shared")).unwrap();
    for t in [0.0, 0.7, 1.9, 3.0] {
        explicit.advance_to(t).unwrap();
        shared.advance_to(t).unwrap();
        for (a, b) in explicit.frame().bodies.iter().zip(&shared.frame().bodies) {
            for (x, y) in [(a.position, b.position), (a.u, b.u), (a.v, b.v), (a.w, b.w)] {
                assert!((0..3).all(|k| (x[k] - y[k]).abs() < 1e-8), "t = {t}: {x:?} {y:?}");
            }
        }
        for (a, b) in explicit.multipliers().iter().zip(&shared.multipliers()) {
            for (x, y) in [(a.force, b.force), (a.moment, b.moment)] {
                assert!((0..3).all(|k| (x[k] - y[k]).abs() < 1e-6), "t = {t}, {}: {x:?} {y:?}", a.joint);
            }
        }
    }
}

#[test]
fn sharing_removes_coordinates_and_rows_but_no_freedom() {
    let (explicit, shared) = (check(&scene("cp-cv")).unwrap(), check(&scene("shared")).unwrap());
    assert_eq!((explicit.coordinates, explicit.rows), (24, 21));
    assert_eq!((shared.coordinates, shared.rows), (21, 17));
    assert_eq!((explicit.degrees_of_freedom, shared.degrees_of_freedom), (4, 4));
    assert_eq!((explicit.redundant.len(), shared.redundant.len()), (1, 0));
}

/// The augmented system in the shared coordinates, whose mass matrix couples the bodies, gives the accelerations that
/// the elimination gives.
#[test]
fn the_augmented_system_agree() {
    augmented_agrees(&scene("shared"));
}

/// A director along a fixed direction has no coordinates, and puts no mass anywhere.
#[test]
fn the_augmented_system_agrees_where_directors_are_shared_with_the_ground() {
    let mut scene = catalogue::scene("n-four-bar:2").unwrap();
    scene.coordinates = Coordinates::Shared;
    augmented_agrees(&scene);
}

fn augmented_agrees(scene: &Scene) {
    let system = System::new(Model::new(scene).unwrap());
    let n = system.coordinates;
    let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
    system.start(&mut q, &mut v);
    let at = State::at(&system, 0.0, &q, &v);
    let mut acceleration = vec![0.0; n];
    Elimination::new(&system).accelerate(&system, &at, (0.0, 0.0)).write(&mut acceleration);
    let solution = AugmentedSystem::new(&system, &at).solve().unwrap().acceleration;
    for k in 0..n {
        assert!((solution[k] - acceleration[k]).abs() < 1e-9, "{k}: {} {}", solution[k], acceleration[k]);
    }
}

/// One word for the whole scene does what a word at each joint does, and tells where it cannot.
#[test]
fn a_whole_scene_shares_wherever_an_axis_is_a_director() {
    let mut whole = scene("cp-cv");
    whole.coordinates = Coordinates::Shared;
    let (by_scene, by_joint) = (check(&whole).unwrap(), check(&scene("shared")).unwrap());
    assert_eq!((by_scene.coordinates, by_scene.rows), (by_joint.coordinates, by_joint.rows));
    assert!(by_scene.notes.is_empty());

    whole.joints[1].axis = Some([0.0, 1.0, 0.1]);
    let oblique = check(&whole).unwrap();
    assert_eq!((oblique.coordinates, oblique.rows), (24, 21));
    assert!(
        oblique.notes.iter().any(|note| note.contains("\"hinge\" shares no director")),
        "{:?}",
        oblique.notes
    );

    // A body that is described otherwise shares nothing, and is not forced to.
    whole.joints[1].axis = Some([0.0, 1.0, 0.0]);
    whole.bodies[0].coordinates = Some(Coordinates::Reduced);
    assert_eq!(check(&whole).unwrap().coordinates, 21);
}

/// All hinges of the double four-bar share z with the ground: planar natural coordinates come out by themselves.
#[test]
fn a_planar_mechanism_shares_its_normal_with_the_ground() {
    let mut scene = catalogue::scene("n-four-bar:2").unwrap();
    scene.simulation.tolerance = 1e-10;
    let explicit = scene.clone();
    for joint in &mut scene.joints {
        joint.rows = Some(AxisRows::Shared);
    }
    let report = check(&scene).unwrap();
    assert_eq!((report.coordinates, report.degrees_of_freedom), (45, 1));
    let (mut a, mut b) = (Simulation::new(&explicit).unwrap(), Simulation::new(&scene).unwrap());
    for t in [0.5, 2.0] {
        a.advance_to(t).unwrap();
        b.advance_to(t).unwrap();
        let (x, y) = (a.frame().bodies[0].position, b.frame().bodies[0].position);
        assert!(libm::hypot(x[0] - y[0], x[1] - y[1]) < 1e-7, "t = {t}: {x:?} {y:?}");
    }
}
