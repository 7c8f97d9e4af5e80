//! Steps of the series are the same with every set of instructions, and a part of one the same as if it had been asked for at once.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use pulp::Arch;
use triad_engine::catalogue;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::dynamics::series::{IslandSeries, StepPlan};
use triad_engine::model::Model;
use triad_engine::system::{System, planar};

/// A built-in scene's system and its start.
fn started(name: &str) -> (System, Vec<f64>) {
    let scene = catalogue::scene(name).unwrap();
    let system = Mechanism::new(System::new(Model::new(&scene).unwrap())).system;
    let mut y = vec![0.0; 2 * system.coordinates];
    let (q, q_dot) = y.split_at_mut(system.coordinates);
    system.start(q, q_dot);
    (system, y)
}

/// Products and sums are fused whether the processor does it or not.
#[test]
fn every_set_of_instructions_gives_the_same_bits() {
    for name in ["spatial-chain:5", "spatial-slider-crank", "bricard", "heavy-top", "n-four-bar:2"] {
        let (system, y) = started(name);
        let system = &system;
        let q = &y[..system.coordinates];
        let flat = planar::recognize(system, q).ok().map(|plane| plane.reduce(system.clone(), q).unwrap());
        assert_eq!(flat.is_some(), name == "n-four-bar:2");
        let system = flat.as_ref().unwrap_or(system);
        let own =
            if flat.is_some() { IslandSeries::in_plane } else { IslandSeries::in_space }(system, 12, &[]);
        compare(name, system, own, y);
    }
}

/// A part of a step that was taken back is the step that would have been taken at once, with the same error carried along.
#[test]
fn a_step_taken_back_serves_for_a_part_of_it() {
    for name in ["spatial-chain:5", "spatial-slider-crank", "bricard", "rssr", "crank-rocker"] {
        let (system, y) = started(name);
        let system = &system;
        let mut own = IslandSeries::in_space(system, 12, &[0.0; 8][..system.angle_joints.len()]);
        own.place(system, 0.0, &y);
        own.carry_errors(system);
        own.linearize();
        let mut plan =
            StepPlan { order: 12, tolerance: 1e-6, length: system.length, end: 1.0, dry_run: false };
        let start = (0..3).map(|_| own.step(plan).time).last().unwrap();
        let mut fresh = own.clone();
        let whole = own.step(plan);
        own.go_back(start);
        plan.end = start + 0.6 * whole.h;
        let (again, at_once) = (own.step(plan), fresh.step(plan));
        assert_eq!(own.counters().evaluations, fresh.counters().evaluations, "{name}: expanded once");
        assert_eq!((again.h, again.order), (at_once.h, at_once.order), "{name}");
        let [mut a, mut b] = [(); 2].map(|()| y.clone());
        own.store(system, &mut a);
        fresh.store(system, &mut b);
        assert_eq!(a, b, "{name}");
        assert!(own.error(system, again.h, &mut a) && fresh.error(system, again.h, &mut b));
        let largest = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let off = a.iter().zip(&b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(largest > 0.0 && off <= 1e-2 * largest, "{name}: {off:e} of {largest:e}");
    }
}

fn compare(name: &str, system: &System, mut own: IslandSeries, mut y: Vec<f64>) {
    let mut plain = own.clone();
    plain.restrict(Arch::Scalar);
    let plan = StepPlan { order: 12, tolerance: 1e-9, length: system.length, end: 1.0, dry_run: false };
    for series in [&mut own, &mut plain] {
        series.place(system, 0.0, &y);
        series.carry_errors(system);
        series.linearize();
    }
    let mut other = y.clone();
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
    for _ in 0..5 {
        let [step, same_step] = [&mut own, &mut plain].map(|series| series.step(plan));
        assert_eq!(step.h.to_bits(), same_step.h.to_bits(), "{name}");
        for part in [0.4, 1.0] {
            let tau = part * step.h;
            own.interpolate(system, tau, step.order, &mut y);
            plain.interpolate(system, tau, step.order, &mut other);
            assert!(same(&y, &other), "{name}: within a step");
            assert!(own.error(system, tau, &mut y) && plain.error(system, tau, &mut other));
            assert!(same(&y, &other) && y.iter().any(|x| *x != 0.0), "{name}: the error");
        }
        own.linearize();
        plain.linearize();
        assert_eq!(own.correct_positions().to_bits(), plain.correct_positions().to_bits(), "{name}");
        own.store(system, &mut y);
        plain.store(system, &mut other);
        assert!(same(&y, &other), "{name}: at its end");
    }
}
