//! Joints, drivers and loads against motions that are known in closed form.

use std::f64::consts::{PI, TAU};
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

/// A body with three different moments of inertia; `extra` overrides its keys.
fn body(name: &str, extra: &serde_json::Value) -> serde_json::Value {
    let mut body = serde_json::json!({
        "name": name, "mass": 2.0, "inertia": { "principal": [0.3, 0.5, 0.7] },
    });
    for (key, value) in extra.as_object().into_iter().flatten() {
        body[key] = value.clone();
    }
    body
}

/// Coordinates and integrators, each of which knows the catalogue in its own way.
const HOW: [(&str, &str); 4] =
    [("full", "dop853"), ("reduced", "dop853"), ("full", "taylor"), ("reduced", "taylor")];

#[allow(clippy::unwrap_used)] // a helper of tests
fn simulation(mut scene: serde_json::Value, coordinates: &str, integrator: &str) -> Simulation {
    scene["name"] = "test".into();
    scene["coordinates"] = coordinates.into();
    scene["simulation"] = serde_json::json!({ "duration": 20, "tolerance": 1e-11, "integrator": integrator });
    let scene = Scene::from_json(&scene.to_string()).unwrap();
    Simulation::new(&scene).unwrap()
}

/// Runs a scene with both kinds of body and compares coordinate x of the first body's position with `expected`.
#[allow(clippy::unwrap_used)] // a helper of tests
fn follows_x(scene: &serde_json::Value, times: &[f64], expected: impl Fn(f64) -> f64) {
    for (coordinates, integrator) in HOW {
        let mut simulation = simulation(scene.clone(), coordinates, integrator);
        for &t in times {
            simulation.advance_to(t).unwrap();
            let x = simulation.frame().bodies[0].position[0];
            assert!(
                (x - expected(t)).abs() < 1e-8,
                "{coordinates} by {integrator}, t = {t}: {x} against {}",
                expected(t)
            );
        }
    }
}

/// Runs a scene with both kinds of body and compares the angle of the first body's u about z with `expected`.
#[allow(clippy::unwrap_used)] // a helper of tests
fn follows_angle(scene: &serde_json::Value, times: &[f64], expected: impl Fn(f64) -> f64) {
    for (coordinates, integrator) in HOW {
        let mut simulation = simulation(scene.clone(), coordinates, integrator);
        for &t in times {
            simulation.advance_to(t).unwrap();
            let u = simulation.frame().bodies[0].u;
            let (cos, sin) = (libm::cos(expected(t)), libm::sin(expected(t)));
            let error = libm::hypot(u[0] - cos, u[1] - sin);
            assert!(error < 1e-8, "{coordinates} by {integrator}, t = {t}: off by {error}");
        }
    }
}

/// Times of comparison, s, none of them a multiple of another.
const TIMES: [f64; 4] = [0.3, 1.0, 2.7, 6.0];

fn slider(loads: &serde_json::Value, speed: f64) -> serde_json::Value {
    serde_json::json!({
        "gravity": [0, 0, -9.81],
        "bodies": [body("block", &serde_json::json!({ "velocity": [speed, 0, 0] }))],
        "joints": [{ "name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "block",
                     "point": [0, 0, 0], "axis": [1, 0, 0] }],
        "loads": loads,
    })
}

fn wheel(loads: &serde_json::Value, speed: f64) -> serde_json::Value {
    serde_json::json!({
        "gravity": [0, 0, -9.81],
        "bodies": [body("wheel", &serde_json::json!({ "angular_velocity": [0, 0, speed] }))],
        "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "wheel",
                     "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "loads": loads,
    })
}

/// x(t) of m ẍ + c ẋ + k x = f from x = 0 with speed v.
fn oscillator(m: f64, c: f64, k: f64, f: f64, v: f64) -> impl Fn(f64) -> f64 {
    let decay = c / (2.0 * m);
    let omega = (k / m - decay * decay).sqrt();
    let rest = f / k;
    move |t| {
        let sine = (v - decay * rest) / omega;
        rest + libm::exp(-decay * t) * (sine * libm::sin(omega * t) - rest * libm::cos(omega * t))
    }
}

#[test]
fn spring_damper_and_actuator_along_a_slider() {
    let load = serde_json::json!([{ "type": "slider", "name": "s", "joint": "rail", "stiffness": 30, "damping": 1.5,
        "force": { "kind": "constant", "value": 4 } }]);
    follows_x(&slider(&load, 0.7), &TIMES, oscillator(2.0, 1.5, 30.0, 4.0, 0.7));
}

