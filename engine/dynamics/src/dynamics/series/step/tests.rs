//! Steps are the same with every set of instructions, and a part of one the same as if it had been asked for at once.

use super::super::Planar;
use super::*;
use crate::constraints::mechanism::Mechanism;
use crate::model::Model;
use crate::scene::catalogue;
use crate::system::{System, planar};

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
        match flat {
            Some(flat) => compare(name, &flat, Series::<4, Planar<4>>::planar(&flat, 12, &[]), y),
            None if name == "heavy-top" => compare(name, system, Series::single(system, 12, &[]), y),
            None => compare(name, system, Series::<4>::new(system, 12, &[]), y),
        }
    }
}

/// A part of a step that was taken back is the step that would have been taken at once, with the same error carried along.
#[test]
fn a_step_taken_back_serves_for_a_part_of_it() {
    for name in ["spatial-chain:5", "spatial-slider-crank", "bricard", "rssr", "crank-rocker"] {
        let (system, y) = started(name);
        let system = &system;
        let mut own = Series::<4>::new(system, 12, &[0.0; 8][..system.angle_joints.len()]);
        own.place(system, 0.0, &y);
        own.carry_errors(system);
        own.linearize();
        let mut plan =
            StepPlan { order: 12, tolerance: 1e-6, length: system.length, end: 1.0, dry_run: false };
        for _ in 0..3 {
            own.step(plan);
        }
        let (start, mut fresh) = (own.time, own.clone());
        let whole = own.step(plan);
        own.go_back(start);
        plan.end = start + 0.6 * whole.h;
        let (again, at_once) = (own.step(plan), fresh.step(plan));
        assert_eq!(own.counters.evaluations, fresh.counters.evaluations, "{name}: expanded once");
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

fn compare<const L: usize, B: Bodies<L>>(
    name: &str,
    system: &System,
    mut own: Series<L, B>,
    mut y: Vec<f64>,
) {
    own.place(system, 0.0, &y);
    own.linearize();
    let mut plain = own.clone();
    let plan = StepPlan { order: 12, tolerance: 1e-9, length: system.length, end: 1.0, dry_run: false };
    for _ in 0..5 {
        let taken = own.step(plan);
        assert_eq!(taken.h.to_bits(), Step(&mut plain, plan).with_simd(pulp::Scalar::new()).h.to_bits());
        for part in [Part::Linearize, Part::Correct(0), Part::Correct(1)] {
            let moved = Call(&mut plain, part).with_simd(pulp::Scalar::new());
            assert_eq!(own.call(part).to_bits(), moved.to_bits(), "{name}: {part:?}");
        }
    }
    let mut other = y.clone();
    own.store(system, &mut y);
    plain.store(system, &mut other);
    assert!(y.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
}
