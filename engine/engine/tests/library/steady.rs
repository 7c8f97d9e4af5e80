//! Modes about steady motions against closed forms: tops and rotors.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use serde_json::json;
use std::f64::consts::TAU;
use triad_engine::analysis::{Modes, ModesAbout, modes};
use triad_engine::scene::Scene;

const G: f64 = 9.81;

fn steady(text: &str) -> Modes {
    modes(&Scene::from_json(text).unwrap(), ModesAbout::Steady).unwrap()
}

fn same(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
    }
}

/// A top without an axis of symmetry, upright at the speed Ω, with the moments A, B, C about its tip:
/// A B λ⁴ + (A k₂ + B k₁ + (A + B − C)² Ω²) λ² + k₁ k₂ = 0, k₁ = (C − B) Ω² − m g l, k₂ = (C − A) Ω² − m g l. Of four roots with one modulus
/// two grow.
#[test]
fn an_unsymmetrical_top_may_grow_and_says_so() {
    let (a, b, c, speed) = (0.05 + 0.18, 0.07 + 0.18, 0.04, 40.0);
    let found = steady(
        r#"{"name": "top", "gravity": [0, 0, -9.81], "bodies": [{"name": "top", "mass": 2, "center_of_mass": [0, 0, 0.3],
            "inertia": {"principal": [0.05, 0.07, 0.04]}, "angular_velocity": [0, 0, 40]}],
            "joints": [{"name": "tip", "type": "spherical", "body_i": "ground", "body_j": "top", "point": [0, 0, 0]}]}"#,
    );
    let [k1, k2] = [b, a].map(|other| (c - other) * speed * speed - 2.0 * G * 0.3);
    let (twice, product) = (a * k2 + b * k1 + (a + b - c) * (a + b - c) * speed * speed, k1 * k2 / (a * b));
    // λ = ±σ ± iω: σ² + ω² is the root of the product, ω² − σ² half the coefficient.
    let (modulus, middle) = (product.sqrt(), 0.5 * twice / (a * b));
    let (omega, sigma) = ((0.5 * (modulus + middle)).sqrt(), (0.5 * (modulus - middle)).sqrt());
    assert_eq!(found.modes[0].kind, "drifts");
    // Their frequencies are equal but for rounding.
    let mut swings: Vec<_> = found.modes[1..].iter().collect();
    swings.sort_by(|a, b| a.growth.total_cmp(&b.growth));
    assert_eq!([swings[0].kind, swings[1].kind], ["oscillates", "grows"]);
    same(&[swings[0].growth, swings[1].growth], &[-sigma, sigma], 1e-9);
    same(&[swings[0].frequency, swings[1].frequency].map(|f| TAU * f), &[omega; 2], 1e-9);
}

/// A rotor in springs that turn with its shaft, whose dampers turn with it as well: m (r̈ + 2 Ω × ṙ − Ω² r) + d ṙ + k r = 0. Beyond the
/// critical speed √(k/m) nothing pushes it back.
#[test]
fn a_rotor_in_turning_springs_is_steady_on_its_axis() {
    let (m, spring, damper) = (2.0, 150.0, 3.0);
    for speed in [5.0, 20.0] {
        let loads: Vec<_> = [0.2f64, 0.2 + TAU / 3.0, 0.2 + 2.0 * TAU / 3.0]
            .iter()
            .enumerate()
            .map(|(k, angle)| {
                json!({ "type": "spring", "name": format!("s{k}"), "body_i": "shaft", "body_j": "rotor", "stiffness": spring,
                    "damping": damper, "point_i": [libm::cos(*angle), libm::sin(*angle), 0], "point_j": [0, 0, 0], "free_length": 0.6 })
            })
            .collect();
        let text = json!({ "name": "rotor", "gravity": [0, 0, 0],
            "bodies": [
                { "name": "rotor", "mass": m, "inertia": { "principal": [0.1, 0.13, 0.2] }, "angular_velocity": [0, 0, speed] },
                { "name": "shaft", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] } }],
            "joints": [
                { "name": "plane", "type": "planar", "body_i": "ground", "body_j": "rotor", "point": [0, 0, 0], "axis": [0, 0, 1] },
                { "name": "bearing", "type": "revolute", "body_i": "ground", "body_j": "shaft", "point": [0, 0, 0], "axis": [0, 0, 1] }],
            "drivers": [{ "type": "angle", "name": "motor", "joint": "bearing", "motion": { "kind": "ramp", "rate": speed } }],
            "loads": loads });
        let found = steady(&text.to_string());
        // With z = x + iy: λ² + (d/m + 2iΩ) λ + k/m − Ω² = 0: three springs are 3/2 of one along each direction, and their
        // tension, 0.4 of a stiffness, 3/2 of it across.
        let half = nalgebra::Complex::<f64>::new(0.75 * damper / m, speed);
        let root = nalgebra::ComplexField::sqrt(half * half - (1.5 * 1.4 * spring / m - speed * speed));
        let mut expected = [-half + root, -half - root].map(|value| (value.re, value.im.abs()));
        expected.sort_by(|a, b| a.1.total_cmp(&b.1));
        let told: Vec<_> = found.modes.iter().filter(|mode| mode.kind != "drifts").collect();
        assert_eq!(told.len(), 2, "{:?}", found.modes);
        for (mode, (growth, omega)) in told.iter().zip(expected) {
            assert!(
                (mode.growth - growth).abs() < 1e-8 && (TAU * mode.frequency - omega).abs() < 1e-8,
                "{mode:?}"
            );
        }
    }
}
