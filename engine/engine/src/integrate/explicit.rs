//! Explicit Runge-Kutta methods: stages, step control and dense output, whatever the coefficients
//! (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, sections II.4 to II.6) — eq. (10.1).

mod dop853;
mod dopri5;
mod ode45;
mod tableau;

pub use dop853::DOP853;
pub use dopri5::DOPRI5;
pub use ode45::DEFAULT_TOLERANCE as ODE45_TOLERANCE;
pub use tableau::Tableau;

use super::step::{MIN_ERROR, MIN_RETRY, SAFETY, StepRecord, StopReason, weighted_norm};
use super::stepper::{IslandStep, OdeMethod, Stepper};
use ode45::Ode45Control;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::state;

/// A fixed step that is shorter than what is left to the end by at most this factor is stretched to the end: rounding of the
/// sum of steps must not add a sliver.
const FIXED_STEP_STRETCH: f64 = 1.000_001;

/// Change of a step that led where there is no state, as a factor, and how fast larger ones are tried again: ten times as short, and as
/// long again at once, steps spent most of their work beyond the edge of a chart.
const NO_STATE: f64 = 0.5;
const AFTER_NO_STATE: f64 = 1.5;

/// How steps are chosen.
#[derive(Clone, Copy, Debug)]
enum Control {
    /// From the root mean square of the error — eq. (10.1).
    MeanSquare {
        /// Relative and absolute tolerance.
        tolerance: f64,
    },
    /// As MATLAB's ode45 does.
    Ode45(Ode45Control),
    /// All of one size.
    Fixed,
}

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Explicit {
    tableau: &'static Tableau,
    control: Control,
    last: StepRecord,
    /// ẏ at the end of the last step.
    rate: Vec<f64>,
    /// ẏ at the end of the step that is tried.
    end_rate: Vec<f64>,
    /// Size of the next step, and the largest that is tried after one that led where there is no state.
    h: f64,
    largest: f64,
    /// State at the start of the last step, and the stages of the step.
    y_old: Vec<f64>,
    k: Vec<Vec<f64>>,
    trial: Vec<f64>,
    /// Coefficients of the dense output, and whether they are those of the last step.
    dense: Vec<Vec<f64>>,
    dense_ready: bool,
}

impl Explicit {
    /// Starts at (t, y), with relative and absolute tolerance `tolerance`.
    pub fn new(
        tableau: &'static Tableau,
        system: &mut impl OdeSystem,
        t: f64,
        y: &[f64],
        tolerance: f64,
    ) -> Self {
        let mut integrator = Self::at(tableau, Control::MeanSquare { tolerance }, t, y);
        system.rhs(t, y, &mut integrator.rate);
        integrator.h = integrator.first_step(system, tolerance);
        integrator
    }

    /// Starts at (t, y) under the step control of MATLAB's ode45, for a run to `end`.
    pub fn ode45(system: &mut impl OdeSystem, t: f64, y: &[f64], tolerance: f64, end: f64) -> Self {
        let control = Ode45Control::new(tolerance, end - t);
        let mut integrator = Self::at(&DOPRI5, Control::Ode45(control), t, y);
        system.rhs(t, y, &mut integrator.rate);
        integrator.h = control.first_step(y, &integrator.rate, end - t);
        integrator
    }

    /// Starts at (t, y) with steps of size h, whatever the error.
    pub fn with_step(
        tableau: &'static Tableau,
        system: &mut impl OdeSystem,
        t: f64,
        y: &[f64],
        h: f64,
    ) -> Self {
        let mut integrator = Self::at(tableau, Control::Fixed, t, y);
        system.rhs(t, y, &mut integrator.rate);
        integrator.h = h;
        integrator
    }

    fn at(tableau: &'static Tableau, control: Control, t: f64, y: &[f64]) -> Self {
        let n = y.len();
        Self {
            tableau,
            control,
            last: StepRecord::new(t, y),
            rate: vec![0.0; n],
            end_rate: vec![0.0; n],
            h: 0.0,
            largest: f64::INFINITY,
            y_old: y.to_vec(),
            k: vec![vec![0.0; n]; tableau.stored()],
            trial: vec![0.0; n],
            dense: vec![vec![0.0; n]; 3 + tableau.dense.len()],
            dense_ready: false,
        }
    }

    /// A first step from the sizes of y, ẏ and a difference quotient of ẏ.
    fn first_step(&mut self, system: &mut impl OdeSystem, tolerance: f64) -> f64 {
        let (y, f) = (&self.last.y, &self.rate);
        let d0 = weighted_norm(y.iter().copied(), y, y, tolerance);
        let d1 = weighted_norm(f.iter().copied(), y, y, tolerance);
        let h0 = if d0 < 1e-10 || d1 < 1e-10 { 1e-6 } else { 0.01 * d0 / d1 };
        for (x, (y, f)) in self.trial.iter_mut().zip(y.iter().zip(f)) {
            *x = y + h0 * f;
        }
        system.rhs(self.last.t + h0, &self.trial, &mut self.k[1]);
        let change = self.k[1].iter().zip(f).map(|(a, b)| a - b);
        let d2 = weighted_norm(change, y, y, tolerance) / h0;
        let largest = d1.max(d2);
        let power = 1.0 / f64::from(self.tableau.order);
        let h1 = if largest <= 1e-15 { (h0 * 1e-3).max(1e-6) } else { libm::pow(0.01 / largest, power) };
        h1.min(100.0 * h0)
    }