#[test]
fn spring_between_two_points() {
    // Along the line of the spring: free length 1, pulled by an actuator of 4 N towards the ground's point at x = -1.
    let load = serde_json::json!([{ "type": "spring", "name": "s", "body_i": "ground", "point_i": [-1, 0, 0],
        "body_j": "block", "point_j": [0, 0, 0], "stiffness": 30, "damping": 1.5,
        "force": { "kind": "constant", "value": 4 } }]);
    follows_x(&slider(&load, 0.7), &TIMES, oscillator(2.0, 1.5, 30.0, -4.0, 0.7));
}

#[test]
fn torsional_spring_damper_and_motor() {
    let load = serde_json::json!([{ "type": "torsion", "name": "s", "joint": "axle", "stiffness": 11, "damping": 0.4,
        "torque": { "kind": "constant", "value": 2 } }]);
    follows_angle(&wheel(&load, 0.9), &TIMES, oscillator(0.7, 0.4, 11.0, 2.0, 0.9));
}

#[test]
fn smoothed_coulomb_friction_stops_a_block() {
    // Far above the smoothing speed the deceleration is coulomb / m; the tail below it is shorter than 1e-4 m.
    let load = serde_json::json!([{ "type": "slider", "name": "f", "joint": "rail",
        "friction": { "coulomb": 3, "smoothing": 1e-4 } }]);
    let mut run = simulation(slider(&load, 2.0), "full", "taylor");
    run.advance_to(1.0).unwrap();
    assert!((run.frame().bodies[0].position[0] - (2.0 - 0.75)).abs() < 1e-8);
    run.advance_to(2.0).unwrap();
    let stop = run.frame().bodies[0];
    assert!((stop.position[0] - 2.0 * 2.0 / 3.0).abs() < 1e-7, "{}", stop.position[0]);
    assert!(stop.velocity[0].abs() < 1e-4);
}

#[test]
fn forces_and_moments_of_both_frames() {
    let force = |frame: &str, vector: [f64; 3]| {
        serde_json::json!([{ "type": "force", "name": "f", "body": "block", "frame": frame,
            "force": { "kind": "fixed", "vector": vector } }])
    };
    follows_x(&slider(&force("world", [3.0, 5.0, 7.0]), 0.0), &TIMES, |t| 0.75 * t * t);
    follows_x(&slider(&force("body", [3.0, 5.0, 7.0]), 0.0), &TIMES, |t| 0.75 * t * t);
    // A force at a point beside the axle of a wheel turns with it in the body's frame: constant moment.
    let beside = serde_json::json!([{ "type": "force", "name": "f", "body": "wheel", "frame": "body",
        "point": [0.5, 0, 0], "force": { "kind": "fixed", "vector": [0, 1.4, 0] } }]);
    follows_angle(&wheel(&beside, 0.0), &TIMES, |t| 0.5 * t * t);
    let moment = serde_json::json!([{ "type": "moment", "name": "m", "body": "wheel",
        "moment": { "kind": "components", "x": { "kind": "constant", "value": 5 },
                    "y": { "kind": "constant", "value": 0 }, "z": { "kind": "ramp", "rate": 0.7 } } }]);
    follows_angle(&wheel(&moment, 0.0), &TIMES, |t| t * t * t / 6.0);
}

#[test]
fn a_driven_angle_passes_pi_and_many_turns() {
    let mut scene = wheel(&serde_json::json!([]), 0.0);
    scene["drivers"] = serde_json::json!([{ "type": "angle", "name": "motor", "joint": "axle",
        "motion": { "kind": "polynomial", "coefficients": [0, 0, 1.3] } }]);
    follows_angle(&scene, &[0.5, 1.55, 3.0, 9.0], |t| 1.3 * t * t);
    // The motor's torque is J θ̈.
    let mut run = simulation(scene, "full", "taylor");
    run.advance_to(5.0).unwrap();
    let motor = run.multipliers().into_iter().find(|j| j.joint == "motor").unwrap();
    assert!((motor.moment[2] - 0.7 * 2.6).abs() < 1e-9, "{:?}", motor.moment);
}

#[test]
fn driven_slide_and_point() {
    let wave = serde_json::json!({ "kind": "harmonic", "amplitude": 0.4, "frequency": 3 });
    let mut scene = slider(&serde_json::json!([]), 0.0);
    scene["drivers"] = serde_json::json!([{ "type": "slide", "name": "d", "joint": "rail", "motion": wave }]);
    follows_x(&scene, &TIMES, |t| 0.4 * libm::sin(3.0 * t));
    let mut run = simulation(scene.clone(), "reduced", "taylor");
    run.advance_to(2.0).unwrap();
    let force = run.multipliers().into_iter().find(|j| j.joint == "d").unwrap().force[0];
    assert!((force + 2.0 * 0.4 * 9.0 * libm::sin(6f64)).abs() < 1e-8);
    let none = serde_json::json!({ "kind": "constant", "value": 0 });
    scene["joints"] = serde_json::json!([]);
    scene["drivers"] = serde_json::json!([{ "type": "point", "name": "d", "body": "block", "point": [0, 0, 0],
        "motion": { "kind": "components", "x": wave, "y": none, "z": none } }]);
    follows_x(&scene, &TIMES, |t| 0.4 * libm::sin(3.0 * t));
}

