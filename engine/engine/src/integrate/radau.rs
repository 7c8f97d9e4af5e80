//! Radau IIA of order 5: implicit Runge-Kutta for stiff springs, dampers and friction — eq. (10.5)
//! (Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.8).
//!
//! It integrates ẋ = f(t, x), x = (η, η̇), second-order equations in independent coordinates: the linear systems of
//! Newton's method then have the size of η alone. Their matrices come from differences of f and are kept from step to
//! step as long as Newton's method converges well.

mod coefficients;
mod linear;

use super::step::{MIN_ERROR, SAFETY, StepRecord, StopReason, weighted_norm};
use super::stepper::OdeMethod;
use coefficients::{C, ESTIMATE, PAIR, REAL, T, T_INVERSE, collocation};
use linear::{Factors, RateJacobian};
use nalgebra::{Complex, DVector};
use triad_dynamics::ode::OdeSystem;

/// Relative rounding of the stages: Newton's method does not converge further.
const ROUNDING: f64 = 1e-12;
/// Greatest number of iterations of Newton's method for a step.
const MAX_ITERATIONS: usize = 9;
/// Ratio of successive corrections above which the next step gets a new Jacobian matrix.
const SLOW: f64 = 1e-3;
/// Ratio of successive corrections above which Newton's method does not converge.
const DIVERGING: f64 = 0.99;
/// Least and greatest change of the step, as factors.
const CHANGE: (f64, f64) = (0.125, 6.0);
/// Factors of the step that are not worth new factors of the matrices.
const KEPT: std::ops::Range<f64> = 1.0..1.2;
/// Square of the same, in predictive control.
const MIN_SQUARED_ERROR: f64 = 1e-24;
/// Error of the step before that predictive control takes for no smaller than this.
const MIN_LAST_ERROR: f64 = 1e-2;
/// Least size of a coordinate for the increment of its difference quotient, m or 1.
const MIN_INCREMENT_SIZE: f64 = 1e-5;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Radau {
    /// Bound of the error estimate, which is of order 3: with it the error of order 5 follows the tolerance.
    estimated: f64,
    fixed: bool,
    last: StepRecord,
    /// ẋ at the end of the last step.
    rate: Vec<f64>,
    /// Size of the next step.
    h: f64,
    x_old: Vec<f64>,
    /// Stages less the start of the step; of the last accepted step for dense output.
    z: [Vec<f64>; 3],
    z_old: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    f: [Vec<f64>; 3],
    trial: Vec<f64>,
    jacobian: RateJacobian,
    factors: Option<Factors>,
    /// Ratio of successive corrections in the last step.
    contraction: f64,
    /// Size and error of the step before.
    before: Option<(f64, f64)>,
}

impl Radau {
    /// Order of the method.
    pub const ORDER: u32 = 5;

