//! The integrator of a run: starts the method that was chosen, and stops a run that no longer gets anywhere.

mod progress;

use super::augmented::Augmented;
use super::driven::Driven;
use super::explicit::{DOP853, DOPRI5, Explicit};
use super::in_chart::{Bridged, Chart, IndependentCoordinates, Start};
use super::passings::Passings;
use super::penalty::{Penalty, PenaltyParameters};
use super::radau::{RADAU_5, Radau};
use super::rattle::Rattle;
use super::step::{FEW_BREAKS, RARE_BREAKS, StepRecord, StopReason};
use super::stepper::Stepper;
use super::taylor::Taylor;
use crate::scene::{ConstraintMethod, IntegratorKind};
use progress::ProgressMonitor;
use std::ops::{Deref, DerefMut};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::Counters;
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::system::System;

/// The integrator of a run. It dereferences to the method that it runs.
#[derive(Debug)]
pub struct Integrator {
    stepper: Box<dyn Stepper>,
    progress: ProgressMonitor,
    /// Whether steps end at each break of a given function.
    at_each_break: bool,
    /// What ends steps early where points of springs pass each other, if there are such and the method does not see for itself.
    passings: Option<Passings>,
}

impl Clone for Integrator {
    fn clone(&self) -> Self {
        Self {
            stepper: self.stepper.boxed(),
            progress: self.progress.clone(),
            at_each_break: self.at_each_break,
            passings: self.passings.clone(),
        }
    }
}

impl Deref for Integrator {
    type Target = dyn Stepper;

    fn deref(&self) -> &Self::Target {
        &*self.stepper
    }
}

impl DerefMut for Integrator {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut *self.stepper
    }
}

