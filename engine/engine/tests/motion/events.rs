//! Events against moments known in closed form, with each integrator.

#![allow(clippy::unwrap_used)]

use serde_json::{Value, json};
use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

fn with_events(mut scene: Value, integrator: &str, events: &Value) -> Simulation {
    scene["events"] = events.clone();
    scene["simulation"]["integrator"] = integrator.into();
    scene["simulation"]["tolerance"] = json!(1e-12);
    Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap()
}

fn built_in(name: &str) -> Value {
    serde_json::to_value(catalogue::scene(name).unwrap()).unwrap()
}

/// Integrators with dense output of high, of higher and of low order.
const ALL: [&str; 3] = ["taylor", "dop853", "dopri5"];

/// A01 starts at rest in the horizontal: it is lowest after a quarter of the period 4 K(1/2)/√g, and every half after.
#[test]
fn a_pendulum_passes_its_lowest_point_on_time() {
    let period = 2.367_841_947_576_237_4;
    let low = json!([
        { "name": "lowest", "of": { "type": "coordinate", "body": "bob", "direction": [1, 0, 0] }, "value": 0 },
        { "name": "rightwards", "of": { "type": "coordinate", "body": "bob", "direction": [2, 0, 0] }, "value": 0, "passing": "upwards" },
        { "name": "never", "of": { "type": "coordinate", "body": "bob", "direction": [0, 1, 0] }, "value": 0.1 },
    ]);
    for integrator in ALL {
        let mut run = with_events(built_in("simple-pendulum"), integrator, &low);
        run.advance_to(4.0 * period).unwrap();
        let times = |name: &str| -> Vec<f64> {
            run.events().iter().filter(|e| e.name == name).map(|e| e.time).collect()
        };
        assert_eq!(times("lowest").len(), 8, "{integrator}");
        for (k, time) in times("lowest").into_iter().enumerate() {
            let exact = (0.25 + 0.5 * k as f64) * period;
            assert!((time - exact).abs() < 2e-10, "{integrator}: {time} against {exact}");
        }
        assert_eq!(times("rightwards").len(), 4);
        assert!(times("never").is_empty());
        assert!(run.events().windows(2).all(|pair| pair[0].time <= pair[1].time));
    }
}

/// A driven wheel: θ = 1.3 t², so that it has turned n times at √(2πn/1.3), and a point of it touches a line twice a turn.
#[test]
fn angles_through_turns_distances_and_the_end_of_a_run() {
    let scene = json!({
        "name": "wheel", "simulation": { "duration": 9 },
        "bodies": [{ "name": "wheel", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] } }],
        "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "drivers": [{ "type": "angle", "name": "motor", "joint": "axle",
            "motion": { "kind": "polynomial", "coefficients": [0, 0, 1.3] } }],
    });
    let tau = std::f64::consts::TAU;
    let at = |angle: f64| (angle / 1.3).sqrt();
    let events = json!([
        { "name": "five turns", "of": { "type": "angle", "joint": "axle" }, "value": 5.0 * tau },
        { "name": "near", "of": { "type": "distance", "body_i": "wheel", "point_i": [1, 0, 0], "body_j": "ground",
            "point_j": [0, 2, 0] }, "value": 1.000_001 },
        { "name": "end", "of": { "type": "angle", "joint": "axle" }, "value": 7.25 * tau, "stop": true },
    ]);
    for integrator in ["taylor", "dop853"] {
        let mut run = with_events(scene.clone(), integrator, &events);
        run.advance_to(9.0).unwrap();
        let named = |name: &str| run.events().iter().filter(|e| e.name == name).collect::<Vec<_>>();
        assert!((named("five turns")[0].time - at(5.0 * tau)).abs() < 1e-11, "{integrator}");
        assert!((named("five turns")[0].rate - 2.6 * at(5.0 * tau)).abs() < 1e-9, "{integrator}");
        // The distance falls below the value for a moment only, once a turn, and just before the end.
        assert_eq!(named("near").len(), 15, "{integrator}");
        assert!(run.finished() && (run.time() - at(7.25 * tau)).abs() < 1e-11, "{integrator}");
        let u = run.frame().bodies[0].u;
        assert!((u[1] - 1.0).abs() < 1e-9, "{integrator}: shown is the moment itself");
        run.reset();
        assert!(run.events().is_empty() && !run.finished());
        run.advance_to(9.0).unwrap();
        assert!(run.finished());
    }
}

