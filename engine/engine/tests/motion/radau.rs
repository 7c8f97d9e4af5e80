//! Order of Radau's method, and steps of a stiff motion.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::integrate::{OdeMethod, RADAU_5, RADAU_9, RADAU_13, Radau, RadauTables};
use triad_engine::ode::OdeSystem;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

/// ÿ = −ẏ⁰ sin y − 0.3 ẏ + cos t: a damped, driven pendulum.
struct Pendulum;

impl OdeSystem for Pendulum {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        rate[0] = x[1];
        rate[1] = -libm::sin(x[0]) - 0.3 * x[1] + libm::cos(t);
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

/// ẍ = 2 x³ and ÿ = −y, which x = 1/(1 + t) and y = cos t satisfy.
struct Known;

impl OdeSystem for Known {
    fn rhs(&mut self, _: f64, y: &[f64], rate: &mut [f64]) {
        rate.copy_from_slice(&[y[2], y[3], 2.0 * y[0] * y[0] * y[0], -y[1]]);
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

/// ÿ = −k (y − cos t) − d ẏ with k = 1e10: follows cos t from any start.
struct Stiff;

impl OdeSystem for Stiff {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        rate[0] = x[1];
        rate[1] = -1e10 * (x[0] - libm::cos(t)) - 1e6 * x[1];
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

fn end(h: f64) -> f64 {
    let mut integrator = Radau::with_step(&RADAU_5, &mut Pendulum, 0.0, &[1.0, 0.0], 1e-13, h);
    while integrator.last().t < 2.0 - 0.5 * h {
        integrator.step(&mut Pendulum, 1e9).unwrap();
    }
    integrator.last().y[0]
}

#[test]
fn has_order_five() {
    let reference = end(1.0 / 128.0);
    let error = |h: f64| (end(h) - reference).abs();
    let order = libm::log2(error(0.25) / error(0.0625)) / 2.0;
    assert!((order - 5.0).abs() < 0.3, "{order}");
}

/// How far a method is off after two seconds in so many steps.
fn off(tables: &'static RadauTables, steps: u32) -> f64 {
    let h = 2.0 / f64::from(steps);
    let mut method = Radau::with_step(tables, &mut Known, 0.0, &[1.0, 1.0, -1.0, 0.0], 1e-12, h);
    while method.last().t < 2.0 - 0.5 * h {
        method.step(&mut Known, 1e9).unwrap();
    }
    let exact = [1.0 / 3.0, libm::cos(2.0), -1.0 / 9.0, -libm::sin(2.0)];
    method.last().y.iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn each_number_of_stages_has_its_order() {
    for (tables, order, steps) in
        // With more than seven steps of order 13 rounding is as large as the error.
        [(&RADAU_5, 5.0, [16, 32]), (&RADAU_9, 9.0, [8, 16]), (&RADAU_13, 13.0, [4, 7])]
    {
        let [coarse, fine] = steps.map(|steps| off(tables, steps));
        let observed = libm::log2(coarse / fine) / libm::log2(f64::from(steps[1]) / f64::from(steps[0]));
        assert!((observed - order).abs() < 0.9, "{order}: {coarse:.2e}, {fine:.2e}, {observed:.2}");
    }
}

/// What Newton's method leaves adds up from step to step, and grows with what x does to its neighbours.
#[test]
fn stages_are_solved_to_rounding_where_the_tolerance_is_near_it() {
    for (tables, steps) in [(&RADAU_9, 32), (&RADAU_13, 8), (&RADAU_13, 16)] {
        let off = off(tables, steps);
        assert!(off < 1e-12, "{steps} steps: {off:.2e}");
    }
}

#[test]
fn a_stiff_motion_costs_few_steps() {
    let mut integrator = Radau::new(&mut Stiff, 0.0, &[1.5, 0.0], 1e-8);
    while integrator.last().t < 10.0 {
        integrator.step(&mut Stiff, 10.0).unwrap();
    }
    let expected = libm::cos(10.0f64) + 1e-4 * libm::sin(10f64);
    assert!((integrator.last().y[0] - expected).abs() < 1e-7, "{:?}", integrator.last().y);
    // The estimate is of order three: steps of about 1e-8 to the power 1/4 each.
    assert!(integrator.last().steps.accepted < 600, "{:?}", integrator.last().steps);
}

/// A mechanism that passes next to its change point: the second solution, in steps of its own, comes to where it goes on by ever shorter ones.
/// It is given up, and the run ends as if it had none: it took minutes.
#[test]
fn a_second_solution_that_gets_nowhere_is_given_up() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/nearly-parallelogram.json");
    let scene = Scene::from_json(&std::fs::read_to_string(file).unwrap()).unwrap();
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(0.9).unwrap();
    assert!(run.summary().steps < 1000, "{:?}", run.summary().steps);
    assert!(run.error_unknown_from().unwrap() > 0.3);
    let told = run.summary().doubts.concat();
    assert!(told.contains("the second solution that it is read off cannot go on"), "{told}");
}
