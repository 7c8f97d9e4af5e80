//! Each variant of the engine's errors is met by a case here, and its sentence, code, place and remedy are those that were
//! read: `tests/data/reviewed/refusals-*.snap`. The errors of lessons have theirs in `lessons/src/tests/refusals.rs`.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::EngineError;
use triad_engine::analysis::{
    AnalysisError, ModesAbout, Wanted, assemble, check, equilibrium, equilibrium_while, kinematics, modes,
};
use triad_engine::catalogue::{self, CatalogueError};
use triad_engine::constraints::ConstraintError;
use triad_engine::model::{CustomLoadError, ModelError};
use triad_engine::prelude::{CustomLoad, Wrench};
use triad_engine::reactions::report::Convention;
use triad_engine::reactions::uniqueness::UniquenessError;
use triad_engine::run::Simulation;
use triad_engine::scene::{Scene, SceneError};
use triad_engine::solution::Simulate;
use triad_tests::refusals::{Refusals, all_reviewed};
use triad_tests::variants;
use triad_urdf::{SideCar, UrdfError};

/// A pendulum that is pushed along x: everything that a scene may have, right.
fn good() -> Value {
    json!({
        "name": "good",
        "bodies": [{ "name": "bob", "mass": 1, "inertia": { "principal": [0.1, 1, 1] }, "position": [1, 0, 0] }],
        "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "bob",
            "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "loads": [{ "name": "push", "type": "force", "body": "bob", "force": { "kind": "fixed", "vector": [1, 0, 0] } }],
        "parameters": [{ "name": "mass", "label": "Mass", "pointer": "/bodies/0/mass", "low": 0.5, "high": 2 }],
        "simulation": { "duration": 1 }
    })
}

/// Two rotors that moments set in motion against each other, in steps that are too long to tell how often.
fn spun() -> Value {
    let body = |name: &str| json!({ "name": name, "mass": 1, "inertia": { "principal": [1, 1, 1] } });
    let joint = |name: &str, i: &str, j: &str| json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [0, 0, 0], "axis": [0, 0, 1] });
    let load = |name: &str, body: &str, moment: f64| json!({ "name": name, "type": "moment", "body": body, "moment": [0, 0, moment] });
    json!({
        "name": "spun", "gravity": [0, 0, 0],
        "bodies": [body("b"), body("c")],
        "joints": [joint("j", "ground", "b"), joint("k", "b", "c")],
        "loads": [load("one way", "c", 13.6), load("and the other", "b", -13.6)],
        "events": [{ "name": "turn", "of": { "type": "angle", "joint": "k" }, "value": 6.3 }],
        "simulation": { "duration": 1, "integrator": "dop853", "step": 0.5 }
    })
}

/// The good scene with another value at a place, which may be new.
fn with(place: &str, value: Value) -> Value {
    let mut scene = good();
    let (parent, key) = place.rsplit_once('/').unwrap();
    let parent = scene.pointer_mut(parent).unwrap();
    match key.parse::<usize>() {
        Ok(index) => parent[index] = value,
        Err(_) => parent[key] = value,
    }
    scene
}

fn scene(value: &Value) -> Scene {
    Scene::from_json(&value.to_string()).unwrap()
}

fn check_error(scene: &Scene) -> EngineError {
    check::check(scene).expect_err("the scene is refused")
}

/// A parallelogram whose links all lie on one line, at rest: two motions can begin there.
fn flat(integrator: &str) -> Value {
    let bar = |name: &str, x: f64| json!({ "name": name, "mass": 1, "inertia": { "principal": [0.1, 1, 1] }, "position": [x, 0, 0] });
    let pin = |name: &str, i: &str, j: &str, x: f64| json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [x, 0, 0], "axis": [0, 0, 1] });
    json!({
        "name": "flat",
        "bodies": [bar("crank", 0.5), bar("coupler", 2.0), bar("rocker", 2.5)],
        "joints": [pin("A", "ground", "crank", 0.0), pin("B", "crank", "coupler", 1.0),
            pin("C", "coupler", "rocker", 3.0), pin("D", "rocker", "ground", 2.0)],
        "simulation": { "duration": 1, "integrator": integrator, "step": 0.01 }
    })
}

fn at_rest(mut scene: Scene) -> Scene {
    for body in &mut scene.bodies {
        (body.velocity, body.angular_velocity) = Default::default();
    }
    scene
}

