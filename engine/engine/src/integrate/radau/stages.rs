//! The stages of a step and Newton's method for them, in the coordinates in which A⁻¹ falls into blocks.

use super::coefficients::{Method, ORDER_9, Tables};
use super::linear::{Factors, RateJacobian};
use crate::integrate::step::StepRecord;
use nalgebra::{Complex, DVector};
use triad_dynamics::ode::OdeSystem;

/// Relative rounding of the stages: Newton's method does not converge further.
const ROUNDING: f64 = 1e-12;
/// Part of the error that a step may have to which its stages are solved.
const SOLVED: f64 = 0.03;
/// Ratio of successive corrections above which Newton's method does not converge.
const DIVERGING: f64 = 0.99;
/// Ratio of a step to the one before it above which the polynomial of that says nothing about the new stages.
const MAX_EXTRAPOLATION: f64 = 1.6;

/// How Newton's method went.
#[derive(Clone, Copy, Debug)]
pub struct Solved {
    /// Iterations.
    pub iterations: usize,
    /// Ratio of its successive corrections.
    pub contraction: f64,
}

/// The stages.
#[derive(Clone, Debug)]
pub struct Stages {
    /// The method.
    pub method: Method,
    /// Stages less the start of the step.
    pub z: Vec<Vec<f64>>,
    /// Those of the last accepted step.
    pub z_old: Vec<Vec<f64>>,
    /// T⁻¹ z.
    w: Vec<Vec<f64>>,
    /// ẋ at the stages.
    f: Vec<Vec<f64>>,
    /// Power at the stages, W, and at those of the last accepted step; zero where nothing changes the energy.
    power: Vec<f64>,
    power_old: Vec<f64>,
    trial: Vec<f64>,
    real: DVector<f64>,
    pair: DVector<Complex<f64>>,
    weights: Vec<f64>,
}

impl Stages {
    /// Allocates for n numbers.
    pub fn new(tables: &'static Tables, n: usize) -> Self {
        let method = Method::new(tables);
        let s = method.stages();
        let zeros = || vec![vec![0.0; n]; s];
        Self {
            method,
            z: zeros(),
            z_old: zeros(),
            w: zeros(),
            f: zeros(),
            power: vec![0.0; s],
            power_old: vec![0.0; s],
            trial: vec![0.0; n],
            real: DVector::zeros(n),
            pair: DVector::zeros(n),
            weights: vec![0.0; s],
        }
    }

    /// Greatest number of iterations of Newton's method for a step: with more stages it takes more.
    pub fn max_iterations(&self) -> usize {
        (6 + self.method.stages()).max(9)
    }

    /// Solves for the stages of a step of size h by simplified Newton iteration, to a part of the error `estimated`.
    pub fn solve(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        (jacobian, factors): (&RateJacobian, &Factors),
        estimated: f64,
    ) -> Option<Solved> {
        let h = factors.h;
        self.predict(last, h);
        let enough = (ROUNDING / estimated).max(estimated.sqrt().min(SOLVED));
        let most = self.max_iterations();
        let (mut size_before, mut rate, mut contraction) = (0.0f64, 0.0f64, 0.0f64);
        for iteration in 0..most {
            for stage in 0..self.z.len() {
                for (trial, (x, z)) in self.trial.iter_mut().zip(last.y.iter().zip(&self.z[stage])) {
                    *trial = x + z;
                }
                let node = self.method.tables.nodes[stage].0;
                system.begin_stage(stage, iteration == 0);
                system.rhs(last.t + node * h, &self.trial, &mut self.f[stage]);
                if !self.f[stage].iter().all(|f| f.is_finite()) {
                    return None;
                }
            }
            let size = self.correct((jacobian, factors), last, estimated);
            if iteration > 0 {
                rate = size / size_before;
                contraction = if iteration == 1 { rate } else { (rate * contraction).sqrt() };
                if rate.is_nan() || rate >= DIVERGING {
                    // Rounding keeps small corrections from shrinking.
                    return (size <= enough).then_some(Solved { iterations: iteration + 1, contraction });
                }
                let left = (most - 1 - iteration) as f64;
                if rate / (1.0 - rate) * size * libm::pow(rate, left) > 10.0 * enough && size > enough {
                    return None;
                }
            }
            size_before = size.max(f64::MIN_POSITIVE);
            let converged =
                if iteration == 0 { size <= 1e-3 * enough } else { rate / (1.0 - rate) * size <= enough };
            if converged {
                return Some(Solved { iterations: iteration + 1, contraction });
            }
        }
        None
    }

    /// Evaluates the stages once more as they were found, for the power there. Returns by how much the work of the step may be
    /// off, relative to it, if the power at its start is `before`: the power there less what the stages make of it.
    pub fn find_power(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        h: f64,
        before: f64,
    ) -> [f64; 2] {
        for stage in 0..self.z.len() {
            for (trial, (x, z)) in self.trial.iter_mut().zip(last.y.iter().zip(&self.z[stage])) {
                *trial = x + z;
            }
            system.begin_stage(stage, false);
            system.rhs(last.t + self.method.tables.nodes[stage].0 * h, &self.trial, &mut self.f[stage]);
            self.power[stage] = system.power().unwrap_or(0.0);
        }
        self.method.through(0.0, &mut self.weights);
        let foreseen: f64 = self.weights.iter().zip(&self.power).map(|(weight, power)| weight * power).sum();
        let nodes = self.method.tables.nodes;
        let turnover: f64 = nodes.iter().zip(&self.power).map(|((_, b), power)| b * power.abs()).sum();
        [h / self.method.tables.real * (before - foreseen).abs(), h * turnover]
    }

