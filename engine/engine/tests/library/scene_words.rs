//! What an author may write shorter, and points with names.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::prelude::*;
use triad_engine::run::MarkerFrame;
use triad_engine::scene::{ConstraintMethod, Scene};

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string()).unwrap()
}

/// A tumbling body whose frame is neither in its centre of mass nor along its principal axes.
fn tumbling(coordinates: &str) -> Scene {
    scene(&json!({
        "name": "tumbling", "coordinates": coordinates, "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "body", "mass": 2, "center_of_mass": [0.1, -0.2, 0.3], "position": [1, 2, 3],
            "inertia": { "tensor": [[1, 0.1, 0], [0.1, 2, -0.2], [0, -0.2, 2.5]] },
            "orientation": { "axis": [1, 1, 0], "angle": 0.7 },
            "velocity": [0.5, 0, 0], "angular_velocity": [1, -2, 3] }],
        "markers": [{ "name": "corner", "body": "body", "point": [0.4, 0.5, -0.6] }, { "name": "frame", "body": "body" },
            { "name": "post", "body": "ground", "point": [1, 0, 0] }],
        "events": [{ "name": "low", "of": { "type": "marker", "marker": "corner", "direction": [0, 1, 0] }, "value": 1.5 },
            { "name": "same", "of": { "type": "coordinate", "body": "body", "point": [0.4, 0.5, -0.6], "direction": [0, 1, 0] }, "value": 1.5 }],
        "simulation": { "tolerance": 1e-12 }
    }))
}

#[test]
fn a_marker_moves_as_the_point_of_its_body() {
    for coordinates in ["full", "reduced"] {
        let scene = tumbling(coordinates);
        let motion = scene.simulate(0.0..1.0).unwrap();
        let start = motion.at(0.0).unwrap();
        let frame = start.marker("frame").unwrap();
        assert!((0..3).all(|k| (frame.position[k] - [1.0, 2.0, 3.0][k]).abs() < 1e-14));
        assert!((0..3).all(|k| (frame.velocity[k] - [0.5, 0.0, 0.0][k]).abs() < 1e-14));
        assert_eq!(
            start.marker("post").unwrap(),
            MarkerFrame { position: [1.0, 0.0, 0.0], velocity: [0.0; 3] }
        );
        // Where it is, and the differences of that, at some moment.
        let (t, h) = (0.6, 1e-4);
        let at = |t: f64| motion.at(t).unwrap();
        let [before, here, after] = [t - h, t, t + h].map(|t| at(t).marker("corner").unwrap());
        assert_eq!(here.position, at(t).point("body", [0.4, 0.5, -0.6]).unwrap());
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(t).unwrap();
        let acceleration = run.marker_accelerations();
        assert_eq!(acceleration[2], [0.0; 3], "the ground's");
        for k in 0..3 {
            let rate = (after.position[k] - before.position[k]) / (2.0 * h);
            assert!((rate - here.velocity[k]).abs() < 1e-5, "{coordinates}: {rate} and {}", here.velocity[k]);
            let rate = (after.velocity[k] - before.velocity[k]) / (2.0 * h);
            assert!(
                (rate - acceleration[0][k]).abs() < 1e-4,
                "{coordinates}: {rate} and {}",
                acceleration[0][k]
            );
        }
        assert_eq!(motion.times_of("low").unwrap(), motion.times_of("same").unwrap());
        assert_eq!(motion.times_of("low").unwrap().len(), 1);
        let error = at(t).marker("corer").unwrap_err();
        assert_eq!(
            (&*error.to_string(), &*error.hint()),
            ("there is no marker \"corer\"", "Did you mean \"corner\"?")
        );
    }
}

#[test]
fn a_marker_of_no_body_and_an_event_of_no_marker_are_refused() {
    let mut wrong = tumbling("full");
    wrong.markers[0].body = "bodi".to_owned();
    let error = Simulation::new(&wrong).unwrap_err();
    assert_eq!(error.pointer().as_deref(), Some("/markers/0/body"));
    let mut wrong = tumbling("full");
    wrong.markers[0].name = "corne".to_owned();
    let error = Simulation::new(&wrong).unwrap_err();
    assert_eq!(error.hint(), "Did you mean \"corne\"?", "{error}");
    assert_eq!((error.code(), error.pointer().as_deref()), ("unknown-marker", Some("/events/0/of/marker")));
}

