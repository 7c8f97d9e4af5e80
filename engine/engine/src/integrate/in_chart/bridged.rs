//! Steps past singular positions. Where a joint hardly holds, no coordinates are independent for long: what rounding leaves open
//! grows with one over the hold in positions, with its square in accelerations, and no step of an implicit method meets its
//! tolerance. There the steps are those of DOP853 with projection, which evaluates stages beside the constraints.

use super::chart::{Chart, IndependentCoordinates};
use super::within::{InChart, Start};
use crate::integrate::explicit::{DOP853, Explicit};
use crate::integrate::step::{StepRecord, Steps, StopReason};
use crate::integrate::stepper::{IslandStep, Stepper};
use std::any::Any;
use triad_dynamics::constraints::mechanism::Mechanism;

/// A method in the coordinates of a chart, and the one that bridges the places without any.
#[derive(Clone, Debug)]
pub struct Bridged<S: Start> {
    choice: IndependentCoordinates,
    start: S,
    inside: Option<InChart<S::Method>>,
    bridge: Option<Explicit>,
    last: StepRecord,
    /// Steps of methods that were left.
    left: Steps,
    tolerance: f64,
    /// Whether the author has chosen the steps: nothing is bridged then.
    fixed: bool,
    /// Whether a joint hardly holds at the end of the last step.
    loose: bool,
}

impl<S: Start> Bridged<S> {
    /// Starts at the consistent state y.
    pub fn new(
        choice: IndependentCoordinates,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        tolerance: f64,
        start: S,
    ) -> Self {
        let fixed = mechanism.system.model.settings.step.is_some();
        let mut bridged = Self {
            choice,
            start,
            inside: None,
            bridge: None,
            last: StepRecord::new(t, y),
            left: Steps::default(),
            tolerance,
            fixed,
            loose: false,
        };
        bridged.enter(mechanism);
        bridged
    }

    /// Takes a chart at the end of the last step, if there is one.
    fn enter(&mut self, mechanism: &mut Mechanism) {
        let StepRecord { t, y, .. } = &self.last;
        let chart = Chart::new(self.choice, mechanism, *t, y);
        self.inside = chart.map(|chart| InChart::new(chart, mechanism, *t, y, &self.start));
        if self.inside.is_some() {
            self.leave_bridge();
        }
    }

    fn leave_bridge(&mut self) {
        if let Some(bridge) = self.bridge.take() {
            self.left = sum(self.left, Stepper::last(&bridge).steps);
        }
    }

    /// Goes on by the bridge.
    fn leave(&mut self, mechanism: &mut Mechanism) {
        if let Some(inside) = self.inside.take() {
            self.left = sum(self.left, inside.last().steps);
        }
        let StepRecord { t, y, .. } = &self.last;
        mechanism.set_state(*t, y);
        self.bridge = Some(Explicit::new(&DOP853, mechanism, *t, y, self.tolerance));
    }

    fn stepper(&self) -> Option<&dyn Stepper> {
        let bridge = self.bridge.as_ref().map(|bridge| bridge as &dyn Stepper);
        bridge.or(self.inside.as_ref().map(|inside| inside as &dyn Stepper))
    }

    fn stepper_mut(&mut self) -> Option<&mut dyn Stepper> {
        match (&mut self.bridge, &mut self.inside) {
            (Some(bridge), _) => Some(bridge),
            (None, Some(inside)) => Some(inside),
            (None, None) => None,
        }
    }

    /// Takes over the record of the method at work.
    fn record(&mut self) {
        let left = self.left;
        if let Some(stepper) = self.stepper() {
            let mut last = stepper.last().clone();
            last.steps = sum(left, last.steps);
            self.last = last;
        }
    }
}

impl<S: Start> Stepper for Bridged<S> {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        if self.bridge.is_some() && !self.loose {
            self.enter(mechanism);
        }
        if self.bridge.is_none() && !self.fixed && (self.loose || self.inside.is_none()) {
            self.leave(mechanism);
        }
        let undetermined = StopReason::Undetermined { time: self.last.t };
        let mut result = self.stepper_mut().map_or(Err(undetermined), |stepper| stepper.step(mechanism, end));
        if matches!(result, Err(StopReason::Undetermined { .. })) && self.bridge.is_none() && !self.fixed {
            self.leave(mechanism);
            result = self.stepper_mut().map_or(result, |stepper| stepper.step(mechanism, end));
        }
        self.record();
        result
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        match self.stepper_mut() {
            Some(stepper) => stepper.interpolate(mechanism, t, y),
            None => y.copy_from_slice(&self.last.y),
        }
    }

    fn interpolate_smoothly(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        match self.stepper_mut() {
            Some(stepper) => stepper.interpolate_smoothly(mechanism, t, y),
            None => y.copy_from_slice(&self.last.y),
        }
    }

    fn island_step<'a>(&'a self, mechanism: &'a Mechanism) -> Option<IslandStep<'a>> {
        self.stepper()?.island_step(mechanism)
    }

    fn leader(&self) -> Option<&dyn Any> {
        if self.bridge.is_none() { self.inside.as_ref().map(|inside| inside as &dyn Any) } else { None }
    }

    fn follow(&mut self, mechanism: &mut Mechanism, other: &dyn Any) -> bool {
        let inside = self.inside.as_mut().filter(|_| self.bridge.is_none());
        let followed = inside
            .zip(other.downcast_ref())
            .is_some_and(|(inside, other): (_, &InChart<_>)| inside.follow_step(mechanism, other));
        if followed {
            self.record();
        }
        followed
    }

    fn can_retreat(&self) -> bool {
        self.stepper().is_some_and(Stepper::can_retreat)
    }

    fn retreat(&mut self, mechanism: &mut Mechanism) {
        if let Some(stepper) = self.stepper_mut() {
            stepper.retreat(mechanism);
        }
        self.record();
    }

    fn set_loose(&mut self, loose: bool) {
        self.loose = loose;
    }

    fn work_to(&self, t: f64) -> Option<f64> {
        self.stepper()?.work_to(t)
    }

    fn next_size(&self) -> Option<f64> {
        self.stepper()?.next_size()
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

fn sum(a: Steps, b: Steps) -> Steps {
    Steps { accepted: a.accepted + b.accepted, rejected: a.rejected + b.rejected }
}
