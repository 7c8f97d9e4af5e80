//! How much of a signal no harmonic motion explains.

use std::f64::consts::TAU;

use super::least::least;

/// Frequencies that are tried.
const FREQUENCIES: u32 = 600;
/// Most periods within the time.
const MOST_PERIODS: f64 = 30.0;
/// Times that the best frequency is looked around for a better one, closer and closer.
const ROUNDS: usize = 20;

/// Harmonic motions of all frequencies that are tried, at some times: what is fitted to any signal there.
#[derive(Debug)]
pub(crate) struct Waves {
    times: Vec<f64>,
    tried: Vec<(f64, Wave)>,
}

/// cos ωt and sin ωt at the times, and the matrix of the least squares of a cos ωt + b sin ωt + c.
#[derive(Debug)]
struct Wave {
    basis: Vec<[f64; 2]>,
    matrix: [[f64; 3]; 3],
}

/// Distance between the periods that are tried.
fn step() -> f64 {
    MOST_PERIODS / f64::from(FREQUENCIES)
}

impl Waves {
    /// Of all frequencies, at these times.
    pub(crate) fn new(times: &[f64]) -> Self {
        let times = times.to_vec();
        let wave = |k: u32| {
            let periods = f64::from(k) * step();
            (periods, Wave::new(&times, omega(&times, periods)))
        };
        let tried = (1..=FREQUENCIES).map(wave).collect();
        Self { times, tried }
    }

    /// The part of the swings that the best harmonic motion leaves.
    pub(super) fn unexplained(&self, values: &[f64]) -> f64 {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let size = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>().sqrt();
        let tried = self.tried.iter().map(|(periods, wave)| (*periods, wave.rest(values)));
        let left = |periods: f64| Wave::new(&self.times, omega(&self.times, periods)).rest(values);
        let rest = least(tried, step(), ROUNDS, left).map_or(f64::INFINITY, |(_, rest)| rest);
        if size > 0.0 { rest / size } else { 0.0 }
    }
}

/// The angular frequency of so many periods within the times.
fn omega(times: &[f64], periods: f64) -> f64 {
    TAU * periods / times.last().copied().unwrap_or(1.0)
}

impl Wave {
    fn new(times: &[f64], omega: f64) -> Self {
        let basis = times.iter().map(|t| [libm::cos(omega * t), libm::sin(omega * t)]).collect();
        let mut wave = Self { basis, matrix: [[0.0; 3]; 3] };
        for &[cos, sin] in &wave.basis {
            let b = [cos, sin, 1.0];
            for (row, bi) in wave.matrix.iter_mut().zip(b) {
                for (entry, bj) in row.iter_mut().zip(b) {
                    *entry += bi * bj;
                }
            }
        }
        wave
    }

    /// What it leaves of the values, in the least squares.
    fn rest(&self, values: &[f64]) -> f64 {
        let mut right = [0.0; 3];
        for (&[cos, sin], x) in self.basis.iter().zip(values) {
            for (entry, b) in right.iter_mut().zip([cos, sin, 1.0]) {
                *entry += b * x;
            }
        }
        let Some([a, b, c]) = solved(self.matrix, right) else { return f64::INFINITY };
        let rest = self.basis.iter().zip(values).map(|(&[cos, sin], x)| {
            let rest = x - [a * cos, b * sin, c * 1.0].into_iter().sum::<f64>();
            rest * rest
        });
        rest.sum::<f64>().sqrt()
    }
}

/// The solution of three equations by Cramer's rule.
fn solved(m: [[f64; 3]; 3], r: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(&m);
    let with = |k: usize| {
        let mut m = m;
        for (row, x) in m.iter_mut().zip(r) {
            row[k] = x;
        }
        det(&m) / whole
    };
    (whole.abs() > f64::MIN_POSITIVE).then(|| [with(0), with(1), with(2)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_harmonic_motion_is_explained_and_another_is_not() {
        let times: Vec<f64> = (0..400).map(|k| f64::from(k) / 40.0).collect();
        let of = |signal: fn(f64) -> f64| {
            Waves::new(&times).unexplained(&times.iter().map(|t| signal(*t)).collect::<Vec<_>>())
        };
        assert!(of(|t| 2.0 * libm::sin(3.1 * t) + 0.7) < 1e-4);
        assert!(of(|t| libm::sin(libm::sin(3.1 * t)) + 0.1 * libm::cos(t * t)) > 0.05);
        assert_eq!(of(|_| 3.0), 0.0);
    }
}