/// A plain number is a constant motion, three plain numbers a constant vector.
#[test]
fn plain_numbers_and_vectors_are_constants() {
    let written = |moment: Value, torque: Value, motion: Value| {
        scene(&json!({
            "name": "plain", "bodies": [{ "name": "b", "mass": 1, "inertia": { "principal": [1, 1, 1] } }],
            "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "b", "point": [0, 0, 0], "axis": [0, 0, 1] }],
            "loads": [{ "name": "m", "type": "moment", "body": "b", "moment": moment },
                { "name": "t", "type": "torsion", "joint": "pin", "torque": torque }],
            "drivers": [{ "name": "d", "type": "angle", "joint": "pin", "motion": motion }]
        }))
    };
    let fixed = json!({ "kind": "fixed", "vector": [0, 0, 0.033] });
    let constant = |value: f64| json!({ "kind": "constant", "value": value });
    assert_eq!(
        written(json!([0, 0, 0.033]), json!(-2), json!(0.5)),
        written(fixed.clone(), constant(-2.0), constant(0.5))
    );
    // Both are written as they always were.
    let text = written(json!([0, 0, 0.033]), json!(-2), json!(0.5)).to_json();
    assert!(text.contains("\"kind\": \"fixed\"") && text.contains("\"kind\": \"constant\""), "{text}");
}

#[test]
fn what_is_no_motion_is_told_with_what_is_wanted() {
    let refused = |moment: &str| {
        let text = format!(
            r#"{{"name": "x", "bodies": [{{"name": "b", "mass": 1}}], "loads": [{{"name": "m", "type": "moment", "body": "b", "moment": {moment}}}]}}"#
        );
        Scene::from_json(&text).unwrap_err().to_string()
    };
    assert!(
        refused("\"up\"").contains("expected three numbers, or a motion of a vector"),
        "{}",
        refused("\"up\"")
    );
    assert!(
        refused("[0, 1]").contains("invalid length 2, expected an array of length 3"),
        "{}",
        refused("[0, 1]")
    );
    let wrong = refused(r#"{"kind": "components", "x": "fast", "y": 0, "z": 0}"#);
    assert!(wrong.contains("expected a number, or a motion"), "{wrong}");
    let unknown = refused(r#"{"kind": "components", "x": {"kind": "ramp", "speed": 1}, "y": 0, "z": 0}"#);
    assert!(unknown.contains("speed") && unknown.contains("loads[0]"), "{unknown}");
}

/// The normal of a plane, and the direction of a line, belong to body i alone.
#[test]
fn an_axis_of_body_i_is_enough_for_a_line_or_a_plane() {
    for kind in ["point-in-plane", "point-on-line"] {
        let with = |axis_j: Option<[f64; 3]>| {
            let mut scene = scene(&json!({
                "name": "slide", "gravity": [1, -9.81, 2],
                "bodies": [{ "name": "b", "mass": 1, "inertia": { "principal": [1, 2, 2] }, "angular_velocity": [1, 2, 3] }],
                "joints": [{ "name": "j", "type": kind, "body_i": "ground", "body_j": "b",
                    "point_i": [0, 0, 0], "point_j": [0, 0, 0], "axis_i": [0, 1, 0] }]
            }));
            scene.joints[0].axis_j = axis_j;
            let motion = scene.simulate(0.0..1.0).unwrap();
            motion.at(1.0).unwrap().position("b").unwrap()
        };
        assert_eq!(with(None), with(Some([0.0, 1.0, 0.0])), "{kind}");
    }
}

/// A double pendulum of rods, its elbow turned.
#[allow(clippy::needless_pass_by_value, reason = "written in place")]
fn double_pendulum(start: Value, hand: bool) -> Scene {
    let (angle, bend) = (0.7f64, -1.2f64);
    let elbow = [libm::cos(angle), libm::sin(angle), 0.0];
    let second = angle + bend;
    let body = |name: &str, from: [f64; 3], turned: f64| {
        json!({ "name": name, "mass": 1, "inertia": { "principal": [0.01, 0.1, 0.1] }, "center_of_mass": [0.5, 0, 0],
            "position": from, "orientation": { "axis": [0, 0, 1], "angle": turned } })
    };
    let mut bodies = vec![body("upper", [0.0; 3], 0.0), body("lower", [1.0, 0.0, 0.0], 0.0)];
    if hand {
        bodies = vec![body("upper", [0.0; 3], angle), body("lower", elbow, second)];
        bodies[0]["angular_velocity"] = json!([0, 0, 2]);
        bodies[1]["angular_velocity"] = json!([0, 0, 5]);
        bodies[1]["velocity"] = json!([-2.0 * elbow[1], 2.0 * elbow[0], 0.0]);
    }
    let mut scene = json!({
        "name": "double", "gravity": [0, -9.81, 0], "bodies": bodies,
        "joints": [
            { "name": "shoulder", "type": "revolute", "body_i": "ground", "body_j": "upper", "point_i": [0, 0, 0],
                "point_j": [0, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 0, 1] },
            { "name": "elbow", "type": "revolute", "body_i": "lower", "body_j": "upper", "point_i": [0, 0, 0],
                "point_j": [1, 0, 0], "axis_i": [0, 0, -1], "axis_j": [0, 0, -1] }]
    });
    if !start.is_null() {
        scene["joints"][0]["start"] = start[0].clone();
        scene["joints"][1]["start"] = start[1].clone();
    }
    self::scene(&scene)
}

#[test]
fn joints_place_the_bodies_that_hang_on_them() {
    let by_hand = double_pendulum(Value::Null, true).simulate(0.0..1.0).unwrap();
    // The elbow's axis is −z and its body i the lower rod: both signs turn about.
    let start = json!([{ "angle": 0.7, "rate": 2.0 }, { "angle": -1.2, "rate": 3.0 }]);
    let by_joints = double_pendulum(start, false).simulate(0.0..1.0).unwrap();
    for t in [0.0, 0.5, 1.0] {
        for body in ["upper", "lower"] {
            let [a, b] = [&by_hand, &by_joints].map(|motion| motion.at(t).unwrap().position(body).unwrap());
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-7), "{body} at {t} s: {a:?} and {b:?}");
            let [a, b] = [&by_hand, &by_joints].map(|motion| motion.at(t).unwrap().velocity(body).unwrap());
            assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-6), "{body} at {t} s: {a:?} and {b:?}");
        }
    }
}

