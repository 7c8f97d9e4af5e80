//! Radau IIA of orders 5, 9 and 13: implicit Runge-Kutta for stiff springs, dampers and friction — eq. (10.6)
//! (Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.8).
//!
//! It integrates ẋ = f(t, x), x = (η, η̇), second-order equations in independent coordinates: the linear systems of
//! Newton's method then have the size of η alone. Their matrices come from differences of f and are kept from step to
//! step as long as Newton's method converges well.

mod coefficients;
mod linear;

mod blocks;

mod factors;
mod updates;

mod stages;

mod differences;

mod beside;

mod breaks;

mod error;

use super::step::{MIN_ERROR, SAFETY, StepRecord, StopReason, weighted_norm};
use super::stepper::OdeMethod;
use beside::Beside;
pub use coefficients::{RADAU_5, RADAU_9, RADAU_13, RadauTables};
use differences::BesideStates;
use factors::Factors;
use linear::RateJacobian;
use stages::Stages;
use triad_dynamics::ode::OdeSystem;

/// Ratio of successive corrections that steps are chosen for: it grows with the step, and beyond this one Newton's method
/// costs more than a longer step saves.
const CONTRACTION: f64 = 0.25;
/// Ratio of successive corrections above which the next step gets a new Jacobian matrix.
const SLOW: f64 = 1e-2;
/// Part of their size by which the coordinates may change in the first step, before its error is known.
const FIRST_CHANGE: f64 = 1e-2;
/// The first step where nothing moves yet, s.
const LONGEST_FIRST_STEP: f64 = 1e-2;
/// Least and greatest change of the step, as factors.
const CHANGE: (f64, f64) = (0.125, 6.0);
/// Change of a step whose equations were not solved, as a factor, and how fast larger ones are tried again.
const UNSOLVED: f64 = 0.6;
const AFTER_UNSOLVED: f64 = 1.08;
/// Least change of the step for the sake of Newton's method, as a factor.
const MIN_FOR_CONTRACTION: f64 = 0.5;
/// Factors of the step that are not worth new factors of the matrices.
const KEPT: std::ops::Range<f64> = 1.0..1.2;
/// Square of the same, in predictive control.
const MIN_SQUARED_ERROR: f64 = 1e-24;
/// Error of the step before that predictive control takes for no smaller than this.
const MIN_LAST_ERROR: f64 = 1e-2;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Radau {
    /// Bound of the error estimate: where a motion is stiff, errors are of the estimate's order, not of the method's.
    estimated: f64,
    /// −1 / order of the error of the estimate.
    exponent: f64,
    fixed: bool,
    last: StepRecord,
    /// ẋ at the end of the last step.
    rate: Vec<f64>,
    /// Size of the next step, and the largest that is tried after one whose equations could not be solved.
    h: f64,
    largest: f64,
    /// Power at the end of the last step, W, if something changes the energy, and the sum of its absolute work so far, J.
    power: Option<f64>,
    turnover: f64,
    /// The same with the step that is tried.
    new_turnover: f64,
    x_old: Vec<f64>,
    stages: Stages,
    trial: Vec<f64>,
    trial_rate: Vec<f64>,
    defect: Vec<f64>,
    /// Which way dry frictions slide at the start and at the end of a step.
    slidings: [Vec<i8>; 2],
    jacobian: RateJacobian,
    beside_states: BesideStates,
    factors: Factors,
    /// Ratio of successive corrections in the last step.
    contraction: f64,
    /// Size and error of the step before.
    before: Option<(f64, f64)>,
    /// What it has needed to take steps beside another run.
    beside: Option<Box<Beside>>,
}

impl Radau {
    /// Order of the method with steps of one size.
    pub const ORDER: u32 = 5;

    /// Starts at (t, x) with relative and absolute tolerance `tolerance`.
    pub fn new(system: &mut impl OdeSystem, t: f64, x: &[f64], tolerance: f64) -> Self {
        let tables = RadauTables::of(tolerance, system.solves_nothing());
        let mut integrator = Self::with_tables(tables, system, t, x, tolerance);
        integrator.h = first_step(x, &integrator.rate);
        integrator
    }

    /// Starts at (t, x) with steps of size h, whatever the error; their equations are solved to the tolerance.
    pub fn with_step(
        tables: &'static RadauTables,
        system: &mut impl OdeSystem,
        t: f64,
        x: &[f64],
        tolerance: f64,
        h: f64,
    ) -> Self {
        let mut integrator = Self::with_tables(tables, system, t, x, tolerance);
        (integrator.fixed, integrator.h) = (true, h);
        integrator
    }

