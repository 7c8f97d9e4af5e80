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
