//! Orders of the methods and of their dense output, on an equation with a known solution.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::integrate::{DOP853, DOPRI5, Explicit, OdeMethod, Tableau};
use triad_engine::ode::OdeSystem;

/// ẏ = (y₂, −y₁ + t): y = (sin t + t, cos t + 1) from (0, 2).
struct Oscillator;

impl OdeSystem for Oscillator {
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        rate[0] = y[1];
        rate[1] = -y[0] + t;
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

fn run(tableau: &'static Tableau, h: f64) -> Explicit {
    let mut integrator = Explicit::with_step(tableau, &mut Oscillator, 0.0, &[0.0, 2.0], h);
    while integrator.last().t < 2.0 {
        OdeMethod::step(&mut integrator, &mut Oscillator, 2.0).unwrap();
    }
    integrator
}

/// Orders of the end of a step and of the dense output, the step going from `h` to a part of it.
fn orders(tableau: &'static Tableau, h: f64) -> (f64, f64) {
    let end = |h: f64| (run(tableau, h).last().y[0] - (libm::sin(2f64) + 2.0)).abs();
    let inside = |h: f64| {
        let mut integrator = run(tableau, h);
        let mut worst: f64 = 0.0;
        for part in 1..20 {
            let t = 2.0 - h * f64::from(part) / 20.0;
            let mut y = [0.0; 2];
            OdeMethod::interpolate(&mut integrator, &mut Oscillator, t, &mut y);
            worst = worst.max((y[0] - libm::sin(t) - t).abs());
        }
        worst
    };
    (libm::log2(end(h) / end(h / 4.0)) / 2.0, libm::log2(inside(h) / inside(h / 2.0)))
}

#[test]
fn dop853_has_order_eight_and_dense_output_of_order_seven() {
    let (end, inside) = orders(&DOP853, 0.5);
    assert!((end - 8.0).abs() < 0.3, "{end}");
    assert!((7.0..9.0).contains(&inside), "{inside}");
}

#[test]
fn dopri5_has_order_five_and_dense_output_of_order_four() {
    let end = orders(&DOPRI5, 0.125).0;
    assert!((end - 5.0).abs() < 0.3, "{end}");
    let inside = orders(&DOPRI5, 0.25).1;
    assert!((4.0..6.2).contains(&inside), "{inside}");
}

#[test]
fn all_meet_the_end_exactly_and_the_estimate_bounds_the_error() {
    let y = [0.0, 2.0];
    for mut integrator in [
        Explicit::new(&DOP853, &mut Oscillator, 0.0, &y, 1e-9),
        Explicit::new(&DOPRI5, &mut Oscillator, 0.0, &y, 1e-9),
        Explicit::ode45(&mut Oscillator, 0.0, &y, 1e-9, 3.0),
    ] {
        while integrator.last().t < 3.0 {
            OdeMethod::step(&mut integrator, &mut Oscillator, 3.0).unwrap();
        }
        assert_eq!(integrator.last().t, 3.0);
        assert!((integrator.last().y[0] - libm::sin(3f64) - 3.0).abs() < 1e-7);
    }
}
