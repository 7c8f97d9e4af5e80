//! What is left out changes no result, and counters show that it was left out.

#![allow(clippy::unwrap_used)]

use serde_json::json;
use triad_engine::catalogue;
use triad_engine::reactions::report::Convention;
use triad_engine::run::{Simulation, SkippedItem};
use triad_engine::scene::{Driver, Ground, IntegratorKind, Joint, Motion, Orientation, Scene, Skip};

fn scene(name: &str) -> Scene {
    let mut scene = catalogue::scene(name).unwrap();
    scene.simulation.tolerance = 1e-11;
    scene.simulation.integrator = IntegratorKind::Taylor;
    scene.simulation.duration = 1.0;
    scene
}

/// Runs to the end; all positions and directors at ten times, and what was left out.
fn run(scene: &Scene) -> (Vec<f64>, Vec<SkippedItem>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut numbers = Vec::new();
    for k in 1..=10 {
        simulation.advance_to(f64::from(k) / 10.0 * scene.simulation.duration).unwrap();
        for body in simulation.frame().bodies {
            for vector in [body.position, body.u, body.v, body.w, body.velocity] {
                numbers.extend(vector);
            }
        }
    }
    let summary = simulation.summary();
    assert!(summary.position_violation < 1e-12, "{}: {:e}", scene.name, summary.position_violation);
    (numbers, simulation.left_out())
}

fn saved(left: &[SkippedItem], word: &str) -> u64 {
    left.iter().find(|l| l.word == word).unwrap().saved
}

/// Runs with and without leaving out `word`: equal motion, and the counter of the word.
fn compare(scene: &Scene, word: &str, bound: f64) -> (u64, u64) {
    let (with, left) = run(scene);
    let mut all = scene.clone();
    *all.simulation.skip.word_mut(word).unwrap() = false;
    let (without, kept) = run(&all);
    let largest = with.iter().zip(&without).fold(0.0f64, |a, (x, y)| a.max((x - y).abs()));
    assert!(largest < bound, "{} without {word}: {largest:e}", scene.name);
    assert!(!kept.iter().find(|l| l.word == word).unwrap().on);
    (saved(&left, word), saved(&kept, word))
}

/// The same scene with its world turned, so that its plane is no coordinate plane.
fn turned(mut scene: Scene) -> Scene {
    let (c, s) = (0.6, 0.8);
    let turn = |v: [f64; 3]| {
        let v = [v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]];
        [c * v[0] + s * v[2], v[1], c * v[2] - s * v[0]]
    };
    scene.gravity = turn(scene.gravity);
    for body in &mut scene.bodies {
        body.position = turn(body.position);
        body.velocity = turn(body.velocity);
        body.angular_velocity = turn(body.angular_velocity);
        if let Some(Orientation::Directors { u, v, .. }) = &mut body.orientation {
            (*u, *v) = (turn(*u), turn(*v));
        }
    }
    for joint in &mut scene.joints {
        joint.point = joint.point.map(turn);
        joint.axis = joint.axis.map(turn);
    }
    scene
}

#[test]
fn planar_scenes_move_as_in_space() {
    for name in ["simple-pendulum", "n-four-bar:1", "n-four-bar:2", "n-four-bar:5"] {
        let bodies = scene(name).bodies.len() as u64;
        assert_eq!(compare(&scene(name), "planar", 1e-8), (bodies, 0), "{name}");
    }
    assert_eq!(compare(&turned(scene("n-four-bar:2")), "planar", 1e-8), (5, 0));
    for name in ["spatial-double-pendulum", "spatial-chain:3", "bricard"] {
        let (_, left) = run(&scene(name));
        assert_eq!(saved(&left, "planar"), 0, "{name}");
    }
}

