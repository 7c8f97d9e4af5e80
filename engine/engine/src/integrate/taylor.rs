//! Taylor series on the constrained equations — THEORY section 11.
//!
//! Each step expands the motion about its start ([`triad_dynamics::dynamics::series::Series`]), takes the longest step that some pair of
//! successive terms allows, and projects the end onto the constraints. The polynomial is the dense output. Parts of a
//! scene that nothing connects take steps of their own: the one farthest behind goes on.

mod island;

use super::{Steps, Stop};
use crate::run::singularity::Stepped;
use island::Island;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::islands;

/// Highest order.
pub const MAX_ORDER: usize = 30;

/// What a run leaves out, and by how much.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Saved {
    /// Bodies that are solved in a plane.
    pub planar_bodies: usize,
    /// Rows of the solver, and how many there would be in space.
    pub rows: usize,
    /// Rows of the solver for all bodies in space.
    pub rows_in_space: usize,
    /// Parts that are solved apart.
    pub islands: usize,
    /// Steps of bodies taken, and how many there would be if all parts took the steps of the busiest.
    pub body_steps: u64,
    /// Steps of bodies with common steps.
    pub body_steps_together: u64,
    /// Bodies that are left out because they cannot move.
    pub fixed_bodies: usize,
    /// Entries of the matrix that were not written again.
    pub constants: u64,
    /// Steps after which the constraints needed no measuring.
    pub checks: u64,
}

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Taylor {
    islands: Vec<Island>,
    /// End of the last step and the state there.
    t: f64,
    y: Vec<f64>,
    /// Start of the last step, and the part that took it.
    t_old: f64,
    last: usize,
    saved: Saved,
    /// Whether the last step has shown by itself that the constraints hold.
    proven: bool,
    /// Steps so far.
    pub steps: Steps,
    /// Projections so far.
    pub projections: u64,
}

impl Taylor {
    /// Starts at (t, y), which must be in place in the mechanism and consistent, with relative and absolute tolerance
    /// `tolerance`.
    pub fn new(mechanism: &Mechanism, t: f64, y: &[f64], tolerance: f64) -> Self {
        let Mechanism { system, state, elimination, .. } = mechanism;
        let skip = system.model.settings.skip;
        let q = &y[..system.coordinates];
        let split = islands::split(system, q, skip.islands, skip.fixed);
        let turns: Vec<f64> = state.angles().iter().map(|angle| angle.value).collect();
        let redundant = elimination.is_redundant();
        let islands: Vec<Island> = if split.parts.is_empty() && split.fixed == 0 {
            vec![Island::new(system, None, redundant, &turns, t, y, tolerance)]
        } else {
            let island = |part: islands::Part| {
                let turns: Vec<f64> =
                    part.system.angle_joints.iter().map(|joint| turn(system, &turns, joint)).collect();
                Island::new(system, Some(part), redundant, &turns, t, y, tolerance)
            };
            split.parts.into_iter().map(island).collect()
        };
        let mut saved = Saved {
            islands: islands.len(),
            fixed_bodies: split.fixed,
            rows_in_space: system.solver_rows,
            ..Saved::default()
        };
        for island in &islands {
            saved.rows += island.rows();
            saved.planar_bodies += if island.is_planar() { island.bodies() } else { 0 };
        }
        Self {
            islands,
            t,
            y: y.to_vec(),
            t_old: t,
            last: 0,
            saved,
            proven: false,
            steps: Steps::default(),
            projections: 0,
        }
    }

    /// Whether knots of prescribed functions follow so closely until `end` that steps, which end at each of them, would be
    /// far shorter than the series allow.
    pub fn crowded(&mut self, end: f64) -> bool {
        self.islands.iter_mut().any(|island| island.crowded(end))
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
        self.t - self.t_old
    }

    /// Whether the last step has shown by itself that the constraints hold at its end.
    pub fn proves_constraints(&mut self) -> bool {
        if self.proven {
            self.saved.checks += 1;
        }
        self.proven
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        let mut sum = Counters::default();
        for island in &self.islands {
            let own = island.counters();
            sum.evaluations += own.evaluations;
            sum.factorizations += own.factorizations;
            sum.solves += own.solves;
        }
        sum
    }

    /// What has been left out so far.
    pub fn saved(&self) -> Saved {
        let mut saved = self.saved;
        let most = self.islands.iter().map(Island::steps).max().unwrap_or(0);
        for island in &self.islands {
            saved.body_steps += island.steps() * island.bodies() as u64;
            saved.body_steps_together += most * island.bodies() as u64;
            saved.constants += island.constants_kept();
        }
        saved
    }

    /// The last step of the part that took it, if it may hide a singular position.
    pub fn stepped(&self, system: &System) -> Option<Stepped<'_>> {
        self.islands.get(self.last).and_then(|island| island.stepped(system, self.last))
    }

    /// How firmly each joint of that part holds at time t within its last step.
    pub fn holds_inside(&mut self, t: f64) -> &[f64] {
        self.islands.get_mut(self.last).map_or(&[], |island| island.holds_inside(t))
    }

    /// Writes the state at time t as the part that took the last step knows it: of other parts, the end of it.
    pub fn write_part(&self, system: &System, t: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.y);
        if let Some(island) = self.islands.get(self.last) {
            island.interpolate(system, t, y);
        }
    }

    /// Takes one step, not beyond `end`: the part that is farthest behind goes on.
    pub fn step(&mut self, system: &System, end: f64) -> Result<(), Stop> {
        let behind =
            self.islands.iter_mut().enumerate().min_by(|(_, a), (_, b)| a.time().total_cmp(&b.time()));
        let Some((index, island)) = behind else {
            // Nothing can move.
            (self.t_old, self.t, self.proven) = (self.t, end, false);
            return Ok(());
        };
        let (proven, rejected) = island.step(system, end, &mut self.y)?;
        (self.last, self.proven) = (index, proven);
        self.steps.accepted += 1;
        self.steps.rejected += rejected;

        self.projections += 1;
        self.t_old = self.t;
        self.t = self.islands.iter().map(Island::time).fold(f64::INFINITY, f64::min);
        if self.islands.len() > 1 {
            let Self { islands, t, y, .. } = self;
            for island in islands {
                island.interpolate(system, *t, y);
            }
        }
        Ok(())
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t within it, J.
    pub fn work_to(&self, t: f64) -> f64 {
        self.islands.iter().map(|island| island.work_to(t) - island.work_to(self.t_old)).sum()
    }

    /// Multipliers of the solver rows at a state within the last step, with A there, where the series have them: those of
    /// the whole in space do.
    pub fn multipliers(&self, system: &System, state: &State, jacobian: &TwistJacobian) -> Option<Vec<f64>> {
        let [island] = self.islands.as_slice() else { return None };
        island.multipliers(system, state, jacobian)
    }

    /// Writes y(t) within the last step.
    pub fn interpolate(&self, system: &System, t: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.y);
        if t < self.t {
            self.islands.iter().for_each(|island| island.interpolate(system, t.max(self.t_old), y));
        }
    }
}

/// The angle of a joint at the start.
fn turn(system: &System, turns: &[f64], joint: &str) -> f64 {
    let place = system.angle_joints.iter().position(|name| name == joint);
    place.and_then(|place| turns.get(place)).copied().unwrap_or(0.0)
}
