//! A method of order p is exact on polynomials of degree p, and its dense output on those of its own order.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::integrate::{DOP853, DOPRI5, Explicit, OdeMethod, RADAU_5, Radau, Tableau};
use triad_engine::ode::OdeSystem;

/// Start of the runs, s: not zero, so that t enters.
const START: f64 = 0.3;
/// Their end, s: two steps later.
const END: f64 = 2.3;
/// Their fixed step, s.
const STEP: f64 = 1.0;
/// Relative error below which a method is exact. Measured: 6e-14 for the dense output of DOP853, 2e-14 at most elsewhere.
const ROUNDING: f64 = 1e-12;
/// Relative error above which it is not. Measured for one degree more: from 2e-3 at the end of DOP853's steps.
const CLEARLY_WRONG: f64 = 1e-4;

/// y_k = tᵏ for k = 0 to the highest degree, twice: as an integral, ẏ_k = k tᵏ⁻¹, and as a chain, ẏ_k = k y_(k−1).
/// Together they need the order conditions of quadrature and those of linear systems.
struct Powers {
    degree: i32,
}

impl Powers {
    fn state(&self, t: f64) -> Vec<f64> {
        let powers = (0..=self.degree).map(|k| libm::pow(t, f64::from(k)));
        powers.clone().chain(powers).collect()
    }
}

impl OdeSystem for Powers {
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        let (integrals, chain) = rate.split_at_mut(y.len() / 2);
        (integrals[0], chain[0]) = (0.0, 0.0);
        for k in 1..=self.degree {
            let at = usize::try_from(k).unwrap();
            integrals[at] = f64::from(k) * libm::pow(t, f64::from(k - 1));
            chain[at] = f64::from(k) * y[y.len() / 2 + at - 1];
        }
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

/// The same as equations of second order, x = (η, η̇) with η_k = tᵏ, k from 2 on, η̈_k = k (k − 1) tᵏ⁻² and
/// η̈_k = k (k − 1) η_(k−2).
struct SecondOrder {
    degree: i32,
}

impl SecondOrder {
    fn state(&self, t: f64) -> Vec<f64> {
        let places = (0..=self.degree).map(|k| libm::pow(t, f64::from(k)));
        let rates = (0..=self.degree).map(|k| f64::from(k) * libm::pow(t, f64::from((k - 1).max(0))));
        places.clone().chain(places).chain(rates.clone()).chain(rates).collect()
    }
}

impl OdeSystem for SecondOrder {
    fn rhs(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        let f = x.len() / 2;
        rate[..f].copy_from_slice(&x[f..]);
        rate[f..].fill(0.0);
        for k in 2..=self.degree {
            let at = usize::try_from(k).unwrap();
            let factor = f64::from(k * (k - 1));
            rate[f + at] = factor * libm::pow(t, f64::from(k - 2));
            rate[f + f / 2 + at] = factor * x[f / 2 + at - 2];
        }
    }
    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

/// Largest relative error at the end of steps, and within them.
fn errors(
    mut method: impl OdeMethod,
    system: &mut impl OdeSystem,
    exact: impl Fn(f64) -> Vec<f64>,
) -> [f64; 2] {
    let error = |t: f64, y: &[f64]| {
        let relative = exact(t).into_iter().zip(y).map(|(exact, y)| (y - exact).abs() / exact.abs().max(1.0));
        relative.fold(0.0, f64::max)
    };
    let [mut ends, mut inside] = [0.0f64; 2];
    let mut y = method.last().y.clone();
    while method.last().t < END {
        method.step(system, END).unwrap();
        ends = ends.max(error(method.last().t, &method.last().y));
        for part in [0.2, 0.5, 0.9] {
            let t = method.last().t - part * method.last().h;
            method.interpolate(system, t, &mut y);
            inside = inside.max(error(t, &y));
        }
    }
    [ends, inside]
}

fn explicit(tableau: &'static Tableau, degree: u32) -> [f64; 2] {
    let mut powers = Powers { degree: degree.cast_signed() };
    let start = powers.state(START);
    let method = Explicit::with_step(tableau, &mut powers, START, &start, STEP);
    let exact = Powers { degree: powers.degree };
    errors(method, &mut powers, |t| exact.state(t))
}

fn radau(degree: u32) -> [f64; 2] {
    let mut powers = SecondOrder { degree: degree.cast_signed() };
    let start = powers.state(START);
    let method = Radau::with_step(&RADAU_5, &mut powers, START, &start, 1e-13, STEP);
    let exact = SecondOrder { degree: powers.degree };
    errors(method, &mut powers, |t| exact.state(t))
}

#[test]
fn explicit_methods_are_exact_to_their_orders_and_no_further() {
    for (tableau, dense) in [(&DOP853, 7), (&DOPRI5, 4)] {
        let order = tableau.order;
        let [end, beyond] = [order, order + 1].map(|degree| explicit(tableau, degree)[0]);
        assert!(end < ROUNDING && beyond > CLEARLY_WRONG, "order {order}: {end:e}, {beyond:e}");
        let [inside, beyond] = [dense, dense + 1].map(|degree| explicit(tableau, degree)[1]);
        assert!(inside < ROUNDING && beyond > CLEARLY_WRONG, "order {order}, inside: {inside:e}, {beyond:e}");
    }
}

#[test]
fn radau_is_exact_to_order_five_and_its_dense_output_to_order_three() {
    let [end, beyond] = [Radau::ORDER, Radau::ORDER + 1].map(|degree| radau(degree)[0]);
    assert!(end < ROUNDING && beyond > CLEARLY_WRONG, "{end:e}, {beyond:e}");
    let [inside, beyond] = [3, 4].map(|degree| radau(degree)[1]);
    assert!(inside < ROUNDING && beyond > CLEARLY_WRONG, "inside: {inside:e}, {beyond:e}");
}
