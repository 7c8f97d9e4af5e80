//! Dormand-Prince 5(4): explicit Runge-Kutta of order 5 with an error estimate of order 4 and dense output of order 4
//! (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, section II.5, II.6).

use super::{Plant, Steps, Stop, combine, weighted_norm};

/// Safety factor of the step control, and the least and greatest change of the step.
const SAFETY: f64 = 0.9;
const LEAST: f64 = 0.2;
const GREATEST: f64 = 10.0;
const STAGES: usize = 7;

/// Nodes c and rows of A; the last row is b, whose rate is the first stage of the next step.
const C: [f64; STAGES] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
const A: [&[(usize, f64)]; STAGES] = [
    &[],
    &[(0, 1.0 / 5.0)],
    &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
    &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
    &[(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)],
    &[
        (0, 9017.0 / 3168.0),
        (1, -355.0 / 33.0),
        (2, 46732.0 / 5247.0),
        (3, 49.0 / 176.0),
        (4, -5103.0 / 18656.0),
    ],
    &[(0, 35.0 / 384.0), (2, 500.0 / 1113.0), (3, 125.0 / 192.0), (4, -2187.0 / 6784.0), (5, 11.0 / 84.0)],
];
/// b less the weights of order 4.
const E: [f64; STAGES] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// The fourth difference of the dense output.
const D: [f64; STAGES] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Dopri5 {
    tolerance: f64,
    t: f64,
    y: Vec<f64>,
    rate: Vec<f64>,
    h: f64,
    t_old: f64,
    h_old: f64,
    y_old: Vec<f64>,
    k: Vec<Vec<f64>>,
    trial: Vec<f64>,
    /// Steps so far.
    pub steps: Steps,
}

impl Dopri5 {
    /// Order of the method.
    pub const ORDER: u32 = 5;

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
            k: vec![vec![0.0; n]; STAGES],
            trial: vec![0.0; n],
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
        let h1 = if largest <= 1e-15 { (h0 * 1e-3).max(1e-6) } else { (0.01 / largest).powf(0.2) };
        h1.min(100.0 * h0)
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop> {
        let mut rejected = false;
        loop {
            let left = end - self.t;
            let h = if 1.01 * self.h >= left { left } else { self.h };
            if h <= 16.0 * f64::EPSILON * self.t.abs().max(end.abs()) && left > h {
                return Err(Stop::StepTooSmall { time: self.t, step: h });
            }
            let error = self.attempt(plant, h);
            if error < 1.0 {
                let grown = (SAFETY * error.max(1e-10).powf(-0.2)).clamp(LEAST, GREATEST);
                let next = h * if rejected { grown.min(1.0) } else { grown };
                self.accept(plant, h, end);
                self.h = if h < self.h { self.h.max(next) } else { next };
                return Ok(());
            }
            if error.is_finite() {
                self.h = h * (SAFETY * error.powf(-0.2)).max(LEAST);
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
        let sum = |i: usize| h * (0..STAGES).map(|j| E[j] * self.k[j][i]).sum::<f64>();
        weighted_norm((0..self.y.len()).map(sum), &self.y, &self.trial, self.tolerance)
    }

    fn accept(&mut self, plant: &mut impl Plant, h: f64, end: f64) {
        self.t_old = self.t;
        self.h_old = h;
        self.y_old.copy_from_slice(&self.y);
        self.y.copy_from_slice(&self.trial);
        self.t = if h == end - self.t { end } else { self.t + h };
        self.rate.copy_from_slice(&self.k[STAGES - 1]);
        plant.settle(self.t, &mut self.y, &mut self.rate);
        self.steps.accepted += 1;
    }

    /// Writes y(t) within the last step, to order 4.
    pub fn interpolate(&self, t: f64, out: &mut [f64]) {
        if t >= self.t || self.h_old == 0.0 {
            out.copy_from_slice(&self.y);
            return;
        }
        let h = self.h_old;
        let x = ((t - self.t_old) / h).clamp(0.0, 1.0);
        for (i, out) in out.iter_mut().enumerate() {
            let change = self.y[i] - self.y_old[i];
            let start = h * self.k[0][i] - change;
            let end = change - h * self.rate[i] - start;
            let fourth = h * (0..STAGES).map(|j| D[j] * self.k[j][i]).sum::<f64>();
            *out = self.y_old[i] + x * (change + (1.0 - x) * (start + x * (end + (1.0 - x) * fourth)));
        }
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

    fn fixed_step(h: f64) -> Dopri5 {
        let mut integrator = Dopri5::new(&mut Oscillator, 0.0, &[0.0, 2.0], 1e6);
        while integrator.t < 2.0 - 1e-9 {
            integrator.attempt(&mut Oscillator, h);
            integrator.accept(&mut Oscillator, h, 1e9);
        }
        integrator
    }

    #[test]
    fn has_order_five_and_dense_output_of_order_four() {
        let end = |h: f64| (fixed_step(h).y[0] - (2f64.sin() + 2.0)).abs();
        let order = (end(0.125) / end(0.03125)).log2() / 2.0;
        assert!((order - 5.0).abs() < 0.3, "{order}");
        let inside = |h: f64| {
            let integrator = fixed_step(h);
            (1..20)
                .map(|part| {
                    let t = 2.0 - h * f64::from(part) / 20.0;
                    let mut y = [0.0; 2];
                    integrator.interpolate(t, &mut y);
                    (y[0] - t.sin() - t).abs()
                })
                .fold(0.0, f64::max)
        };
        let order = (inside(0.25) / inside(0.125)).log2();
        assert!((4.0..6.2).contains(&order), "{order}");
    }

    #[test]
    fn the_estimate_bounds_the_error_of_a_run() {
        let mut integrator = Dopri5::new(&mut Oscillator, 0.0, &[0.0, 2.0], 1e-9);
        while integrator.time() < 3.0 {
            integrator.step(&mut Oscillator, 3.0).unwrap();
        }
        assert_eq!(integrator.time(), 3.0);
        assert!((integrator.state()[0] - 3f64.sin() - 3.0).abs() < 1e-7);
    }
}
