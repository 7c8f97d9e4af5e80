//! Given functions of time in the methods that know only values: no step goes over a pulse unseen, or over a rare break.

#![allow(clippy::unwrap_used, clippy::panic)]

use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

/// A free body of 2 kg on which a force along x acts.
fn pushed(force: &Value, integrator: &str, stabilization: &Value, tolerance: f64) -> Scene {
    let scene = json!({
        "name": "pushed", "gravity": [0, 0, 0],
        "bodies": [{"name": "b", "mass": 2, "inertia": {"principal": [1, 1.2, 1.3]}, "velocity": [1, 0, 0]}],
        "loads": [{"name": "f", "type": "force", "body": "b", "point": [0, 0, 0],
                   "force": {"kind": "components", "x": force, "y": 0, "z": 0}}],
        "simulation": {"duration": 10, "tolerance": tolerance, "integrator": integrator, "stabilization": stabilization}
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

fn at_end(scene: &Scene) -> (Simulation, [f64; 2]) {
    let mut run = Simulation::new(scene).unwrap();
    run.advance_to(10.0).unwrap();
    let body = &run.frame().bodies[0];
    let numbers = [body.position[0] - 10.0, body.velocity[0] - 1.0];
    (run, numbers)
}

/// A pulse of a millisecond after seven seconds of rest, and on a line, a parabola and a sine, whose series know nothing of it: the body
/// has its momentum afterwards.
#[test]
fn every_method_sees_a_short_pulse_wherever_it_stands() {
    let velocity = 0.5 * std::f64::consts::PI.sqrt();
    let (sine, cosine) = (libm::sin(10.0), libm::cos(10.0));
    let grounds = [
        ("0", [0.0, 0.0]),
        ("t", [1000.0 / 12.0, 25.0]),
        ("0.3*t^2", [125.0, 50.0]),
        ("sin(t)", [0.5 * (10.0 - sine), 0.5 * (1.0 - cosine)]),
    ];
    let projection = json!({"kind": "projection"});
    let cases = [
        ("taylor", projection.clone()),
        ("dop853", projection.clone()),
        ("dopri5", projection.clone()),
        ("ode45", projection.clone()),
        ("radau", projection.clone()),
        ("rattle", projection),
        ("dop853", json!({"kind": "partitioning"})),
        ("radau", json!({"kind": "partitioning"})),
        ("dop853", json!({"kind": "baumgarte", "alpha": 10, "beta": 10})),
        ("dop853", json!({"kind": "penalty"})),
        ("trapezoidal", json!({"kind": "augmented-lagrangian"})),
    ];
    let mut failed = Vec::new();
    for (ground, [far, fast]) in grounds {
        let pulse = json!({"kind": "expression", "value": format!("{ground}+1000*exp(-((t-7.3)/0.001)^2)")});
        for (integrator, stabilization) in &cases {
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let (run, [x, v]) = at_end(&pushed(&pulse, integrator, stabilization, tolerance));
                let off = (v - fast - velocity).abs().max((x - far - 2.7 * velocity).abs());
                let summary = run.summary();
                let case =
                    format!("{ground}, {integrator}, {stabilization}, {tolerance:e}: off by {off:.1e}");
                println!("{case}, {} + {} steps", summary.steps, summary.rejected);
                // Of order two, with the errors of many steps.
                let most = if *integrator == "trapezoidal" { 1e4 } else { 30.0 };
                if off > most * tolerance * (1.0 + far) {
                    failed.push(case);
                }
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Between the knots of a table the force is a cubic polynomial, which order eight integrates exactly: steps that end at the knots are as
/// exact as those of one cubic, and none is refused.
#[test]
fn steps_end_at_the_rare_knots_of_a_table() {
    let values = [0.0, 3.0, -2.0, 4.0, 0.0, -5.0];
    let table = json!({"kind": "table", "times": [0, 2, 4, 6, 8, 10], "values": values});
    let smooth = json!({"kind": "polynomial", "coefficients": [0, 3, -1, 0.1]});
    let projection = json!({"kind": "projection"});
    let exact = at_end(&pushed(&table, "taylor", &projection, 1e-12)).1;
    for integrator in ["dop853", "dopri5", "ode45"] {
        let (run, there) = at_end(&pushed(&table, integrator, &projection, 1e-9));
        let (plain, _) = at_end(&pushed(&smooth, integrator, &projection, 1e-9));
        let off = (there[0] - exact[0]).abs().max((there[1] - exact[1]).abs());
        let (summary, plain) = (run.summary(), plain.summary());
        println!(
            "{integrator}: off by {off:.1e}, {} + {} steps, of one cubic {} + {}",
            summary.steps, summary.rejected, plain.steps, plain.rejected
        );
        assert!(off < 1e-9 * (1.0 + exact[0].abs()), "{integrator}: off by {off:e}");
        assert!(summary.rejected <= plain.rejected + 2, "{integrator}: {} steps refused", summary.rejected);
    }
}
