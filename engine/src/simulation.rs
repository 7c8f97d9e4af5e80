//! A scene that runs: time, state, steps, and what can be asked of them.

mod explain;
mod moment;

pub use explain::LeftOut;
pub use moment::Moment;

use crate::balance;
use crate::elimination::Counters;
use crate::error::EngineError;
use crate::event::{self, Happening};
use crate::integrate::{self, Integrator, Plant, Stop};
use crate::jacobian::Jacobian;
use crate::mechanism::Mechanism;
use crate::model::{Model, ModelBody};
use crate::rank::{self, Rank};
use crate::reaction::report::{Convention, ReactionReport, report};
use crate::reaction::{self, JointMultipliers};
use crate::scene::{IntegratorKind, Scene};
use crate::system::System;
use crate::trust;
use nalgebra::Vector3;
use serde::Serialize;

/// A body at one moment, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BodyFrame {
    /// Centre of mass, m.
    pub position: [f64; 3],
    /// Director u, a principal axis.
    pub u: [f64; 3],
    /// Director v.
    pub v: [f64; 3],
    /// Director w.
    pub w: [f64; 3],
    /// Velocity of the centre of mass, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [f64; 3],
}

/// All bodies at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyFrame>,
}

/// What a run has cost and how far it can be trusted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Time, s.
    pub time: f64,
    /// Kinetic plus potential energy, J.
    pub energy: f64,
    /// Work of drivers and of loads without potential since the start, J.
    pub work: f64,
    /// Energy less that of the start and the work since, J: zero but for errors.
    pub energy_drift: f64,
    /// Largest |Φ|.
    pub position_violation: f64,
    /// Largest |Φ̇|.
    pub velocity_violation: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Size of the last step, s.
    pub step_size: f64,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Factorizations.
    pub factorizations: u64,
    /// Back-solves.
    pub solves: u64,
    /// Projections onto the constraints.
    pub projections: u64,
    /// The integrator at work.
    pub integrator: IntegratorKind,
    /// Why it is this one.
    pub reason: String,
    /// Whether the end of the run is reached.
    pub finished: bool,
}