/// The error with which a scene's run ends, or does not begin.
fn run_error(scene: &Scene) -> EngineError {
    let mut run = match Simulation::new(scene) {
        Ok(run) => run,
        Err(error) => return error,
    };
    run.set_step_limit(5_000);
    run.advance_to(run.duration()).expect_err("the run stops")
}

#[test]
fn texts_that_are_no_scene() {
    let mut met = Refusals::new(
        variants!(SceneError: TooLong, Syntax, TooMany, NoNumber, UnknownParameter, OutsideParameter),
    );
    let mut meet = |tried: &str, error: SceneError| {
        let told = EngineError::from(error.clone());
        met.meet(tried, &error, told.code(), told.pointer().as_deref(), &told.hint());
    };
    meet("a text of 20 MB", Scene::from_json(&" ".repeat(20_000_000)).unwrap_err());
    for (tried, text) in [
        ("no JSON", "{\"name\": \"a\",}".to_owned()),
        ("an unknown key", with("/bodies/0/colour", json!("red")).to_string()),
        ("a word where a number belongs", with("/bodies/0/mass", json!("heavy")).to_string()),
        ("a kind of joint that does not exist", with("/joints/0/type", json!("hinge")).to_string()),
        ("no list", with("/bodies", json!("bob")).to_string()),
        ("a number in place of a joint", with("/joints/0", json!(1)).to_string()),
        ("four components", with("/gravity", json!([0, 1, 2, 3])).to_string()),
        ("a list in place of a scene", "[1, 2]".to_owned()),
        ("a number in place of a word", with("/joints/0/type", json!(1)).to_string()),
        ("two components", with("/gravity", json!([0, 1])).to_string()),
        ("no name", good().to_string().replacen("\"name\":\"good\",", "", 1)),
    ] {
        meet(tried, Scene::from_json(&text).unwrap_err());
    }
    let many: Vec<Value> = (0..6000).map(|k| json!({"name": format!("b{k}"), "mass": 1})).collect();
    meet("6000 bodies", Scene::from_json(&with("/bodies", json!(many)).to_string()).unwrap_err());
    let scene = scene(&good());
    let one = json!(1.0);
    for place in ["/bodies/0/mas", "/bodies/7/mass", "/bodies/0", "/bodies/0/position", "/name"] {
        meet(&format!("a number at {place}"), scene.changed([], [(place, &one)]).unwrap_err());
    }
    meet("a parameter that is not there", scene.changed([("wind", 1.0)], []).unwrap_err());
    meet("a parameter beyond its range", scene.changed([("mass", 9.0)], []).unwrap_err());

    let mut names = Refusals::new(variants!(CatalogueError: Unknown, Number));
    for name in ["simple-pendulm", "something else", "n-four-bar:0", "spatial-chain"] {
        let error = catalogue::scene(name).unwrap_err();
        names.meet(name, &error, error.code(), None, &error.hint());
    }
    all_reviewed("refusals-scene", [met.text(), names.text()]);
}