/// A driven slider-crank whose parts lie in different heights, with a swinging bob, a spring and a force with a part out
/// of the plane.
#[test]
fn loads_and_drivers_act_in_the_plane_as_in_space() {
    let text = r#"{
      "name": "slider", "gravity": [0, -9.81, 0],
      "bodies": [
        {"name": "crank", "mass": 1, "position": [0.25, 0, 0.1], "inertia": {"principal": [0.01, 0.02, 0.025]}},
        {"name": "rod", "mass": 1, "position": [1, 0, 0.2], "inertia": {"principal": [0.01, 0.09, 0.09]}},
        {"name": "block", "mass": 2, "position": [1.5, 0, 0.3], "inertia": {"principal": [0.1, 0.1, 0.1]}},
        {"name": "bob", "mass": 0.3, "position": [1.5, -0.4, 0], "inertia": {"principal": [0.001, 0.001, 0.001]}}
      ],
      "joints": [
        {"name": "a", "type": "revolute", "body_i": "ground", "body_j": "crank", "point": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "b", "type": "revolute", "body_i": "crank", "body_j": "rod", "point": [0.5, 0, 0], "axis": [0, 0, 1]},
        {"name": "c", "type": "revolute", "body_i": "rod", "body_j": "block", "point": [1.5, 0, 0], "axis": [0, 0, 1]},
        {"name": "d", "type": "prismatic", "body_i": "ground", "body_j": "block", "point": [1.5, 0, 0], "axis": [1, 0, 0]},
        {"name": "e", "type": "revolute", "body_i": "block", "body_j": "bob", "point": [1.5, 0, 0], "axis": [0, 0, 1]}
      ],
      "drivers": [
        {"name": "turn", "type": "angle", "joint": "a", "motion": {"kind": "harmonic", "mean": 0.0, "amplitude": 0.8, "frequency": 2.0, "phase": 0.0}}
      ],
      "loads": [
        {"name": "push", "type": "force", "body": "bob", "point": [1.5, -0.5, 0], "force": {"kind": "fixed", "vector": [0.4, 0.1, 0.2]}, "frame": "body"},
        {"name": "coil", "type": "spring", "body_i": "ground", "body_j": "bob", "point_i": [2, 0.5, 0], "point_j": [1.5, -0.4, 0], "stiffness": 5, "damping": 0.2}
      ]
    }"#;
    let mut slider = Scene::from_json(text).unwrap();
    slider.simulation = scene("simple-pendulum").simulation;
    let (saved, _) = compare(&slider, "planar", 1e-8);
    assert_eq!(saved, 4);
}

/// Two pendulums of different lengths, and a chain, with nothing between them.
fn three_islands() -> Scene {
    let mut scene = scene("n-four-bar:1");
    for (k, length) in [(0, 0.3), (1, 2.0)] {
        let other = self::scene("simple-pendulum");
        let (mut bob, mut pin) = (other.bodies[0].clone(), other.joints[0].clone());
        let name = format!("bob-{k}");
        bob.position = [5.0 - length, 0.0, 0.0];
        bob.name.clone_from(&name);
        bob.shape.clear();
        pin.name = format!("pin-{k}");
        pin.body_j = name;
        pin.point = Some([5.0, 0.0, 0.0]);
        scene.bodies.insert(k, bob);
        scene.joints.push(pin);
    }
    scene
}

#[test]
fn islands_take_steps_of_their_own() {
    let (saved, none) = compare(&three_islands(), "islands", 1e-8);
    assert!(saved > 8, "{saved}");
    assert_eq!(none, 0);
    let (_, left) = run(&three_islands());
    assert!(left.iter().any(|l| l.word == "islands" && l.what.starts_with("3 parts")));
}

#[test]
fn bodies_tied_to_the_ground_are_ground() {
    let mut scene = scene("n-four-bar:1");
    let mut base = scene.bodies[0].clone();
    base.name = "base".to_owned();
    base.velocity = [0.0; 3];
    base.angular_velocity = [0.0; 3];
    base.position = [0.1, -0.2, 0.3];
    scene.bodies.insert(0, base);
    let mut weld = Joint::fixed("weld", Ground, "base");
    weld.point = Some([0.0, -0.2, 0.0]);
    scene.joints.push(weld);
    scene.joints[0].body_i = "base".to_owned();
    assert_eq!(compare(&scene, "fixed", 1e-8), (1, 0));
}