    fn fixed_step(&mut self, system: &mut impl OdeSystem, end: f64) -> Result<(), StopReason> {
        let left = end - self.last.t;
        let h = if FIXED_STEP_STRETCH * self.h >= left { left } else { self.h };
        self.attempt(system, h);
        if !is_finite(&self.trial) {
            return Err(self.last.not_finite());
        }
        // What is not finite there ends the next step.
        self.reach_end(system, h, end);
        if is_finite(&self.end_rate) && !system.knows_turns() {
            return Err(StopReason::TurnsUnknown { time: self.last.t, step: h });
        }
        self.accept(system, h, end);
        Ok(())
    }

    fn step_by_mean_square(
        &mut self,
        system: &mut impl OdeSystem,
        end: f64,
        tolerance: f64,
    ) -> Result<(), StopReason> {
        let power = -1.0 / f64::from(self.tableau.order);
        let (least, greatest) = self.tableau.change;
        let mut rejected = false;
        loop {
            let h = self.last.next_size(self.h, end)?;
            self.attempt(system, h);
            let error =
                self.tableau.error(h, &self.k, &self.last.y, &self.trial, tolerance) * system.magnification();
            let arrives = error >= 1.0 || (self.reach_end(system, h, end) && system.knows_turns());
            let error = if arrives { error } else { f64::NAN };
            if error < 1.0 {
                let grown = (SAFETY * libm::pow(error.max(MIN_ERROR), power)).clamp(least, greatest);
                let next = h * if rejected { grown.min(1.0) } else { grown };
                self.accept(system, h, end);
                // A step that was cut to meet the end says nothing about the next one.
                self.h = if h < self.h { self.h.max(next) } else { next }.min(self.largest);
                self.largest *= AFTER_NO_STATE;
                return Ok(());
            }
            if error.is_finite() {
                self.h = h * (SAFETY * libm::pow(error, power)).max(least);
            } else if h > MIN_RETRY * (1.0 + self.last.t.abs()) && is_finite(&self.rate) {
                self.largest = NO_STATE * h;
                self.h = self.largest;
            } else {
                return Err(self.last.not_finite());
            }
            rejected = true;
            self.last.steps.rejected += 1;
        }
    }

    fn step_by_ode45(
        &mut self,
        system: &mut impl OdeSystem,
        end: f64,
        control: Ode45Control,
    ) -> Result<(), StopReason> {
        let least = 16.0 * f64::EPSILON * self.last.t;
        let left = end - self.last.t;
        let mut h = self.h.clamp(least, control.largest.max(least));
        if 1.1 * h >= left {
            h = left;
        }
        let mut untouched = true;
        let error = loop {
            self.attempt(system, h);
            let error = h * Ode45Control::error(&self.k, &self.last.y, &self.trial) * system.magnification();
            // The last stage is at the end of the step.
            let error = if error <= control.relative && !system.knows_turns() { f64::NAN } else { error };
            if error <= control.relative {
                break error;
            }
            self.last.steps.rejected += 1;
            if error.is_nan() {
                if h <= MIN_RETRY * (1.0 + self.last.t.abs()) || !is_finite(&self.rate) {
                    return Err(self.last.not_finite());
                }
                h *= NO_STATE;
                self.largest = h;
            } else if h <= least {
                return Err(StopReason::StepTooSmall { time: self.last.t, step: h });
            } else {
                h = (h * control.shrink(error, untouched)).max(least);
            }
            untouched = false;
        };
        self.reach_end(system, h, end);
        self.accept(system, h, end);
        self.h = if untouched { control.next(h, error) } else { h }.min(self.largest);
        self.largest *= AFTER_NO_STATE;
        Ok(())
    }

    /// All stages of a step of size h, and its end.
    fn attempt(&mut self, system: &mut impl OdeSystem, h: f64) {
        let Self { tableau, control, last: StepRecord { t, y, .. }, rate, k, trial, .. } = self;
        let rows = tableau.rows;
        let combine = match control {
            Control::MeanSquare { .. } | Control::Fixed => combine,
            // The published counts of steps depend on the last bit.
            Control::Ode45(_) => Ode45Control::combine,
        };
        k[0].copy_from_slice(rate);
        for stage in 1..tableau.stages {
            combine(trial, y, h, rows[stage], k);
            system.begin_stage(stage - 1, true);
            system.rhs(*t + tableau.nodes[stage] * h, trial, &mut k[stage]);
        }
        if !tableau.reuses_last {
            combine(trial, y, h, rows[tableau.stages], k);
        }
    }

