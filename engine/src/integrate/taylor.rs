//! Taylor series on the constrained equations — THEORY section 11.
//!
//! Each step expands the motion about its start ([`Series`]), takes the longest step that some pair of successive
//! terms allows, and projects the end onto the constraints. The polynomial is the dense output.

use super::{Steps, Stop};
use crate::elimination::Counters;
use crate::mechanism::Mechanism;
use crate::series::{LEAST_TOLERANCE_REDUNDANT, Plan, Series};
use crate::system::System;

/// Highest order.
pub const MAX_ORDER: usize = 30;
/// Knots follow closely if they leave less than this part of a step between them (measured: docs/PERFORMANCE.md).
const CROWDED: f64 = 0.1;
/// Most knots that are counted.
const MOST_KNOTS: usize = 100_000;
/// The series, bundled as suits the number of bodies.
#[derive(Clone, Debug)]
enum Engine {
    /// One body.
    Narrow(Box<Series<1>>),
    /// Several.
    Wide(Box<Series<4>>),
}

/// Runs `$call` with `$series` bound to the series.
macro_rules! with {
    ($engine:expr, $series:ident => $call:expr) => {
        match $engine {
            Engine::Narrow($series) => $call,
            Engine::Wide($series) => $call,
        }
    };
}

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Taylor {
    tolerance: f64,
    order: usize,
    length: f64,
    engine: Engine,
    /// End of the last step and the state there.
    t: f64,
    y: Vec<f64>,
    /// The last step: its start, size and the terms that it used.
    t_old: f64,
    h_old: f64,
    order_old: usize,
    /// Steps so far.
    pub steps: Steps,
    /// Projections so far.
    pub projections: u64,
}

impl Taylor {
    /// Starts at (t, y), which must be in place in the mechanism and consistent, with relative and absolute tolerance
    /// `tolerance`.
    pub fn new(mechanism: &Mechanism, t: f64, y: &[f64], tolerance: f64) -> Self {
        let Mechanism { system, elimination, .. } = mechanism;
        let redundant = elimination.is_redundant();
        let turns: Vec<f64> = elimination.angles.iter().map(|angle| angle.value).collect();
        let tolerance = if redundant { tolerance.max(LEAST_TOLERANCE_REDUNDANT) } else { tolerance };
        let order = order_for(tolerance);
        let mut engine = if system.bodies.len() == 1 {
            Engine::Narrow(Box::new(Series::new(system, order, redundant, &turns)))
        } else {
            Engine::Wide(Box::new(Series::new(system, order, redundant, &turns)))
        };
        with!(&mut engine, s => {
            s.place(system, t, y);
            s.linearize();
        });
        Self {
            tolerance,
            order,
            length: system.length,
            engine,
            t,
            y: y.to_vec(),
            t_old: t,
            h_old: 0.0,
            order_old: order,
            steps: Steps::default(),
            projections: 0,
        }
    }

    /// Whether knots of prescribed functions follow so closely until `end` that steps, which end at each of them, would be
    /// far shorter than the series allow.
    pub fn crowded(&mut self, end: f64) -> bool {
        let (t, order, tolerance) = (self.t, self.order, self.tolerance);
        with!(&mut self.engine, s => {
            let knots = s.knots_before(end, MOST_KNOTS);
            knots > 0 && (end - t) / (knots as f64) < CROWDED * s.natural_step(order, tolerance)
        })
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &[f64] {
        &self.y
    }

    /// Size of the last step, s.
    pub fn last_step(&self) -> f64 {
        self.h_old
    }

    /// Order of the last step.
    pub fn last_order(&self) -> usize {
        self.order_old
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        with!(&self.engine, s => s.counters)
    }

    /// Takes one step, not beyond `end`.
    pub fn step(&mut self, system: &System, end: f64) -> Result<(), Stop> {
        let plan = Plan { order: self.order, tolerance: self.tolerance, length: self.length, end };
        let taken = with!(&mut self.engine, s => {
            let taken = s.step(plan);
            s.store(system, &mut self.y);
            taken
        });
        if !taken.finite || taken.h.is_nan() {
            return Err(Stop::NotFinite { time: self.t });
        }
        if taken.h <= 16.0 * f64::EPSILON * self.t.abs().max(end.abs()) && taken.time < end && !taken.at_break
        {
            return Err(Stop::StepTooSmall { time: self.t, step: taken.h });
        }
        self.t_old = self.t;
        self.h_old = taken.h;
        self.order_old = taken.order;
        self.t = taken.time;
        self.steps.accepted += 1;
        self.steps.rejected += taken.rejected;
        self.projections += 1;
        Ok(())
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t within it, J.
    pub fn work_to(&self, t: f64) -> f64 {
        with!(&self.engine, s => s.work((t - self.t_old).clamp(0.0, self.h_old)))
    }

    /// Gives the mechanism, which stands at time t within the last step, the multipliers of that moment. Tells whether the
    /// series have them.
    pub fn give_multipliers(&self, mechanism: &mut Mechanism, t: f64) -> bool {
        let Mechanism { system, elimination, .. } = mechanism;
        let tau = t - self.t_old;
        self.h_old > 0.0
            && (0.0..=self.h_old).contains(&tau)
            && with!(&self.engine, s => s.give_multipliers(system, tau, self.order_old, elimination))
    }

    /// Writes y(t) within the last step.
    pub fn interpolate(&self, system: &System, t: f64, y: &mut [f64]) {
        if t >= self.t || self.h_old == 0.0 {
            y.copy_from_slice(&self.y);
            return;
        }
        let tau = (t - self.t_old).clamp(0.0, self.h_old);
        with!(&self.engine, s => s.interpolate(system, tau, self.order_old, y));
    }
}

/// Order for a tolerance: 8 for 1e-3, 14 for 1e-9, 18 for 1e-13.
fn order_for(tolerance: f64) -> usize {
    let powers = std::iter::successors(Some(tolerance), |t| Some(10.0 * t));
    let digits = powers.take(MAX_ORDER).take_while(|&t| t < 0.3).count();
    (5 + digits).clamp(6, MAX_ORDER)
}
