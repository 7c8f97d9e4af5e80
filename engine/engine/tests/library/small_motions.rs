//! Equilibria and modes of random mechanisms against references that were computed from their energies alone, without any equation
//! of motion: `../data/small_motions.py`.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use serde::Deserialize;
use std::f64::consts::TAU;
use triad_engine::analysis::{ModesAbout, equilibrium, modes};
use triad_engine::scene::Scene;

#[derive(Deserialize)]
struct Reference {
    /// Starts near its equilibrium.
    scene: serde_json::Value,
    /// Centres of mass at rest, m.
    centers: Vec<[f64; 3]>,
    /// Real and imaginary parts of the eigenvalues, of conjugates the upper one, 1/s; equal ones as often as they occur.
    eigenvalues: Vec<[f64; 2]>,
}

fn references() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/small-motions.json")).unwrap()
}

#[test]
fn random_mechanisms_come_to_rest_where_their_energy_is_least() {
    for Reference { scene, centers, .. } in references() {
        let name = &scene["name"];
        let found = equilibrium(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        assert_eq!(found.stable, Some(true), "{name}");
        let length = centers.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
        for (body, center) in found.bodies.iter().zip(&centers) {
            for (found, expected) in body.position.iter().zip(center) {
                assert!((found - expected).abs() < 1e-9 * length, "{name}: {found} instead of {expected}");
            }
        }
    }
}

#[test]
fn random_mechanisms_have_each_eigenvalue_as_often_as_it_occurs() {
    for Reference { scene, eigenvalues, .. } in references() {
        let name = &scene["name"];
        let found = modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Equilibrium).unwrap();
        let mut told: Vec<[f64; 2]> =
            found.modes.iter().map(|mode| [mode.growth, TAU * mode.frequency]).collect();
        assert_eq!(told.len(), eigenvalues.len(), "{name}: {told:?} instead of {eigenvalues:?}");
        // Each takes the nearest of those that are left.
        for expected in &eigenvalues {
            let distance = |x: &[f64; 2]| libm::hypot(x[0] - expected[0], x[1] - expected[1]);
            let nearest =
                (0..told.len()).min_by(|a, b| distance(&told[*a]).total_cmp(&distance(&told[*b]))).unwrap();
            let off = distance(&told.swap_remove(nearest));
            let size = libm::hypot(expected[0], expected[1]);
            assert!(off < 1e-8 * size, "{name}: {expected:?} is missed by {off}");
        }
    }
}