#[test]
fn a_screw_falls_slowly_and_turns_with_its_pitch() {
    // Along x, pulled by gravity along x: ẍ = g m / (m + J / p²), p the advance for one radian.
    let pitch = 0.5;
    let p = pitch / TAU;
    let scene = serde_json::json!({
        "gravity": [9.81, 0, 0],
        "bodies": [body("nut", &serde_json::json!({}))],
        "joints": [{ "name": "thread", "type": "screw", "body_i": "ground", "body_j": "nut", "point": [0, 0, 0],
                     "axis": [1, 0, 0], "pitch": pitch }],
    });
    let acceleration = 9.81 * 2.0 / (2.0 + 0.3 / (p * p));
    follows_x(&scene, &TIMES, |t| 0.5 * acceleration * t * t);
    let mut run = simulation(scene, "full", "taylor");
    run.advance_to(6.0).unwrap();
    let frame = run.frame().bodies[0];
    let angle = frame.position[0] / p;
    assert!(angle > PI * 3.0, "more than one turn, for the sake of the test");
    assert!((frame.v[1] - libm::cos(angle)).abs() < 1e-7 && (frame.v[2] - libm::sin(angle)).abs() < 1e-7);
}

#[test]
fn a_gear_shares_the_torque() {
    // Two wheels with moments 0.7 and 0.7, the second turning −3 times as fast: θ̈ = τ / (J + 9 J).
    let scene = serde_json::json!({
        "gravity": [0, 0, 0],
        "bodies": [body("small", &serde_json::json!({})), body("large", &serde_json::json!({ "position": [2, 0, 0] }))],
        "joints": [
            { "name": "a", "type": "revolute", "body_i": "ground", "body_j": "small", "point": [0, 0, 0], "axis": [0, 0, 1] },
            { "name": "b", "type": "revolute", "body_i": "ground", "body_j": "large", "point": [2, 0, 0], "axis": [0, 0, 1] },
            { "name": "mesh", "type": "gear", "joints": ["a", "b"], "ratio": -3 },
        ],
        "loads": [{ "type": "torsion", "name": "t", "joint": "a", "torque": { "kind": "constant", "value": 2.1 } }],
    });
    let acceleration = 2.1 / (0.7 * 10.0);
    follows_angle(&scene, &TIMES, |t| 0.5 * acceleration * t * t);
    let mut run = simulation(scene, "reduced", "dop853");
    run.advance_to(6.0).unwrap();
    let angle = -3.0 * 0.5 * acceleration * 36.0;
    assert!((run.frame().bodies[1].u[0] - libm::cos(angle)).abs() < 1e-7);
}

#[test]
fn a_point_mass_on_a_rod_is_the_pendulum() {
    let bob = serde_json::json!({ "name": "bob", "mass": 1.0, "position": [-1, 0, 0] });
    let scene = |joint: serde_json::Value| serde_json::json!({ "gravity": [0, -9.81, 0], "bodies": [bob.clone()], "joints": [joint] });
    let on_rod =
        scene(serde_json::json!({ "name": "rod", "type": "rod", "body_i": "ground", "body_j": "bob",
        "points": [[0, 0, 0], [-1, 0, 0]] }));
    let on_pin =
        scene(serde_json::json!({ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "bob",
        "point": [0, 0, 0], "axis": [0, 0, 1] }));
    let (mut rod, mut pin) = (simulation(on_rod, "full", "taylor"), simulation(on_pin, "reduced", "dop853"));
    for t in TIMES {
        rod.advance_to(t).unwrap();
        pin.advance_to(t).unwrap();
        let (a, b) = (rod.frame().bodies[0].position, pin.frame().bodies[0].position);
        assert!(libm::hypot(a[0] - b[0], a[1] - b[1]) < 1e-7, "t = {t}: {a:?} {b:?}");
    }
}