/// A closed chain of three rods, the first of which carries a plate and a fin, with loads in frames of merged bodies, a driver and a
/// spring between them.
fn welded(normal: &str) -> Scene {
    let text = r#"{
      "name": "welded", "gravity": [0.5, -9.81, 0],
      "bodies": [
        {"name": "crank", "mass": 1, "position": [0, 0.5, 0], "inertia": {"principal": [0.09, 0.01, 0.09]}},
        {"name": "plate", "mass": 2, "position": [0.3, 0.6, 0.2], "inertia": {"principal": [0.1, 0.2, 0.25]},
         "orientation": {"axis": [1, 2, 3], "angle": 0.7}, "coordinates": "reduced"},
        {"name": "fin", "mass": 0.5, "position": [0.5, 0.9, -0.1], "inertia": {"tensor": [[0.03, 0.005, 0], [0.005, 0.02, 0.001], [0, 0.001, 0.04]]}},
        {"name": "rod", "mass": 1, "position": [0.5, 1, 0], "inertia": {"principal": [0, 0.09, 0.09]}},
        {"name": "rocker", "mass": 1, "position": [1, 0.5, 0], "inertia": {"principal": [0.09, 0.01, 0.09]}}
      ],
      "joints": [
        {"name": "a", "type": "revolute", "body_i": "ground", "body_j": "crank", "point": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "bolt", "type": "fixed", "body_i": "crank", "body_j": "plate", "point": [0.1, 0.6, 0.1]},
        {"name": "seam", "type": "fixed", "body_i": "fin", "body_j": "plate", "point": [0.4, 0.7, 0]},
        {"name": "b", "type": "revolute", "body_i": "plate", "body_j": "rod", "point": [0, 1, 0], "axis": NORMAL},
        {"name": "c", "type": "KIND", "body_i": "rod", "body_j": "rocker", "point": [1, 1, 0]AXIS},
        {"name": "d", "type": "revolute", "body_i": "rocker", "body_j": "ground", "point": [1, 0, 0], "axis": [0, 0, 1]}
      ],
      "loads": [
        {"name": "push", "type": "force", "body": "fin", "point": [0.1, 0, 0.05], "force": {"kind": "fixed", "vector": [4, 1, 2]}, "frame": "body"},
        {"name": "twist", "type": "moment", "body": "plate", "moment": {"kind": "fixed", "vector": [0.2, 0.1, 0.6]}, "frame": "body"},
        {"name": "inside", "type": "spring", "body_i": "crank", "body_j": "fin", "point_i": [0, 0.1, 0], "point_j": [0.1, 0, 0], "stiffness": 50, "free_length": 0.1, "damping": 1},
        {"name": "coil", "type": "spring", "body_i": "plate", "body_j": "rocker", "point_i": [0.1, 0, 0], "point_j": [0, 0.1, 0], "stiffness": 20, "damping": 0.2}
      ]
    }"#;
    let (kind, axis) =
        if normal == "[0, 0, 1]" { ("revolute", r#", "axis": [0, 0, 1]"#) } else { ("spherical", "") };
    let text = text.replace("NORMAL", normal).replace("KIND", kind).replace("AXIS", axis);
    let mut scene = Scene::from_json(&text).unwrap();
    scene.simulation = self::scene("simple-pendulum").simulation;
    scene
}

/// In a plane, in space, and driven; with the coordinates and rows that are left.
#[test]
fn bodies_rigidly_joined_move_as_one() {
    let planar = welded("[0, 0, 1]");
    assert_eq!(compare(&planar, "fixed", 1e-8), (2, 0));
    let rows = |scene: &Scene| {
        let (_, left) = run(scene);
        left.iter().find(|l| l.word == "fixed").unwrap().what.clone()
    };
    assert!(rows(&planar).contains("2 merged with those that they are rigidly joined to, 4 rows left"));
    let spatial = welded("[0, 0.2, 1]");
    assert_eq!(compare(&spatial, "fixed", 1e-8), (2, 0));
    assert!(rows(&spatial).ends_with("18 rows left"), "{}", rows(&spatial));
    let mut driven = welded("[0, 0, 1]");
    let motion = Motion::Harmonic { mean: 0.0, amplitude: 0.8, frequency: 2.0, phase: 0.0 };
    driven.drivers.push(Driver::Angle { name: "turn".to_owned(), joint: "a".to_owned(), motion });
    assert_eq!(compare(&driven, "fixed", 1e-8), (2, 0));
}

#[test]
fn constants_checks_reports_and_outputs_change_nothing() {
    for name in ["spatial-chain:5", "n-four-bar:2", "spatial-slider-crank"] {
        for word in ["constants", "checks", "reports"] {
            let (saved, none) = compare(&scene(name), word, 1e-13);
            assert!(saved > 0 && none == 0, "{name}: {word} saved {saved}, and {none} when switched off");
        }
        let (saved, none) = compare(&scene(name), "outputs", 1e-8);
        assert!(saved >= 9 && none == 0, "{name}: {saved} and {none}");
    }
}

#[test]
fn nothing_left_out_is_the_same_motion() {
    let mut all = three_islands();
    let (with, _) = run(&all);
    all.simulation.skip = Skip::nothing();
    let (without, left) = run(&all);
    let largest = with.iter().zip(&without).fold(0.0f64, |a, (x, y)| a.max((x - y).abs()));
    assert!(largest < 1e-8, "{largest:e}");
    assert!(left.iter().all(|l| l.saved == 0), "{left:?}");
}

/// Two wheels on a carrier, geared 1 : 2, which turns freely, or is the ground; a moment of 1 N m on the second one.
fn geared(carrier: &str, wheels_first: [bool; 2], with_another: bool) -> Scene {
    let wheel = |name: &str, x: f64| json!({ "name": name, "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] }, "position": [x, 0, 0] });
    let hinge = |name: &str, wheel: &str, first: bool, x: f64| {
        let (i, j) = if first { (wheel, carrier) } else { (carrier, wheel) };
        // Swapped bodies and a turned axis measure the same angle.
        let axis = if first { -1 } else { 1 };
        json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [x, 0, 0], "axis": [0, 0, axis] })
    };
    let mut bodies = vec![wheel("a", 0.0), wheel("b", 1.0)];
    let mut joints = vec![hinge("A", "a", wheels_first[0], 0.0), hinge("B", "b", wheels_first[1], 1.0)];
    joints.push(json!({ "name": "G", "type": "gear", "joints": ["A", "B"], "ratio": 2 }));
    if carrier != "ground" {
        bodies.push(wheel(carrier, 0.5));
        joints.push(
            json!({ "name": "C", "type": "revolute", "body_i": "ground", "body_j": carrier, "point": [0, 0, 0], "axis": [0, 0, 1] }),
        );
    }
    if with_another {
        bodies.push(wheel("far", 9.0));
    }
    let scene = json!({
        "name": "geared", "gravity": [0, 0, 0], "bodies": bodies, "joints": joints,
        "loads": [{ "name": "m", "type": "moment", "body": "b", "moment": [0, 0, 1] }],
        "simulation": { "duration": 1, "integrator": "taylor", "tolerance": 1e-11 },
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

/// A gear holds whichever bodies of its hinges are named first, also where another body moves on its own, and tells what it does to a
/// wheel: α of the first wheel is 1 N m · 2 / (0.1 + 4 · 0.1) kg m², the gear takes all but 0.1 · 2 α of the moment.
#[test]
fn gears_hold_wheels_of_any_order_beside_other_islands() {
    for first in [[false, false], [false, true], [true, false], [true, true]] {
        for carrier in ["ground", "c"] {
            let (together, _) = run(&geared(carrier, first, false));
            let bodies = if carrier == "ground" { 2 } else { 3 };
            let (beside, _) = run(&geared(carrier, first, true));
            for (k, moment) in together.chunks(15 * bodies).zip(beside.chunks(15 * (bodies + 1))) {
                let largest = k.iter().zip(moment).fold(0.0f64, |a, (x, y)| a.max((x - y).abs()));
                assert!(largest < 1e-9, "{carrier}, {first:?}: {largest:e}");
            }
        }
        let mut grounded = Simulation::new(&geared("ground", first, true)).unwrap();
        grounded.advance_to(1.0).unwrap();
        let u = grounded.frame().bodies[0].u;
        let angle = 0.5 * 2.0 / 0.5;
        assert!(
            (u[0] - libm::cos(angle)).abs() < 1e-9 && (u[1] - libm::sin(angle)).abs() < 1e-9,
            "{first:?}: {u:?}"
        );
        let told = grounded.reactions(Convention::default()).unwrap();
        let gear = told.reactions.iter().find(|reaction| reaction.joint == "G").unwrap();
        assert_eq!((gear.on.as_str(), gear.by.as_str()), ("b", "a"));
        assert!((gear.moment[2].value + 0.2).abs() < 1e-9, "{first:?}: {}", gear.moment[2].value);
    }
}

/// A driver that asks a body for a motion which a fixed joint forbids is refused, also beside a body whose steps hold by themselves.
#[test]
fn an_impossible_motion_is_refused_beside_other_islands() {
    let scene = json!({
        "name": "welded", "simulation": { "duration": 1, "integrator": "taylor" },
        "bodies": [{ "name": "a", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] } },
            { "name": "b", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] }, "position": [1, 0, 0] }],
        "joints": [{ "name": "F", "type": "fixed", "body_i": "ground", "body_j": "a", "point": [0, 0, 0] },
            { "name": "A", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 0, 1] },
            { "name": "B", "type": "revolute", "body_i": "ground", "body_j": "b", "point": [1, 0, 0], "axis": [0, 0, 1] }],
        "drivers": [{ "name": "d", "type": "angle", "joint": "A",
            "motion": { "kind": "polynomial", "coefficients": [0, 0, 0, 1] } }],
    });
    let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
    let refused = run.advance_to(1.0).unwrap_err().to_string();
    assert!(refused.contains("driver \"d\" asks for"), "{refused}");
}

