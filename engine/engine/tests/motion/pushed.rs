//! Prescribed forces that low terms of a series know nothing of: the series must not step over them.

#![allow(clippy::unwrap_used)]

use crate::common::difference;
use serde_json::json;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

/// A body of 2 kg on a rail, pushed by f(t): x = v₀ t + g t²/2 + ∫ (t − s) f(s) ds / m. Forces that begin like a high power of time,
/// that are pulses, and that vibrate: low terms of the motion, which choose the step elsewhere, know nothing of them.
#[test]
fn forces_that_the_first_terms_know_nothing_of_are_followed() {
    type Force = fn(f64) -> f64;
    let forces: [(&str, Force); 9] = [
        ("1-cos(3*t)", |t| 1.0 - libm::cos(3.0 * t)),
        ("2*sin(3*t)^3", |t| 2.0 * cube(libm::sin(3.0 * t))),
        ("t^2*exp(-3*t)", |t| t * t * libm::exp(-3.0 * t)),
        ("t^9", |t| cube(cube(t))),
        ("50*exp(-((t-2.537)/0.2)^2)", |t| 50.0 * libm::exp(-25.0 * (t - 2.537) * (t - 2.537))),
        ("50*exp(-((t-2.537)/0.02)^2)", |t| 50.0 * libm::exp(-2500.0 * (t - 2.537) * (t - 2.537))),
        ("5*sin(2*t)^61", |t| 5.0 * libm::pow(libm::sin(2.0 * t).abs(), 61.0) * libm::sin(2.0 * t).signum()),
        ("sin(3*t)^66", |t| libm::pow(libm::sin(3.0 * t).abs(), 66.0)),
        ("sin(3000*t)", |t| libm::sin(3000.0 * t)),
    ];
    for (text, force) in forces {
        let moved = 0.5 * 4.0 + quadrature(|s| (4.0 - s) * force(s)) / 2.0;
        for gravity in [0.0, -9.81] {
            let ways =
                [1e-3, 1e-6, 1e-9, 1e-12].map(|tolerance| ["taylor", "auto"].map(|way| (way, tolerance)));
            for (integrator, tolerance) in ways.into_iter().flatten() {
                let value = json!({
                    "name": "pushed", "gravity": [gravity, 0, 0],
                    "bodies": [{"name": "A", "mass": 2, "inertia": {"principal": [1, 1.2, 1.3]}}],
                    "joints": [{"name": "J", "type": "prismatic", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [1, 0, 0],
                                "start": {"slide": 0, "speed": 0.5}}],
                    "loads": [{"name": "F", "type": "slider", "joint": "J", "force": {"kind": "expression", "value": text}}],
                    "simulation": {"duration": 4, "tolerance": tolerance, "integrator": integrator}
                });
                let mut run = Simulation::new(&Scene::from_json(&value.to_string()).unwrap()).unwrap();
                run.advance_to(4.0).unwrap();
                let error = (run.frame().bodies[0].position[0] - moved - 8.0 * gravity).abs();
                // Where vibrations within the tolerance add up to more than the mechanism, it is told that nothing is known.
                let Some(told) = run.error_estimate() else { continue };
                let told = told.position;
                assert!(
                    error < 10.0 * told + 1e-11 && error < 1e3 * tolerance * (1.0 + moved.abs()),
                    "{text}, gravity {gravity}, {integrator}, {tolerance:e}: {error:e}, told {told:e}"
                );
            }
        }
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// ∫ f from 0 to 4, by Gauss' rule of two points in each of many parts.
fn quadrature(f: impl Fn(f64) -> f64) -> f64 {
    let parts = 400_000;
    let half = 2.0 / f64::from(parts);
    let off = half / f64::sqrt(3.0);
    let middles = (0..parts).map(|k| f64::from(2 * k + 1) * half);
    middles.map(|middle| half * (f(middle - off) + f(middle + off))).sum()
}

/// Two hinges of an arm at rest in space, one with a motor whose torque begins like t²; and two pendulums, one of which hangs at rest
/// with such a torque: beside `radau`.
#[test]
fn mechanisms_at_rest_follow_torques_that_begin_like_a_square() {
    let torque = |size: f64, rate: f64| json!({"kind": "harmonic", "mean": size, "amplitude": -size, "frequency": rate, "phase": std::f64::consts::FRAC_PI_2});
    let arm = json!({
        "name": "arm", "gravity": [0, 0, 0],
        "bodies": [
            {"name": "A", "mass": 2, "inertia": {"tensor": [[0.05, 0.01, -0.004], [0.01, 0.08, 0.006], [-0.004, 0.006, 0.06]]},
             "center_of_mass": [0.3, 0.05, -0.1]},
            {"name": "B", "mass": 1, "inertia": {"tensor": [[0.02, -0.003, 0.001], [-0.003, 0.03, 0.004], [0.001, 0.004, 0.025]]},
             "center_of_mass": [0.2, -0.05, -0.2], "position": [0.6, 0, 0.1]}
        ],
        "joints": [
            {"name": "J1", "type": "revolute", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [0.2, 1, 0.3],
             "start": {"angle": 0.4}},
            {"name": "J2", "type": "revolute", "body_i": "A", "body_j": "B", "point": [0.6, 0, 0.1], "axis": [1, 0.1, -0.2],
             "start": {"angle": -0.3}}
        ],
        "loads": [{"name": "motor", "type": "torsion", "joint": "J2", "torque": torque(0.02, 3.0)}],
        "simulation": {"duration": 2}
    });
    let body = |name: &str, x: f64| {
        json!({"name": name, "mass": 1.5, "inertia": {"principal": [0.05, 0.01, 0.05]}, "center_of_mass": [0, -0.4, 0],
               "position": [x, 0, 0]})
    };
    let pendulums = json!({
        "name": "two", "gravity": [0, -9.81, 0],
        "bodies": [body("A", 0.0), body("B", 3.0)],
        "joints": [
            {"name": "J", "type": "revolute", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [0, 0, 1]},
            {"name": "K", "type": "revolute", "body_i": "ground", "body_j": "B", "point": [3, 0, 0], "axis": [0, 0, 1],
             "start": {"angle": 1, "rate": 0.5}}
        ],
        "loads": [{"name": "F", "type": "torsion", "joint": "J", "torque": torque(0.01, 6.0)}],
        "simulation": {"duration": 4}
    });
    for value in [arm, pendulums] {
        let scene = |integrator, tolerance| {
            let mut scene = Scene::from_json(&value.to_string()).unwrap().tolerance(tolerance);
            scene.simulation.integrator = integrator;
            scene
        };
        let exact = scene(IntegratorKind::Radau, 1e-12);
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let off = difference(&scene(IntegratorKind::Taylor, tolerance), &exact);
            assert!(off < 1e2 * tolerance, "{}, {tolerance:e}: {off:e}", exact.name);
        }
    }
}

/// What a driver or a force does to masses that are shaken along a line is known wherever a table has a row, though the motion has far fewer
/// terms than its power: E − E₀ = W. (Beside the energies of the beginning, of 1e-13 J, W is rounded.)
#[test]
fn the_work_on_shaken_masses_is_known_within_steps() {
    let slider = json!({"name": "J", "type": "prismatic", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [0, 0, 1]});
    let driver = |value: &str| json!([{"name": "D", "type": "slide", "joint": "J", "motion": {"kind": "expression", "value": value}}]);
    let force = json!([{"name": "F", "type": "force", "body": "A", "point": [0, 0, 0],
        "force": {"kind": "components", "x": {"kind": "expression", "value": "10*sin(100*t)"}, "y": 0, "z": 0}}]);
    let spring = json!([{"name": "F", "type": "slider", "joint": "J", "stiffness": 100, "damping": 0.5,
        "force": {"kind": "expression", "value": "10*sin(50*t)"}}]);
    let none = || json!([]);
    // With about the largest energy, J.
    let scenes = [
        (json!([slider]), driver("0.1*sin(100*t)"), none(), 50.0),
        (json!([slider]), driver("0.1*sin(20*t)"), none(), 2.0),
        (json!([slider]), driver("t^9"), none(), 40.0),
        (json!([slider]), none(), spring, 10.0),
        (none(), none(), force, 0.02),
    ];
    for (joints, drivers, loads, size) in scenes {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let scene = json!({
                "name": "shaken", "gravity": [0, 0, if joints == none() { 0.0 } else { -9.81 }],
                "bodies": [{"name": "A", "mass": 1, "inertia": {"principal": [0.1, 0.11, 0.12]}}],
                "joints": joints, "drivers": drivers, "loads": loads,
                "simulation": {"duration": 1, "tolerance": tolerance, "integrator": "taylor"}
            });
            let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
            for row in 1..=100 {
                run.advance_to(0.01 * f64::from(row)).unwrap();
                let summary = run.summary();
                let off = summary.energy_drift.abs();
                assert!(
                    off < 10.0 * tolerance * size && (row < 100 || summary.doubts.is_empty()),
                    "{loads}, {drivers}, {tolerance:e}, row {row}: {off:e}, {:?}",
                    summary.doubts
                );
            }
        }
    }
}