#[test]
fn conservative_loads_keep_the_energy() {
    let scene = serde_json::json!({
        "gravity": [0, 0, -9.81],
        "bodies": [
            body("a", &serde_json::json!({ "angular_velocity": [1, 0.4, 0] , "center_of_mass": [0.2, 0.1, -0.3] })),
            body("b", &serde_json::json!({ "position": [1, 0, 0], "velocity": [0.5, 0, 0.2] })),
        ],
        "joints": [{ "name": "ball", "type": "spherical", "body_i": "ground", "body_j": "a", "point": [0, 0.1, 0] }],
        "loads": [
            { "type": "spring", "name": "s", "body_i": "a", "point_i": [0.3, 0.2, 0.1], "body_j": "b",
              "point_j": [-0.2, 0.1, 0.4], "stiffness": 200, "free_length": 0.4 },
        ],
    });
    for (coordinates, integrator) in HOW {
        let mut run = simulation(scene.clone(), coordinates, integrator);
        run.advance_to(4.0).unwrap();
        let summary = run.summary();
        assert!(summary.energy_drift.abs() < 1e-7, "{}", summary.energy_drift);
        // Between steps the state is read off the interpolation, which is as exact as the tolerance.
        assert!(summary.position_violation < 1e-9);
    }
}

/// Whatever drivers, dampers, motors and friction do, energy less their work stays what it was.
#[test]
fn work_accounts_for_the_energy_of_every_load_and_driver() {
    let wave = serde_json::json!({ "kind": "harmonic", "mean": 0.3, "amplitude": 2, "frequency": 3 });
    let constant = |value: f64| serde_json::json!({ "kind": "constant", "value": value });
    let vector =
        serde_json::json!({ "kind": "components", "x": constant(0.4), "y": wave, "z": constant(-0.7) });
    let chain = |loads: serde_json::Value, drivers: serde_json::Value| {
        serde_json::json!({
            "gravity": [0.5, 0, -9.81],
            "bodies": [
                body("a", &serde_json::json!({ "center_of_mass": [0.2, 0.1, -0.3] })),
                body("b", &serde_json::json!({ "position": [1, 0, 0], "center_of_mass": [0.3, -0.2, 0.1] })),
            ],
            "joints": [
                { "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 1, 1] },
                { "name": "tube", "type": "cylindrical", "body_i": "a", "body_j": "b", "point": [1, 0, 0], "axis": [1, 0.2, 0] },
                { "name": "rail", "type": "point-in-plane", "body_i": "ground", "body_j": "b", "point": [1, 0, 0], "axis": [1, 1, 4] },
            ],
            "loads": loads, "drivers": drivers,
        })
    };
    let none = serde_json::json!([]);
    let hold = serde_json::json!({ "type": "slider", "name": "hold", "joint": "tube", "stiffness": 60 });
    let friction = serde_json::json!({ "viscous": 0.3, "coulomb": 0.5, "smoothing": 0.2 });
    let cases = [
        serde_json::json!({ "type": "force", "name": "l", "body": "b", "point": [0.1, 0.2, 0.3], "force": vector }),
        serde_json::json!({ "type": "force", "name": "l", "body": "b", "point": [0.1, 0.2, 0.3], "force": vector, "frame": "body" }),
        serde_json::json!({ "type": "moment", "name": "l", "body": "b", "moment": vector }),
        serde_json::json!({ "type": "moment", "name": "l", "body": "a", "moment": vector, "frame": "body" }),
        serde_json::json!({ "type": "spring", "name": "l", "body_i": "a", "point_i": [0, 0.5, 0], "body_j": "b",
            "point_j": [0.2, 0, 0.6], "stiffness": 40, "damping": 3, "force": wave }),
        serde_json::json!({ "type": "torsion", "name": "l", "joint": "pin", "stiffness": 5, "damping": 0.5, "torque": wave,
            "friction": friction }),
        serde_json::json!({ "type": "slider", "name": "l", "joint": "tube", "damping": 0.5, "force": wave,
            "friction": friction }),
    ];
    let mut scenes: Vec<serde_json::Value> =
        cases.into_iter().map(|load| chain(serde_json::json!([hold, load]), none.clone())).collect();
    for driver in [
        serde_json::json!({ "type": "angle", "name": "d", "joint": "pin", "motion": { "kind": "smooth-step", "from": 0, "to": 0.5,
            "start": 0, "end": 1 } }),
        serde_json::json!({ "type": "slide", "name": "d", "joint": "tube",
            "motion": { "kind": "harmonic", "amplitude": 0.2, "frequency": 3 } }),
    ] {
        scenes.push(chain(serde_json::json!([hold]), serde_json::json!([driver])));
    }
    for scene in scenes {
        for (coordinates, integrator) in HOW {
            let mut run = simulation(scene.clone(), coordinates, integrator);
            run.advance_to(0.8).unwrap();
            let summary = run.summary();
            assert!(summary.work.abs() > 1e-3, "it does work: {scene}");
            let scale = 1.0 + summary.energy.abs() + summary.work.abs();
            assert!(summary.energy_drift.abs() < 1e-8 * scale, "{}: {scene}", summary.energy_drift);
        }
    }
}