/// A loop is closed with the given angle held, and its rate too.
#[test]
fn a_loop_closes_with_the_given_angle_held() {
    let mut scene = catalogue::scene("crank-rocker").unwrap();
    scene.drivers.clear();
    scene.joints[0] = scene.joints[0].clone().starting_at(1.0, 5.0);
    let motion = scene.simulate(0.0..0.1).unwrap();
    let start = motion.at(0.0).unwrap();
    // The crank is stated at 0.4 rad.
    let crank = start.marker("A").unwrap();
    assert!(
        (crank.position[0] - libm::cos(1.4)).abs() < 1e-12
            && (crank.velocity[1] - 5.0 * libm::cos(1.4)).abs() < 1e-9
    );
    let rocker = start.marker("B").unwrap();
    let length = libm::hypot(rocker.position[0] - crank.position[0], rocker.position[1] - crank.position[1]);
    assert!((length - 3.4).abs() < 1e-9, "the coupler is {length} m long");
    let notes = Simulation::new(&scene).unwrap().notes().join("\n");
    assert!(!notes.contains("leave") && !notes.contains("keeps"), "{notes}");
}

/// What is asked for and cannot be had is told with both numbers.
#[test]
fn lost_velocities_and_rates_are_told() {
    // Spinning the shaft alone leaves nothing: it weighs little.
    let mut scene = catalogue::scene("governor").unwrap();
    scene.joints[0].start = None;
    scene.bodies[0].angular_velocity = [0.0, 0.0, 6.3];
    let notes = Simulation::new(&scene).unwrap().notes().join("\n");
    assert!(
        notes.contains("body \"shaft\": of the angular velocity (0.0000e0, 0.0000e0, 6.3000e0) rad/s"),
        "{notes}"
    );
    // Two rates of a mechanism with one freedom contradict each other.
    let mut scene = catalogue::scene("crank-rocker").unwrap();
    scene.drivers.clear();
    scene.joints[3] = scene.joints[3].clone().starting_at(0.0, 5.0);
    let notes = Simulation::new(&scene).unwrap().notes().join("\n");
    assert!(
        notes
            .contains("joint \"D\": 5 rad/s are given for the start, but all that is given together leaves "),
        "{notes}"
    );
    // A joint without an axis has no angle.
    let mut scene = catalogue::scene("spatial-chain:2").unwrap();
    scene.joints[0] = scene.joints[0].clone().starting_at(0.1, 0.0);
    let error = Simulation::new(&scene).unwrap_err();
    assert_eq!(error.pointer().as_deref(), Some("/joints/0/start"));
}