#[test]
fn a_slide_passes_its_place() {
    // s = 0.4 sin 3t passes 0.2 upwards at π/18 and downwards at 5π/18.
    let scene = json!({
        "name": "rail", "simulation": { "duration": 1 },
        "bodies": [{ "name": "block", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] } }],
        "joints": [{ "name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "block", "point": [0, 0, 0], "axis": [1, 0, 0] }],
        "drivers": [{ "type": "slide", "name": "d", "joint": "rail", "motion": { "kind": "harmonic", "amplitude": 0.4, "frequency": 3 } }],
    });
    let events = json!([{ "name": "there", "of": { "type": "slide", "joint": "rail" }, "value": 0.2 },
        { "name": "start", "of": { "type": "slide", "joint": "rail" }, "value": 0 }]);
    for integrator in ALL {
        let mut run = with_events(scene.clone(), integrator, &events);
        run.advance_to(1.0).unwrap();
        let times: Vec<f64> = run.events().iter().map(|e| e.time).collect();
        let exact = [1.0, 5.0].map(|k| k * std::f64::consts::PI / 18.0);
        assert_eq!(times.len(), 2, "{integrator}: a number that starts on the value has not passed it");
        assert!(
            times.iter().zip(exact).all(|(t, exact)| (t - exact).abs() < 1e-10),
            "{integrator}: {times:?}"
        );
    }
}

/// A wheel waits, turns to 1 rad from 0.3 to 0.7 s, and waits there: it leaves one value and arrives at the other, and passes neither.
#[test]
fn a_number_that_rests_on_its_value_passes_nothing() {
    let rest = |from: f64, to: f64, events: &Value, integrator: &str| {
        let scene = json!({
            "name": "wheel", "simulation": { "duration": 1 },
            "bodies": [{ "name": "wheel", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] } },
                { "name": "weight", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] }, "position": [0.3, 0.4, 0.5] }],
            "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "wheel", "point": [0, 0, 0], "axis": [1, 2, 3] },
                { "name": "held", "type": "fixed", "body_i": "ground", "body_j": "weight", "point": [1, 0, 0] }],
            "drivers": [{ "type": "angle", "name": "motor", "joint": "axle",
                "motion": { "kind": "smooth-step", "from": from, "to": to, "start": 0.3, "end": 0.7 } }],
        });
        let mut run = with_events(scene, integrator, events);
        run.advance_to(1.0).unwrap();
        (run.events().to_vec(), run.time())
    };
    let angle = |value: f64| json!({ "name": "angle", "of": { "type": "angle", "joint": "axle" }, "value": value, "stop": true });
    let place = json!({ "name": "place", "of": { "type": "coordinate", "body": "weight", "point": [0.3, -0.3, 0.1], "direction": [1, 1, 1] },
        "value": 1.3 / 3.0_f64.sqrt() });
    for integrator in ["taylor", "dop853", "dopri5", "radau"] {
        let (events, time) = rest(0.0, 1.0, &json!([angle(0.0), place]), integrator);
        assert!(events.is_empty() && time == 1.0, "{integrator}: {} events to {time}", events.len());
        let (events, time) = rest(0.0, 1.0, &json!([angle(1.0)]), integrator);
        assert!(events.is_empty() && time == 1.0, "{integrator}: {} events to {time}", events.len());
        let (events, _) = rest(0.0, 1.0, &json!([angle(0.5)]), integrator);
        assert!(events.len() == 1 && (events[0].time - 0.5).abs() < 1e-10, "{integrator}: {events:?}");
    }
}

/// A rotor of 50 rad/s: `radau`, in the angle of its hinge, takes steps of many turns.
#[test]
fn every_turn_within_a_long_step_is_seen() {
    let scene = json!({
        "name": "rotor", "gravity": [0, 0, 0], "simulation": { "duration": 3 },
        "bodies": [{ "name": "rotor", "mass": 1.0, "inertia": { "principal": [0.1, 0.1, 0.1] } }],
        "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "rotor", "point": [0, 0, 0], "axis": [0, 0, 1],
            "start": { "rate": 50 } }],
    });
    let events = json!([{ "name": "x", "of": { "type": "coordinate", "body": "rotor", "point": [1, 0, 0], "direction": [1, 0, 0] },
        "value": 0.37 }]);
    for integrator in ["radau", "taylor"] {
        let mut run = with_events(scene.clone(), integrator, &events);
        run.advance_to(3.0).unwrap();
        let at = libm::acos(0.37);
        let turn = std::f64::consts::TAU;
        let exact: Vec<f64> = (0..24)
            .map(f64::from)
            .flat_map(|k| [turn * k + at, turn * (k + 1.0) - at])
            .map(|angle| angle / 50.0)
            .collect();
        let times: Vec<f64> = run.events().iter().map(|event| event.time).collect();
        assert_eq!(times.len(), 48, "{integrator}");
        assert!(
            times.iter().zip(exact).all(|(t, exact)| (t - exact).abs() < 1e-8),
            "{integrator}: {times:?}"
        );
    }
}

