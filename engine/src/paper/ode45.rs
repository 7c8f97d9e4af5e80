//! The step control of MATLAB's ode45, on which the published counts of steps rest.
//!
//! Dormand and Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980): orders 5(4), first
//! same as last, the fifth-order result goes on. Default options: relative tolerance 1e-3, absolute tolerance 1e-6,
//! largest step a tenth of the run. Never used for anything but that comparison.

const STAGES: usize = 7;
const A: [[f64; 6]; STAGES] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Weights of the fifth order less those of the fourth.
const E: [f64; STAGES] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
const RELATIVE: f64 = 1e-3;
const ABSOLUTE: f64 = 1e-6;
const THRESHOLD: f64 = ABSOLUTE / RELATIVE;

/// What a run cost, in the words of the published table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Failed attempts.
    pub failed: u64,
    /// Evaluations of ẏ: one, and six for each attempt.
    pub evaluations: u64,
}

/// Integrates ẏ = f(y) from 0 to `end`; `visit` sees the start and the end of each step. `None` if a step would have to
/// be smaller than time resolves, or `rate` fails.
pub fn integrate(
    mut rate: impl FnMut(&[f64], &mut [f64]) -> bool,
    y: &mut [f64],
    end: f64,
    mut visit: impl FnMut(f64, &[f64]),
) -> Option<Counts> {
    let n = y.len();
    let mut k = vec![vec![0.0; n]; STAGES];
    let mut trial = vec![0.0; n];
    let (mut t, largest) = (0.0, 0.1 * end);
    if !rate(y, &mut k[0]) {
        return None;
    }
    let mut counts = Counts { evaluations: 1, ..Counts::default() };
    visit(t, y);
    let mut h = first_step(y, &k[0], largest, end);
    while t < end {
        let least = 16.0 * f64::EPSILON * t;
        h = h.clamp(least, largest);
        if 1.1 * h >= end - t {
            h = end - t;
        }
        let mut untouched = true;
        let error = loop {
            for stage in 1..STAGES {
                for i in 0..n {
                    let slope: f64 = (0..stage).map(|j| A[stage][j] * k[j][i]).sum();
                    trial[i] = y[i] + h * slope;
                }
                if !rate(&trial, &mut k[stage]) {
                    return None;
                }
            }
            counts.evaluations += 6;
            let error = h * error_norm(&k, y, &trial);
            if error <= RELATIVE {
                break error;
            }
            counts.failed += 1;
            if h <= least || error.is_nan() {
                return None;
            }
            let shrink = if untouched { (0.8 * (RELATIVE / error).powf(0.2)).max(0.1) } else { 0.5 };
            h = (h * shrink).max(least);
            untouched = false;
        };
        counts.steps += 1;
        t = if h == end - t { end } else { t + h };
        y.copy_from_slice(&trial);
        k.swap(0, STAGES - 1);
        visit(t, y);
        if untouched {
            let relative = 1.25 * (error / RELATIVE).powf(0.2);
            h = if relative > 0.2 { h / relative } else { 5.0 * h };
        }
    }
    Some(counts)
}

fn first_step(y: &[f64], rate: &[f64], largest: f64, end: f64) -> f64 {
    let h = largest.min(end);
    let slope = y.iter().zip(rate).fold(0.0f64, |a, (y, f)| a.max((f / y.abs().max(THRESHOLD)).abs()));
    let inverse = slope / (0.8 * RELATIVE.powf(0.2));
    if h * inverse > 1.0 { 1.0 / inverse } else { h }
}

/// max |Σ E_j k_j| / max(|y|, |y'|, threshold).
fn error_norm(k: &[Vec<f64>], y: &[f64], y_new: &[f64]) -> f64 {
    let mut largest = 0.0f64;
    for i in 0..y.len() {
        let error: f64 = (0..STAGES).map(|j| E[j] * k[j][i]).sum();
        let relative = (error / y[i].abs().max(y_new[i].abs()).max(THRESHOLD)).abs();
        // Unlike `max`, keeps a NaN.
        if relative > largest || relative.is_nan() {
            largest = relative;
        }
    }
    largest
}