/// An integrator that the scene's other settings rule out is replaced, and the run says so.
#[test]
fn an_integrator_that_cannot_run_is_replaced_in_words() {
    let told = |integrator: IntegratorKind, method: ConstraintMethod, step: Option<f64>| {
        let mut scene = catalogue::scene("simple-pendulum").unwrap();
        let settings = &mut scene.simulation;
        (settings.integrator, settings.constraint_method, settings.step) = (integrator, method, step);
        let notes = Simulation::new(&scene).unwrap().notes().to_vec();
        notes.into_iter().find(|note| note.starts_with("runs by"))
    };
    let penalty = ConstraintMethod::Penalty { alpha: 1e7, omega: 10.0, mu: 1.0 };
    let replaced = told(IntegratorKind::Taylor, penalty, None).unwrap();
    assert_eq!(replaced, "runs by dop853: taylor was asked for, but penalty belongs to Runge-Kutta methods");
    assert!(told(IntegratorKind::Radau, penalty, None).is_some());
    assert!(told(IntegratorKind::Taylor, ConstraintMethod::Projection, Some(0.01)).is_some());
    assert_eq!(told(IntegratorKind::Dopri5, penalty, None), None);
    assert_eq!(told(IntegratorKind::Auto, penalty, None), None);
    assert_eq!(told(IntegratorKind::Taylor, ConstraintMethod::Projection, None), None);
}

/// An angle of more than a turn at the start counts its turns.
#[test]
fn a_start_of_several_turns_is_counted() {
    let mut scene = Scene::new("turns").gravity([0.0; 3]);
    let wheel = scene.add(Body::new("wheel", 1.0).inertia(Inertia::Principal([1.0; 3])));
    let axle =
        Joint::revolute("axle", Ground, &wheel).at([0.0; 3]).about([0.0, 0.0, 1.0]).starting_at(20.0, 1.0);
    let axle = scene.add(axle);
    let past = scene.add(Event::new("past", Quantity::angle(&axle), 20.5));
    let times = scene.simulate(0.0..1.0).unwrap().times_of(&past).unwrap();
    assert!(times.len() == 1 && (times[0] - 0.5).abs() < 1e-12, "{times:?}");
}

