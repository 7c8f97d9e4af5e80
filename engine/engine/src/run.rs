//! A scene that runs: time, state, steps, and what can be asked of them.

pub mod energy_balance;

pub mod singularity;

mod cause;
mod events;
mod explain;
mod frame;
mod queries;
mod snapshot;
mod summary;

pub use events::EventOccurrence;
pub use explain::SkippedItem;
pub use frame::Frame;
pub use snapshot::Snapshot;
pub use summary::Summary;

use crate::error::{EngineError, LastGood};
use crate::integrate::{self, Integrator};
use crate::run::singularity::{SingularConfiguration, SingularityMonitor};
use crate::scene::{IntegratorKind, Scene};
use nalgebra::{Matrix3, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::{self, Rank};
use triad_dynamics::dynamics::elimination::Counters;
use triad_dynamics::model::{Model, ModelBody};
use triad_dynamics::state::{BodyFrame, State};
use triad_dynamics::system::System;

/// A scene that runs: it stands at a time, and can be asked about the state there.
///
/// ```
/// let mut run = triad_engine::run::Simulation::new(&triad_engine::catalogue::scene("free-fall")?)?;
/// assert_eq!(run.advance_to(0.5).map(|()| run.frame().time)?, 0.5);
/// # Ok::<(), triad_engine::EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulation {
    mechanism: Mechanism,
    integrator: Integrator,
    kind: IntegratorKind,
    reason: String,
    start: Vec<f64>,
    rank: Rank,
    notes: Vec<String>,
    /// Time of the state that is shown, not after the end of the last step.
    time: f64,
    /// The state that is shown, as y = (q, q̇) and evaluated.
    shown: Vec<f64>,
    current: State,
    start_energy: f64,
    /// Largest kinetic energy at the ends of steps that were looked at, J.
    kinetic: f64,
    /// Whether neither drivers nor loads without potential act.
    conservative: bool,
    /// Their work up to the start of the last step, J.
    work: f64,
    scratch: Vec<f64>,
    /// Steps, rejected ones included, after which the run stops.
    step_limit: u64,
    /// What has happened so far, in the order of time.
    happened: Vec<EventOccurrence>,
    /// Numbers of events less their values, and their rates, where the last step ended.
    last_numbers: Vec<[f64; 2]>,
    /// When the run ends, s: its duration, or the moment of an event that stops it.
    end: f64,
    counted: explain::Counted,
    /// Searches steps for singular configurations.
    singularities: SingularityMonitor,
}

impl Simulation {
    /// Checks, assembles and starts a scene.
    pub fn new(scene: &Scene) -> Result<Self, EngineError> {
        Self::from_model(Model::new(scene)?)
    }

    /// Assembles and starts a checked model.
    pub fn from_model(model: Model) -> Result<Self, EngineError> {
        let mut notes = model.notes.clone();
        let mut mechanism = Mechanism::new(System::new(model));
        let n = mechanism.system.coordinates;
        let mut start = vec![0.0; 2 * n];
        let (q, q_dot) = start.split_at_mut(n);
        mechanism.system.start(q, q_dot);
        notes.extend(mechanism.assemble(&mut start)?);
        let rank = {
            let Mechanism { system, state, elimination, .. } = &mut mechanism;
            rank::analyze(system, state, elimination, &start[..n])
        };
        rank::check(&mechanism.system, &rank)?;
        if rank.at_start < rank.rank {
            notes.push(format!(
                "the start is a singular position: {} rows lose their hold there, and several branches of motion may \
                 begin; without a velocity that chooses one, which of them is followed is not determined",
                rank.rank - rank.at_start
            ));
        }
        mechanism.elimination.set_dependent(&rank.dependent);
        mechanism.elimination.counters = Counters::default();
        mechanism.set_state(0.0, &start);
        let current = mechanism.state.clone();
        let start_energy = current.energy(&mechanism.system);
        let (kind, reason) = integrate::choose(&mut mechanism, &start);
        mechanism.elimination.counters = Counters::default();
        let integrator = Integrator::start(kind, &mut mechanism, 0.0, &start);
        let shown = start.clone();
        let singularities = SingularityMonitor::new(&mut mechanism, &rank);
        let conservative = mechanism.system.is_conservative();
        let looks = !conservative || !mechanism.system.event_functions.is_empty();
        let scratch = vec![0.0; if looks { 2 * n } else { 0 }];
        let end = mechanism.system.model.settings.duration;
        let mut simulation = Self {
            mechanism,
            integrator,
            kind,
            reason,
            start,
            rank,
            notes,
            time: 0.0,
            shown,
            current,
            start_energy,
            kinetic: 0.0,
            conservative,
            work: 0.0,
            scratch,
            step_limit: u64::MAX,
            happened: Vec::new(),
            last_numbers: Vec::new(),
            end,
            counted: explain::Counted::default(),
            singularities,
        };
        simulation.restart_events();
        Ok(simulation)
    }

