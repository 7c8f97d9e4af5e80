//! A simulation: the state of a scene at one time, advanced step by step, with everything that can be computed from it.

mod energy_balance;
mod singularity;

mod examiner;
mod frame;
mod ringing;
mod state_view;

mod companion;

mod cause;
mod errors;
mod events;
mod explain;
mod lent_inertia;
mod notes;
mod outputs;
mod queries;
mod restart;
mod seen;
mod snapshot;
pub(crate) mod start;
mod summary;

pub use errors::{ErrorEstimate, ReactionErrors};
pub use events::EventOccurrence;
pub use explain::SkippedItem;
pub use frame::{Frame, MarkerFrame};
pub use outputs::{Column, Moment, Outputs, RowWriter, append_row};
pub use singularity::SingularConfiguration;
pub use snapshot::{Snapshot, list_size};
pub use state_view::StateView;
pub use summary::Summary;

use crate::error::{EngineError, LastGood};
use crate::integrate::{Integrator, StopReason};
use crate::model::{CustomLoadError, Model};
use crate::scene::IntegratorKind;
use companion::Companion;
use examiner::Examiner;
use lent_inertia::LentInertia;
use notes::Notes;
use seen::Seen;
use singularity::SingularityMonitor;
use state_view::CachedState;
use std::sync::OnceLock;
use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::system::System;

/// How often a step that leads off the constraints is halved before the run stops: near a branching position Newton's method
/// reaches them from a short step only, and where a driver asks for what the joints refuse from none.
const MAX_HALVINGS: u32 = 20;

/// A running simulation of a scene.
///
/// It has one current state, that at [`Simulation::time`]; [`Simulation::advance_to`] moves on to a later one. Methods that
/// compute something from the current state take `&self`, leave the run as it is, and solve for accelerations and multipliers
/// at most once for each state. [`Solution`](crate::Solution) keeps a whole run instead.
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
    /// A second solution, where the integrator does not carry its error along.
    companion: Option<Box<Companion>>,
    kind: IntegratorKind,
    reason: String,
    start: Vec<f64>,
    rank: Rank,
    notes: Notes,
    /// The current state: at the end of the last step, or before it.
    current: CachedState,
    start_energy: f64,
    /// Largest energies so far.
    seen: Seen,
    /// Whether neither drivers nor loads without potential act.
    conservative: bool,
    /// Bodies without inertia about some axis.
    lent_inertia: LentInertia,
    /// Work of drivers and of loads without potential up to the start of the last step, J.
    work: f64,
    scratch: Vec<f64>,
    /// Steps, rejected ones included, after which the run stops.
    step_limit: u64,
    /// Events found so far, in the order of time.
    occurrences: Vec<EventOccurrence>,
    /// How many of them have been judged by the estimate.
    judged_events: usize,
    /// See [`Simulation::off_at_start`].
    off_at_start: OnceLock<f64>,
    /// For each event, its quantity less the value that triggers it, and the rate of that, at the end of the last step.
    last_numbers: Vec<[f64; 2]>,
    /// When the run ends, s: its duration, or the moment of an event that stops it.
    end: f64,
    /// Work after steps and at outputs, done or left out.
    counters: explain::RunCounters,
    /// Searches steps for singular configurations.
    singularities: SingularityMonitor,
    /// Makes solvers for states that are looked at.
    examiner: Examiner,
    /// The run before the steps that are being taken again to tell two branches of the motion apart.
    before_branching: Option<Box<Self>>,
}

impl Simulation {
    /// The assembled system.
    #[doc(hidden)]
    pub fn system(&self) -> &System {
        &self.mechanism.system
    }

    /// The checked model.
    pub fn model(&self) -> &Model {
        &self.mechanism.system.model
    }

    /// Rank of the joint rows near the start — THEORY section 8.
    pub fn rank(&self) -> &Rank {
        &self.rank
    }

    /// What was found or corrected when the run began, in sentences.
    pub fn notes(&self) -> &[String] {
        self.notes.all()
    }

    /// End of the run, s.
    pub fn duration(&self) -> f64 {
        self.model().settings.duration
    }

    /// Time t of the current state, s.
    pub fn time(&self) -> f64 {
        self.current.time()
    }

    /// Generalized coordinates q of the current state, in the order of the columns of the Jacobian: m for positions, 1 for
    /// directors.
    pub fn q(&self) -> &[f64] {
        &self.current.y()[..self.system().coordinates]
    }

    /// Generalized velocities q̇ of the current state: m/s and 1/s.
    pub fn q_dot(&self) -> &[f64] {
        &self.current.y()[self.system().coordinates..]
    }

    /// Whether the end of the run is reached, or an event that stops it.
    pub fn finished(&self) -> bool {
        self.time() >= self.end
    }

    /// Time up to which the run has been integrated, s: that of the last good state if it has stopped.
    pub fn reached(&self) -> f64 {
        self.integrator.last().t
    }

    /// Singular configurations passed since the start — THEORY section 8.
    pub fn singular_configurations(&self) -> Vec<SingularConfiguration> {
        self.singularities.configurations(self.system())
    }