/// Two balls and a tilted block on a rod, against the same as bodies of their own.
#[test]
fn attached_masses_are_part_of_their_body() {
    let rod = || Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]).angular_velocity([0.3, 1.0, -2.0]);
    let places = [[0.5, 0.0, 0.0], [0.1, 0.4, -0.2], [-0.3, 0.0, 0.6]];
    let inertia = Inertia::Tensor([[0.2, 0.01, 0.0], [0.01, 0.1, 0.02], [0.0, 0.02, 0.15]]);
    let hinge = |scene: &mut Scene| {
        scene.add(Joint::spherical("hinge", Ground, "rod").at([0.0; 3]));
        scene.add(Marker::new("tip", "rod", [0.5, 0.0, 0.0]));
    };
    let mut whole = Scene::new("whole");
    whole.add(rod().attach(2.0, places[0], None).attach(3.0, places[1], None).attach(
        4.0,
        places[2],
        Some(inertia.clone()),
    ));
    hinge(&mut whole);
    let mut parts = Scene::new("parts");
    parts.add(rod());
    for (k, place) in places.into_iter().enumerate() {
        let at = [place[0] + 0.5, place[1], place[2]];
        let mut ball = Body::new(format!("part {k}"), 2.0 + k as f64).position(at);
        ball.inertia = (k == 2).then(|| inertia.clone());
        let ball = scene_with_spin(&mut parts, ball);
        parts.add(Joint::fixed(format!("weld {k}"), "rod", &ball).at(at));
    }
    hinge(&mut parts);
    let [a, b] = [whole, parts].map(|scene| scene.simulate(0.0..1.0).unwrap());
    for t in [0.3, 1.0] {
        let [a, b] = [&a, &b].map(|motion| motion.at(t).unwrap().marker("tip").unwrap().position);
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-7), "at {t} s: {a:?} and {b:?}");
    }
    let error = Simulation::new(&{
        let mut scene = Scene::new("wrong");
        scene.add(rod().attach(0.0, [0.0; 3], None));
        scene
    });
    assert_eq!(error.unwrap_err().pointer().as_deref(), Some("/bodies/0/attached/0/mass"));
}

/// A part that turns with the rod.
fn scene_with_spin(scene: &mut Scene, mut part: Body) -> triad_engine::scene::BodyHandle {
    let (omega, arm) = ([0.3, 1.0, -2.0], [part.position[0] - 0.5, part.position[1], part.position[2]]);
    part.velocity = [
        omega[1] * arm[2] - omega[2] * arm[1],
        omega[2] * arm[0] - omega[0] * arm[2],
        omega[0] * arm[1] - omega[1] * arm[0],
    ];
    part.angular_velocity = omega;
    scene.add(part)
}

/// Formulas move what a harmonic motion moves, and end where they are not defined.
#[test]
fn a_formula_of_t_is_a_motion() {
    let driven = |motion: Motion| {
        let mut scene = Scene::new("driven");
        let wheel = scene.add(Body::new("wheel", 1.0).inertia(Inertia::Principal([1.0, 2.0, 3.0])));
        let axle = scene.add(Joint::revolute("axle", Ground, &wheel).at([0.0; 3]).about([0.0, 0.0, 1.0]));
        scene.add(Driver::angle("motor", axle, motion));
        scene
    };
    let torque = |motion: Motion| {
        driven(motion).simulate(0.0..2.0).unwrap().driver_reaction("motor", 1.3).unwrap().moment[2]
    };
    let (formula, harmonic) = (torque(Motion::expression("0.2*sin(7*t)")), torque(Motion::sine(0.2, 7.0)));
    assert!((formula - harmonic).abs() < 1e-9, "{formula} and {harmonic}");
    for (text, told) in [
        ("asin(2*t)", "t = 0.500000000 s"),
        ("1/(t-0.3333)", "t = 0.333300000 s"),
        ("2*x", "known are t"),
        ("abs(t-1)", "abs of something that depends on t"),
        ("2*(t", "a bracket is not closed"),
    ] {
        let error = Simulation::new(&driven(Motion::expression(text))).unwrap_err();
        assert!(error.to_string().contains(told), "{text}: {error}");
        assert_eq!(error.pointer().as_deref(), Some("/drivers/0/motion"));
    }
}

/// The example of docs/SCENES.md is a scene that runs, and both of its events happen.
#[test]
fn the_example_of_the_guide_runs() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/SCENES.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let example = guide.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let scene = Scene::from_json(example).unwrap();
    let motion = scene.simulate(0.0..scene.simulation.duration).unwrap();
    assert!(!motion.times_of("lowest").unwrap().is_empty());
    assert!((motion.at(0.0).unwrap().marker("bob").unwrap().position[0] - libm::cos(1.2)).abs() < 1e-12);
    // Each kind of joint and of motion has its row in a table.
    for kind in JointKind::ALL {
        assert!(guide.contains(&format!("| `{kind}` |")), "{kind}");
    }
    for kind in ["ramp", "polynomial", "harmonic", "smooth-step", "table", "expression"] {
        assert!(guide.contains(&format!("| `{kind}` |")), "{kind}");
    }
}