    /// Evaluates the end of a step of size h in a run to `end`. False if there is no state there: stages that were found do not show
    /// that it is.
    fn reach_end(&mut self, system: &mut impl OdeSystem, h: f64, end: f64) -> bool {
        if self.tableau.reuses_last {
            self.end_rate.copy_from_slice(&self.k[self.tableau.stages - 1]);
        } else {
            system.begin_stage(self.tableau.stages - 1, true);
            system.rhs(self.last.end_of(h, end), &self.trial, &mut self.end_rate);
        }
        is_finite(&self.end_rate)
    }

    /// Takes over the step whose end was evaluated last.
    fn accept(&mut self, system: &mut impl OdeSystem, h: f64, end: f64) {
        self.y_old.copy_from_slice(&self.last.y);
        self.last.y.copy_from_slice(&self.trial);
        self.last.advance(h, end);
        let StepRecord { t, y, .. } = &mut self.last;
        std::mem::swap(&mut self.rate, &mut self.end_rate);
        system.after_step(*t, y, &mut self.rate);
        self.dense_ready = false;
    }

    fn prepare_dense(&mut self, system: &mut impl OdeSystem) {
        let h = self.last.h;
        let Self { tableau, k, trial, .. } = self;
        if tableau.stored() > tableau.stages {
            k[tableau.stages].copy_from_slice(&self.rate);
        }
        for stage in tableau.stages + 1..tableau.stored() {
            combine(trial, &self.y_old, h, tableau.rows[stage], k);
            system.rhs(self.last.t_old + tableau.nodes[stage] * h, trial, &mut k[stage]);
        }
        for i in 0..self.last.y.len() {
            let change = self.last.y[i] - self.y_old[i];
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

impl OdeMethod for Explicit {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, system: &mut impl OdeSystem, end: f64) -> Result<(), StopReason> {
        match self.control {
            Control::MeanSquare { tolerance } => self.step_by_mean_square(system, end, tolerance),
            Control::Ode45(control) => self.step_by_ode45(system, end, control),
            Control::Fixed => self.fixed_step(system, end),
        }?;
        // Its end is moved onto the constraints, from far away perhaps to nowhere.
        if !is_finite(&self.last.y) {
            OdeMethod::take_back(self);
            return Err(self.last.not_finite());
        }
        Ok(())
    }

    /// What dense output needs beyond the stages is evaluated at most once for each step.
    fn interpolate(&mut self, system: &mut impl OdeSystem, t: f64, out: &mut [f64]) {
        if self.last.has_ended(t) {
            out.copy_from_slice(&self.last.y);
            return;
        }
        if !self.dense_ready {
            self.prepare_dense(system);
        }
        let x = self.last.part(t);
        for (i, out) in out.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (power, coefficient) in self.dense.iter().enumerate().rev() {
                sum = (sum + coefficient[i]) * if power % 2 == 0 { x } else { 1.0 - x };
            }
            *out = self.y_old[i] + sum;
        }
    }

    fn next_size(&self) -> Option<f64> {
        Some(self.h)
    }

    fn take_back(&mut self) {
        self.last.take_back();
        self.last.y.copy_from_slice(&self.y_old);
    }

    fn restart(&mut self, system: &mut impl OdeSystem, y: &[f64], _: &[Vec<f64>]) {
        self.last.y.copy_from_slice(y);
        system.rhs(self.last.t, y, &mut self.rate);
        self.last.h = 0.0;
        self.largest = f64::INFINITY;
    }
}

impl Stepper for Explicit {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        OdeMethod::step(self, mechanism, end)
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        OdeMethod::interpolate(self, mechanism, t, y);
    }

    fn island_step<'a>(&'a self, mechanism: &'a Mechanism) -> Option<IslandStep<'a>> {
        let StepRecord { t, y, h, .. } = &self.last;
        // The last evaluation was at the end of the step.
        let pivot_products = Some(mechanism.elimination.pivot_products());
        let pace = state::fastest(&mechanism.system, y);
        let (start, constraints) = (t - h, None);
        Some(IslandStep { island: 0, start, end: *t, pivot_products, constraints, pace, clearance: 0.0 })
    }

    fn next_size(&self) -> Option<f64> {
        OdeMethod::next_size(self)
    }

    fn can_retreat(&self) -> bool {
        !matches!(self.control, Control::Fixed) && self.last.h > 0.0
    }

    fn retreat(&mut self, mechanism: &mut Mechanism) {
        self.take_back();
        self.rate.copy_from_slice(&self.k[0]);
        mechanism.set_state(self.last.t, &self.last.y);
        mechanism.state.commit_motion();
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

fn is_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

/// out ← y + h Σ a_j k_j.
fn combine(out: &mut [f64], y: &[f64], h: f64, weights: &[(usize, f64)], k: &[Vec<f64>]) {
    out.copy_from_slice(y);
    for &(j, a) in weights {
        let factor = h * a;
        for (out, k) in out.iter_mut().zip(&k[j]) {
            *out += factor * k;
        }
    }
}