/// A body without symmetry that a joint holds in a point of the ground moves about that point as with rows that hold it: loads in its
/// frame, a spring and a moment act on it, and where it is is right for every point.
#[test]
fn a_body_turns_about_its_pivot_as_with_rows_for_that() {
    let text = r#"{
      "name": "rock", "gravity": [1, -9.81, 2],
      "bodies": [
        {"name": "rock", "mass": 2.5, "position": [0.3, -0.2, 0.25], "center_of_mass": [0.05, 0.02, -0.03],
         "inertia": {"tensor": [[0.4, 0.03, -0.05], [0.03, 0.3, 0.04], [-0.05, 0.04, 0.2]]}, "angular_velocity": [2, 5, -3],
         "velocity": [-0.1, -1.4, -1]}
      ],
      "joints": [{"name": "hook", "type": "spherical", "body_i": "rock", "body_j": "ground", "point": [0.1, 0.1, -0.1]}],
      "loads": [
        {"name": "push", "type": "force", "body": "rock", "point": [0.4, 0, 0.1], "force": {"kind": "fixed", "vector": [3, 1, 2]}, "frame": "body"},
        {"name": "wind", "type": "force", "body": "rock", "point": [0, 0.2, 0.1], "force": {"kind": "fixed", "vector": [0, 1, -2]}},
        {"name": "twist", "type": "moment", "body": "rock", "moment": {"kind": "fixed", "vector": [0.5, 0.3, -0.4]}, "frame": "body"},
        {"name": "coil", "type": "spring", "body_i": "ground", "body_j": "rock", "point_i": [1, 1, 0.5], "point_j": [0.5, -0.3, 0.3], "stiffness": 40, "damping": 0.7}
      ]
    }"#;
    let mut rock = Scene::from_json(text).unwrap();
    rock.simulation = scene("simple-pendulum").simulation;
    compare(&rock, "fixed", 1e-8);
    let told = |scene: &Scene| run(scene).1.into_iter().find(|left| left.word == "fixed").unwrap().what;
    assert!(told(&rock).ends_with("; 1 turned about points of the ground without rows for these"));
    rock.simulation.skip.fixed = false;
    assert!(!told(&rock).contains("points of the ground"));
    for (name, turned) in [("n-four-bar:2", 3), ("heavy-top", 1), ("spatial-chain:3", 1), ("bricard", 0)] {
        let scene = scene(name);
        compare(&scene, "fixed", 1e-8);
        assert_eq!(
            told(&scene).contains(&format!("; {turned} turned")),
            turned > 0,
            "{name}: {}",
            told(&scene)
        );
    }
}

