//! Assembly: consistent positions from rough ones, and what is told of them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use crate::analyses::near;
use nalgebra::Vector3;
use serde_json::json;
use triad_engine::analysis::assemble;
use triad_engine::catalogue;
use triad_engine::scene::Scene;

/// A four-bar whose links are roughly placed: the kept link stays, all joints close.
#[test]
fn a_rough_start_is_assembled_around_what_is_kept() {
    let text = r#"{"name": "rough",
      "bodies": [
        {"name": "crank", "mass": 1, "inertia": {"principal": [0.01, 0.1, 0.1]}, "center_of_mass": [0.5, 0, 0],
         "orientation": {"axis": [0, 0, 1], "angle": 1.2}, "angular_velocity": [0, 0, 3]},
        {"name": "coupler", "mass": 2, "inertia": {"principal": [0.01, 0.2, 0.2]}, "position": [0.6, 1.4, 0.2]},
        {"name": "rocker", "mass": 1.5, "inertia": {"principal": [0.01, 0.2, 0.2]}, "position": [2.2, 0.3, -0.1],
         "orientation": {"axis": [0, 0.1, 1], "angle": 1.0}}],
      "joints": [
        {"name": "A", "type": "revolute", "body_i": "ground", "body_j": "crank", "point_i": [0, 0, 0], "point_j": [0, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]},
        {"name": "B", "type": "revolute", "body_i": "crank", "body_j": "coupler", "point_i": [1, 0, 0], "point_j": [0, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]},
        {"name": "C", "type": "revolute", "body_i": "coupler", "body_j": "rocker", "point_i": [2, 0, 0], "point_j": [1.5, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]},
        {"name": "D", "type": "revolute", "body_i": "rocker", "body_j": "ground", "point_i": [0, 0, 0], "point_j": [2, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]}]}"#;
    let scene = Scene::from_json(text).unwrap();
    let found = assemble(&scene, &["crank".to_owned()]).unwrap();
    assert!(found.violation > 0.1 && found.left < 1e-12, "{found:?}");
    let [crank, coupler, rocker] = found.bodies.as_slice() else { panic!("three bodies") };
    assert!(crank.moved < 1e-9 && crank.turned < 1e-9, "{crank:?}");
    assert!(coupler.moved > 0.05 && rocker.turned > 0.05);
    let tip = Vector3::new(libm::cos(1.2f64), libm::sin(1.2f64), 0.0);
    assert!((Vector3::from(coupler.position) - tip).norm() < 1e-9);
    assert!((Vector3::from(rocker.position) - Vector3::new(2.0, 0.0, 0.0)).norm() < 1e-9);
    // The kept link keeps its velocity too; the others follow.
    near(crank.angular_velocity[2], 3.0, 1e-6, "spin");
    let speed = Vector3::new(0.0, 0.0, 3.0).cross(&tip);
    assert!((Vector3::from(coupler.velocity) - speed).norm() < 2e-6);
    let error = assemble(&scene, &["crank".to_owned(), "rocker".to_owned()]).unwrap_err();
    assert_eq!(error.code(), "cannot-pin");
}

/// Positions that six digits were printed of are moved by less than those, and turned by a number.
#[test]
fn a_start_that_is_rounded_is_turned_by_next_to_nothing() {
    let scene = crate::loops::problem("squeezer/rounded");
    for kept in [vec![], vec!["OF".to_owned()]] {
        for body in assemble(&scene, &kept).unwrap().bodies {
            assert!((0.0..1e-5).contains(&body.turned) && (0.0..1e-6).contains(&body.moved), "{body:?}");
        }
    }
}

/// With points in the world nothing is open, and lengths are what rounded positions make them: that is told.
#[test]
fn assembly_tells_which_joints_do_not_keep_lengths() {
    let notes = |scene: &Scene| assemble(scene, &[]).unwrap().notes;
    let told = notes(&crate::loops::problem("squeezer/rounded"));
    assert!(
        told.len() == 1 && told[0].contains("\"O\"") && told[0].contains("only point_i and point_j"),
        "{told:?}"
    );
    let mut local = catalogue::scene("crank-rocker").unwrap();
    assert!(notes(&local)[0].contains("\"O\", \"A\", \"B\", \"D\""));
    local.joints.retain(|joint| joint.name != "A" && joint.name != "B");
    local.drivers.clear();
    // One joint of a body leaves no length open.
    assert_eq!(notes(&local), Vec::<String>::new());
    assert_eq!(notes(&catalogue::scene("simple-pendulum").unwrap()), Vec::<String>::new());
}

/// Springs, gears and events count the angles of joints from the stated positions: where these are replaced, the count goes with them.
#[test]
fn assembly_tells_the_angles_that_are_counted() {
    let mut scene = catalogue::scene("n-four-bar:1").unwrap();
    let joint = scene.joints[0].name.clone();
    let notes = |scene: &Scene| {
        let found = assemble(scene, &[]).unwrap();
        found.notes.into_iter().filter(|note| note.contains("stated_angle")).collect::<Vec<_>>()
    };
    let json = json!([{"name": "spring", "type": "torsion", "joint": joint, "stiffness": 50}]);
    scene.loads = serde_json::from_value(json).unwrap();
    assert_eq!(notes(&scene), Vec::<String>::new(), "where they are closed nothing is told");
    let mut value = serde_json::to_value(&scene).unwrap();
    value["joints"][0]["start"] = json!({"angle": 0.3});
    let told = notes(&Scene::from_json(&value.to_string()).unwrap());
    assert!(told.len() == 1 && told[0].contains(&format!("joint \"{joint}\" is 0.")), "{told:?}");
}