    /// The assembled system.
    pub fn system(&self) -> &System {
        &self.mechanism.system
    }

    /// The checked model.
    pub fn model(&self) -> &Model {
        &self.mechanism.system.model
    }

    /// Rank of the joint rows near the start.
    pub fn rank(&self) -> &Rank {
        &self.rank
    }

    /// What was found or corrected.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// End of the run, s.
    pub fn duration(&self) -> f64 {
        self.model().settings.duration
    }

    /// Time of the state that is shown, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Generalized coordinates that are shown.
    pub fn q(&self) -> &[f64] {
        &self.shown[..self.system().coordinates]
    }

    /// Generalized velocities that are shown.
    pub fn q_dot(&self) -> &[f64] {
        &self.shown[self.system().coordinates..]
    }

    /// Whether the end of the run is reached, or an event that stops it.
    pub fn finished(&self) -> bool {
        self.time >= self.end
    }

    /// Goes on from where another run of the same scene stands, whose numbers may differ: bodies keep their places
    /// and velocities as far as the constraints allow. Counters and energies are counted from here. Returns what was
    /// corrected, in words.
    pub fn continue_from(&mut self, other: &Self) -> Result<Vec<String>, EngineError> {
        let time = other.time.min(self.duration());
        let frames = other.frame().bodies;
        let n = self.system().coordinates;
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        let system = &self.mechanism.system;
        let places = system.model.bodies.iter().zip(&other.model().bodies).zip(&frames);
        let moved: Vec<ModelBody> = places.map(|((body, old), frame)| placed_as(body, old, frame)).collect();
        system.start_of(&moved, q, q_dot);
        self.mechanism.state.copy_revolutions(&other.current);
        let notes = self.mechanism.assemble_at(time, &mut y)?;
        self.mechanism.state.commit_revolutions();
        self.begin(time, &y);
        Ok(notes)
    }

    /// Starts to integrate at a consistent state.
    fn begin(&mut self, time: f64, y: &[f64]) {
        self.mechanism.elimination.counters = Counters::default();
        self.mechanism.projections = 0;
        self.counted = explain::Counted::default();
        (self.work, self.kinetic) = (0.0, 0.0);
        self.singularities.reset();
        self.mechanism.set_state(time, y);
        self.integrator = Integrator::start(self.kind, &mut self.mechanism, time, y);
        self.time = time;
        self.shown.copy_from_slice(y);
        self.evaluate_current();
        self.start_energy = self.current.energy(&self.mechanism.system);
        self.restart_events();
    }

    /// Back to the start; counters begin anew.
    pub fn reset(&mut self) {
        self.mechanism.state.reset_revolutions();
        let start = std::mem::take(&mut self.start);
        self.begin(0.0, &start);
        self.start = start;
    }

    /// Goes on by one step of the integrator (or to the end of the step that the shown state lies in).
    pub fn step(&mut self) -> Result<(), EngineError> {
        if self.time >= self.integrator.last().t && !self.finished() {
            self.integrate_one(self.duration())?;
        }
        self.show(self.integrator.last().t);
        Ok(())
    }

    /// Goes on to time t, at most the end of the run.
    pub fn advance_to(&mut self, t: f64) -> Result<(), EngineError> {
        self.advance_towards(t, u64::MAX).map(|_| ())
    }

    /// Goes on towards time t by at most so many integrator steps, and tells whether it got there. If not, the state
    /// that is shown stays as it is, and the next call goes on from where this one ended: a caller who must be able
    /// to stop asks in pieces, with the same result.
    pub fn advance_towards(&mut self, t: f64, most_steps: u64) -> Result<bool, EngineError> {
        let mut t = t.min(self.end);
        if t.is_nan() || t < self.time {
            return Err(EngineError::TimeOutside { time: t, from: self.time, to: self.duration() });
        }
        let mut left = most_steps;
        let end = if self.model().settings.skip.outputs { self.duration() } else { t };
        while self.integrator.last().t < t {
            if left == 0 {
                return Ok(false);
            }
            left -= 1;
            self.integrate_one(end)?;
            t = t.min(self.end);
        }
        self.counted.outputs[0] += u64::from(t < self.integrator.last().t);
        self.counted.outputs[1] += 1;
        self.show(t);
        Ok(true)
    }

    /// Shows the state of a time within the last step, not after the end of the run.
    fn show(&mut self, t: f64) {
        self.time = t.min(self.end);
        self.integrator.interpolate(&mut self.mechanism, self.time, &mut self.shown);
        self.evaluate_current();
    }

    /// Takes over the state that is shown; whole turns are counted as the run has counted them.
    fn evaluate_current(&mut self) {
        let Self { mechanism: Mechanism { system, state, .. }, current, .. } = self;
        current.set_revolutions(state.angles().iter().map(|angle| angle.reference));
        let (q, q_dot) = self.shown.split_at(system.coordinates);
        current.set(system, self.time, q, q_dot);
    }