/// Places of a good scene, and what cannot stand there.
fn what_cannot_be() -> Vec<(&'static str, Value)> {
    vec![
        ("/bodies", json!([])),
        ("/bodies/0/name", json!("ground")),
        ("/bodies/0/name", json!("")),
        ("/joints/0/body_j", json!("bobb")),
        ("/joints/0/body_j", json!("something else")),
        ("/joints/0/body_j", json!("ground")),
        ("/simulation/tolerance", json!(0)),
        ("/bodies/0/mass", json!(-2)),
        ("/bodies/0/attached", json!([{"mass": 0, "point": [0, 1, 0]}])),
        ("/bodies/0/attached", json!([{"mass": 1, "point": [0, 1, 0], "inertia": {"principal": [1, 1, 5]}}])),
        (
            "/bodies/0/attached",
            json!([{"mass": 1, "point": [0, 1, 0], "inertia": {"tensor": [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]}}]),
        ),
        ("/bodies/0/inertia", json!({"principal": [1, 1, 5]})),
        ("/bodies/0/inertia", json!({"tensor": [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]})),
        ("/bodies/0/orientation", json!({"u": [1, 0, 0]})),
        ("/bodies/0/orientation", json!({"quaternion": [0, 0, 0, 0]})),
        ("/joints/0/axis", json!([0, 0, 0])),
        ("/joints/0/axis", Value::Null),
        ("/joints/0/pitch", json!(0.1)),
        (
            "/joints/0",
            json!({"name": "s", "type": "screw", "body_i": "ground", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 0, 1], "pitch": 0}),
        ),
        (
            "/joints/0",
            json!({"name": "r", "type": "rod", "body_i": "ground", "body_j": "bob", "points": [[1, 0, 0], [1, 0, 0]]}),
        ),
        ("/gravity", json!([0, -1e200, 0])),
        (
            "/drivers",
            json!([{"name": "m", "type": "angle", "joint": "nothing", "motion": {"kind": "constant", "value": 0}}]),
        ),
        ("/loads/0", json!({"name": "rub", "type": "torsion", "joint": "pim", "damping": 1})),
        ("/loads/0", json!({"name": "slip", "type": "slider", "joint": "pin", "damping": 1})),
        ("/markers", json!([{"name": "tip", "body": "bobb"}])),
        (
            "/events",
            json!([{"name": "low", "of": {"type": "marker", "marker": "tip", "direction": [0, 1, 0]}, "value": 0}]),
        ),
        ("/simulation/outputs", json!(["reactions:pim"])),
        ("/simulation/outputs", json!(["energy:pin"])),
        ("/parameters/0/low", json!(1.5)),
        ("/parameters/0/pointer", json!("/bodies/0/weight")),
    ]
}

#[test]
fn scenes_that_cannot_be() {
    let mut met = Refusals::new(variants!(
        ModelError: NoBodies, DuplicateName, ReservedName, UnknownName, SameBody, NotFinite, OutOfRange, Mass, Inertia,
        Asymmetric, Orientation, Geometry, Parameter
    ));
    let mut meet = |tried: &str, scene: &Scene| {
        let EngineError::Model(error) = check_error(scene) else {
            panic!("{tried}: not an error of the model")
        };
        met.meet(tried, &error, error.code(), Some(&error.pointer()), &error.hint());
    };
    let body = good()["bodies"][0].clone();
    for (place, value) in what_cannot_be() {
        meet(&format!("{place} is {value}"), &scene(&with(place, value.clone())));
    }
    meet("two bodies of one name", &scene(&with("/bodies", json!([body, body]))));
    let mut never = scene(&good());
    never.bodies[0].velocity[1] = f64::NAN;
    meet("a velocity that is not a number", &never);
    all_reviewed("refusals-model", [met.text()]);
}

