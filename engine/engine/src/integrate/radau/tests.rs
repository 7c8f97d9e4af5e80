//! The orders of the methods, with steps of one size.

use super::coefficients::{ORDER_5, ORDER_9, ORDER_13, Tables};
use super::{OdeMethod, OdeSystem, Radau};

/// ẍ = 2 x³ and ÿ = −y, which x = 1/(1 + t) and y = cos t satisfy.
struct Known;

impl OdeSystem for Known {
    fn rhs(&mut self, _: f64, y: &[f64], rate: &mut [f64]) {
        rate.copy_from_slice(&[y[2], y[3], 2.0 * y[0] * y[0] * y[0], -y[1]]);
    }

    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}

/// How far a method is off after two seconds in so many steps.
fn off(tables: &'static Tables, steps: u32) -> f64 {
    let mut method = Radau::with_tables(tables, &mut Known, 0.0, &[1.0, 1.0, -1.0, 0.0], 1e-12);
    (method.fixed, method.h) = (true, 2.0 / f64::from(steps));
    while method.last.t < 2.0 {
        assert!(method.step(&mut Known, 2.0).is_ok());
    }
    let exact = [1.0 / 3.0, libm::cos(2.0), -1.0 / 9.0, -libm::sin(2.0)];
    method.last.y.iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn each_method_has_its_order() {
    for (tables, order, steps) in
        [(&ORDER_5, 5.0, [16, 32]), (&ORDER_9, 9.0, [8, 16]), (&ORDER_13, 13.0, [4, 8])]
    {
        let [coarse, fine] = steps.map(|steps| off(tables, steps));
        let observed = libm::log2(coarse / fine);
        assert!((observed - order).abs() < 0.9, "{order}: {coarse:.2e}, {fine:.2e}, {observed:.2}");
    }
}

/// What Newton's method leaves adds up from step to step, and grows with what x does to its neighbours.
#[test]
fn stages_are_solved_to_rounding_where_the_tolerance_is_near_it() {
    for (tables, steps) in [(&ORDER_9, 32), (&ORDER_13, 8), (&ORDER_13, 16)] {
        let off = off(tables, steps);
        assert!(off < 1e-12, "{steps} steps: {off:.2e}");
    }
}