    /// Places up to now at which branches of the motion come so near each other that either may have been followed, in words.
    pub fn branching(&self) -> Vec<String> {
        self.singularities.doubts(self.system())
    }

    /// Evaluations inside steps in the search for singular configurations.
    pub fn probes(&self) -> u64 {
        self.singularities.probes()
    }

    /// Ends a run with [`EngineError::StepLimit`] after so many steps, rejected ones included.
    pub fn set_step_limit(&mut self, steps: u64) {
        self.step_limit = steps;
    }

    /// Start and end of the last step, s.
    pub(crate) fn last_step(&self) -> [f64; 2] {
        let last = self.integrator.last();
        [last.t - last.h, last.t]
    }

    /// Writes the state y = (q, q̇) at a time within the last step; the current state stays as it is. At its end the state is
    /// that after the projection onto the constraints, before it that of the step's polynomial.
    pub(crate) fn look_into_step(&mut self, t: f64, y: &mut [f64]) {
        self.integrator.interpolate(&mut self.mechanism, t, y);
    }

    /// From now on finds outputs by interpolation within steps that are not shortened for them, whatever the settings say.
    pub(crate) fn interpolate_outputs(&mut self) {
        self.mechanism.system.model.settings.skip.outputs = true;
    }

    /// Goes on to time t, s, at most to the end of the run.
    ///
    /// # Errors
    ///
    /// [`EngineError::TimeOutside`] for a time before the current one. The error of a run that cannot go on gives the reason,
    /// the time and, where it can be found, the joint, driver or load; the last good state is then the current one.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut run = Simulation::new(&catalogue::scene("free-fall")?)?;
    /// run.advance_to(0.5)?;
    /// assert_eq!(run.advance_to(0.2).unwrap_err().code(), "time-outside-run");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn advance_to(&mut self, t: f64) -> Result<(), EngineError> {
        self.advance_towards(t, u64::MAX).map(|_| ())
    }

    /// Advances towards time t by at most `most_steps` steps of the integrator, and returns whether it got there. If it did
    /// not, the current state stays as it is, and the next call continues where this one ended: a caller who must be able to
    /// interrupt the run advances in portions, with the same result.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::advance_to`].
    pub fn advance_towards(&mut self, t: f64, most_steps: u64) -> Result<bool, EngineError> {
        let mut t = t.min(self.end);
        if t.is_nan() || t < self.time() {
            return Err(EngineError::TimeOutside { time: t, from: self.time(), to: self.duration() });
        }
        let mut steps_left = most_steps;
        let end = if self.model().settings.skip.outputs { self.duration() } else { t };
        while self.integrator.last().t < t {
            if steps_left == 0 {
                return Ok(false);
            }
            steps_left -= 1;
            self.take_step(end)?;
            t = t.min(self.end);
        }
        self.counters.outputs[0] += u64::from(t < self.integrator.last().t);
        self.counters.outputs[1] += 1;
        self.set_current_time(t);
        Ok(true)
    }

    /// Advances by one step of the integrator, or to the end of the step that the current state lies in.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::advance_to`].
    pub fn step(&mut self) -> Result<(), EngineError> {
        if self.time() >= self.integrator.last().t && !self.finished() {
            self.take_step(self.duration())?;
        }
        self.set_current_time(self.integrator.last().t);
        Ok(())
    }

    /// Takes one step of the integrator, not beyond `end`; the current state stays as it is.
    pub(crate) fn take_step(&mut self, end: f64) -> Result<(), EngineError> {
        let steps = self.integrator.last().steps;
        if steps.accepted + steps.rejected >= self.step_limit {
            let (time, steps) = (self.integrator.last().t, self.step_limit);
            let last = self.stop_at_last_good(time, self.integrator.last().steps.accepted);
            return Err(EngineError::StepLimit { time, steps, last });
        }
        self.work += self.work_of_last_step(self.integrator.last().t);
        self.judge_events(self.integrator.last().t);
        if let Some(companion) = &mut self.companion {
            let (work, _) = self.integrator.work(&self.mechanism);
            companion.keep_up(&self.integrator, work.evaluations);
        }
        self.step_integrator(end)?;
        let Self { mechanism, integrator, lent_inertia, .. } = &mut *self;
        let last = integrator.last();
        let looked = lent_inertia.look(mechanism, last.t, &last.y);
        looked.map_err(|error| self.left_constraints(error))?;
        self.seen.step(&self.mechanism.system, self.integrator.last(), self.work);
        self.find_events();
        if !self.model().settings.skip.reports {
            self.report_step();
        }
        Ok(())
    }

    /// Takes a step of the integrator, not beyond `end`, shorter ones where it leads off the constraints or where branches of
    /// the motion come near each other. Where no step is short enough to tell them apart, the run goes back, passes them as it
    /// would have, and keeps the doubt.
    fn step_integrator(&mut self, end: f64) -> Result<(), EngineError> {
        let mut until = end;
        let mut halvings = 0;
        self.off_at_start.take();
        loop {
            let Self { integrator, mechanism, .. } = &mut *self;
            if let Err(stop) = integrator.step(mechanism, until) {
                let Some(before) = self.before_branching.take() else { return Err(self.stopped(stop)) };
                self.go_back(*before);
                until = end;
                continue;
            }
            if let Err(error) = self.check_step() {
                let Self { integrator, mechanism, .. } = &mut *self;
                let fixed = mechanism.system.model.settings.step.is_some();
                let (reached, middle) =
                    (integrator.last().t, integrator.last().t - 0.5 * integrator.last().h);
                if fixed || halvings == MAX_HALVINGS || middle >= reached || !integrator.can_retreat() {
                    return Err(self.left_constraints(error));
                }
                halvings += 1;
                until = middle;
                integrator.take_back(mechanism);
                continue;
            }
            let Self { integrator, mechanism, singularities, .. } = &mut *self;
            let Some(shorter) = singularities.step(mechanism, integrator) else { break };
            integrator.take_back_to_search(mechanism);
            until = shorter;
            if self.singularities.is_resolving() && self.before_branching.is_none() {
                self.before_branching = Some(Box::new(self.clone()));
            }
        }
        if self.before_branching.is_some() && !self.singularities.is_resolving() {
            self.before_branching = None;
        }
        Ok(())
    }

    /// Goes back to what the run was, where branches that cannot be told apart were not yet looked for; the current state stays.
    fn go_back(&mut self, before: Self) {
        let tried = std::mem::replace(self, before);
        let Self { integrator, mechanism, singularities, .. } = self;
        singularities.give_up(&tried.singularities, mechanism, integrator);
        self.current = tried.current;
    }

    /// Measures the constraints at the end of the last step where the integrator has not proved that they hold.
    fn check_step(&mut self) -> Result<(), ConstraintError> {
        let step = self.integrator.last();
        self.mechanism.check_angles([step.t - step.h, step.t])?;
        if self.model().settings.skip.checks && self.integrator.proves_constraints() {
            return Ok(());
        }
        self.counters.checks += 1;
        let last = self.integrator.last();
        self.mechanism.check(last.t, &last.y)
    }

    /// The end of a run whose integrator cannot go on.
    fn stopped(&mut self, stop: StopReason) -> EngineError {
        let failure = self.load_failure();
        let last = self.stop_at_last_good(self.integrator.last().t, self.integrator.last().steps.accepted);
        match failure {
            Some(error) => EngineError::CustomLoad { error, last: Some(last) },
            None => EngineError::stopped(stop, last),
        }
    }

    /// The end of a run whose last step left the constraints.
    fn left_constraints(&mut self, error: ConstraintError) -> EngineError {
        let last = self.integrator.last();
        let (start, steps) = (last.t - last.h, last.steps.accepted.saturating_sub(1));
        self.mechanism.state.take_back_motion();
        let last = self.stop_at_last_good(start, steps);
        EngineError::from(error).after(last)
    }

    /// Computes at the end of the last step what is otherwise computed on request.
    fn report_step(&mut self) {
        let current = self.current.clone();
        let (time, y) = (self.integrator.last().t, self.integrator.last().y.clone());
        self.set_current(time, &y);
        // Not left to `summary`, which would prepare the dense output in a copy of the run.
        let work = self.work_of_last_step(time);
        self.current.work(|| work);
        let _ = (self.summary(), self.multipliers(), self.jacobian());
        self.current = current;
        self.counters.reports += 1;
    }

    /// Why a load that is a function of the state could not act in the step that has just failed.
    fn load_failure(&self) -> Option<CustomLoadError> {
        let failure = self.mechanism.elimination.load_failure()?;
        // An earlier failure belongs to a trial step, after which a shorter step was accepted: it has done no harm.
        let in_this_step =
            !matches!(failure, CustomLoadError::NotFinite { time, .. } if *time < self.integrator.last().t);
        in_this_step.then(|| failure.clone())
    }

    /// Makes the last good state of a run that cannot go on the current one, and returns what is known about it.
    fn stop_at_last_good(&mut self, time: f64, steps: u64) -> LastGood {
        if time >= self.time() {
            let known = self.current.clone();
            self.set_current_time(time);
            // Within a step that leads to no numbers none can be read off: the state that was shown last stays.
            if !self.current.y().iter().all(|number| number.is_finite()) {
                self.current = known;
            }
        }
        LastGood { steps, size: self.model().settings.step, cause: self.cause().map(Box::new) }
    }

    /// Makes the state at a time within the last step, not after the end of the run, the current one.
    fn set_current_time(&mut self, t: f64) {
        self.judge_events(t);
        let Self { mechanism, integrator, companion, current, end, .. } = self;
        let t = t.min(*end);
        current.replace(mechanism, t, |mechanism, y| integrator.interpolate(mechanism, t, y));
        if let Some(companion) = companion {
            companion.compare(t, current.y(), integrator);
        }
    }

    /// Makes y = (q, q̇) at time t, s, the current state.
    fn set_current(&mut self, t: f64, y: &[f64]) {
        self.current.replace(&mut self.mechanism, t, |_, current| current.copy_from_slice(y));
    }
}
