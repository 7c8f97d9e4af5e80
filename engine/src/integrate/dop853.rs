//! DOP853: explicit Runge-Kutta of order 8 with error estimates of orders 5 and 3 and dense output of order 7
//! (Dormand and Prince; Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, section II.5).

use super::dop853_coefficients::{A, C, D, E3, E5, EXTENDED, STAGES};
use super::{Plant, Steps, Stop, combine, weighted_norm};

/// Safety factor of the step control, and the least and greatest change of the step.
const SAFETY: f64 = 0.9;
const LEAST: f64 = 0.333;
const GREATEST: f64 = 6.0;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Dop853 {
    tolerance: f64,
    /// End of the last accepted step.
    t: f64,
    y: Vec<f64>,
    rate: Vec<f64>,
    /// Size of the next step.
    h: f64,
    /// The last accepted step: its start, size, first state and stages.
    t_old: f64,
    h_old: f64,
    y_old: Vec<f64>,
    k: Vec<Vec<f64>>,
    trial: Vec<f64>,
    dense: Vec<Vec<f64>>,
    dense_ready: bool,
    /// Steps so far.
    pub steps: Steps,
}

impl Dop853 {
    /// Order of the method.
    pub const ORDER: u32 = 8;

    /// Starts at (t, y), with relative and absolute tolerance `tolerance`.
    pub fn new(plant: &mut impl Plant, t: f64, y: &[f64], tolerance: f64) -> Self {
        let n = y.len();
        let mut integrator = Self {
            tolerance,
            t,
            y: y.to_vec(),
            rate: vec![0.0; n],
            h: 0.0,
            t_old: t,
            h_old: 0.0,
            y_old: y.to_vec(),
            k: vec![vec![0.0; n]; EXTENDED],
            trial: vec![0.0; n],
            dense: vec![vec![0.0; n]; 7],
            dense_ready: false,
            steps: Steps::default(),
        };
        plant.rate(t, y, &mut integrator.rate);
        integrator.h = integrator.first_step(plant);
        integrator
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &[f64] {
        &self.y
    }

    /// Size of the last accepted step, s.
    pub fn last_step(&self) -> f64 {
        self.h_old
    }

    /// The first step of Hairer's `hinit`: from the sizes of y, ẏ and a difference quotient of ẏ.
    fn first_step(&mut self, plant: &mut impl Plant) -> f64 {
        let (y, f) = (&self.y, &self.rate);
        let d0 = weighted_norm(y.iter().copied(), y, y, self.tolerance);
        let d1 = weighted_norm(f.iter().copied(), y, y, self.tolerance);
        let h0 = if d0 < 1e-10 || d1 < 1e-10 { 1e-6 } else { 0.01 * d0 / d1 };
        for (x, (y, f)) in self.trial.iter_mut().zip(y.iter().zip(f)) {
            *x = y + h0 * f;
        }
        plant.rate(self.t + h0, &self.trial, &mut self.k[1]);
        let change = self.k[1].iter().zip(f).map(|(a, b)| a - b);
        let d2 = weighted_norm(change, y, y, self.tolerance) / h0;
        let largest = d1.max(d2);
        let h1 = if largest <= 1e-15 { (h0 * 1e-3).max(1e-6) } else { (0.01 / largest).powf(1.0 / 8.0) };
        h1.min(100.0 * h0)
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop> {
        let mut rejected = false;
        loop {
            // Stretch a step that would leave a sliver before the end.
            let left = end - self.t;
            let h = if 1.01 * self.h >= left { left } else { self.h };
            if h <= 16.0 * f64::EPSILON * self.t.abs().max(end.abs()) && left > h {
                return Err(Stop::StepTooSmall { time: self.t, step: h });
            }
            let error = self.attempt(plant, h);
            if error < 1.0 {
                let grown = (SAFETY * error.max(1e-12).powf(-1.0 / 8.0)).clamp(LEAST, GREATEST);
                let next = h * if rejected { grown.min(1.0) } else { grown };
                self.accept(plant, h, end);
                // A step that was cut to meet the end says nothing about the next one.
                self.h = if h < self.h { self.h.max(next) } else { next };
                return Ok(());
            }
            if error.is_finite() {
                self.h = h * (SAFETY * error.powf(-1.0 / 8.0)).max(LEAST);
            } else if h > 1e-10 * (1.0 + self.t.abs()) {
                self.h = 0.1 * h;
            } else {
                return Err(Stop::NotFinite { time: self.t });
            }
            rejected = true;
            self.steps.rejected += 1;
        }
    }

    /// All stages of a step of size h; returns its error relative to the tolerance.
    fn attempt(&mut self, plant: &mut impl Plant, h: f64) -> f64 {
        self.k[0].copy_from_slice(&self.rate);
        for stage in 1..STAGES {
            combine(&mut self.trial, &self.y, h, A[stage], &self.k);
            plant.rate(self.t + C[stage] * h, &self.trial, &mut self.k[stage]);
        }
        combine(&mut self.trial, &self.y, h, A[STAGES], &self.k);
        let estimate = |weights: &[(usize, f64)]| {
            let sum = |i: usize| weights.iter().map(|&(j, e)| e * self.k[j][i]).sum::<f64>();
            let n = self.y.len();
            weighted_norm((0..n).map(sum), &self.y, &self.trial, self.tolerance)
        };
        let (e5, e3) = (estimate(E5), estimate(E3));
        if e5 == 0.0 && e3 == 0.0 { 0.0 } else { h * e5 * e5 / (e5 * e5 + 0.01 * e3 * e3).sqrt() }
    }

    fn accept(&mut self, plant: &mut impl Plant, h: f64, end: f64) {
        self.t_old = self.t;
        self.h_old = h;
        self.y_old.copy_from_slice(&self.y);
        self.y.copy_from_slice(&self.trial);
        self.t = if h == end - self.t { end } else { self.t + h };
        plant.rate(self.t, &self.y, &mut self.rate);
        plant.settle(self.t, &mut self.y, &mut self.rate);
        self.dense_ready = false;
        self.steps.accepted += 1;
    }

    /// Writes y(t) within the last step, to order 7. Three evaluations, once for each step that is asked.
    pub fn interpolate(&mut self, plant: &mut impl Plant, t: f64, out: &mut [f64]) {
        if t >= self.t || self.h_old == 0.0 {
            out.copy_from_slice(&self.y);
            return;
        }
        if !self.dense_ready {
            self.prepare_dense(plant);
        }
        let x = ((t - self.t_old) / self.h_old).clamp(0.0, 1.0);
        for (i, out) in out.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (power, coefficient) in self.dense.iter().rev().enumerate() {
                sum = (sum + coefficient[i]) * if power % 2 == 0 { x } else { 1.0 - x };
            }
            *out = self.y_old[i] + sum;
        }
    }

    fn prepare_dense(&mut self, plant: &mut impl Plant) {
        let h = self.h_old;
        self.k[STAGES].copy_from_slice(&self.rate);
        for stage in STAGES + 1..EXTENDED {
            combine(&mut self.trial, &self.y_old, h, A[stage], &self.k);
            plant.rate(self.t_old + C[stage] * h, &self.trial, &mut self.k[stage]);
        }
        for i in 0..self.y.len() {
            let change = self.y[i] - self.y_old[i];
            self.dense[0][i] = change;
            self.dense[1][i] = h * self.k[0][i] - change;
            self.dense[2][i] = 2.0 * change - h * (self.k[STAGES][i] + self.k[0][i]);
            for (row, weights) in D.iter().enumerate() {
                self.dense[3 + row][i] = h * weights.iter().map(|&(j, d)| d * self.k[j][i]).sum::<f64>();
            }
        }
        self.dense_ready = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ẏ = (y₂, −y₁ + t): y = (sin t + t, cos t + 1) from (0, 2).
    struct Oscillator;

    impl Plant for Oscillator {
        fn rate(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
            rate[0] = y[1];
            rate[1] = -y[0] + t;
        }
        fn settle(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
    }

    fn fixed_step(h: f64) -> Dop853 {
        let mut integrator = Dop853::new(&mut Oscillator, 0.0, &[0.0, 2.0], 1e6);
        while integrator.t < 2.0 - 1e-9 {
            integrator.h = h;
            integrator.attempt(&mut Oscillator, h);
            integrator.accept(&mut Oscillator, h, 1e9);
        }
        integrator
    }

    #[test]
    fn has_order_eight_and_dense_output_of_order_seven() {
        let end = |h: f64| (fixed_step(h).y[0] - (2f64.sin() + 2.0)).abs();
        let order = (end(0.5) / end(0.125)).log2() / 2.0;
        assert!((order - 8.0).abs() < 0.3, "{order}");
        let inside = |h: f64| {
            let mut integrator = fixed_step(h);
            let mut worst: f64 = 0.0;
            for part in 1..20 {
                let t = 2.0 - h * f64::from(part) / 20.0;
                let mut y = [0.0; 2];
                integrator.interpolate(&mut Oscillator, t, &mut y);
                worst = worst.max((y[0] - t.sin() - t).abs());
            }
            worst
        };
        let order = (inside(0.5) / inside(0.25)).log2();
        assert!((7.0..9.0).contains(&order), "{order}");
    }

    #[test]
    fn meets_the_end_exactly() {
        let mut integrator = Dop853::new(&mut Oscillator, 0.0, &[0.0, 2.0], 1e-10);
        while integrator.time() < 3.0 {
            integrator.step(&mut Oscillator, 3.0).unwrap();
        }
        assert_eq!(integrator.time(), 3.0);
        assert!((integrator.state()[0] - 3f64.sin() - 3.0).abs() < 1e-9);
    }
}
