//! Order of Radau's method, and steps of a stiff motion.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::integrate::{OdeMethod, Radau};
use triad_engine::ode::OdeSystem;

/// ÿ = −ẏ⁰ sin y − 0.3 ẏ + cos t: a damped, driven pendulum.
struct Pendulum;

impl OdeSystem for Pendulum {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        rate[0] = x[1];
        rate[1] = -libm::sin(x[0]) - 0.3 * x[1] + libm::cos(t);
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
    let mut integrator = Radau::with_step(&mut Pendulum, 0.0, &[1.0, 0.0], 1e-13, h);
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
