//! Radau IIA of order 5: implicit Runge-Kutta for stiff springs, dampers and friction — eq. (10.5)
//! (Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.8).
//!
//! It integrates ẋ = f(t, x), x = (η, η̇), second-order equations in independent coordinates: the linear systems of
//! Newton's method then have the size of η alone. Their matrices come from differences of f and are kept from step to
//! step as long as Newton's method converges well.

#![allow(clippy::excessive_precision, reason = "the numbers stand as they were published")]

use super::{Plant, Steps, Stop, resolution, weighted_norm};
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};

/// Nodes of the stages.
const C: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
/// Eigenvalues of A⁻¹: one real, one pair.
const REAL: f64 = 3.637_834_252_744_496;
const PAIR: Complex<f64> = Complex::new(2.681_082_873_627_752_3, 3.050_430_199_247_410_5);
/// T, which turns A⁻¹ into its real block form, and its inverse.
const T: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107_02, 0.204_129_352_293_799_93, 0.382_942_112_757_261_94],
    [0.966_048_182_615_092_9, 1.0, 0.0],
];
const T_INVERSE: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_4, -0.596_039_204_828_224_9],
];
/// Weights of the stages in the error estimate of order 3.
const ESTIMATE: [f64; 3] = [-10.048_809_399_827_416, 1.382_142_733_160_748_9, -0.333_333_333_333_333_3];
/// Rounding of the stages, relative to one: Newton's method can do no better.
const ROUNDING: f64 = 1e-12;
/// Most iterations of Newton's method.
const ITERATIONS: usize = 9;
/// Convergence slower than this calls for a new Jacobian.
const SLOW: f64 = 1e-3;
/// Safety factor, and bounds of the change of the step.
const SAFETY: f64 = 0.9;
const CHANGE: (f64, f64) = (0.125, 6.0);
/// Changes of the step that are not worth new factors.
const KEPT: std::ops::Range<f64> = 1.0..1.2;

type RealLu = LU<f64, Dyn, Dyn>;
type ComplexLu = LU<Complex<f64>, Dyn, Dyn>;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Radau {
    /// Bound of the error estimate, which is of order 3: with it the error of order 5 follows the tolerance.
    estimated: f64,
    fixed: bool,
    t: f64,
    x: Vec<f64>,
    rate: Vec<f64>,
    h: f64,
    t_old: f64,
    h_old: f64,
    x_old: Vec<f64>,
    /// Stages less the start of the step; of the last accepted step for dense output.
    z: [Vec<f64>; 3],
    z_old: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    f: [Vec<f64>; 3],
    trial: Vec<f64>,
    jacobian: Jacobian,
    factors: Option<Factors>,
    /// Rate of convergence of the last step, and its error and size.
    contraction: f64,
    last: Option<(f64, f64)>,
    /// Steps so far.
    pub steps: Steps,
}

/// ∂η̈/∂η and ∂η̈/∂η̇.
#[derive(Clone, Debug)]
struct Jacobian {
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    fresh: bool,
    valid: bool,
}

/// Factors of μ² I − μ C − K for the real and the complex μ of one step size.
#[derive(Clone, Debug)]
struct Factors {
    h: f64,
    real: RealLu,
    pair: ComplexLu,
}

impl Radau {
    /// Order of the method.
    pub const ORDER: u32 = 5;

