//! Prescribed functions of time: derivatives, power series, and where formulas end.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use nalgebra::Vector3;
use triad_engine::model::motion::{Curve, MAX_TERMS, TimeFormula, TimeFormulaError, VectorCurve};
use triad_engine::scene::Motion;
use triad_engine::scene::expression::Function;

/// From 1 to 3 between 0.5 and 2 s.
fn smooth_step() -> Curve {
    Curve::new(&Motion::SmoothStep { from: 1.0, to: 3.0, start: 0.5, end: 2.0 }).unwrap()
}

fn spline(x: &[f64], y: &[f64]) -> Curve {
    Curve::new(&Motion::Table { times: x.to_vec(), values: y.to_vec() }).unwrap()
}

fn check(curve: &Curve, times: &[f64]) {
    let h = 1e-4;
    for &t in times {
        let [_, rate, acceleration] = curve.at(t);
        let (before, after) = (curve.at(t - h), curve.at(t + h));
        let scale = 1.0 + acceleration.abs();
        assert!(((after[0] - before[0]) / (2.0 * h) - rate).abs() < 1e-6 * scale, "rate at {t}");
        assert!(((after[1] - before[1]) / (2.0 * h) - acceleration).abs() < 1e-5 * scale, "at {t}");
    }
}

#[test]
fn derivatives_are_those_of_the_values() {
    let times = [-1.3, 0.31, 0.77, 1.2, 1.9, 3.3];
    check(&Curve::Polynomial(vec![0.3, -1.0, 2.0, 0.5]), &times);
    check(&Curve::Harmonic { mean: 1.0, amplitude: 2.0, frequency: 3.0, phase: 0.4 }, &times);
    check(&smooth_step(), &times);
    check(&spline(&[0.0, 0.5, 1.5, 2.0], &[1.0, -1.0, 2.0, 0.0]), &times);
}

#[test]
fn a_spline_meets_its_points_and_a_step_its_ends() {
    let (x, y) = ([0.0, 0.5, 1.5, 2.0], [1.0, -1.0, 2.0, 0.0]);
    let spline = spline(&x, &y);
    for (x, y) in x.iter().zip(y) {
        assert!((spline.at(*x)[0] - y).abs() < 1e-14);
        assert!((spline.at(x - 1e-12)[2] - spline.at(x + 1e-12)[2]).abs() < 1e-9);
    }
    let step = smooth_step();
    assert_eq!(step.at(-7.0), [1.0, 0.0, 0.0]);
    assert_eq!(step.at(9.0), [3.0, 0.0, 0.0]);
    assert!((step.at(2.0 - 1e-9)[0] - 3.0).abs() < 1e-12);
}

#[test]
fn a_turning_vector_keeps_its_length() {
    let start = Vector3::new(0.3, -0.2, 0.9);
    let axis = Vector3::new(1.0, 2.0, -0.5).normalize();
    let curve = VectorCurve::turning(&start, &axis, Curve::Polynomial(vec![0.1, 2.0, -0.3]));
    let h = 1e-5;
    for t in [0.0, 0.7, 2.0] {
        let [value, rate, acceleration] = curve.at(t);
        assert!((value.norm() - start.norm()).abs() < 1e-15);
        let difference = (curve.at(t + h)[0] - curve.at(t - h)[0]) / (2.0 * h);
        assert!((difference - rate).norm() < 1e-8);
        let difference = (curve.at(t + h)[1] - curve.at(t - h)[1]) / (2.0 * h);
        assert!((difference - acceleration).norm() < 1e-7);
    }
}

/// The value at t + τ by the series about t, against the value itself.
#[test]
fn series_of_all_functions_sum_to_their_values() {
    for text in [
        "asin(0.1*sin(10*t))",
        "acos(t/3) + atan(2 t)",
        "tan(t/2)",
        "exp(-t) * cos(3 t)",
        "ln(2 + t)/t^2",
        "sqrt(1 + t^2)",
        "t^3 - 2 t^-1",
        "(1 + t)^1.7",
        "2^t",
        "(1 + t)^t",
        "ellipk(1/2) * t",
        "-(t - 5)^2",
    ] {
        let formula = TimeFormula::parse(text).unwrap();
        let (t, tau) = (0.8, 0.05);
        let (mut series, mut there) = ([0.0; MAX_TERMS], [0.0; 1]);
        formula.expand(t, &mut series);
        formula.expand(t + tau, &mut there);
        let sum = series.iter().rev().fold(0.0, |sum, c| sum * tau + c);
        assert!((sum - there[0]).abs() < 1e-13 * (1.0 + sum.abs()), "{text}: {sum} and {}", there[0]);
        assert_eq!(
            formula.undefined_until(0.8).is_some(),
            text.contains("t^-1") || text.contains("/t^2"),
            "{text}"
        );
    }
}

#[test]
fn where_a_formula_ends_is_found() {
    let until = |text: &str| TimeFormula::parse(text).unwrap().undefined_until(2.0).unwrap();
    assert!((until("asin(2 sin(t))") - std::f64::consts::FRAC_PI_6).abs() < 1e-9);
    assert!((until("sqrt(1.234567 - t)") - 1.234_567).abs() < 1e-9);
    assert!((until("1/(t - 0.33333)") - 0.333_33).abs() < 1e-12);
    assert!((until("tan(t)") - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    assert_eq!(until("ln(t)"), 0.0);
}

#[test]
fn what_is_not_smooth_is_refused() {
    assert_eq!(
        TimeFormula::parse("abs(sin(t))"),
        Err(TimeFormulaError::NotSmooth { function: Function::Abs })
    );
    assert!(TimeFormula::parse("abs(-3) * t").is_ok());
    assert!(TimeFormula::parse("3 x").unwrap_err().to_string().contains("known are t"));
}
