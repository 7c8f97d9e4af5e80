//! Taylor series on the constrained equations — THEORY section 11.
//!
//! Each step expands the motion about its start ([`IslandSeries`](triad_dynamics::dynamics::series::IslandSeries)), takes the
//! longest step that some pair of successive terms allows, and projects the end onto the constraints. The polynomial is the
//! dense output. Islands take steps of their own: the one farthest behind goes on.

mod island;

use super::step::{StepRecord, StopReason};
use super::stepper::{IslandStep, SkippedWork, Stepper};
use super::track::Track;
use island::IslandStepper;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::islands::{self, Island};

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Taylor {
    islands: Vec<IslandStepper>,
    last: StepRecord,
    /// The island that took the last step.
    stepped: usize,
    skipped: SkippedWork,
    /// Whether the projections of the last steps of all islands have shown that the constraints are satisfied.
    proven: bool,
    /// Projections so far.
    projections: u64,
}

impl Taylor {
    /// Starts at (t, y), which must be set in the mechanism and consistent, with relative and absolute tolerance
    /// `tolerance`.
    pub fn new(mechanism: &Mechanism, t: f64, y: &[f64], tolerance: f64) -> Self {
        let Mechanism { system, state, elimination, .. } = mechanism;
        let skip = system.model.settings.skip;
        let q = &y[..system.coordinates];
        let split = islands::split(system, q, skip.islands, skip.fixed);
        let turns: Vec<f64> = state.angles().iter().map(|angle| angle.value).collect();
        let redundant = elimination.is_redundant();
        let islands: Vec<IslandStepper> = if split.islands.is_empty() && split.fixed == 0 {
            vec![IslandStepper::new(system, None, redundant, &turns, t, y, tolerance)]
        } else {
            let island = |of: Island| {
                let turns: Vec<f64> =
                    of.system.angle_joints.iter().map(|joint| turn(system, &turns, joint)).collect();
                IslandStepper::new(system, Some(of), redundant, &turns, t, y, tolerance)
            };
            split.islands.into_iter().map(island).collect()
        };
        let mut skipped = SkippedWork {
            islands: islands.len(),
            fixed_bodies: split.fixed,
            merged_bodies: split.merged,
            rows_in_space: system.solver_rows,
            ..SkippedWork::default()
        };
        for island in &islands {
            skipped.rows += island.rows();
            skipped.pivoted_bodies += island.pivoted();
            skipped.planar_bodies += if island.is_planar() { island.bodies() } else { 0 };
        }
        Self { islands, last: StepRecord::new(t, y), stepped: 0, skipped, proven: false, projections: 0 }
    }

    /// Whether breakpoints of prescribed functions follow so closely until `end` that steps, which end at each of them, would
    /// be far shorter than the series allow.
    pub fn breakpoints_dense(&mut self, end: f64) -> bool {
        self.islands.iter_mut().any(|island| island.breakpoints_dense(end))
    }
}

impl Stepper for Taylor {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    /// The island that is farthest behind goes on.
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let system = &mechanism.system;
        let StepRecord { t, y, t_old, h, steps } = &mut self.last;
        let behind =
            self.islands.iter_mut().enumerate().min_by(|(_, a), (_, b)| a.time().total_cmp(&b.time()));
        if let Some((index, island)) = behind {
            let rejected = island.step(system, end, y)?;
            self.stepped = index;
            steps.accepted += 1;
            steps.rejected += rejected;
            self.projections += 1;
            self.proven = self.islands.iter().all(IslandStepper::is_proven);
            let reached = self.islands.iter().map(IslandStepper::time).fold(f64::INFINITY, f64::min);
            (*t_old, *t) = (*t, reached);
            if self.islands.len() > 1 {
                self.islands.iter().for_each(|island| island.interpolate(system, reached, y));
            }
        } else {
            // Nothing can move.
            (*t_old, *t, self.proven) = (*t, end, false);
        }
        *h = *t - *t_old;
        if !system.angles.is_empty() {
            mechanism.set_state(*t, y);
            mechanism.state.commit_motion();
        }
        Ok(())
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.last.y);
        if t < self.last.t {
            let t = t.max(self.last.t_old);
            self.islands.iter().for_each(|island| island.interpolate(&mechanism.system, t, y));
        }
    }

    /// The last step of the island that took it.
    fn island_step<'a>(&'a self, mechanism: &'a Mechanism) -> Option<IslandStep<'a>> {
        let island = self.islands.get(self.stepped)?;
        island.last_step(&mechanism.system, self.stepped)
    }

    fn track(&mut self) -> Option<&mut dyn Track> {
        self.islands.get_mut(self.stepped).map(|island| island as &mut dyn Track)
    }

    fn can_retreat(&self) -> bool {
        self.islands.get(self.stepped).is_some_and(IslandStepper::can_retreat)
    }

    /// Only the island that took the last step goes back: it is then the one that is farthest behind.
    fn retreat(&mut self, mechanism: &mut Mechanism) {
        let system = &mechanism.system;
        let Some(island) = self.islands.get_mut(self.stepped) else { return };
        island.retreat();
        self.last.take_back();
        self.last.t = island.time();
        self.last.t_old = self.last.t;
        let StepRecord { t, y, .. } = &mut self.last;
        self.islands.iter().for_each(|island| island.interpolate(system, *t, y));
        if !system.angles.is_empty() {
            mechanism.set_state(*t, y);
            mechanism.state.commit_motion();
        }
    }

    fn error(&self, system: &System, t: f64, y: &mut [f64]) -> bool {
        y.fill(0.0);
        self.islands.iter().all(|island| island.error(system, t, y))
    }

    fn error_lost(&self) -> Option<f64> {
        self.islands.iter().filter_map(IslandStepper::error_lost).min_by(f64::total_cmp)
    }

    fn set_resolving(&mut self, resolving: bool) {
        self.islands.iter_mut().for_each(|island| island.set_resolving(resolving));
    }

    fn work_to(&self, t: f64) -> Option<f64> {
        let start = self.last.t_old;
        Some(self.islands.iter().map(|island| island.work_to(t) - island.work_to(start)).sum())
    }

    /// Only the series of the whole in space have them.
    fn multipliers(&self, state: &State, jacobian: &TwistJacobian) -> Option<Vec<f64>> {
        let [island] = self.islands.as_slice() else { return None };
        island.multipliers(state, jacobian)
    }

    fn proves_constraints(&mut self) -> bool {
        if self.proven {
            self.skipped.checks += 1;
        }
        self.proven
    }

    fn skipped(&self) -> Option<SkippedWork> {
        let mut skipped = self.skipped;
        let most = self.islands.iter().map(IslandStepper::steps).max().unwrap_or(0);
        for island in &self.islands {
            skipped.body_steps += island.steps() * island.bodies() as u64;
            skipped.body_steps_together += most * island.bodies() as u64;
            skipped.constants += island.constants_kept();
            skipped.axes += island.axes();
        }
        Some(skipped)
    }

    fn own_work(&self) -> (Counters, u64) {
        let mut sum = Counters::default();
        for island in &self.islands {
            let own = island.counters();
            sum.evaluations += own.evaluations;
            sum.factorizations += own.factorizations;
            sum.solves += own.solves;
        }
        (sum, self.projections)
    }

    fn sees_ahead(&self) -> bool {
        true
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

/// The angle of a joint at the start.
fn turn(system: &System, turns: &[f64], joint: &str) -> f64 {
    let place = system.angle_joints.iter().position(|name| name == joint);
    place.and_then(|place| turns.get(place)).copied().unwrap_or(0.0)
}