    /// The same with one iteration of Newton's method more in each step than the tolerance asks for. Where its first guess is the start
    /// of the step, what a number of iterations leaves is the same function of time whatever the step: two solutions that make as
    /// many agree in it.
    #[must_use]
    pub fn solving_further(mut self) -> Self {
        self.stages.further = true;
        self
    }

    fn with_tables(
        tables: &'static RadauTables,
        system: &mut impl OdeSystem,
        t: f64,
        x: &[f64],
        tolerance: f64,
    ) -> Self {
        let n = x.len();
        let mut rate = vec![0.0; n];
        system.rhs(t, x, &mut rate);
        let power = system.power();
        let stages = Stages::new(tables, n);
        Self {
            power,
            turnover: 0.0,
            new_turnover: 0.0,
            estimated: tolerance,
            exponent: -1.0 / (tables.nodes.len() + 1) as f64,
            fixed: false,
            last: StepRecord::new(t, x),
            rate,
            h: 0.0,
            largest: f64::INFINITY,
            x_old: x.to_vec(),
            factors: Factors::new(n / 2, &stages.blocks),
            stages,
            trial: vec![0.0; n],
            trial_rate: vec![0.0; n],
            defect: vec![0.0; n],
            slidings: Default::default(),
            jacobian: RateJacobian::new(n / 2),
            beside_states: BesideStates::new(n),
            contraction: 1.0,
            before: None,
            beside: None,
        }
    }

    fn accept(&mut self, system: &mut impl OdeSystem, h: f64, end: f64, error: f64, by: f64) {
        // Predictive control: what the last change of the step did to the error tells what the next one will do.
        let mut by = by;
        if let Some((h_before, error_before)) = self.before {
            let predicted = SAFETY * h / h_before
                * libm::pow(error_before / (error * error).max(MIN_SQUARED_ERROR), -self.exponent);
            by = by.min(predicted.clamp(CHANGE.0, CHANGE.1));
        }
        self.before = Some((h, error.max(MIN_LAST_ERROR)));
        let whole = h >= self.h;
        self.x_old.copy_from_slice(&self.last.y);
        self.last.y.copy_from_slice(&self.trial);
        self.rate.copy_from_slice(&self.trial_rate);
        self.stages.accept();
        self.turnover = self.new_turnover;
        self.last.advance(h, end);
        self.power = system.power();
        system.after_step(self.last.t, &mut self.last.y, &mut self.rate);
        self.jacobian.fresh = false;
        if self.fixed {
            return;
        }
        // Small changes are not worth new factors; a step that was cut to meet the end says nothing about the next.
        let next = if KEPT.contains(&by) && self.contraction < SLOW { h } else { h * by };
        self.h = if whole { next } else { self.h.max(next) }.min(self.largest);
        self.largest *= AFTER_UNSOLVED;
    }

    /// Evaluates the end of a step of size h in a run to `end`. False if there is no state there: stages that were found do not
    /// show that it is.
    fn reach_end(&mut self, system: &mut impl OdeSystem, h: f64, end: f64) -> bool {
        let y = &self.last.y;
        let Some(z) = self.stages.z.last() else { return false };
        for (trial, (x, z)) in self.trial.iter_mut().zip(y.iter().zip(z)) {
            *trial = x + z;
        }
        let time = self.last.end_of(h, end);
        system.begin_stage(self.stages.z.len() - 1, false);
        if let Some(rate) = self.stages.rate_at(time) {
            self.trial_rate.copy_from_slice(rate);
            return system.reach(time, &self.trial);
        }
        system.rhs(time, &self.trial, &mut self.trial_rate);
        self.trial_rate.iter().all(|x| x.is_finite())
    }

    /// Prepares another attempt after a step of size h whose equations were not solved.
    fn retry_shorter(&mut self, system: &mut impl OdeSystem, h: f64) -> Result<(), StopReason> {
        if self.fixed && self.jacobian.fresh {
            return Err(StopReason::NoConvergence { time: self.last.t, step: h });
        }
        self.last.steps.rejected += 1;
        self.largest = UNSOLVED * h;
        self.h = if self.fixed { self.h } else { self.largest };
        // Also where it is fresh: what was foreseen of the middle of the longer step may be what was wrong.
        self.differentiate(system)
    }