/// A scene of `tests/data/problems`.
fn problem(name: &str) -> Value {
    let path = triad_tests::root().join(format!("tests/data/problems/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A slider-crank whose block is pushed farther than rod and crank reach.
fn pushed(integrator: &str, stabilization: Value) -> Scene {
    let mut scene: Value =
        serde_json::from_str(&catalogue::scene("spatial-slider-crank").unwrap().to_json()).unwrap();
    scene["drivers"] = json!([{"type": "slide", "name": "push", "joint": "D",
        "motion": {"kind": "ramp", "start": 0.2, "rate": 1.0}}]);
    scene["simulation"]["integrator"] = json!(integrator);
    scene["simulation"]["stabilization"] = stabilization;
    self::scene(&scene)
}

/// A bar with a pin at each end: what they ask for cannot be had together.
fn contradiction() -> Scene {
    let mut scene = with(
        "/joints/0",
        json!({"name": "left", "type": "spherical", "body_i": "ground", "body_j": "bob",
        "point_i": [0, 0, 0], "point_j": [-1, 0, 0]}),
    );
    scene["joints"]
        .as_array_mut()
        .unwrap()
        .push(json!({"name": "right", "type": "spherical", "body_i": "bob",
        "body_j": "ground", "point_i": [1, 0, 0], "point_j": [2.2, 0, 0]}));
    self::scene(&scene)
}

#[test]
fn constraints_that_cannot_be_satisfied() {
    let mut met = Refusals::new(variants!(
        ConstraintError: Assembly, StartTooFar, MotionImpossible, MassesTooDifferent, Lost, NothingHolds, AngleLost, NotFinite
    ));
    let mut meet = |tried: &str, scene: &Scene| {
        let told = run_error(scene);
        let EngineError::Constraint { error, .. } = &told else { panic!("{tried}: {told}") };
        met.meet(tried, error, told.code(), told.pointer().as_deref(), &told.hint());
    };
    meet("a bar between two points that are too far apart", &contradiction());
    meet("a pin that is open by 9 m", &{
        let mut open = with("/joints/0/point", Value::Null);
        open["joints"][0]["point_i"] = json!([9, 0, 0]);
        open["joints"][0]["point_j"] = json!([-1, 0, 0]);
        open["joints"][0]["axis_i"] = json!([0, 0, 1]);
        open["joints"][0]["axis_j"] = json!([0, 0, 1]);
        open["joints"][0]["axis"] = Value::Null;
        scene(&open)
    });
    let turned = |rate: f64, name: &str| json!({"name": name, "type": "angle", "joint": "pin", "motion": {"kind": "ramp", "start": 0, "rate": rate}});
    meet(
        "two drivers of one angle",
        &scene(&with("/drivers", json!([turned(1.0, "slow"), turned(2.0, "fast")]))),
    );
    meet(
        "a driver that pushes past the reach, with penalties",
        &pushed("dop853", json!({"kind": "penalty"})),
    );
    let light = json!({"name": "light", "mass": 1e-9, "inertia": {"principal": [1e-10, 1e-10, 1e-10]}, "position": [0.5, 0, 0]});
    let heavy = json!({"name": "heavy", "mass": 1e9, "inertia": {"principal": [1e8, 1e8, 1e8]}, "position": [1.5, 0, 0]});
    let mut masses = with("/bodies", json!([light, heavy]));
    masses["joints"] = json!([
        {"name": "near", "type": "spherical", "body_i": "ground", "body_j": "light", "point": [0, 0, 0]},
        {"name": "far", "type": "spherical", "body_i": "light", "body_j": "heavy", "point": [1, 0, 0]}]);
    (masses["loads"], masses["parameters"]) = (json!([]), json!([]));
    meet("a heavy body on a light one", &scene(&masses));
    let mut turned = with("/bodies", json!([{"name": "point", "mass": 1, "position": [1, 0, 0]}]));
    (turned["joints"], turned["parameters"]) = (json!([]), json!([]));
    turned["loads"] = json!([{"name": "twist", "type": "moment", "body": "point", "moment": [0, 0, 2]}]);
    meet("a moment on a point mass", &scene(&turned));
    let held = json!([{"name": "hold", "type": "angle-to-world", "body": "bob", "vector": [0, 1, 0], "reference": [0, 1, 0],
        "motion": {"kind": "ramp", "start": -0.5, "rate": 1}}]);
    let mut through = with("/drivers", held);
    through["bodies"][0]["orientation"] = json!({"axis": [0, 0, 1], "angle": -0.5});
    through["bodies"][0]["position"] = json!([0, 0, 0]);
    meet("an angle that its cosine leads through zero", &scene(&through));
    // A run tells it as `EngineError::Diverged`.
    let error = ConstraintError::NotFinite { time: 1.0 };
    met.meet("a state that is not finite", &error, error.code(), error.pointer(), error.hint());
    all_reviewed("refusals-constraint", [met.text()]);
}

#[test]
#[allow(clippy::too_many_lines, reason = "a list")]
fn runs_that_cannot_go_on() {
    let mut met = Refusals::new(variants!(
        EngineError: Scene, Catalogue, Model, Uniqueness, Constraint, CustomLoad, StepTooSmall, Diverged, TurnsUnknown,
        NoConvergence, Stalled, Undetermined, Integrator, StepLimit, TimeOutside, UnknownName
    ));
    let mut meet = |tried: &str, error: &EngineError| {
        met.meet(tried, error, error.code(), error.pointer().as_deref(), &error.hint());
    };
    meet("no JSON", &Scene::from_json("").unwrap_err().into());
    meet("no built-in scene", &catalogue::scene("pendulum").unwrap_err().into());
    meet("a scene without bodies", &check_error(&scene(&with("/bodies", json!([])))));
    meet("a driver that pushes past the reach", &run_error(&pushed("taylor", json!({"kind": "projection"}))));
    meet("the same with another integrator", &run_error(&pushed("dopri5", json!({"kind": "projection"}))));
    meet("the same with penalties", &run_error(&pushed("dop853", json!({"kind": "penalty"}))));
    meet("the same in independent coordinates", &run_error(&pushed("radau", json!({"kind": "projection"}))));
    meet(
        "flat links at rest, in independent coordinates at a fixed step",
        &run_error(&scene(&flat("radau"))),
    );
    meet(
        "the trapezoidal rule alone",
        &run_error(&scene(&with("/simulation/integrator", json!("trapezoidal")))),
    );
    let pushed_down = |force: f64, integrator: &str| {
        let mut scene = with("/loads/0/force/vector", json!([0, force, 0]));
        scene["simulation"]["integrator"] = json!(integrator);
        run_error(&self::scene(&scene))
    };
    meet("a force of 1e200 N", &pushed_down(-1e200, "dop853"));
    meet("a force of 1e308 N", &pushed_down(-1e308, "taylor"));
    let mut window = catalogue::scene("n-four-bar:1").unwrap();
    window.simulation.integrator = "rattle".parse().unwrap();
    window.simulation.step = Some(0.01);
    meet("a singular position by implicit steps", &run_error(&window));
    meet("a step that hides turns of a joint", &run_error(&scene(&spun())));
    let mut short = Simulation::new(&catalogue::scene("simple-pendulum").unwrap()).unwrap();
    short.set_step_limit(2);
    meet("two steps", &short.advance_to(10.0).unwrap_err());
    let motion = scene(&good()).simulate(0.0..1.0).unwrap();
    meet("a time after the end", &motion.at(3.0).unwrap_err());
    meet("a time behind a run", &{
        let mut run = Simulation::new(&scene(&good())).unwrap();
        run.advance_to(0.5).unwrap();
        run.advance_to(1e-300).unwrap_err()
    });
    meet("a joint that is not there", &motion.reaction("pen", 0.5).unwrap_err());
    meet("an event that is not there", &motion.times_of("lowest").unwrap_err());

    let mut unique = Refusals::new(variants!(UniquenessError: TooLarge, NotFinite));
    let long = Simulation::new(&catalogue::scene("n-four-bar:120").unwrap()).unwrap();
    let error = long.reactions(Convention::default()).unwrap_err();
    meet("reactions of 120 four-bars", &error);
    let EngineError::Uniqueness(large) = error else { panic!("{error}") };
    unique.meet("reactions of 120 four-bars", &large, large.code(), None, &large.hint());
    let error = UniquenessError::NotFinite;
    unique.meet("a state that is not finite", &error, error.code(), None, &error.hint());

    let mut loads = Refusals::new(variants!(
        CustomLoadError: DuplicateName, UnknownBody, OnGround, NotFinite, NoSeries
    ));
    let mut act = |tried: &str, integrator: &str, given: Vec<CustomLoad>| {
        let mut scene = scene(&good());
        scene.simulation.integrator = integrator.parse().unwrap();
        let error = scene.simulate_with(given, 0.0..1.0).unwrap_err();
        met.meet(tried, &error, error.code(), error.pointer().as_deref(), &error.hint());
        let EngineError::CustomLoad { error, .. } = error else { panic!("{tried}: {error}") };
        loads.meet(tried, &error, error.code(), None, &error.hint());
    };
    let wind =
        |body: &str, force: f64| CustomLoad::new("wind", body, move |_| Wrench::force([force, 0.0, 0.0]));
    act("two loads of one name", "auto", vec![wind("bob", 1.0), wind("bob", 1.0)]);
    act("a load on a body that is not there", "auto", vec![wind("bab", 1.0)]);
    act("a load on the ground", "auto", vec![wind("ground", 1.0)]);
    act("a force that is not a number", "auto", vec![wind("bob", f64::NAN)]);
    act("a function by series", "taylor", vec![wind("bob", 1.0)]);
    all_reviewed("refusals-run", [met.text(), unique.text(), loads.text()]);
}

#[test]
fn analyses_without_a_result() {
    let mut met = Refusals::new(variants!(
        AnalysisError: Engine, TooLarge, NoEquilibrium, NoSteadyMotion, TooManySpins, NoModes, Free, Spins, SingularStart, Unreachable, BranchLost,
        TooManyPositions, Pinned, NoLongerWanted
    ));
    let mut meet =
        |tried: &str, error: &AnalysisError| met.meet(tried, error, error.code(), None, &error.hint());
    let builtin = |name: &str| catalogue::scene(name).unwrap();
    meet(
        "equilibrium of a scene without bodies",
        &equilibrium(&scene(&with("/bodies", json!([])))).unwrap_err(),
    );
    let chain = at_rest(builtin("spatial-chain:100"));
    meet("steady motion of 100 links at rest", &modes(&chain, ModesAbout::Steady).unwrap_err());
    meet("equilibrium of 201 bodies", &equilibrium(&builtin("spatial-chain:201")).unwrap_err());
    meet("equilibrium of a body that falls", &equilibrium(&builtin("free-fall")).unwrap_err());
    let error = modes(&pushed("auto", json!({"kind": "projection"})), ModesAbout::Steady).unwrap_err();
    meet("vibrations about a motion that is not steady", &error);
    meet("eigenvalues that are not found", &AnalysisError::NoModes);
    meet(
        "kinematics without drivers",
        &kinematics(&builtin("n-four-bar:1"), Convention::default()).unwrap_err(),
    );
    let mut link = problem("rssr/ss");
    link["bodies"][2]["center_of_mass"] = json!([0, 0.01, 0]);
    meet(
        "kinematics of a link that something turns about itself",
        &kinematics(&scene(&link), Convention::default()).unwrap_err(),
    );
    let mut flat = problem("four-bars/parallelogram");
    for (body, x) in [(0, 0.0), (1, 1.0), (2, 4.0)] {
        flat["bodies"][body]["position"] = json!([x, 0, 0]);
        flat["bodies"][body]["orientation"] = json!({"axis": [0, 0, 1], "angle": 0});
    }
    for (joint, x) in [(0, 0.0), (1, 1.0), (2, 5.0), (3, 4.0)] {
        flat["joints"][joint]["point"] = json!([x, 0, 0]);
    }
    meet(
        "kinematics from where branches meet",
        &kinematics(&scene(&flat), Convention::default()).unwrap_err(),
    );
    meet("kinematics between branches", &AnalysisError::BranchLost { time: 0.3, moved: 0.02 });
    let mut often = builtin("spatial-slider-crank");
    (often.simulation.every, often.simulation.duration) = (1e-5, 2.0);
    meet("kinematics of 200000 positions", &kinematics(&often, Convention::default()).unwrap_err());
    meet(
        "kinematics past the reach",
        &kinematics(&pushed("auto", json!({"kind": "projection"})), Convention::default()).unwrap_err(),
    );
    meet(
        "assembly about a body that is not there",
        &assemble(&scene(&good()), &["bab".to_owned()]).unwrap_err(),
    );
    let left = Wanted::default();
    left.no_longer();
    meet(
        "equilibrium for somebody who left",
        &equilibrium_while(&builtin("simple-pendulum"), &left).unwrap_err(),
    );
    all_reviewed("refusals-analysis", [met.text()]);
}

#[test]
fn robots_that_cannot_be_read() {
    let mut met = Refusals::new(variants!(UrdfError: TooLong, Xml, Wrong, NoLongerWanted, Unknown));
    let arm = std::fs::read_to_string(triad_tests::root().join("tests/data/arm.urdf")).unwrap();
    let mut meet = |tried: &str, urdf: &str, side_car: &Value| {
        let side_car: SideCar = serde_json::from_value(side_car.clone()).unwrap();
        let error = triad_urdf::import_while(urdf, &side_car, &|| !tried.contains("left")).unwrap_err();
        let hint = if let UrdfError::Wrong { hint, .. } = &error { hint } else { "" };
        met.meet(tried, &error, "", None, hint);
    };
    let nothing = json!({});
    meet("a text of 9 MB", &" ".repeat(9_000_000), &nothing);
    meet("a tag that is not closed", &arm.replace("</robot>", ""), &nothing);
    meet(
        "a mass that is no number",
        &arm.replace("<mass value=\"2\"/>", "<mass value=\"heavy\"/>"),
        &nothing,
    );
    meet("an unknown kind of joint", &arm.replace("type=\"continuous\"", "type=\"spherical\""), &nothing);
    meet(
        "a link that is its own child",
        &arm.replace("<child link=\"lower\"/>", "<child link=\"upper\"/>"),
        &nothing,
    );
    meet("a body without mass", &arm.replace("<mass value=\"1\"/>", "<mass value=\"0\"/>"), &nothing);
    meet("a robot for somebody who left", &arm, &nothing);
    meet("a side-car that turns another joint", &arm, &json!({"positions": {"ellbow": 1.0}}));
    all_reviewed("refusals-urdf", [met.text()]);
}
