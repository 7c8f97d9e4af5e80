//! The matrices that a student sees: the augmented matrix, S, and what their factorizations fill.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use nalgebra::DMatrix;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::model::Model;
use triad_engine::prelude::*;
use triad_engine::reactions::matrices::{Symmetric, augmented, schur};

fn mechanism(name: &str) -> Mechanism {
    let model = Model::new(&catalogue::scene(name).unwrap()).unwrap();
    let (mut mechanism, y) = Mechanism::from_model(model);
    mechanism.set_state(0.0, &y);
    mechanism
}

fn dense(matrix: &Symmetric) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(matrix.names.len(), matrix.names.len());
    for place in &matrix.places {
        assert!(place.column <= place.row);
        dense[(place.row, place.column)] = place.value;
        dense[(place.column, place.row)] = place.value;
    }
    dense
}

/// Where a dense factorization without reordering leaves anything.
fn touched(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut left = matrix.clone();
    for k in 0..left.nrows() {
        for i in k + 1..left.nrows() {
            let factor = left[(i, k)] / left[(k, k)];
            for j in k + 1..left.ncols() {
                left[(i, j)] -= factor * left[(k, j)];
            }
        }
    }
    left
}

#[test]
fn the_augmented_matrix_is_that_of_the_augmented_system() {
    let mechanism = mechanism("n-four-bar:3");
    let matrix = dense(&augmented(&mechanism.system, &mechanism.state));
    let augmented = AugmentedSystem::new(&mechanism.system, &mechanism.state);
    let n = mechanism.system.coordinates;
    let rows = augmented.jacobian.nrows();
    assert_eq!(matrix.view((0, 0), (n, n)), augmented.mass);
    assert_eq!(matrix.view((n, 0), (rows, n)), augmented.jacobian);
    assert!(matrix.view((n, n), (rows, rows)).iter().all(|x| *x == 0.0), "fill is no number");
}

#[test]
fn a_factorization_leaves_nothing_outside_of_the_pattern_with_its_fill() {
    for name in ["n-four-bar:4", "spatial-slider-crank", "spatial-double-pendulum"] {
        let mut mechanism = mechanism(name);
        let matrix = schur(&mechanism.system, &mechanism.state, &mut mechanism.elimination);
        assert_eq!(matrix.names.len(), mechanism.system.solver_rows, "{name}");
        let mut with_fill = DMatrix::<f64>::zeros(matrix.names.len(), matrix.names.len());
        for place in &matrix.places {
            with_fill[(place.row, place.column)] = 1.0;
        }
        let mut full = dense(&matrix);
        for k in 0..full.nrows() {
            full[(k, k)] *= 1.0 + 1e-3;
        }
        let left = touched(&full);
        for i in 0..left.nrows() {
            for j in 0..=i {
                assert!(with_fill[(i, j)] == 1.0 || left[(i, j)] == 0.0, "{name} {i} {j}: {}", left[(i, j)]);
            }
        }
    }
}

/// Balls that hang together by spherical joints, each on the next; the last on the first if they form a ring.
fn string_of_balls(ring: bool) -> Scene {
    let mut scene = Scene::new("balls");
    let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0], [-0.5, 0.5, 0.1]];
    for (k, place) in places.into_iter().enumerate() {
        scene.add(Body::sphere(format!("{k}"), 1.0, 0.1, place));
    }
    for k in 0..if ring { 5 } else { 4 } {
        let [a, b] = [k, (k + 1) % 5];
        let middle = [0, 1, 2].map(|c| 0.5 * (places[a][c] + places[b][c]));
        scene.add(Joint::spherical(format!("{a}-{b}"), format!("{a}"), format!("{b}")).at(middle));
    }
    scene
}

#[test]
fn a_ring_of_joints_has_fill_and_a_chain_has_none() {
    let fill = |ring: bool| Simulation::new(&string_of_balls(ring)).unwrap().state().schur().fill();
    // Five blocks in a ring: two of the others join when their neighbours are eliminated.
    assert_eq!((fill(false), fill(true)), (0, 2 * 9));
}
