//! The integrator of a run: which one, why, and one face for all of them.

use super::chart::Choice;
use super::in_chart::{InChart, Method};
use super::progress::Progress;
use super::stepper::Halted;
use super::taylor::Saved;
use super::{
    Augmented, DOP853, DOPRI5, Explicit, Penalty, Plant, Radau, Rattle, Stepper, Steps, Stop, Strength,
    Taylor, stiffness,
};
use crate::run::singularity::Stepped;
use crate::scene::{IntegratorKind, Stabilization};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::state::State;
use triad_dynamics::system::System;

/// An integrator at work.
#[derive(Debug)]
pub struct Integrator {
    stepper: Box<dyn Stepper>,
    progress: Progress,
}

impl Clone for Integrator {
    fn clone(&self) -> Self {
        Self { stepper: self.stepper.boxed(), progress: self.progress.clone() }
    }
}

/// The integrator that a scene asks for, or the best one for it, and the reason.
///
/// y is the state at time 0.
pub fn choose(mechanism: &mut Mechanism, y: &[f64]) -> (IntegratorKind, String) {
    let settings = &mechanism.system.model.settings;
    let treatment = settings.stabilization;
    let own_choice = settings.integrator == IntegratorKind::Auto && settings.step.is_none();
    if own_choice
        && matches!(treatment, Stabilization::Projection | Stabilization::Partitioning)
        && let Some(why) = stiffness(mechanism, 0.0, y)
    {
        return (IntegratorKind::Radau, why);
    }
    mechanism.set_state(0.0, y);
    let settings = &mechanism.system.model.settings;
    if let Stabilization::AugmentedLagrangian { .. } = treatment {
        let why = match settings.integrator {
            IntegratorKind::Auto | IntegratorKind::Trapezoidal => String::new(),
            asked => format!("{asked} was asked for, but "),
        };
        let why = format!("{why}the augmented Lagrangian is solved together with the trapezoidal rule");
        return (IntegratorKind::Trapezoidal, why);
    }
    let obstacle = if treatment == Stabilization::Projection {
        settings.step.map(|_| "its steps have no fixed size".to_owned())
    } else {
        Some(format!("{treatment} belongs to Runge-Kutta methods"))
    };
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
        (asked, _) => match own_constraints(asked, treatment) {
            Some(why) => (IntegratorKind::Dop853, format!("{asked} was asked for, but {why}")),
            None => (asked, "the scene asks for it".to_owned()),
        },
    }
}

/// Why an integrator that has its own way with constraints cannot do with another one.
fn own_constraints(asked: IntegratorKind, treatment: Stabilization) -> Option<&'static str> {
    use Stabilization::{Partitioning, Projection};
    match (asked, treatment) {
        (IntegratorKind::Radau, Projection | Partitioning) | (IntegratorKind::Rattle, Projection) => None,
        (IntegratorKind::Radau | IntegratorKind::Rattle, _) => Some(
            "it satisfies the constraints at each step by itself, and leaves nothing for another treatment",
        ),
        (IntegratorKind::Trapezoidal, _) => Some("it is the partner of the augmented Lagrangian alone"),
        _ => None,
    }
}