    /// Ends a run with [`EngineError::StepLimit`] after so many steps, rejected ones included.
    pub fn set_step_limit(&mut self, steps: u64) {
        self.step_limit = steps;
    }

    fn integrate_one(&mut self, end: f64) -> Result<(), EngineError> {
        let steps = self.integrator.last().steps;
        if steps.accepted + steps.rejected >= self.step_limit {
            let (time, steps) = (self.integrator.last().t, self.step_limit);
            let last = self.show_last_good(time, self.integrator.last().steps.accepted);
            return Err(EngineError::StepLimit { time, steps, last });
        }
        self.work += self.work_of_last_step(self.integrator.last().t);
        if let Err(stop) = self.integrator.step(&mut self.mechanism, end) {
            let last = self.show_last_good(self.integrator.last().t, self.integrator.last().steps.accepted);
            return Err(EngineError::stopped(stop, last));
        }
        let skip = self.model().settings.skip;
        if !(skip.checks && self.integrator.proves_constraints()) {
            self.counted.checks += 1;
            let time = self.integrator.last().t;
            if let Err(error) = self.mechanism.check(time, &self.integrator.last().y) {
                let start = time - self.integrator.last().h;
                let last =
                    self.show_last_good(start, self.integrator.last().steps.accepted.saturating_sub(1));
                return Err(EngineError::from(error).after(last));
            }
            let Mechanism { system, state, .. } = &self.mechanism;
            self.kinetic = self.kinetic.max(state.kinetic_energy(system));
        }
        self.singularities.step(&mut self.mechanism, &mut self.integrator);
        self.look_for_events();
        if !skip.reports {
            self.report_step();
        }
        Ok(())
    }

    /// Shows the last good state of a run that cannot go on, and tells what it is like.
    fn show_last_good(&mut self, time: f64, steps: u64) -> LastGood {
        if time >= self.time {
            self.show(time);
        }
        LastGood { steps, cause: self.cause().map(Box::new) }
    }

    /// Finds what is otherwise found when somebody asks, at the end of the last step.
    fn report_step(&mut self) {
        let shown = (self.time, std::mem::replace(&mut self.shown, self.integrator.last().y.clone()));
        self.time = self.integrator.last().t;
        self.evaluate_current();
        let _ = (self.summary(), self.multipliers(), self.jacobian());
        (self.time, self.shown) = shown;
        self.evaluate_current();
        self.counted.reports += 1;
    }

    /// Singular configurations passed since the start.
    pub fn singular_configurations(&self) -> Vec<SingularConfiguration> {
        self.singularities.configurations(self.system())
    }

    /// Evaluations inside steps in the search for singular configurations.
    pub fn probes(&self) -> u64 {
        self.singularities.probes()
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t, J.
    fn work_of_last_step(&mut self, t: f64) -> f64 {
        let start = self.integrator.last().t - self.integrator.last().h;
        if self.conservative || t <= start {
            return 0.0;
        }
        if let Some(work) = self.integrator.work_to(t) {
            return work;
        }
        let counters = self.mechanism.elimination.counters;
        let Self { mechanism, integrator, scratch, .. } = self;
        let work = energy_balance::work(mechanism, (start, t), scratch, |mechanism, t, state| {
            integrator.interpolate(mechanism, t, state);
        });
        self.mechanism.elimination.counters = counters;
        work
    }

    /// Time up to which the run has been integrated, s: that of the last good state if it has stopped.
    pub fn reached(&self) -> f64 {
        self.integrator.last().t
    }

    /// A run that starts where this one stands, velocities reversed: without drivers and losses it goes the way back.
    #[must_use]
    pub fn turned_back(&self) -> Self {
        let mut back = self.clone();
        let n = self.system().coordinates;
        back.start.copy_from_slice(&self.shown);
        back.start[n..].iter_mut().for_each(|v| *v = -*v);
        back.reset();
        back
    }
}

/// A body where `old`, a body of the same frame, stands in a run. Centre of mass and principal axes may differ between
/// the two: what stays in place is the author's frame.
fn placed_as(body: &ModelBody, old: &ModelBody, frame: &BodyFrame) -> ModelBody {
    let axes = [frame.u, frame.v, frame.w].map(Vector3::from);
    let turn = Matrix3::from_columns(&axes) * old.principal_axes.transpose();
    let angular_velocity = Vector3::from(frame.angular_velocity);
    let arm = turn * (body.center_of_mass - old.center_of_mass);
    ModelBody {
        position: Vector3::from(frame.position) + arm,
        directors: turn * body.principal_axes,
        velocity: Vector3::from(frame.velocity) + angular_velocity.cross(&arm),
        angular_velocity,
        ..body.clone()
    }
}