    /// Starts at (t, x) with relative and absolute tolerance `tolerance`.
    pub fn new(plant: &mut impl Plant, t: f64, x: &[f64], tolerance: f64) -> Self {
        let n = x.len();
        let f = n / 2;
        let zeros = || [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        let mut integrator = Self {
            estimated: 0.1 * tolerance.powf(2.0 / 3.0),
            fixed: false,
            t,
            x: x.to_vec(),
            rate: vec![0.0; n],
            h: 0.0,
            t_old: t,
            h_old: 0.0,
            x_old: x.to_vec(),
            z: zeros(),
            z_old: zeros(),
            w: zeros(),
            f: zeros(),
            trial: vec![0.0; n],
            jacobian: Jacobian {
                stiffness: DMatrix::zeros(f, f),
                damping: DMatrix::zeros(f, f),
                fresh: false,
                valid: false,
            },
            factors: None,
            contraction: 1.0,
            last: None,
            steps: Steps::default(),
        };
        plant.rate(t, x, &mut integrator.rate);
        let d0 = weighted_norm(x.iter().copied(), x, x, tolerance);
        let d1 = weighted_norm(integrator.rate.iter().copied(), x, x, tolerance);
        integrator.h = if d0 < 1e-10 || d1 < 1e-10 { 1e-6 } else { (0.01 * d0 / d1).min(1e-2) };
        integrator
    }

    /// Starts at (t, x) with steps of size h, whatever the error; their equations are solved to the tolerance.
    pub fn with_step(plant: &mut impl Plant, t: f64, x: &[f64], tolerance: f64, h: f64) -> Self {
        let mut integrator = Self::new(plant, t, x, tolerance);
        (integrator.fixed, integrator.h) = (true, h);
        integrator
    }

    /// Goes on from the same state in other coordinates.
    pub fn restart(&mut self, plant: &mut impl Plant, x: &[f64]) {
        self.x.copy_from_slice(x);
        plant.rate(self.t, x, &mut self.rate);
        self.h_old = 0.0;
        self.jacobian.valid = false;
        self.factors = None;
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &[f64] {
        &self.x
    }

    /// Size of the last accepted step, s.
    pub fn last_step(&self) -> f64 {
        self.h_old
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop> {
        let mut rejected = false;
        if self.contraction > SLOW || !self.jacobian.valid {
            self.differentiate(plant)?;
        }
        loop {
            let left = end - self.t;
            let h = if 1.01 * self.h >= left { left } else { self.h };
            if h <= resolution(self.t, end) && left > h {
                return Err(Stop::StepTooSmall { time: self.t, step: h });
            }
            if self.factors.as_ref().is_none_or(|factors| factors.h != h) && !self.factorize(h) {
                return Err(Stop::NotFinite { time: self.t });
            }
            let Some(iterations) = self.solve(plant, h) else {
                if self.fixed && self.jacobian.fresh {
                    return Err(Stop::NoConvergence { time: self.t, step: h });
                }
                self.steps.rejected += 1;
                rejected = true;
                if !self.jacobian.fresh {
                    self.differentiate(plant)?;
                }
                self.h = if self.fixed { self.h } else { 0.5 * h };
                self.contraction = 1.0;
                continue;
            };
            let error = self.error(plant, h, rejected);
            let factor = SAFETY * (2 * ITERATIONS + 1) as f64 / (2 * ITERATIONS + iterations) as f64;
            let by = (factor * error.max(1e-12).powf(-0.25)).clamp(CHANGE.0, CHANGE.1);
            if error < 1.0 || self.fixed {
                let by = if rejected { by.min(1.0) } else { by };
                self.accept(plant, h, end, error, by);
                return Ok(());
            }
            self.steps.rejected += 1;
            rejected = true;
            self.h = if error.is_finite() { h * by.min(0.9) } else { 0.1 * h };
        }
    }

    fn accept(&mut self, plant: &mut impl Plant, h: f64, end: f64, error: f64, by: f64) {
        // Predictive control: what the last change of the step did to the error tells what the next one will do.
        let mut by = by;
        if let Some((last_h, last_error)) = self.last {
            let predicted = SAFETY * h / last_h * (last_error / (error * error).max(1e-24)).powf(0.25);
            by = by.min(predicted.clamp(CHANGE.0, CHANGE.1));
        }
        self.last = Some((h, error.max(1e-2)));
        let whole = h >= self.h;
        self.t_old = self.t;
        self.h_old = h;
        self.x_old.copy_from_slice(&self.x);
        for (x, z) in self.x.iter_mut().zip(&self.z[2]) {
            *x += z;
        }
        for (old, z) in self.z_old.iter_mut().zip(&self.z) {
            old.copy_from_slice(z);
        }
        self.t = if h == end - self.t { end } else { self.t + h };
        plant.rate(self.t, &self.x, &mut self.rate);
        plant.settle(self.t, &mut self.x, &mut self.rate);
        self.jacobian.fresh = false;
        self.steps.accepted += 1;
        if self.fixed {
            return;
        }
        // Small changes are not worth new factors; a step that was cut to meet the end says nothing about the next.
        let next = if KEPT.contains(&by) && self.contraction < SLOW { h } else { h * by };
        self.h = if whole { next } else { self.h.max(next) };
    }

    /// Columns of ∂η̈/∂(η, η̇) by differences.
    fn differentiate(&mut self, plant: &mut impl Plant) -> Result<(), Stop> {
        let f = self.x.len() / 2;
        self.trial.copy_from_slice(&self.x);
        for k in 0..2 * f {
            let step = (f64::EPSILON * self.x[k].abs().max(1e-5)).sqrt();
            self.trial[k] = self.x[k] + step;
            let step = self.trial[k] - self.x[k];
            plant.rate(self.t, &self.trial, &mut self.f[0]);
            self.trial[k] = self.x[k];
            let Jacobian { stiffness, damping, .. } = &mut self.jacobian;
            let mut column = if k < f { stiffness.column_mut(k) } else { damping.column_mut(k - f) };
            for i in 0..f {
                column[i] = (self.f[0][f + i] - self.rate[f + i]) / step;
            }
            if !column.iter().all(|x| x.is_finite()) {
                return Err(Stop::NotFinite { time: self.t });
            }
        }
        (self.jacobian.fresh, self.jacobian.valid) = (true, true);
        self.factors = None;
        Ok(())
    }

    /// Factors μ² I − μ C − K for a step of size h. False if they are singular.
    fn factorize(&mut self, h: f64) -> bool {
        let Jacobian { stiffness, damping, .. } = &self.jacobian;
        let f = stiffness.nrows();
        let mu = REAL / h;
        let real = DMatrix::from_diagonal_element(f, f, mu * mu) - damping * mu - stiffness;
        let mu = PAIR / h;
        let pair = DMatrix::from_fn(f, f, |i, j| {
            let unit = if i == j { mu * mu } else { Complex::new(0.0, 0.0) };
            unit - mu * damping[(i, j)] - stiffness[(i, j)]
        });
        let (real, pair) = (real.lu(), pair.lu());
        let regular = real.is_invertible() && pair.is_invertible();
        self.factors = regular.then_some(Factors { h, real, pair });
        regular
    }

    /// Solves for the stages by simplified Newton iteration; returns how many it took.
    fn solve(&mut self, plant: &mut impl Plant, h: f64) -> Option<usize> {
        let n = self.x.len();
        self.predict(h);
        let enough = (ROUNDING / self.estimated).max(self.estimated.sqrt().min(0.03));
        let (mut last, mut rate) = (0.0f64, 0.0f64);
        for iteration in 0..ITERATIONS {
            for stage in 0..3 {
                for (trial, (x, z)) in self.trial.iter_mut().zip(self.x.iter().zip(&self.z[stage])) {
                    *trial = x + z;
                }
                plant.rate(self.t + C[stage] * h, &self.trial, &mut self.f[stage]);
            }
            if !self.f.iter().flatten().all(|f| f.is_finite()) {
                return None;
            }
            let size = self.correct(h, n)?;
            if iteration > 0 {
                rate = size / last;
                self.contraction = if iteration == 1 { rate } else { (rate * self.contraction).sqrt() };
                if rate.is_nan() || rate >= 0.99 {
                    // Rounding keeps small corrections from shrinking.
                    return (size <= enough).then_some(iteration + 1);
                }
                let left = i32::try_from(ITERATIONS - 1 - iteration).unwrap_or(0);
                if rate / (1.0 - rate) * size * rate.powi(left) > 10.0 * enough && size > enough {
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
        let damping = &self.jacobian.damping;
        let (real, pair) = (REAL / h, PAIR / h);
        let forward = |k: usize, i: usize| (0..3).map(|s| T_INVERSE[k][s] * self.f[s][i]).sum::<f64>();
        let r1 = DVector::from_fn(n, |i, _| forward(0, i) - real * self.w[0][i]);
        let r2 = DVector::from_fn(n, |i, _| {
            let w = Complex::new(self.w[1][i], self.w[2][i]);
            Complex::new(forward(1, i), forward(2, i)) - pair * w
        });
        // From the two halves (μ − …): b = μ a − r_a, (μ² − μ C − K) a = r_b + (μ − C) r_a.
        let top = r1.rows(0, f).into_owned();
        let a = factors.real.solve(&(r1.rows(f, f) + &top * real - damping * &top))?;
        let b = &a * real - top;
        let top = r2.rows(0, f).into_owned();
        let damped = damping.map(|x| Complex::new(x, 0.0)) * &top;
        let c = factors.pair.solve(&(r2.rows(f, f) + &top * pair - damped))?;
        let d = &c * pair - top;
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
            let weight = self.estimated * (1.0 + self.x[i].abs());
            sum += (real * real + pair.norm_sqr()) / (weight * weight);
        }
        self.back();
        Some((sum / (3 * n) as f64).sqrt())
    }

    /// Z = (T ⊗ I) W.
    fn back(&mut self) {
        for i in 0..self.x.len() {
            for (stage, row) in T.iter().enumerate() {
                self.z[stage][i] = (0..3).map(|k| row[k] * self.w[k][i]).sum();
            }
        }
    }

    /// Stages from the polynomial of the last step, or zero.
    fn predict(&mut self, h: f64) {
        for i in 0..self.x.len() {
            for stage in 0..3 {
                self.z[stage][i] = if self.h_old > 0.0 {
                    let s = 1.0 + C[stage] * h / self.h_old;
                    self.polynomial(i, s) - self.z_old[2][i]
                } else {
                    0.0
                };
            }
            for (k, row) in T_INVERSE.iter().enumerate() {
                self.w[k][i] = (0..3).map(|s| row[s] * self.z[s][i]).sum();
            }
        }
    }

    /// Error of the step relative to the tolerance; after a refusal, or at the start, its stiff part is filtered twice.
    fn error(&mut self, plant: &mut impl Plant, h: f64, rejected: bool) -> f64 {
        let n = self.x.len();
        let sum = DVector::from_fn(n, |i, _| (0..3).map(|s| ESTIMATE[s] * self.z[s][i]).sum::<f64>() / h);
        let rate = DVector::from_column_slice(&self.rate);
        let Some(mut error) = self.filtered(h, &(&sum + rate)) else { return f64::NAN };
        let norm = |error: &DVector<f64>, s: &Self| {
            let end = s.x.iter().zip(&s.z[2]).map(|(x, z)| x + z).collect::<Vec<f64>>();
            weighted_norm(error.iter().copied(), &s.x, &end, s.estimated)
        };
        let size = norm(&error, self);
        if size < 1.0 || !(rejected || self.steps.accepted == 0) {
            return size;
        }
        for (trial, (x, e)) in self.trial.iter_mut().zip(self.x.iter().zip(error.iter())) {
            *trial = x + e;
        }
        plant.rate(self.t, &self.trial, &mut self.f[0]);
        if let Some(again) = self.filtered(h, &(sum + DVector::from_column_slice(&self.f[0]))) {
            error = again;
        }
        norm(&error, self)
    }

    /// (μ − J)⁻¹ r with the real μ.
    fn filtered(&self, h: f64, r: &DVector<f64>) -> Option<DVector<f64>> {
        let f = r.len() / 2;
        let mu = REAL / h;
        let top = r.rows(0, f).into_owned();
        let damped = &self.jacobian.damping * &top;
        let a = self.factors.as_ref()?.real.solve(&(r.rows(f, f) + &top * mu - damped))?;
        let b = &a * mu - top;
        let mut out = DVector::zeros(2 * f);
        out.rows_mut(0, f).copy_from(&a);
        out.rows_mut(f, f).copy_from(&b);
        Some(out)
    }

    /// The collocation polynomial of the last step less its start, s = 0 … 1.
    fn polynomial(&self, i: usize, s: f64) -> f64 {
        let mut sum = 0.0;
        for (stage, z) in self.z_old.iter().enumerate() {
            let mut weight = s / C[stage];
            for (other, node) in C.iter().enumerate() {
                if other != stage {
                    weight *= (s - node) / (C[stage] - node);
                }
            }
            sum += weight * z[i];
        }
        sum
    }

    /// Writes x(t) within the last step, to order 3.
    pub fn interpolate(&mut self, _: &mut impl Plant, t: f64, out: &mut [f64]) {
        if t >= self.t || self.h_old == 0.0 {
            out.copy_from_slice(&self.x);
            return;
        }
        let s = ((t - self.t_old) / self.h_old).clamp(0.0, 1.0);
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.x_old[i] + self.polynomial(i, s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ÿ = −ẏ⁰ sin y − 0.3 ẏ + cos t: a damped, driven pendulum.
    struct Pendulum;

    impl Plant for Pendulum {
        fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
            rate[0] = x[1];
            rate[1] = -x[0].sin() - 0.3 * x[1] + t.cos();
        }
        fn settle(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
    }

    /// ÿ = −k (y − cos t) − d ẏ with k = 1e10: follows cos t from any start.
    struct Stiff;

    impl Plant for Stiff {
        fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
            rate[0] = x[1];
            rate[1] = -1e10 * (x[0] - t.cos()) - 1e6 * x[1];
        }
        fn settle(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
    }

    fn end(h: f64) -> f64 {
        let mut integrator = Radau::with_step(&mut Pendulum, 0.0, &[1.0, 0.0], 1e-13, h);
        while integrator.time() < 2.0 - 0.5 * h {
            integrator.step(&mut Pendulum, 1e9).unwrap();
        }
        integrator.state()[0]
    }

    #[test]
    fn has_order_five() {
        let reference = end(1.0 / 128.0);
        let error = |h: f64| (end(h) - reference).abs();
        let order = (error(0.25) / error(0.0625)).log2() / 2.0;
        assert!((order - 5.0).abs() < 0.3, "{order}");
    }

    #[test]
    fn a_stiff_motion_costs_few_steps() {
        let mut integrator = Radau::new(&mut Stiff, 0.0, &[1.5, 0.0], 1e-8);
        while integrator.time() < 10.0 {
            integrator.step(&mut Stiff, 10.0).unwrap();
        }
        let expected = (10.0f64).cos() + 1e-4 * 10f64.sin();
        assert!((integrator.state()[0] - expected).abs() < 1e-7, "{:?}", integrator.state());
        // The estimate is of order three: steps of about 1e-8 to the power 1/4 each.
        assert!(integrator.steps.accepted < 600, "{:?}", integrator.steps);
    }
}
