//! Formulas in t that pass numbers too large to be written, and those that have no power series.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::json;
use triad_engine::model::motion::{MAX_TERMS, TimeFormula};
use triad_engine::prelude::*;

/// Exponentials beyond all numbers leave nothing of what is divided by them; poles do, and what is itself beyond has no value.
#[test]
fn what_is_divided_by_more_than_a_number_can_hold_is_zero() {
    let smooth = [
        "1/(1+exp(-2000*(t-0.5)))",
        "5/(1 + 2*exp(-2000*(t-0.5))/3)",
        "(2 - t)/(1 + t + 3*exp(700 - 800 t)*exp(700*(1 - t)))",
        "(1 + exp(1500 - 2000 t))^-2",
        "1/sqrt(1 + exp(1500 - 2000 t))",
        "exp(-exp(1500 - 2000 t))",
        "atan(exp(1500 - 2000 t))",
        "1/(1 + 2^(2000 - 3000 t))",
    ];
    for text in smooth {
        let formula = TimeFormula::parse(text).unwrap();
        assert_eq!(formula.undefined_until(1.0), None, "{text}");
        // Through the range of numbers no coefficient is lost.
        for k in 0..=5000 {
            let mut series = [0.0; MAX_TERMS];
            formula.expand(f64::from(k) / 5000.0, &mut series);
            assert!(series.iter().all(|c| c.is_finite()), "{text} at {k}: {series:?}");
        }
    }
    let mut series = [0.0; MAX_TERMS];
    TimeFormula::parse(smooth[0]).unwrap().expand(0.0, &mut series);
    assert_eq!(series, [0.0; MAX_TERMS]);
    let without_series = [
        "exp(2000 t)",
        "1/(1/t)",
        "1/(1/(-t^2))",
        "1/ln(t)",
        "exp(1/t)",
        "t*exp(1000 - t)",
        "1/ln(1 + exp(1000 - t))",
        "1/(exp(720 - t)*exp(t - 720))",
        "1/exp(1000 - t)^0.01",
        "1/t^-0.5",
        "t^2.5",
        "t^0.5",
    ];
    for text in without_series {
        assert!(TimeFormula::parse(text).unwrap().undefined_until(1.0).is_some(), "{text}");
    }
}

/// A load that is switched on by such a formula does what a step at that time does; one without a series is told so, with what to do.
#[test]
fn a_load_is_switched_on_by_a_steep_formula() {
    let pushed = |force: &str, integrator: &str| {
        let scene = json!({
            "name": "switch", "gravity": [0, 0, 0], "bodies": [{ "name": "m", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] } }],
            "joints": [{ "name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "m", "point": [0, 0, 0], "axis": [1, 0, 0] }],
            "loads": [{ "name": "f", "type": "slider", "joint": "rail", "force": { "kind": "expression", "value": force } }],
            "simulation": { "duration": 1, "integrator": integrator },
        });
        Simulation::new(&Scene::from_json(&scene.to_string()).unwrap())
    };
    for integrator in ["taylor", "dop853", "radau"] {
        let mut run = pushed("1/(1+exp(-2000*(t-0.5)))", integrator).unwrap();
        run.advance_to(1.0).unwrap();
        // The integral of the logistic function is ln(1 + exp(x))/2000, and that of the integral differs from t²/2 by π²/6 of its width
        // squared.
        let body = &run.frame().bodies[0];
        let width = 1.0 / 2000.0f64;
        let place = 0.125 + std::f64::consts::PI * std::f64::consts::PI * width * width / 6.0;
        assert!((body.velocity[0] - 0.5).abs() < 1e-8, "{integrator}: {}", body.velocity[0] - 0.5);
        assert!((body.position[0] - place).abs() < 1e-8, "{integrator}: {}", body.position[0] - place);
    }
    let error = pushed("t^2.5", "auto").unwrap_err();
    assert!(error.to_string().contains("its formula has no power series at t = 0.0"), "{error}");
    assert!(error.hint().contains("Change the formula"), "{}", error.hint());
}