/// What is passed just as the run ends is told, whatever rounding says.
#[test]
fn a_value_that_is_reached_as_the_run_ends_is_passed() {
    for rate in [1.0, 0.3, 0.7, 1.1, 1.9, 2.3] {
        let scene = json!({
            "name": "wheel", "simulation": { "duration": 1 },
            "bodies": [{ "name": "wheel", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] } }],
            "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1] }],
            "drivers": [{ "type": "angle", "name": "motor", "joint": "axle", "motion": { "kind": "ramp", "rate": rate } }],
        });
        let events = json!([{ "name": "there", "of": { "type": "angle", "joint": "axle" }, "value": rate }]);
        for integrator in ALL {
            let mut run = with_events(scene.clone(), integrator, &events);
            run.advance_to(1.0).unwrap();
            assert_eq!(run.events().len(), 1, "{integrator}, {rate}/s");
            assert!((run.events()[0].time - 1.0).abs() < 1e-9, "{integrator}, {rate}/s");
        }
    }
}

#[test]
fn an_event_without_its_joint_is_refused() {
    let mut scene = built_in("simple-pendulum");
    scene["events"] = json!([{ "name": "x", "of": { "type": "angle", "joint": "nowhere" }, "value": 0 }]);
    let error = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap_err().to_string();
    assert!(error.contains("nowhere"), "{error}");
}

/// The times of events are told with an error: within three times of what they are off, by a method that is far off.
#[test]
fn the_error_of_the_time_of_an_event_is_told() {
    let period = 2.367_841_947_576_237_4;
    let low = json!([{ "name": "lowest", "of": { "type": "coordinate", "body": "bob", "direction": [1, 0, 0] }, "value": 0 }]);
    for (integrator, tolerance, every) in
        [("dopri5", 1e-4, 0.05), ("dop853", 1e-5, 3.0), ("taylor", 1e-4, 0.7)]
    {
        let mut scene = built_in("simple-pendulum");
        scene["events"] = low.clone();
        scene["simulation"]["integrator"] = integrator.into();
        scene["simulation"]["tolerance"] = json!(tolerance);
        let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        while run.time() < 9.0 {
            run.advance_to(run.time() + every).unwrap();
        }
        let events = run.events();
        assert!(events.len() >= 7, "{integrator}: {events:?}");
        for (k, event) in events.iter().enumerate() {
            let off = (event.time - (0.25 + 0.5 * k as f64) * period).abs();
            let told = event.error.unwrap();
            assert!(off < 3.0 * told && told < 3.0 * off + 1e-6, "{integrator}, {k}: {off:e}, told {told:e}");
        }
    }
}

/// Where a quantity hardly moves the rounding of the numbers that cancel in it decides when it is there.
#[test]
fn an_event_is_known_no_better_than_its_quantity() {
    for (formula, exact) in [("(t-1)^3", 1.0), ("(t-1)^2-1e-10", 1.0 - 1e-5)] {
        let start = if exact < 1.0 { 1.0 - 1e-10 } else { -1.0 };
        let scene = json!({
            "name": "slow", "gravity": [0, 0, 0],
            "bodies": [{ "name": "b", "mass": 1, "inertia": { "principal": [0.1, 0.2, 0.25] },
                         "position": [start, 0, 0] }],
            "joints": [{ "name": "j", "type": "prismatic", "body_i": "ground", "body_j": "b",
                         "point_i": [0, 0, 0], "point_j": [0, 0, 0], "axis": [1, 0, 0] }],
            "drivers": [{ "name": "d", "type": "slide", "joint": "j",
                          "motion": { "kind": "expression", "value": formula } }],
            "simulation": { "duration": 3.0 }
        });
        let there = json!([{ "name": "there", "of": { "type": "slide", "joint": "j" }, "value": 0 }]);
        let mut run = with_events(scene, "taylor", &there);
        run.advance_to(3.0).unwrap();
        let event = &run.events()[0];
        let (off, told) = ((event.time - exact).abs(), event.error.unwrap());
        assert!(off > 1e-15 && off < 3.0 * told, "{formula}: {off:e}, told {told:e}");
    }
}

/// Two hands of one clock strike at the same moment: whichever stands first in the file, both are told, and the run ends.
#[test]
fn events_at_the_moment_at_which_a_run_stops_are_told() {
    let scene = json!({
        "name": "hands", "simulation": { "duration": 2 },
        "bodies": [{ "name": "hand", "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] } }],
        "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "hand", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "drivers": [{ "type": "angle", "name": "motor", "joint": "axle", "motion": { "kind": "polynomial", "coefficients": [0, 1] } }],
    });
    let strike = |name: &str, value: f64, stop: bool| json!({ "name": name, "of": { "type": "angle", "joint": "axle" }, "value": value, "stop": stop });
    let (end, gate, later) =
        (strike("end", 0.7, true), strike("gate", 0.7, false), strike("later", 0.701, false));
    for events in [json!([end, gate, later]), json!([later, gate, end])] {
        for integrator in ALL {
            let mut run = with_events(scene.clone(), integrator, &events);
            run.advance_to(2.0).unwrap();
            let mut told: Vec<&str> = run.events().iter().map(|event| &event.name[..]).collect();
            told.sort_unstable();
            assert_eq!(told, ["end", "gate"], "{integrator}, {events}");
            assert!((run.time() - 0.7).abs() < 1e-12, "{integrator}: {}", run.time());
        }
    }
}