/// What else holds a body where its pivot is has no gradient about that: such bodies keep all their rows.
#[test]
fn a_door_on_two_hinges_keeps_its_rows() {
    let hinge = |name: &str, kind: &str, height: f64| {
        let mut joint = json!({ "name": name, "type": kind, "body_i": "ground", "body_j": "door",
            "point": [0, height, 0] });
        if kind != "spherical" {
            joint["axis"] = json!([0, 1, 0]);
        }
        joint
    };
    let door = |kinds: [&str; 2]| {
        let text = json!({
            "name": "door", "gravity": [3, -9.81, 1],
            "bodies": [{ "name": "door", "mass": 20, "position": [0.4, 1, 0],
                "inertia": { "principal": [1.7, 1.1, 0.6] }, "angular_velocity": [0, 1, 0], "velocity": [0, 0, -0.4] }],
            "joints": [hinge("upper", kinds[0], 1.8), hinge("lower", kinds[1], 0.2)]
        });
        let mut door = Scene::from_json(&text.to_string()).unwrap();
        door.simulation = scene("simple-pendulum").simulation;
        door
    };
    for kinds in [["revolute", "revolute"], ["cylindrical", "revolute"], ["revolute", "spherical"]] {
        let door = door(kinds);
        compare(&door, "fixed", 1e-8);
        let (_, left) = run(&door);
        assert!(left.iter().all(|item| !item.what.contains("points of the ground")), "{kinds:?}: {left:?}");
    }
}