/// Forces whose singularities in complex time are near: a step that went past them would leave out terms that hardly fall, and the first
/// of them would say little of its error.
#[test]
fn errors_of_sharp_forces_are_told() {
    let sharp = [
        "asin(0.999*sin(5*t))+atan(50*cos(t))+ln(1.001+cos(2*t))",
        "3*(exp(20*sin(4*t))-exp(-20*sin(4*t)))/(exp(20*sin(4*t))+exp(-20*sin(4*t)))",
    ];
    let (mut moments, mut few) = (0, 0);
    for text in sharp {
        let run = |integrator: IntegratorKind, tolerance: f64| {
            let value = json!({
                "name": "sharp", "gravity": [0, 0, 0],
                "bodies": [{"name": "A", "mass": 1, "inertia": {"principal": [0.1, 0.12, 0.13]}}],
                "joints": [{"name": "J", "type": "prismatic", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [1, 0, 0]}],
                "loads": [{"name": "F", "type": "slider", "joint": "J", "stiffness": 4, "damping": 0.3,
                    "force": {"kind": "expression", "value": text}}],
                "simulation": {"duration": 7}
            });
            let scene =
                Scene::from_json(&value.to_string()).unwrap().integrator(integrator).tolerance(tolerance);
            Simulation::new(&scene).unwrap()
        };
        let mut exact = run(IntegratorKind::Dop853, 1e-12);
        let mut runs = [1e-3, 1e-4, 1e-5].map(|tolerance| run(IntegratorKind::Taylor, tolerance));
        for k in 1..=240 {
            let t = f64::from(k) * 7.0 / 240.0;
            exact.advance_to(t).unwrap();
            for run in &mut runs {
                run.advance_to(t).unwrap();
                let [here, there] = [&*run, &exact].map(|run| run.frame().bodies[0].position[0]);
                let told = run.error_estimate().unwrap().position;
                moments += 1;
                few += usize::from((here - there).abs() > 3.0 * told);
            }
        }
    }
    assert!(few * 100 <= moments, "{few} of {moments} moments");
}
