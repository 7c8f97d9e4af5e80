//! The augmented system and the elimination of the rigid-body rows give the same accelerations.

use crate::common::{Random, random_scene, start};
use nalgebra::DVector;
use triad_engine::dynamics::elimination::Elimination;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::reactions::rigid_multipliers;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_engine::state::State;
use triad_engine::system::System;
use triad_engine::system::index::RowId;

/// Full, reduced or mixed coordinates, body by body.
const KINDS: [fn(usize) -> &'static str; 3] =
    [|_| "full", |_| "reduced", |body| if body % 2 == 0 { "full" } else { "reduced" }];

/// The elimination is exact at any state, also where the directors are not orthonormal and the velocities break every
/// constraint; a common vector is not, since the solver leaves out a row that depends on the others only where it holds.
#[test]
fn the_elimination_agrees_with_the_augmented_system_at_any_state() {
    for (seed, bodies) in (0..12).zip([2, 3, 4, 5, 6].into_iter().cycle()) {
        for kind in KINDS {
            let mut scene = random_scene(seed, bodies, kind);
            for joint in &mut scene.joints {
                joint.rows = joint.rows.map(|_| triad_engine::scene::AxisRows::TwoCar);
            }
            let (system, mut q, mut q_dot) = start(&scene);
            let mut random = Random::new(seed + 1000);
            for x in &mut q {
                *x += 0.05 * random.between(-1.0, 1.0);
            }
            for x in &mut q_dot {
                *x += random.between(-1.0, 1.0);
            }
            let mut acceleration = vec![0.0; q.len()];
            let state = State::at(&system, 0.0, &q, &q_dot);
            Elimination::new(&system).accelerate(&system, &state, (0.0, 0.0)).write(&mut acceleration);
            let solution = AugmentedSystem::new(&system, &state).solve().unwrap();
            let scale = 1.0 + solution.acceleration.amax();
            for (a, b) in acceleration.iter().zip(&solution.acceleration) {
                assert!((a - b).abs() < 1e-10 * scale, "seed {seed}: {a} {b}");
            }
        }
    }
}

/// A run's system, state and accelerations at its consistent start.
fn at_start(scene: &Scene, run: &Simulation) -> (System, State, Vec<f64>) {
    let (system, ..) = start(scene);
    let state = State::at(&system, 0.0, run.q(), run.q_dot());
    (system, state, run.accelerations())
}

/// With common vectors the two agree on the manifold, and so do the multipliers of all unique rows.
#[test]
fn the_elimination_agrees_with_the_augmented_system_on_the_manifold() {
    for (seed, bodies) in (0..12).zip([2, 3, 4, 5, 6].into_iter().cycle()) {
        for kind in KINDS {
            let scene = random_scene(seed, bodies, kind);
            let (system, state, acceleration) = at_start(&scene, &Simulation::new(&scene).unwrap());
            let mut elimination = Elimination::new(&system);
            let found = elimination.accelerate(&system, &state, (0.0, 0.0));
            let augmented = AugmentedSystem::new(&system, &state);
            let solution = augmented.solve().unwrap();
            let scale = 1.0 + solution.acceleration.amax();
            for (a, b) in acceleration.iter().zip(&solution.acceleration) {
                assert!((a - b).abs() < 1e-10 * scale, "seed {seed}: {a} {b}");
            }
            for row in &system.rows {
                if matches!(row.form, triad_engine::system::row::Form::CommonVector { .. }) {
                    continue;
                }
                let index = system.rows.iter().position(|r| r.equation == row.equation).unwrap();
                for (k, lambda) in found.multipliers.of_row(RowId(index)).iter().enumerate() {
                    let augmented = solution.multipliers[system.rigid_rows + row.equation + k];
                    assert!((lambda - augmented).abs() < 1e-8 * scale, "seed {seed}: {lambda} {augmented}");
                }
            }
        }
    }
}

/// With the rigid-body multipliers, every coordinate's equation of motion holds.
#[test]
fn rigid_body_multipliers_close_the_equations_of_motion() {
    for seed in 0..8 {
        for kind in KINDS {
            let scene = random_scene(seed, 4, kind);
            let (system, state, acceleration) = at_start(&scene, &Simulation::new(&scene).unwrap());
            let mut elimination = Elimination::new(&system);
            let found = elimination.accelerate(&system, &state, (0.0, 0.0));
            let augmented = AugmentedSystem::new(&system, &state);
            let rigid = rigid_multipliers(&found);
            let mut all: Vec<f64> = rigid.iter().flat_map(|body| body.rows.iter().map(|r| r.value)).collect();
            assert_eq!(all.len(), system.rigid_rows);
            for index in 0..system.rows.len() {
                all.extend(found.multipliers.of_row(RowId(index)));
            }
            let residual = &augmented.mass * DVector::from(acceleration)
                + augmented.jacobian.tr_mul(&DVector::from(all))
                - &augmented.force;
            assert!(residual.amax() < 1e-9, "seed {seed}: {}", residual.amax());
        }
    }
}