impl Integrator {
    /// Starts an integrator of the given kind (not `Auto`) at (t, y). One that cannot start says so at its first step.
    pub fn start(kind: IntegratorKind, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Self {
        let started = start(kind, mechanism, t, y);
        let stepper = started.unwrap_or_else(|stop| Box::new(Halted { t, y: y.to_vec(), stop }));
        let parts = stepper.saved().map_or(1, |saved| saved.islands);
        Self { progress: Progress::new(t, parts), stepper }
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        self.stepper.time()
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &[f64] {
        self.stepper.state()
    }

    /// Size of the last accepted step, s.
    pub fn last_step(&self) -> f64 {
        self.stepper.last_step()
    }

    /// Steps so far.
    pub fn steps(&self) -> Steps {
        self.stepper.steps()
    }

    /// Whether the last step has shown by itself that the constraints hold at its end.
    pub fn proves_constraints(&mut self) -> bool {
        self.stepper.proves_constraints()
    }

    /// What has been left out so far, where the method knows.
    pub fn saved(&self) -> Option<Saved> {
        self.stepper.saved()
    }

    /// Work done and projections made, including those that the mechanism counts.
    pub fn work(&self, mechanism: &Mechanism) -> (Counters, u64) {
        let counted = mechanism.elimination.counters;
        let (own, projections) = self.stepper.own_work();
        let sum = Counters {
            evaluations: counted.evaluations + own.evaluations,
            factorizations: counted.factorizations + own.factorizations,
            solves: counted.solves + own.solves,
        };
        (sum, mechanism.projections + projections)
    }

    /// The last step as it concerns singular positions; nothing where it cannot hide any.
    pub fn stepped<'a>(&'a self, mechanism: &'a Mechanism) -> Option<Stepped<'a>> {
        self.stepper.stepped(mechanism)
    }

    /// Whether [`Integrator::holds_inside`] tells anything.
    pub fn has_own_holds(&self) -> bool {
        self.stepper.saved().is_some()
    }

    /// How firmly each joint holds at time t within that step, if the method has a way of its own to find it.
    pub fn holds_inside(&mut self, t: f64) -> Option<&[f64]> {
        self.stepper.holds_inside(t)
    }

    /// Writes y(t) within the step that [`Integrator::stepped`] tells of.
    pub fn write_part(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        self.stepper.write_part(mechanism, t, y);
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t within it, J, where the
    /// method knows it.
    pub fn work_to(&self, t: f64) -> Option<f64> {
        self.stepper.work_to(t)
    }

    /// Multipliers of the solver rows at a state within the last step, with A there, where the method has them.
    pub fn multipliers(&self, system: &System, state: &State, jacobian: &TwistJacobian) -> Option<Vec<f64>> {
        self.stepper.multipliers(system, state, jacobian)
    }

    /// Takes one accepted step, not beyond `end`.
    pub fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        self.stepper.step(mechanism, end)?;
        let settings = &mechanism.system.model.settings;
        let time = self.stepper.time();
        match self.progress.stalled(time, settings.duration) {
            // Who gives the size of steps knows how many there will be.
            Some(step) if settings.step.is_none() => Err(Stop::Stalled { time, step }),
            _ => Ok(()),
        }
    }

    /// Writes y(t) within the last step.
    pub fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        self.stepper.interpolate(mechanism, t, y);
    }
}

fn start(
    kind: IntegratorKind,
    mechanism: &mut Mechanism,
    t: f64,
    y: &[f64],
) -> Result<Box<dyn Stepper>, Stop> {
    let settings = &mechanism.system.model.settings;
    let (tolerance, end, step) = (settings.tolerance, settings.duration, settings.step);
    let treatment = settings.stabilization;
    let tolerance = match treatment {
        Stabilization::Penalty { alpha, omega, mu } => {
            tolerance.max(Strength { alpha, omega, mu }.least_tolerance())
        }
        _ => tolerance,
    };
    let explicit = move |mut plant: &mut dyn Plant, y: &[f64]| {
        let tableau = if kind == IntegratorKind::Dop853 { &DOP853 } else { &DOPRI5 };
        match (kind, step) {
            (_, Some(h)) => Explicit::with_step(tableau, &mut plant, t, y, h),
            (IntegratorKind::Ode45, None) => Explicit::ode45(&mut plant, t, y, tolerance, end),
            (_, None) => Explicit::new(tableau, &mut plant, t, y, tolerance),
        }
    };
    let radau = move |mut plant: &mut dyn Plant, x: &[f64]| match step {
        Some(h) => Radau::with_step(&mut plant, t, x, tolerance, h),
        None => Radau::new(&mut plant, t, x, tolerance),
    };
    Ok(match (kind, treatment) {
        (IntegratorKind::Taylor | IntegratorKind::Auto, _) => {
            Box::new(Taylor::new(mechanism, t, y, tolerance))
        }
        (IntegratorKind::Rattle, _) => Box::new(Rattle::new(mechanism, t, y, step)),
        (_, Stabilization::AugmentedLagrangian { alpha }) => {
            Box::new(Augmented::new(mechanism, t, y, alpha, step))
        }
        (IntegratorKind::Radau, Stabilization::Partitioning) => {
            in_chart(Choice::Partition, mechanism, t, y, radau)?
        }
        (IntegratorKind::Radau, _) => in_chart(Choice::Tangent, mechanism, t, y, radau)?,
        (_, Stabilization::Partitioning) => in_chart(Choice::Partition, mechanism, t, y, explicit)?,
        (_, Stabilization::Penalty { alpha, omega, mu }) => {
            let strength = Strength { alpha, omega, mu };
            Box::new(Penalty::new(mechanism, t, y, strength, explicit))
        }
        _ => Box::new(explicit(mechanism, y)),
    })
}

fn in_chart<M: Method>(
    choice: Choice,
    mechanism: &mut Mechanism,
    t: f64,
    y: &[f64],
    start: impl FnOnce(&mut dyn Plant, &[f64]) -> M,
) -> Result<Box<dyn Stepper>, Stop> {
    Ok(Box::new(InChart::new(choice, mechanism, t, y, start)?))
}
