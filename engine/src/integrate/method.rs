//! The integrator of a run: which one, why, and one face for all of them.

use super::{Dop853, Dopri5, Steps, Stop, Taylor};
use crate::elimination::Counters;
use crate::mechanism::Mechanism;
use crate::scene::{IntegratorKind, Stabilization};
use crate::system::System;

/// An integrator at work.
#[derive(Clone, Debug)]
pub enum Integrator {
    /// Explicit Runge-Kutta of order 8.
    Dop853(Box<Dop853>),
    /// Explicit Runge-Kutta of order 5.
    Dopri5(Box<Dopri5>),
    /// Taylor series.
    Taylor(Box<Taylor>),
}

/// The integrator that a scene asks for, or the best one for it, and the reason.
///
/// y is the state at time 0, which must be in place in the mechanism.
pub fn choose(mechanism: &Mechanism, y: &[f64]) -> (IntegratorKind, String) {
    let settings = &mechanism.system.model.settings;
    let baumgarte = settings.stabilization != Stabilization::Projection;
    let obstacle = baumgarte.then(|| "Baumgarte's stabilization belongs to Runge-Kutta methods".to_owned());
    let System { curves, targets, loads, .. } = &mechanism.system;
    let prescribed = !(curves.is_empty() && targets.is_empty() && loads.is_empty());
    let crowded =
        || prescribed && Taylor::new(mechanism, 0.0, y, settings.tolerance).crowded(settings.duration);
    match (settings.integrator, obstacle) {
        (IntegratorKind::Auto, None) if crowded() => (
            IntegratorKind::Dop853,
            "the knots of prescribed motions follow so closely that a series would end at each of them long before its \
             reach"
                .to_owned(),
        ),
        (IntegratorKind::Auto, None) => (
            IntegratorKind::Taylor,
            "every row and load of the scene has a recurrence, so that one factorization serves a whole step"
                .to_owned(),
        ),
        (IntegratorKind::Auto, Some(obstacle)) if settings.tolerance > 1e-5 => {
            (IntegratorKind::Dopri5, format!("{obstacle}, and the tolerance is loose"))
        }
        (IntegratorKind::Auto, Some(obstacle)) => (IntegratorKind::Dop853, obstacle),
        (IntegratorKind::Taylor, Some(obstacle)) => {
            (IntegratorKind::Dop853, format!("taylor was asked for, but {obstacle}"))
        }
        (asked, _) => (asked, "the scene asks for it".to_owned()),
    }
}

impl Integrator {
    /// Starts an integrator of the given kind (not `Auto`) at (t, y).
    pub fn start(kind: IntegratorKind, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Self {
        let tolerance = mechanism.system.model.settings.tolerance;
        match kind {
            IntegratorKind::Taylor | IntegratorKind::Auto => {
                Self::Taylor(Box::new(Taylor::new(mechanism, t, y, tolerance)))
            }
            IntegratorKind::Dop853 => Self::Dop853(Box::new(Dop853::new(mechanism, t, y, tolerance))),
            IntegratorKind::Dopri5 => Self::Dopri5(Box::new(Dopri5::new(mechanism, t, y, tolerance))),
        }
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        match self {
            Self::Dop853(i) => i.time(),
            Self::Dopri5(i) => i.time(),
            Self::Taylor(i) => i.time(),
        }
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &[f64] {
        match self {
            Self::Dop853(i) => i.state(),
            Self::Dopri5(i) => i.state(),
            Self::Taylor(i) => i.state(),
        }
    }

    /// Size of the last accepted step, s.
    pub fn last_step(&self) -> f64 {
        match self {
            Self::Dop853(i) => i.last_step(),
            Self::Dopri5(i) => i.last_step(),
            Self::Taylor(i) => i.last_step(),
        }
    }

    /// Steps so far.
    pub fn steps(&self) -> Steps {
        match self {
            Self::Dop853(i) => i.steps,
            Self::Dopri5(i) => i.steps,
            Self::Taylor(i) => i.steps,
        }
    }

    /// Whether the last step has shown by itself that the constraints hold at its end.
    pub fn proves_constraints(&mut self) -> bool {
        match self {
            Self::Dop853(_) | Self::Dopri5(_) => false,
            Self::Taylor(i) => i.proves_constraints(),
        }
    }

    /// Work done and projections made, including those that the mechanism counts.
    pub fn work(&self, mechanism: &Mechanism) -> (Counters, u64) {
        let counted = mechanism.elimination.counters;
        match self {
            Self::Dop853(_) | Self::Dopri5(_) => (counted, mechanism.projections),
            Self::Taylor(i) => {
                let own = i.counters();
                let sum = Counters {
                    evaluations: counted.evaluations + own.evaluations,
                    factorizations: counted.factorizations + own.factorizations,
                    solves: counted.solves + own.solves,
                };
                (sum, mechanism.projections + i.projections)
            }
        }
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        match self {
            Self::Dop853(i) => i.step(mechanism, end),
            Self::Dopri5(i) => i.step(mechanism, end),
            Self::Taylor(i) => {
                i.step(&mechanism.system, end)?;
                if !mechanism.system.angles.is_empty() {
                    mechanism.set_state(i.time(), i.state());
                    mechanism.elimination.keep_turns();
                }
                Ok(())
            }
        }
    }

    /// Writes y(t) within the last step.
    pub fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        match self {
            Self::Dop853(i) => i.interpolate(mechanism, t, y),
            Self::Dopri5(i) => i.interpolate(t, y),
            Self::Taylor(i) => i.interpolate(&mechanism.system, t, y),
        }
    }
}