    /// Factors for a step of size h.
    fn factor(&mut self, h: f64) -> Result<(), StopReason> {
        let known = self.factors.h == h;
        if known || self.factors.factor(&self.jacobian, &self.stages.blocks, h) {
            Ok(())
        } else {
            Err(self.last.not_finite())
        }
    }
}

/// A first step in which no coordinate changes by more than a small part of what errors are measured in, 1 + |x|. x itself says
/// nothing: at the position of a chart it is zero but for rounding.
fn first_step(x: &[f64], rate: &[f64]) -> f64 {
    let fastest = weighted_norm(rate.iter().copied(), x, x, 1.0);
    (FIRST_CHANGE / fastest).min(LONGEST_FIRST_STEP)
}

impl OdeMethod for Radau {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, system: &mut impl OdeSystem, end: f64) -> Result<(), StopReason> {
        self.go_alone(system);
        let (mut rejected, mut end) = (false, self.end_at_rare_break(system, end));
        if self.contraction > SLOW || !self.jacobian.valid {
            self.differentiate(system)?;
        }
        loop {
            let h = self.last.next_size(self.h, end)?;
            self.factor(h)?;
            let matrices = (&self.jacobian, &mut self.factors);
            let solved = self.stages.solve(system, &self.last, matrices, self.estimated);
            let Some(solved) = solved else {
                rejected = true;
                if !self.ends_at_break(system, (h, UNSOLVED), &mut end) {
                    self.retry_shorter(system, h)?;
                }
                continue;
            };
            self.contraction = solved.contraction;
            let mut error = self.error(system, rejected).max(self.work_error(system, h));
            if error < 1.0 && !self.fixed && self.slides_otherwise(system, h, end) {
                error = error.max(self.plain_defect()).max(self.unsolved(system, h));
            }
            let most = self.stages.max_iterations();
            let factor = SAFETY * (2 * most + 1) as f64 / (2 * most + solved.iterations) as f64;
            let by = (factor * libm::pow(error.max(MIN_ERROR), self.exponent)).clamp(CHANGE.0, CHANGE.1);
            let by = by.min((CONTRACTION / solved.contraction).max(MIN_FOR_CONTRACTION));
            if error < 1.0 || self.fixed {
                if !(self.reach_end(system, h, end) && system.knows_turns()) {
                    self.retry_shorter(system, h)?;
                    rejected = true;
                    continue;
                }
                let by = if rejected { by.min(1.0) } else { by };
                self.accept(system, h, end, error, by);
                return Ok(());
            }
            rejected = true;
            if self.ends_at_break(system, (h, by), &mut end) {
                continue;
            }
            self.last.steps.rejected += 1;
            self.h = if error.is_finite() { h * by.min(0.9) } else { 0.1 * h };
        }
    }

    /// To the order of the stages.
    fn interpolate(&mut self, _: &mut impl OdeSystem, t: f64, out: &mut [f64]) {
        if self.last.has_ended(t) {
            out.copy_from_slice(&self.last.y);
            return;
        }
        let part = self.last.part(t);
        let start = std::mem::take(&mut self.x_old);
        self.last_stages().interpolate(part, &start, out);
        self.x_old = start;
    }

    fn stage_weights(&mut self, t: f64) -> Option<&[f64]> {
        let part = self.last.part(t);
        (self.last.h > 0.0).then(|| self.last_stages().weights_at(part))
    }

    /// By the quadrature of the stages, to the order of the method.
    fn work_to(&self, t: f64) -> Option<f64> {
        self.power?;
        let x = if self.last.h > 0.0 { self.last.part(t) } else { 0.0 };
        Some(self.stages.work(x, self.last.h))
    }

    fn follow(&mut self, system: &mut impl OdeSystem, other: &Self) -> bool {
        self.follow_step(system, other)
    }

    fn take_back(&mut self) {
        self.last.take_back();
        self.last.y.copy_from_slice(&self.x_old);
    }

    fn restart(&mut self, system: &mut impl OdeSystem, x: &[f64], step: &[Vec<f64>]) {
        self.last.y.copy_from_slice(x);
        system.rhs(self.last.t, x, &mut self.rate);
        if let Some((start, stages)) =
            step.split_first().filter(|(_, stages)| stages.len() == self.stages.z.len())
        {
            self.x_old.copy_from_slice(start);
            self.stages.replace(stages, start);
        } else {
            self.last.h = 0.0;
        }
        self.jacobian.valid = false;
        self.factors.forget();
    }
}