impl Integrator {
    /// Starts an integrator of the given kind (not `Auto`) at (t, y). One that cannot start fails at its first step.
    pub fn start(kind: IntegratorKind, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Self {
        let few = has_few_breaks(&mechanism.system, t);
        Self::started(start(kind, mechanism, t, y, false), t, y).minding(&mechanism.system, few)
    }

    /// The same for a solution that another one of the same method is compared with: it solves the equations of its steps further.
    pub fn start_beside(kind: IntegratorKind, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Self {
        Self::started(start(kind, mechanism, t, y, true), t, y).minding(&mechanism.system, true)
    }

    /// None: its first step is refused. For copies of a run that only answer questions.
    pub fn ended(t: f64, y: &[f64]) -> Self {
        Self::started(Err(StopReason::Undetermined { time: t }), t, y)
    }

    fn started(started: Result<Box<dyn Stepper>, StopReason>, t: f64, y: &[f64]) -> Self {
        let stepper =
            started.unwrap_or_else(|reason| Box::new(FailedStart { record: StepRecord::new(t, y), reason }));
        let islands = stepper.skipped().map_or(1, |skipped| skipped.islands);
        Self { progress: ProgressMonitor::new(t, islands), stepper, at_each_break: false, passings: None }
    }

    /// With what ends its steps.
    fn minding(self, system: &System, at_each_break: bool) -> Self {
        let watches = !self.stepper.sees_ahead() && system.has_directed_springs();
        Self { passings: watches.then(Passings::default), at_each_break, ..self }
    }

    /// Work done and projections made, including those that the mechanism counts.
    pub fn work(&self, mechanism: &Mechanism) -> (Counters, u64) {
        let counted = mechanism.elimination.counters;
        let (own, projections) = self.own_work();
        let sum = Counters {
            evaluations: counted.evaluations + own.evaluations,
            factorizations: counted.factorizations + own.factorizations,
            solves: counted.solves + own.solves,
        };
        (sum, mechanism.projections + projections)
    }

    /// What there is to say of the size of its steps, in a sentence.
    pub fn told_of_steps(&self) -> Option<String> {
        self.stepper.told_of_steps()
    }

    /// Takes the last step of another run of the same mechanism and method beside it. False where that is not possible, or would hide what
    /// that one steps over.
    pub fn follow(&mut self, mechanism: &mut Mechanism, other: &Self) -> bool {
        let leader = other.leader().filter(|_| other.at_each_break);
        leader.is_some_and(|other| self.stepper.follow(mechanism, other))
    }

    /// Takes the last step back as well, to search what lies ahead by shorter ones: no sign of a run that gets nowhere.
    pub fn take_back_to_search(&mut self, mechanism: &mut Mechanism) {
        mechanism.state.take_back_motion();
        self.stepper.retreat(mechanism);
        self.progress.restart(self.last().t);
    }

    /// Takes the last step back, so that a shorter one can be taken instead.
    pub fn take_back(&mut self, mechanism: &mut Mechanism) {
        mechanism.state.take_back_motion();
        self.stepper.retreat(mechanism);
        self.progress.take_back(self.last().t);
    }

    /// Where a step that is not to go beyond `end` ends at the latest: where a given function of time that has rested begins to change, in small
    /// parts of the time after that, where another piece of one begins, if there are few or pieces are longer than steps, and before points of
    /// springs pass each other. With steps of one size the author has chosen what they see.
    fn latest(&mut self, system: &System, end: f64) -> f64 {
        if self.stepper.sees_ahead() || system.model.settings.step.is_some() {
            return end;
        }
        let last = self.stepper.last();
        let end = end.min(system.look_until(last.t));
        let end = self.passings.as_mut().map_or(end, |passings| passings.end_of_step(system, last, end));
        let first = system.next_break(last.t);
        let rare = |h: f64| first < last.t + h && system.next_break(first) - first >= RARE_BREAKS * h;
        let stops = first < end && (self.at_each_break || self.stepper.next_size().is_some_and(rare));
        if stops { first } else { end }
    }

    /// Takes one accepted step, not beyond `end`.
    ///
    /// # Errors
    ///
    /// [`StopReason`]: why the run cannot go on.
    pub fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let end = self.latest(&mechanism.system, end);
        self.stepper.step(mechanism, end)?;
        let settings = &mechanism.system.model.settings;
        let time = self.last().t;
        match self.progress.stalled(time, settings.duration) {
            // With a fixed step the author chose how many there are.
            Some(step) if settings.step.is_none() => Err(StopReason::Stalled { time, step }),
            _ => Ok(()),
        }
    }
}

/// Whether given functions have few breaks from time t on.
fn has_few_breaks(system: &System, t: f64) -> bool {
    let next = |t: &f64| Some(system.next_break(*t)).filter(|t| *t < system.model.settings.duration);
    std::iter::successors(next(&t), next).take(FEW_BREAKS + 1).count() <= FEW_BREAKS
}

/// An integrator that could not start: its first step returns the reason.
#[derive(Clone, Debug)]
struct FailedStart {
    record: StepRecord,
    reason: StopReason,
}

impl Stepper for FailedStart {
    fn last(&self) -> &StepRecord {
        &self.record
    }
    fn step(&mut self, _: &mut Mechanism, _: f64) -> Result<(), StopReason> {
        Err(self.reason)
    }
    fn interpolate(&mut self, _: &mut Mechanism, _: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.record.y);
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

fn start(
    kind: IntegratorKind,
    mechanism: &mut Mechanism,
    t: f64,
    y: &[f64],
    beside: bool,
) -> Result<Box<dyn Stepper>, StopReason> {
    let settings = &mechanism.system.model.settings;
    let (tolerance, end, step) = (settings.tolerance, settings.duration, settings.step);
    let method = settings.constraint_method;
    let tolerance = match method {
        ConstraintMethod::Penalty { alpha, omega, mu } => {
            tolerance.max(PenaltyParameters { alpha, omega, mu }.min_tolerance(&mechanism.system))
        }
        _ => tolerance,
    };
    let explicit = StartExplicit { kind, tolerance, step, end };
    let radau = StartRadau { tolerance, step, beside };
    let (tangent, partition) = (IndependentCoordinates::Tangent, IndependentCoordinates::Partition);
    Ok(match (kind, method) {
        (IntegratorKind::Taylor | IntegratorKind::Auto, _) => {
            Box::new(Taylor::new(mechanism, t, y, tolerance))
        }
        (IntegratorKind::Rattle, _) => Box::new(Rattle::new(mechanism, t, y, step)),
        (_, ConstraintMethod::AugmentedLagrangian { alpha }) => {
            Box::new(Augmented::new(mechanism, t, y, alpha, step))
        }
        (IntegratorKind::Trapezoidal, _) => return Err(StopReason::Alone),
        (IntegratorKind::Radau, ConstraintMethod::Partitioning) => {
            in_chart(partition, mechanism, t, y, tolerance, radau)
        }
        (IntegratorKind::Radau, _) => in_chart(tangent, mechanism, t, y, tolerance, radau),
        (_, ConstraintMethod::Partitioning) => in_chart(partition, mechanism, t, y, tolerance, explicit),
        (_, ConstraintMethod::Penalty { alpha, omega, mu }) => {
            let parameters = PenaltyParameters { alpha, omega, mu };
            Box::new(Penalty::new(mechanism, t, y, parameters, |system, y| explicit.start(system, t, y)))
        }
        _ => Box::new(explicit.start(mechanism, t, y)),
    })
}

/// How an explicit method is started.
#[derive(Clone, Copy, Debug)]
struct StartExplicit {
    kind: IntegratorKind,
    tolerance: f64,
    step: Option<f64>,
    end: f64,
}

impl Start for StartExplicit {
    type Method = Explicit;

    fn start(&self, mut system: &mut dyn OdeSystem, t: f64, y: &[f64]) -> Explicit {
        let tableau = if self.kind == IntegratorKind::Dop853 { &DOP853 } else { &DOPRI5 };
        match (self.kind, self.step) {
            (_, Some(h)) => Explicit::with_step(tableau, &mut system, t, y, h),
            (IntegratorKind::Ode45, None) => Explicit::ode45(&mut system, t, y, self.tolerance, self.end),
            (_, None) => Explicit::new(tableau, &mut system, t, y, self.tolerance),
        }
    }
}

/// How Radau IIA is started.
#[derive(Clone, Copy, Debug)]
struct StartRadau {
    tolerance: f64,
    step: Option<f64>,
    beside: bool,
}

impl Start for StartRadau {
    type Method = Radau;

    fn start(&self, mut system: &mut dyn OdeSystem, t: f64, x: &[f64]) -> Radau {
        let method = match self.step {
            Some(h) => Radau::with_step(&RADAU_5, &mut system, t, x, self.tolerance, h),
            None => Radau::new(&mut system, t, x, self.tolerance),
        };
        if self.beside { method.solving_further() } else { method }
    }
}

fn in_chart(
    choice: IndependentCoordinates,
    mechanism: &mut Mechanism,
    t: f64,
    y: &[f64],
    tolerance: f64,
    start: impl Start,
) -> Box<dyn Stepper> {
    if Chart::freedoms_at(mechanism, t, y) == 0 {
        return Box::new(Driven::new(mechanism, t, y));
    }
    Box::new(Bridged::new(choice, mechanism, t, y, tolerance, start))
}