/// A scene that runs.
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
    /// The state that is shown.
    shown: Vec<f64>,
    start_energy: f64,
    /// Whether drivers or loads without potential act.
    exchanges_energy: bool,
    /// Their work up to the start of the last step, J.
    work: f64,
    scratch: Vec<f64>,
    /// Steps, rejected ones included, after which the run stops.
    step_limit: u64,
    /// What has happened so far, in the order of time.
    happened: Vec<Happening>,
    /// When the run ends, s: its duration, or the moment of an event that stops it.
    end: f64,
    /// Made when first asked for.
    jacobian: Option<Jacobian>,
    counted: explain::Counted,
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
        let rank = rank::analyze(&mechanism.system, &mut mechanism.elimination, &start[..n]);
        if rank.at_start < rank.rank {
            notes.push(format!(
                "the start is a singular position: {} rows lose their hold there, and several branches of motion may \
                 begin; without a velocity that chooses one, which of them is followed is not determined",
                rank.rank - rank.at_start
            ));
        }
        mechanism.elimination.set_redundant(!rank.dependent.is_empty());
        mechanism.elimination.counters = Counters::default();
        mechanism.set_state(0.0, &start);
        let start_energy = mechanism.elimination.energy(&mechanism.system);
        let (kind, reason) = integrate::choose(&mechanism, &start);
        let integrator = Integrator::start(kind, &mut mechanism, 0.0, &start);
        let shown = start.clone();
        let exchanges_energy = balance::exchanges_energy(&mechanism.system);
        let looks = exchanges_energy || !mechanism.system.watches.is_empty();
        let scratch = vec![0.0; if looks { 4 * n } else { 0 }];
        let end = mechanism.system.model.settings.duration;
        Ok(Self {
            mechanism,
            integrator,
            kind,
            reason,
            start,
            rank,
            notes,
            time: 0.0,
            shown,
            start_energy,
            exchanges_energy,
            work: 0.0,
            scratch,
            step_limit: u64::MAX,
            happened: Vec::new(),
            end,
            jacobian: None,
            counted: explain::Counted::default(),
        }
        .watching())
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

    /// Events up to the shown time, in the order of time.
    pub fn events(&self) -> &[Happening] {
        let count = self.happened.partition_point(|h| h.time <= self.time);
        &self.happened[..count]
    }

    /// Forgets what has happened; numbers that events look at are counted from the start of the integrator on, whose
    /// state must be in place.
    fn watching(mut self) -> Self {
        self.watch_anew();
        self
    }

    fn watch_anew(&mut self) {
        self.happened.clear();
        self.end = self.duration();
        let Mechanism { system, elimination, .. } = &mut self.mechanism;
        if system.watches.is_empty() {
            return;
        }
        elimination.set_time(system, self.integrator.time());
        let (q, q_dot) = self.integrator.state().split_at(system.coordinates);
        elimination.place(system, q);
        elimination.set_velocity(system, q_dot);
        for watch in &mut system.watches {
            watch.begin(elimination);
        }
    }

    /// Goes on from where another run of the same scene stands, whose numbers may differ: bodies keep their places
    /// and velocities as far as the constraints allow. Counters and energies are counted from here. Returns what was
    /// corrected, in words.
    pub fn continue_from(&mut self, other: &mut Self) -> Result<Vec<String>, EngineError> {
        let time = other.time.min(self.duration());
        let frames = other.frame().bodies;
        let n = self.system().coordinates;
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        let system = &mut self.mechanism.system;
        let places = system.model.bodies.iter().zip(&other.model().bodies).zip(&frames);
        let moved: Vec<ModelBody> = places.map(|((body, old), frame)| body.placed_as(old, frame)).collect();
        let given = std::mem::replace(&mut system.model.bodies, moved);
        system.start(q, q_dot);
        system.model.bodies = given;
        self.mechanism.elimination.take_turns(&other.mechanism.elimination);
        let notes = self.mechanism.assemble_at(time, &mut y)?;
        self.mechanism.elimination.keep_turns();
        self.begin(time, &y);
        Ok(notes)
    }

    /// Starts to integrate at a consistent state.
    fn begin(&mut self, time: f64, y: &[f64]) {
        self.mechanism.elimination.counters = Counters::default();
        self.mechanism.projections = 0;
        self.counted = explain::Counted::default();
        self.work = 0.0;
        self.mechanism.set_state(time, y);
        self.start_energy = self.mechanism.elimination.energy(&self.mechanism.system);
        self.integrator = Integrator::start(self.kind, &mut self.mechanism, time, y);
        self.time = time;
        self.shown.copy_from_slice(y);
        self.watch_anew();
    }

    /// Back to the start; counters begin anew.
    pub fn reset(&mut self) {
        self.mechanism.elimination.forget_turns();
        let start = std::mem::take(&mut self.start);
        self.begin(0.0, &start);
        self.start = start;
    }

    /// Goes on by one step of the integrator (or to the end of the step that the shown state lies in).
    pub fn step(&mut self) -> Result<(), EngineError> {
        if self.time >= self.integrator.time() && !self.finished() {
            self.integrate_one(self.duration())?;
        }
        self.show(self.integrator.time());
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
        while self.integrator.time() < t {
            if left == 0 {
                return Ok(false);
            }
            left -= 1;
            self.integrate_one(end)?;
            t = t.min(self.end);
        }
        self.counted.outputs[0] += u64::from(t < self.integrator.time());
        self.counted.outputs[1] += 1;
        self.show(t);
        Ok(true)
    }

    /// Shows the state of a time within the last step, not after the end of the run.
    fn show(&mut self, t: f64) {
        self.time = t.min(self.end);
        self.integrator.interpolate(&mut self.mechanism, self.time, &mut self.shown);
    }

    /// Ends a run with [`EngineError::StepLimit`] after so many steps, rejected ones included.
    pub fn set_step_limit(&mut self, steps: u64) {
        self.step_limit = steps;
    }

    fn integrate_one(&mut self, end: f64) -> Result<(), EngineError> {
        let steps = self.integrator.steps();
        if steps.accepted + steps.rejected >= self.step_limit {
            return Err(EngineError::StepLimit { time: self.integrator.time(), steps: self.step_limit });
        }
        self.work += self.work_of_last_step(self.integrator.time());
        self.integrator.step(&mut self.mechanism, end).map_err(|stop| match stop {
            Stop::StepTooSmall { time, step } => EngineError::StepTooSmall { time, step },
            Stop::NotFinite { time } => EngineError::Diverged { time },
        })?;
        let skip = self.model().settings.skip;
        if !(skip.checks && self.integrator.proves_constraints()) {
            self.counted.checks += 1;
            self.mechanism.check(self.integrator.time(), self.integrator.state())?;
        }
        self.look_for_events();
        if !skip.reports {
            self.report_step();
        }
        Ok(())
    }

    /// Finds what is otherwise found when somebody asks, at the end of the last step.
    fn report_step(&mut self) {
        let shown = (self.time, std::mem::replace(&mut self.shown, self.integrator.state().to_vec()));
        self.time = self.integrator.time();
        self.summary();
        self.multipliers();
        self.jacobian();
        (self.time, self.shown) = shown;
        self.counted.reports += 1;
    }

    /// Finds what has happened in the last step.
    fn look_for_events(&mut self) {
        if self.mechanism.system.watches.is_empty() {
            return;
        }
        let Self { mechanism, integrator, scratch, happened, .. } = self;
        let (before, end) = (happened.len(), integrator.time());
        let step = (end - integrator.last_step(), end);
        let mut watches = std::mem::take(&mut mechanism.system.watches);
        let state = &mut scratch[..integrator.state().len()];
        let see = |t: f64, watch: &event::Watch| {
            integrator.interpolate(mechanism, t, state);
            mechanism.set_state(t, state);
            watch.look(&mechanism.elimination)
        };
        event::find(&mut watches, step, see, happened);
        mechanism.system.watches = watches;
        if let Some(last) = happened[before..].iter().position(|h| h.stop) {
            happened.truncate(before + last + 1);
            self.end = happened[before + last].time;
        }
    }

    /// Work of drivers and of loads without potential from the start of the last step to time t, J.
    fn work_of_last_step(&mut self, t: f64) -> f64 {
        let start = self.integrator.time() - self.integrator.last_step();
        if !self.exchanges_energy || t <= start {
            return 0.0;
        }
        if let Integrator::Taylor(series) = &self.integrator {
            return series.work_to(t);
        }
        let counters = self.mechanism.elimination.counters;
        let Self { mechanism, integrator, scratch, .. } = self;
        let (state, rate) = scratch.split_at_mut(integrator.state().len());
        let work = balance::work(mechanism, (start, t), state, rate, |mechanism, t, state| {
            integrator.interpolate(mechanism, t, state);
        });
        self.mechanism.elimination.counters = counters;
        work
    }

    /// Time up to which the run has been integrated, s: that of the last good state if it has stopped.
    pub fn reached(&self) -> f64 {
        self.integrator.time()
    }

    /// How far the shown state is from its constraints, each row relative to its size.
    pub fn opening(&mut self) -> trust::Opening {
        self.mechanism.set_state(self.time, &self.shown);
        trust::opening(&self.mechanism.system, &self.mechanism.elimination)
    }

    /// Bodies at the shown state.
    pub fn frame(&mut self) -> Frame {
        self.mechanism.set_state(self.time, &self.shown);
        let bodies = self.mechanism.elimination.bodies.iter().map(|state| {
            let e = state.q.e;
            // ω = ½ Σ e_k × ė_k — eq. (6.4).
            let omega: Vector3<f64> =
                (0..3).map(|k| e[k].cross(&state.q_dot.e[k])).sum::<Vector3<f64>>() * 0.5;
            BodyFrame {
                position: state.q.r.into(),
                u: e[0].into(),
                v: e[1].into(),
                w: e[2].into(),
                velocity: state.q_dot.r.into(),
                angular_velocity: omega.into(),
            }
        });
        Frame { time: self.time, bodies: bodies.collect() }
    }

    /// Cost and trust at the shown state.
    pub fn summary(&mut self) -> Summary {
        let work = self.work + self.work_of_last_step(self.time);
        self.mechanism.set_state(self.time, &self.shown);
        let elimination = &self.mechanism.elimination;
        let energy = elimination.energy(&self.mechanism.system);
        let (position_violation, velocity_violation) = elimination.violation(&self.mechanism.system);
        let (counters, projections) = self.integrator.work(&self.mechanism);
        let steps = self.integrator.steps();
        Summary {
            time: self.time,
            energy,
            work,
            energy_drift: energy - self.start_energy - work,
            position_violation,
            velocity_violation,
            steps: steps.accepted,
            rejected: steps.rejected,
            step_size: self.integrator.last_step(),
            evaluations: counters.evaluations,
            factorizations: counters.factorizations,
            solves: counters.solves,
            projections,
            integrator: self.kind,
            reason: self.reason.clone(),
            finished: self.finished(),
        }
    }

    /// A run that starts where this one stands, all velocities reversed: without drivers and losses it goes the same
    /// way back.
    #[must_use]
    pub fn turned_back(&self) -> Self {
        let mut back = self.clone();
        let n = self.system().coordinates;
        back.start.copy_from_slice(&self.shown);
        back.start[n..].iter_mut().for_each(|v| *v = -*v);
        back.reset();
        back.mechanism.set_state(0.0, &back.start);
        back.start_energy = back.mechanism.elimination.energy(&back.mechanism.system);
        back
    }

    /// The Jacobian Φ_q at the shown state, rigid-body rows first.
    pub fn jacobian(&mut self) -> &Jacobian {
        self.mechanism.set_state(self.time, &self.shown);
        let Mechanism { system, elimination, .. } = &self.mechanism;
        let jacobian = self.jacobian.get_or_insert_with(|| Jacobian::new(system, elimination));
        jacobian.refresh(system, elimination);
        jacobian
    }

    /// Accelerations q̈ at the shown state.
    pub fn accelerations(&mut self) -> Vec<f64> {
        let time = self.time;
        self.without_counting(|mechanism, shown| {
            let mut rate = vec![0.0; shown.len()];
            mechanism.rate(time, shown, &mut rate);
            rate.split_off(mechanism.system.coordinates)
        })
    }

    /// Accelerations of the centres of mass at the shown state, in the world, m/s².
    pub fn mass_accelerations(&mut self) -> Vec<[f64; 3]> {
        let q_ddot = self.accelerations();
        self.system().bodies.iter().map(|body| body.layout.position(&q_ddot).r.into()).collect()
    }

    /// Multipliers λ and reactions of each joint at the shown state.
    pub fn multipliers(&mut self) -> Vec<JointMultipliers> {
        self.accelerations();
        reaction::multipliers(&self.mechanism.system, &self.mechanism.elimination)
    }

    /// The same, read off the series of the last step where the integrator has them: without an evaluation, and as exact
    /// as the tolerance makes the accelerations. For pictures of many moments.
    pub fn multipliers_between_steps(&mut self) -> Vec<JointMultipliers> {
        self.mechanism.set_state(self.time, &self.shown);
        if let Integrator::Taylor(series) = &self.integrator
            && series.give_multipliers(&mut self.mechanism, self.time)
        {
            return reaction::multipliers(&self.mechanism.system, &self.mechanism.elimination);
        }
        self.multipliers()
    }

    /// Reactions of joints and drivers at the shown state, with what is unique about them.
    pub fn reactions(&mut self, convention: Convention) -> Result<ReactionReport, EngineError> {
        self.accelerations();
        let Mechanism { system, elimination, .. } = &self.mechanism;
        Ok(report(system, elimination, self.time, convention)?)
    }

    /// What is asked out of curiosity must not change the counters of the run.
    fn without_counting<T>(&mut self, ask: impl FnOnce(&mut Mechanism, &[f64]) -> T) -> T {
        let counters = self.mechanism.elimination.counters;
        let answer = ask(&mut self.mechanism, &self.shown);
        self.mechanism.elimination.counters = counters;
        answer
    }
}