    /// Keeps the stages as those of the last step.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.z, &mut self.z_old);
        std::mem::swap(&mut self.power, &mut self.power_old);
    }

    /// Integral of the power from the start of the last step, of size h, to its part x, J.
    pub fn work(&self, x: f64, h: f64) -> f64 {
        let mut weights = vec![0.0; self.power_old.len()];
        let mut work = 0.0;
        // Exact for a polynomial through the stages.
        for (node, weight) in ORDER_9.nodes {
            self.method.through(node * x, &mut weights);
            work += weight
                * weights.iter().zip(&self.power_old).map(|(weight, power)| weight * power).sum::<f64>();
        }
        work * x * h
    }

    /// One Newton step of all stages; returns its size relative to the error that a step may have.
    fn correct(
        &mut self,
        (jacobian, factors): (&RateJacobian, &Factors),
        last: &StepRecord,
        estimated: f64,
    ) -> f64 {
        let h = factors.h;
        let tables = self.method.tables;
        let inverse = &self.method.t_inverse;
        let (n, s) = (last.y.len(), self.z.len());
        let mut sum = 0.0;
        let weight = |i: usize| estimated * (1.0 + last.y[i].abs());
        let forward =
            |f: &[Vec<f64>], k: usize, i: usize| (0..s).map(|j| inverse[(k, j)] * f[j][i]).sum::<f64>();
        for i in 0..n {
            self.real[i] = forward(&self.f, 0, i) - tables.real / h * self.w[0][i];
        }
        factors.solve_real(jacobian, tables, &mut self.real);
        for i in 0..n {
            self.w[0][i] += self.real[i];
            let part = self.real[i] / weight(i);
            sum += part * part;
        }
        for (pair, eigenvalue) in tables.pairs.iter().enumerate() {
            let (k, mu) = (1 + 2 * pair, eigenvalue / h);
            for i in 0..n {
                let w = Complex::new(self.w[k][i], self.w[k + 1][i]);
                self.pair[i] = Complex::new(forward(&self.f, k, i), forward(&self.f, k + 1, i)) - mu * w;
            }
            factors.solve_pair(jacobian, tables, pair, &mut self.pair);
            for i in 0..n {
                self.w[k][i] += self.pair[i].re;
                self.w[k + 1][i] += self.pair[i].im;
                sum += self.pair[i].norm_sqr() / (weight(i) * weight(i));
            }
        }
        let t = &self.method.t;
        for (stage, z) in self.z.iter_mut().enumerate() {
            for (i, z) in z.iter_mut().enumerate() {
                *z = (0..s).map(|k| t[(stage, k)] * self.w[k][i]).sum();
            }
        }
        (sum / (s * n) as f64).sqrt()
    }

    /// First stages: from the polynomial of the last step, or none.
    fn predict(&mut self, last: &StepRecord, h: f64) {
        let s = self.z.len();
        let known = last.h > 0.0 && h <= MAX_EXTRAPOLATION * last.h;
        for stage in 0..s {
            if !known {
                self.z[stage].fill(0.0);
                continue;
            }
            let node = self.method.tables.nodes[stage].0;
            self.method.collocation(1.0 + node * h / last.h, &mut self.weights);
            for i in 0..last.y.len() {
                self.z[stage][i] = self.polynomial(i) - self.z_old[s - 1][i];
            }
        }
        let inverse = &self.method.t_inverse;
        for (k, w) in self.w.iter_mut().enumerate() {
            for (i, w) in w.iter_mut().enumerate() {
                *w = (0..s).map(|j| inverse[(k, j)] * self.z[j][i]).sum();
            }
        }
    }

    /// The collocation polynomial of the last step, less its start, with the weights in place.
    fn polynomial(&self, i: usize) -> f64 {
        self.weights.iter().zip(&self.z_old).map(|(weight, z)| weight * z[i]).sum()
    }

    /// Takes the last step in other coordinates: its stages and its start.
    pub fn replace(&mut self, stages: &[Vec<f64>], start: &[f64]) {
        for (z, stage) in self.z_old.iter_mut().zip(stages) {
            for (z, (stage, start)) in z.iter_mut().zip(stage.iter().zip(start)) {
                *z = stage - start;
            }
        }
    }

    /// Adds to `start`, the state at the start of the last step, what the polynomial of that step gains up to its part x.
    pub fn interpolate(&mut self, x: f64, start: &[f64], out: &mut [f64]) {
        self.method.collocation(x, &mut self.weights);
        for (i, (out, start)) in out.iter_mut().zip(start).enumerate() {
            *out = start + self.polynomial(i);
        }
    }
}