/// Mechanisms of hinges and slides in space, with what is attached to them.
#[test]
fn axes_ask_for_no_products_of_series() {
    let mut chain = scene("spatial-chain:4");
    for (k, joint) in chain.joints.iter_mut().enumerate().skip(1) {
        *joint = Joint::revolute(&joint.name, &joint.body_i, &joint.body_j).at(joint.point.unwrap()).about([
            0.3,
            1.0 - 0.4 * k as f64,
            0.7,
        ]);
    }
    for (scene, axes) in [(scene("bricard"), 6), (scene("spatial-slider-crank"), 2), (chain, 3)] {
        assert_eq!(compare(&scene, "axes", 1e-8), (axes, 0), "{}", scene.name);
    }
    for name in ["n-four-bar:2", "spatial-double-pendulum", "free-body"] {
        assert_eq!(saved(&run(&scene(name)).1, "axes"), 0, "{name}");
    }
}

/// Multipliers between steps are those of the rows as they are written.
#[test]
fn multipliers_of_axes_are_those_of_their_rows() {
    let lambda = |scene: &Scene| {
        let mut run = Simulation::new(scene).unwrap();
        run.advance_to(0.35).unwrap();
        let found = run.multipliers_between_steps();
        let numbers: Vec<f64> = found.iter().flat_map(|joint| &joint.rows).map(|row| row.value).collect();
        numbers
    };
    let mut scene = scene("spatial-slider-crank");
    scene.simulation.tolerance = 1e-12;
    let with = lambda(&scene);
    scene.simulation.skip.axes = false;
    let without = lambda(&scene);
    let largest = without.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    assert!(largest > 1.0, "{largest}");
    for (a, b) in with.iter().zip(&without) {
        assert!((a - b).abs() < 1e-8 * largest, "{a} {b}");
    }
}