    /// Starts at (t, x) with relative and absolute tolerance `tolerance`.
    pub fn new(system: &mut impl OdeSystem, t: f64, x: &[f64], tolerance: f64) -> Self {
        let n = x.len();
        let zeros = || [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        let mut integrator = Self {
            estimated: 0.1 * libm::pow(tolerance, 2.0 / 3.0),
            fixed: false,
            last: StepRecord::new(t, x),
            rate: vec![0.0; n],
            h: 0.0,
            x_old: x.to_vec(),
            z: zeros(),
            z_old: zeros(),
            w: zeros(),
            f: zeros(),
            trial: vec![0.0; n],
            jacobian: RateJacobian::new(n / 2),
            factors: None,
            contraction: 1.0,
            before: None,
        };
        system.rhs(t, x, &mut integrator.rate);
        let d0 = weighted_norm(x.iter().copied(), x, x, tolerance);
        let d1 = weighted_norm(integrator.rate.iter().copied(), x, x, tolerance);
        integrator.h = if d0 < 1e-10 || d1 < 1e-10 { 1e-6 } else { (0.01 * d0 / d1).min(1e-2) };
        integrator
    }

    /// Starts at (t, x) with steps of size h, whatever the error; their equations are solved to the tolerance.
    pub fn with_step(system: &mut impl OdeSystem, t: f64, x: &[f64], tolerance: f64, h: f64) -> Self {
        let mut integrator = Self::new(system, t, x, tolerance);
        (integrator.fixed, integrator.h) = (true, h);
        integrator
    }

    fn accept(&mut self, system: &mut impl OdeSystem, h: f64, end: f64, error: f64, by: f64) {
        // Predictive control: what the last change of the step did to the error tells what the next one will do.
        let mut by = by;
        if let Some((h_before, error_before)) = self.before {
            let predicted = SAFETY * h / h_before
                * libm::pow(error_before / (error * error).max(MIN_SQUARED_ERROR), 0.25);
            by = by.min(predicted.clamp(CHANGE.0, CHANGE.1));
        }
        self.before = Some((h, error.max(MIN_LAST_ERROR)));
        let whole = h >= self.h;
        self.x_old.copy_from_slice(&self.last.y);
        for (x, z) in self.last.y.iter_mut().zip(&self.z[2]) {
            *x += z;
        }
        for (old, z) in self.z_old.iter_mut().zip(&self.z) {
            old.copy_from_slice(z);
        }
        self.last.advance(h, end);
        let StepRecord { t, y: x, .. } = &mut self.last;
        system.rhs(*t, x, &mut self.rate);
        system.after_step(*t, x, &mut self.rate);
        self.jacobian.fresh = false;
        if self.fixed {
            return;
        }
        // Small changes are not worth new factors; a step that was cut to meet the end says nothing about the next.
        let next = if KEPT.contains(&by) && self.contraction < SLOW { h } else { h * by };
        self.h = if whole { next } else { self.h.max(next) };
    }

    /// Columns of ∂η̈/∂(η, η̇) by differences.
    fn differentiate(&mut self, system: &mut impl OdeSystem) -> Result<(), StopReason> {
        let f = self.last.y.len() / 2;
        self.trial.copy_from_slice(&self.last.y);
        for k in 0..2 * f {
            let step = (f64::EPSILON * self.last.y[k].abs().max(MIN_INCREMENT_SIZE)).sqrt();
            self.trial[k] = self.last.y[k] + step;
            let step = self.trial[k] - self.last.y[k];
            system.rhs(self.last.t, &self.trial, &mut self.f[0]);
            self.trial[k] = self.last.y[k];
            let RateJacobian { stiffness, damping, .. } = &mut self.jacobian;
            let mut column = if k < f { stiffness.column_mut(k) } else { damping.column_mut(k - f) };
            for i in 0..f {
                column[i] = (self.f[0][f + i] - self.rate[f + i]) / step;
            }
            if !column.iter().all(|x| x.is_finite()) {
                return Err(self.last.not_finite());
            }
        }
        (self.jacobian.fresh, self.jacobian.valid) = (true, true);
        self.factors = None;
        Ok(())
    }

    /// Solves for the stages by simplified Newton iteration; returns how many it took.
    fn solve(&mut self, system: &mut impl OdeSystem, h: f64) -> Option<usize> {
        let n = self.last.y.len();
        self.predict(h);
        let enough = (ROUNDING / self.estimated).max(self.estimated.sqrt().min(0.03));
        let (mut last, mut rate) = (0.0f64, 0.0f64);
        for iteration in 0..MAX_ITERATIONS {
            for stage in 0..3 {
                for (trial, (x, z)) in self.trial.iter_mut().zip(self.last.y.iter().zip(&self.z[stage])) {
                    *trial = x + z;
                }
                system.rhs(self.last.t + C[stage] * h, &self.trial, &mut self.f[stage]);
            }
            if !self.f.iter().flatten().all(|f| f.is_finite()) {
                return None;
            }
            let size = self.correct(h, n)?;
            if iteration > 0 {
                rate = size / last;
                self.contraction = if iteration == 1 { rate } else { (rate * self.contraction).sqrt() };
                if rate.is_nan() || rate >= DIVERGING {
                    // Rounding keeps small corrections from shrinking.
                    return (size <= enough).then_some(iteration + 1);
                }
                let left = (MAX_ITERATIONS - 1 - iteration) as f64;
                if rate / (1.0 - rate) * size * libm::pow(rate, left) > 10.0 * enough && size > enough {
                    return None;
                }
            }
            last = size.max(f64::MIN_POSITIVE);
            let converged =
                if iteration == 0 { size <= 1e-3 * enough } else { rate / (1.0 - rate) * size <= enough };
            if converged {
                if iteration == 0 {
                    self.contraction = SLOW;
                }
                return Some(iteration + 1);
            }
        }
        None
    }

    /// One Newton step of all stages; returns its size relative to the tolerance.
    fn correct(&mut self, h: f64, n: usize) -> Option<f64> {
        let f = n / 2;
        let factors = self.factors.as_ref()?;
        let (real, pair) = (REAL / h, PAIR / h);
        let forward = |k: usize, i: usize| (0..3).map(|s| T_INVERSE[k][s] * self.f[s][i]).sum::<f64>();
        let r1 = DVector::from_fn(n, |i, _| forward(0, i) - real * self.w[0][i]);
        let r2 = DVector::from_fn(n, |i, _| {
            let w = Complex::new(self.w[1][i], self.w[2][i]);
            Complex::new(forward(1, i), forward(2, i)) - pair * w
        });
        let [a, b] = factors.solve_real(&self.jacobian, &r1)?;
        let [c, d] = factors.solve_pair(&self.jacobian, &r2)?;
        for i in 0..f {
            for (at, real, pair) in [(i, a[i], c[i]), (f + i, b[i], d[i])] {
                self.w[0][at] += real;
                self.w[1][at] += pair.re;
                self.w[2][at] += pair.im;
            }
        }
        let mut sum = 0.0;
        for i in 0..n {
            let (real, pair) = if i < f { (a[i], c[i]) } else { (b[i - f], d[i - f]) };
            let weight = self.estimated * (1.0 + self.last.y[i].abs());
            sum += (real * real + pair.norm_sqr()) / (weight * weight);
        }
        self.back();
        Some((sum / (3 * n) as f64).sqrt())
    }

    /// Z = (T ⊗ I) W.
    fn back(&mut self) {
        for i in 0..self.last.y.len() {
            for (stage, row) in T.iter().enumerate() {
                self.z[stage][i] = (0..3).map(|k| row[k] * self.w[k][i]).sum();
            }
        }
    }

    /// Stages from the polynomial of the last step, or zero.
    fn predict(&mut self, h: f64) {
        let weights = C.map(|c| collocation(1.0 + c * h / self.last.h));
        for i in 0..self.last.y.len() {
            for stage in 0..3 {
                let known = self.last.h > 0.0;
                self.z[stage][i] =
                    if known { self.polynomial(i, weights[stage]) - self.z_old[2][i] } else { 0.0 };
            }
            for (k, row) in T_INVERSE.iter().enumerate() {
                self.w[k][i] = (0..3).map(|s| row[s] * self.z[s][i]).sum();
            }
        }
    }

    /// Error of the step relative to the tolerance; after a refusal, or at the start, its stiff part is filtered twice.
    fn error(&mut self, system: &mut impl OdeSystem, h: f64, rejected: bool) -> f64 {
        let n = self.last.y.len();
        let sum = DVector::from_fn(n, |i, _| (0..3).map(|s| ESTIMATE[s] * self.z[s][i]).sum::<f64>() / h);
        let rate = DVector::from_column_slice(&self.rate);
        let Some(mut error) = self.filtered(&(&sum + rate)) else { return f64::NAN };
        let norm = |error: &DVector<f64>, s: &Self| {
            let end = s.last.y.iter().zip(&s.z[2]).map(|(x, z)| x + z).collect::<Vec<f64>>();
            weighted_norm(error.iter().copied(), &s.last.y, &end, s.estimated)
        };
        let size = norm(&error, self);
        if size < 1.0 || !(rejected || self.last.steps.accepted == 0) {
            return size;
        }
        for (trial, (x, e)) in self.trial.iter_mut().zip(self.last.y.iter().zip(error.iter())) {
            *trial = x + e;
        }
        system.rhs(self.last.t, &self.trial, &mut self.f[0]);
        if let Some(again) = self.filtered(&(sum + DVector::from_column_slice(&self.f[0]))) {
            error = again;
        }
        norm(&error, self)
    }

    /// (μ I − J)⁻¹ r with the real μ.
    fn filtered(&self, r: &DVector<f64>) -> Option<DVector<f64>> {
        let [a, b] = self.factors.as_ref()?.solve_real(&self.jacobian, r)?;
        let f = a.len();
        let mut out = DVector::zeros(2 * f);
        out.rows_mut(0, f).copy_from(&a);
        out.rows_mut(f, f).copy_from(&b);
        Some(out)
    }

    /// The collocation polynomial of the last step, less its start, from the weights of the stages.
    fn polynomial(&self, i: usize, weights: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for (weight, z) in weights.iter().zip(&self.z_old) {
            sum += weight * z[i];
        }
        sum
    }
}

impl OdeMethod for Radau {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, system: &mut impl OdeSystem, end: f64) -> Result<(), StopReason> {
        let mut rejected = false;
        if self.contraction > SLOW || !self.jacobian.valid {
            self.differentiate(system)?;
        }
        loop {
            let h = self.last.next_size(self.h, end)?;
            if self.factors.as_ref().is_none_or(|factors| factors.h != h) {
                self.factors = Factors::new(&self.jacobian, h);
                if self.factors.is_none() {
                    return Err(self.last.not_finite());
                }
            }
            let Some(iterations) = self.solve(system, h) else {
                if self.fixed && self.jacobian.fresh {
                    return Err(StopReason::NoConvergence { time: self.last.t, step: h });
                }
                self.last.steps.rejected += 1;
                rejected = true;
                if !self.jacobian.fresh {
                    self.differentiate(system)?;
                }
                self.h = if self.fixed { self.h } else { 0.5 * h };
                self.contraction = 1.0;
                continue;
            };
            let error = self.error(system, h, rejected);
            let factor = SAFETY * (2 * MAX_ITERATIONS + 1) as f64 / (2 * MAX_ITERATIONS + iterations) as f64;
            let by = (factor * libm::pow(error.max(MIN_ERROR), -0.25)).clamp(CHANGE.0, CHANGE.1);
            if error < 1.0 || self.fixed {
                let by = if rejected { by.min(1.0) } else { by };
                self.accept(system, h, end, error, by);
                return Ok(());
            }
            self.last.steps.rejected += 1;
            rejected = true;
            self.h = if error.is_finite() { h * by.min(0.9) } else { 0.1 * h };
        }
    }

    /// To order 3.
    fn interpolate(&mut self, _: &mut impl OdeSystem, t: f64, out: &mut [f64]) {
        if self.last.has_ended(t) {
            out.copy_from_slice(&self.last.y);
            return;
        }
        let weights = collocation(self.last.part(t));
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.x_old[i] + self.polynomial(i, weights);
        }
    }

    fn restart(&mut self, system: &mut impl OdeSystem, x: &[f64]) {
        self.last.y.copy_from_slice(x);
        system.rhs(self.last.t, x, &mut self.rate);
        self.last.h = 0.0;
        self.jacobian.valid = false;
        self.factors = None;
    }
}
