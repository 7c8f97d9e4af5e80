//! Explicit Runge-Kutta methods: stages, step control and dense output, whatever the coefficients
//! (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, sections II.4 to II.6) — eq. (10.1).

use super::matlab::Matlab;
use super::tableau::Tableau;
use super::{Plant, Steps, Stop, combine, resolution, weighted_norm};

/// Safety factor of the step control.
const SAFETY: f64 = 0.9;

/// How steps are chosen.
#[derive(Clone, Copy, Debug)]
enum Control {
    /// From the root mean square of the error — eq. (10.1).
    MeanSquare {
        /// Relative and absolute tolerance.
        tolerance: f64,
    },
    /// As MATLAB's ode45 does.
    Matlab(Matlab),
    /// All of one size.
    Fixed,
}

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Explicit {
    tableau: &'static Tableau,
    control: Control,
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

impl Explicit {
    /// Starts at (t, y), with relative and absolute tolerance `tolerance`.
    pub fn new(tableau: &'static Tableau, plant: &mut impl Plant, t: f64, y: &[f64], tolerance: f64) -> Self {
        let mut integrator = Self::at(tableau, Control::MeanSquare { tolerance }, t, y);
        plant.rate(t, y, &mut integrator.rate);
        integrator.h = integrator.first_step(plant, tolerance);
        integrator
    }

    /// Starts at (t, y) under the step control of MATLAB's ode45, for a run to `end`.
    pub fn ode45(plant: &mut impl Plant, t: f64, y: &[f64], tolerance: f64, end: f64) -> Self {
        let control = Matlab::new(tolerance, end - t);
        let mut integrator = Self::at(&super::DOPRI5, Control::Matlab(control), t, y);
        plant.rate(t, y, &mut integrator.rate);
        integrator.h = control.first_step(y, &integrator.rate, end - t);
        integrator
    }

    /// Starts at (t, y) with steps of size h, whatever the error.
    pub fn with_step(tableau: &'static Tableau, plant: &mut impl Plant, t: f64, y: &[f64], h: f64) -> Self {
        let mut integrator = Self::at(tableau, Control::Fixed, t, y);
        plant.rate(t, y, &mut integrator.rate);
        integrator.h = h;
        integrator
    }

    fn at(tableau: &'static Tableau, control: Control, t: f64, y: &[f64]) -> Self {
        let n = y.len();
        Self {
            tableau,
            control,
            t,
            y: y.to_vec(),
            rate: vec![0.0; n],
            h: 0.0,
            t_old: t,
            h_old: 0.0,
            y_old: y.to_vec(),
            k: vec![vec![0.0; n]; tableau.stored()],
            trial: vec![0.0; n],
            dense: vec![vec![0.0; n]; 3 + tableau.dense.len()],
            dense_ready: false,
            steps: Steps::default(),
        }
    }

    /// Goes on from (t, y), a state written in other coordinates, with the step size that was reached.
    pub fn restart(&mut self, plant: &mut impl Plant, y: &[f64]) {
        self.y.copy_from_slice(y);
        plant.rate(self.t, y, &mut self.rate);
        self.h_old = 0.0;
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

    /// A first step from the sizes of y, ẏ and a difference quotient of ẏ.
    fn first_step(&mut self, plant: &mut impl Plant, tolerance: f64) -> f64 {
        let (y, f) = (&self.y, &self.rate);
        let d0 = weighted_norm(y.iter().copied(), y, y, tolerance);
        let d1 = weighted_norm(f.iter().copied(), y, y, tolerance);
        let h0 = if d0 < 1e-10 || d1 < 1e-10 { 1e-6 } else { 0.01 * d0 / d1 };
        for (x, (y, f)) in self.trial.iter_mut().zip(y.iter().zip(f)) {
            *x = y + h0 * f;
        }
        plant.rate(self.t + h0, &self.trial, &mut self.k[1]);
        let change = self.k[1].iter().zip(f).map(|(a, b)| a - b);
        let d2 = weighted_norm(change, y, y, tolerance) / h0;
        let largest = d1.max(d2);
        let power = 1.0 / f64::from(self.tableau.order);
        let h1 = if largest <= 1e-15 { (h0 * 1e-3).max(1e-6) } else { (0.01 / largest).powf(power) };
        h1.min(100.0 * h0)
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, plant: &mut impl Plant, end: f64) -> Result<(), Stop> {
        match self.control {
            Control::MeanSquare { tolerance } => self.step_by_mean_square(plant, end, tolerance),
            Control::Matlab(control) => self.step_by_matlab(plant, end, control),
            Control::Fixed => {
                let left = end - self.t;
                let h = if 1.000_001 * self.h >= left { left } else { self.h };
                self.attempt(plant, h);
                if self.trial.iter().any(|y| !y.is_finite()) {
                    return Err(Stop::NotFinite { time: self.t });
                }
                self.accept(plant, h, end);
                Ok(())
            }
        }
    }

    fn step_by_mean_square(&mut self, plant: &mut impl Plant, end: f64, tolerance: f64) -> Result<(), Stop> {
        let power = -1.0 / f64::from(self.tableau.order);
        let (least, greatest) = self.tableau.change;
        let mut rejected = false;
        loop {
            // Stretch a step that would leave a sliver before the end.
            let left = end - self.t;
            let h = if 1.01 * self.h >= left { left } else { self.h };
            if h <= resolution(self.t, end) && left > h {
                return Err(Stop::StepTooSmall { time: self.t, step: h });
            }
            self.attempt(plant, h);
            let error = self.tableau.error(h, &self.k, &self.y, &self.trial, tolerance);
            if error < 1.0 {
                let grown = (SAFETY * error.max(1e-12).powf(power)).clamp(least, greatest);
                let next = h * if rejected { grown.min(1.0) } else { grown };
                self.accept(plant, h, end);
                // A step that was cut to meet the end says nothing about the next one.
                self.h = if h < self.h { self.h.max(next) } else { next };
                return Ok(());
            }
            if error.is_finite() {
                self.h = h * (SAFETY * error.powf(power)).max(least);
            } else if h > 1e-10 * (1.0 + self.t.abs()) {
                self.h = 0.1 * h;
            } else {
                return Err(Stop::NotFinite { time: self.t });
            }
            rejected = true;
            self.steps.rejected += 1;
        }
    }

    fn step_by_matlab(&mut self, plant: &mut impl Plant, end: f64, control: Matlab) -> Result<(), Stop> {
        let least = 16.0 * f64::EPSILON * self.t;
        let left = end - self.t;
        let mut h = self.h.clamp(least, control.largest.max(least));
        if 1.1 * h >= left {
            h = left;
        }
        let mut untouched = true;
        let error = loop {
            self.attempt(plant, h);
            let error = h * Matlab::error(&self.k, &self.y, &self.trial);
            if error <= control.relative {
                break error;
            }
            self.steps.rejected += 1;
            if error.is_nan() {
                return Err(Stop::NotFinite { time: self.t });
            }
            if h <= least {
                return Err(Stop::StepTooSmall { time: self.t, step: h });
            }
            h = (h * control.shrink(error, untouched)).max(least);
            untouched = false;
        };
        self.accept(plant, h, end);
        self.h = if untouched { control.next(h, error) } else { h };
        Ok(())
    }

    /// All stages of a step of size h, and its end.
    fn attempt(&mut self, plant: &mut impl Plant, h: f64) {
        let Self { tableau, control, t, y, rate, k, trial, .. } = self;
        let rows = tableau.rows;
        let combine = match control {
            Control::MeanSquare { .. } | Control::Fixed => combine,
            // The published counts of steps depend on the last bit.
            Control::Matlab(_) => Matlab::combine,
        };
        k[0].copy_from_slice(rate);
        for stage in 1..tableau.stages {
            combine(trial, y, h, rows[stage], k);
            plant.rate(*t + tableau.nodes[stage] * h, trial, &mut k[stage]);
        }
        if !tableau.reuses_last {
            combine(trial, y, h, rows[tableau.stages], k);
        }
    }

    fn accept(&mut self, plant: &mut impl Plant, h: f64, end: f64) {
        self.t_old = self.t;
        self.h_old = h;
        self.y_old.copy_from_slice(&self.y);
        self.y.copy_from_slice(&self.trial);
        self.t = if h == end - self.t { end } else { self.t + h };
        if self.tableau.reuses_last {
            self.rate.copy_from_slice(&self.k[self.tableau.stages - 1]);
        } else {
            plant.rate(self.t, &self.y, &mut self.rate);
        }
        plant.settle(self.t, &mut self.y, &mut self.rate);
        self.dense_ready = false;
        self.steps.accepted += 1;
    }

    /// Writes y(t) within the last step. What it needs beyond the stages is evaluated once for each step that is
    /// asked.
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
            for (power, coefficient) in self.dense.iter().enumerate().rev() {
                sum = (sum + coefficient[i]) * if power % 2 == 0 { x } else { 1.0 - x };
            }
            *out = self.y_old[i] + sum;
        }
    }

    fn prepare_dense(&mut self, plant: &mut impl Plant) {
        let h = self.h_old;
        let Self { tableau, k, trial, .. } = self;
        if tableau.stored() > tableau.stages {
            k[tableau.stages].copy_from_slice(&self.rate);
        }
        for stage in tableau.stages + 1..tableau.stored() {
            combine(trial, &self.y_old, h, tableau.rows[stage], k);
            plant.rate(self.t_old + tableau.nodes[stage] * h, trial, &mut k[stage]);
        }
        for i in 0..self.y.len() {
            let change = self.y[i] - self.y_old[i];
            self.dense[0][i] = change;
            self.dense[1][i] = h * k[0][i] - change;
            self.dense[2][i] = 2.0 * change - h * (self.rate[i] + k[0][i]);
            for (row, weights) in tableau.dense.iter().enumerate() {
                self.dense[3 + row][i] = h * weights.iter().map(|&(j, d)| d * k[j][i]).sum::<f64>();
            }
        }
        self.dense_ready = true;
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DOP853, DOPRI5};
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

    fn fixed_step(tableau: &'static Tableau, h: f64) -> Explicit {
        let mut integrator = Explicit::with_step(tableau, &mut Oscillator, 0.0, &[0.0, 2.0], h);
        while integrator.t < 2.0 {
            integrator.step(&mut Oscillator, 2.0).unwrap();
        }
        integrator
    }

    /// Orders of the end of a step and of the dense output, the step going from `h` to a part of it.
    fn orders(tableau: &'static Tableau, h: f64) -> (f64, f64) {
        let end = |h: f64| (fixed_step(tableau, h).y[0] - (2f64.sin() + 2.0)).abs();
        let inside = |h: f64| {
            let mut integrator = fixed_step(tableau, h);
            let mut worst: f64 = 0.0;
            for part in 1..20 {
                let t = 2.0 - h * f64::from(part) / 20.0;
                let mut y = [0.0; 2];
                integrator.interpolate(&mut Oscillator, t, &mut y);
                worst = worst.max((y[0] - t.sin() - t).abs());
            }
            worst
        };
        ((end(h) / end(h / 4.0)).log2() / 2.0, (inside(h) / inside(h / 2.0)).log2())
    }

    #[test]
    fn dop853_has_order_eight_and_dense_output_of_order_seven() {
        let (end, inside) = orders(&DOP853, 0.5);
        assert!((end - 8.0).abs() < 0.3, "{end}");
        assert!((7.0..9.0).contains(&inside), "{inside}");
    }

    #[test]
    fn dopri5_has_order_five_and_dense_output_of_order_four() {
        let end = orders(&DOPRI5, 0.125).0;
        assert!((end - 5.0).abs() < 0.3, "{end}");
        let inside = orders(&DOPRI5, 0.25).1;
        assert!((4.0..6.2).contains(&inside), "{inside}");
    }

    #[test]
    fn all_meet_the_end_exactly_and_the_estimate_bounds_the_error() {
        let y = [0.0, 2.0];
        for mut integrator in [
            Explicit::new(&DOP853, &mut Oscillator, 0.0, &y, 1e-9),
            Explicit::new(&DOPRI5, &mut Oscillator, 0.0, &y, 1e-9),
            Explicit::ode45(&mut Oscillator, 0.0, &y, 1e-9, 3.0),
        ] {
            while integrator.time() < 3.0 {
                integrator.step(&mut Oscillator, 3.0).unwrap();
            }
            assert_eq!(integrator.time(), 3.0);
            assert!((integrator.state()[0] - 3f64.sin() - 3.0).abs() < 1e-7);
        }
    }
}
