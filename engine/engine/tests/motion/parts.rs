//! The small parts of integrators that no program sees, tested by themselves: their sources are read in here, so that the
//! library need not be compiled once more for its own tests.

#[allow(dead_code, reason = "the tests use some of it")]
#[path = "../../src/integrate/hermite.rs"]
mod hermite;
#[path = "../../../dynamics/src/dynamics/elimination/friction/least.rs"]
mod least;
#[allow(dead_code, reason = "the tests use some of it")]
#[path = "../../src/integrate/integrator/progress.rs"]
mod progress;
#[allow(dead_code, reason = "the tests use some of it")]
#[path = "../../src/integrate/step.rs"]
mod step;

use hermite::{cubic, quintic};
use least::least_friction;
use nalgebra::Vector3;
use progress::ProgressMonitor;
use step::StepRecord;

/// x^n − x and its first two derivatives.
fn p(n: i32, x: f64) -> [f64; 3] {
    let n_real = f64::from(n);
    [
        libm::pow(x, f64::from(n)) - x,
        n_real * libm::pow(x, f64::from(n - 1)) - 1.0,
        n_real * (n_real - 1.0) * libm::pow(x, f64::from(n - 2)),
    ]
}

/// Largest error of value and rate of an interpolant of x^n − x from x = 1 to 3.
fn error(n: i32, interpolant: impl Fn([f64; 3], [f64; 3], f64) -> (f64, f64)) -> f64 {
    let parts = [0.0, 0.3, 0.5, 0.9, 1.0];
    let errors = parts.map(|s| {
        let (value, rate) = interpolant(p(n, 1.0), p(n, 3.0), s);
        let [expected, slope, _] = p(n, 1.0 + 2.0 * s);
        (value - expected).abs().max((rate - slope).abs())
    });
    errors.into_iter().fold(0.0, f64::max)
}

#[test]
fn the_cubic_is_exact_for_degree_three_and_no_higher() {
    let cubic = |a: [f64; 3], b: [f64; 3], s| cubic([a[0], a[1]], [b[0], b[1]], 2.0, s);
    for n in 1..=3 {
        assert!(error(n, cubic) < 1e-13, "{n}");
    }
    assert!(error(4, cubic) > 0.1);
}

#[test]
fn the_quintic_is_exact_for_degree_five_and_no_higher() {
    let quintic = |a, b, s| quintic(a, b, 2.0, s);
    for n in 1..=5 {
        assert!(error(n, quintic) < 1e-11, "{n}");
    }
    assert!(error(6, quintic) > 0.1);
}

#[test]
fn shrinking_steps_stall_and_growing_or_sufficient_ones_do_not() {
    let run = |mut h: f64, factor: f64| {
        let (mut t, mut progress) = (0.0, ProgressMonitor::new(0.0, 1));
        (0..2_000).find_map(|_| {
            t += h;
            h *= factor;
            progress.stalled(t, 10.0)
        })
    };
    assert!(run(1e-2, 0.8).is_some_and(|step| step < 1e-8));
    assert!(run(1e-12, 1.0).is_some());
    assert!(run(1e-13, 1.0005).is_some());
    assert_eq!(run(1e-12, 1.03), None);
    assert_eq!(run(1e-7, 1.0), None);
}

#[test]
fn the_last_step_ends_at_the_end_without_a_sliver() {
    let mut record = StepRecord::new(0.1, &[0.0]);
    assert_eq!(record.next_size(0.2, 1.0), Ok(0.2));
    assert_eq!(record.next_size(0.895, 1.0), Ok(0.9));
    record.advance(0.9, 1.0);
    assert_eq!((record.t, record.t_old, record.steps.accepted), (1.0, 0.1, 1));
    assert!(record.has_ended(1.0) && !record.has_ended(0.5));
    assert!((record.part(0.55) - 0.5).abs() < 1e-15);
    assert!(record.next_size(1e-17, 2.0).is_err());
}

#[test]
fn the_least_friction_is_found_or_there_is_none() {
    let (u, none) = (Vector3::new(3.0, 4.0, 0.0), Vector3::zeros());
    assert_eq!(least_friction(0.5, &[u, none], &[none, none]), Some(2.5));
    assert_eq!(least_friction(-0.5, &[u, none], &[none, none]), Some(-2.5));
    // f = ½ |5 + f|.
    let found = least_friction(0.5, &[u, none], &[u / 5.0, none]).unwrap_or(f64::NAN);
    assert!((found - 5.0).abs() < 1e-14, "{found}");
    // f = 2 |5 − f|: 10/3 and 10; the lesser one goes over into that of small coefficients.
    let found = least_friction(2.0, &[u, none], &[u / -5.0, none]).unwrap_or(f64::NAN);
    assert!((found - 10.0 / 3.0).abs() < 1e-14, "{found}");
    assert_eq!(least_friction(2.0, &[u, none], &[u / 5.0, none]), None, "it locks");
    assert_eq!(least_friction(f64::NAN, &[u, none], &[u / 5.0, none]), None);
    assert_eq!(least_friction(0.0, &[u, none], &[u, none]), Some(0.0));
}
