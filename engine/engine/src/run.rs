//! A scene that runs: it stands at a time, goes on by steps, and can be asked about the state where it stands.

mod energy_balance;
mod singularity;

mod frame;
mod state_view;

mod cause;
mod events;
mod explain;
mod queries;
mod restart;
mod snapshot;
mod start;
mod summary;

pub use events::EventOccurrence;
pub use explain::SkippedItem;
pub use frame::Frame;
pub use singularity::SingularConfiguration;
pub use snapshot::Snapshot;
pub use state_view::StateView;
pub use summary::Summary;

use crate::error::{EngineError, LastGood};
use crate::integrate::Integrator;
use crate::model::{CustomLoadError, Model};
use crate::scene::IntegratorKind;
use singularity::SingularityMonitor;
use state_view::Shown;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::system::System;

/// A scene that runs.
///
/// It shows the state at a time, [`Simulation::time`]; [`Simulation::advance_to`] goes on. Questions about the state take
/// `&self`, change nothing, and solve at most once for each state that is shown. [`Solution`](crate::Solution) keeps a
/// whole run instead.
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
    /// The state that is shown, not after the end of the last step.
    shown: Shown,
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

    /// What was found or corrected, in words.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// End of the run, s.
    pub fn duration(&self) -> f64 {
        self.model().settings.duration
    }

    /// Time t of the state that is shown, s.
    pub fn time(&self) -> f64 {
        self.shown.time()
    }

    /// Generalized coordinates q that are shown, in the order of the columns of the Jacobian: m for positions, 1 for
    /// directors.
    pub fn q(&self) -> &[f64] {
        &self.shown.y()[..self.system().coordinates]
    }

    /// Generalized velocities q̇ that are shown: m/s and 1/s.
    pub fn q_dot(&self) -> &[f64] {
        &self.shown.y()[self.system().coordinates..]
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

    /// Evaluations inside steps in the search for singular configurations.
    pub fn probes(&self) -> u64 {
        self.singularities.probes()
    }

    /// Ends a run with [`EngineError::StepLimit`] after so many steps, rejected ones included.
    pub fn set_step_limit(&mut self, steps: u64) {
        self.step_limit = steps;
    }

    /// Shows all times from the steps that the run takes on its way to its end, whatever its settings say.
    pub(crate) fn interpolate_outputs(&mut self) {
        self.mechanism.system.model.settings.skip.outputs = true;
    }

    /// Goes on to time t, s, at most to the end of the run.
    ///
    /// # Errors
    ///
    /// [`EngineError::TimeOutside`] for a time before the one that is shown. A run that cannot go on tells why, with the
    /// time and, where it can be told, the joint, driver or load; it then shows its last good state.
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

    /// Goes on towards time t by at most so many integrator steps, and tells whether it got there. If not, the state
    /// that is shown stays as it is, and the next call goes on from where this one ended: a caller who must be able
    /// to stop asks in pieces, with the same result.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::advance_to`].
    pub fn advance_towards(&mut self, t: f64, most_steps: u64) -> Result<bool, EngineError> {
        let mut t = t.min(self.end);
        if t.is_nan() || t < self.time() {
            return Err(EngineError::TimeOutside { time: t, from: self.time(), to: self.duration() });
        }
        let mut left = most_steps;
        let end = if self.model().settings.skip.outputs { self.duration() } else { t };
        while self.integrator.last().t < t {
            if left == 0 {
                return Ok(false);
            }
            left -= 1;
            self.take_step(end)?;
            t = t.min(self.end);
        }
        self.counted.outputs[0] += u64::from(t < self.integrator.last().t);
        self.counted.outputs[1] += 1;
        self.show(t);
        Ok(true)
    }

    /// Goes on by one step of the integrator (or to the end of the step that the shown state lies in).
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::advance_to`].
    pub fn step(&mut self) -> Result<(), EngineError> {
        if self.time() >= self.integrator.last().t && !self.finished() {
            self.take_step(self.duration())?;
        }
        self.show(self.integrator.last().t);
        Ok(())
    }

    /// Takes one step of the integrator, not beyond `end`, and shows nothing of it.
    pub(crate) fn take_step(&mut self, end: f64) -> Result<(), EngineError> {
        let steps = self.integrator.last().steps;
        if steps.accepted + steps.rejected >= self.step_limit {
            let (time, steps) = (self.integrator.last().t, self.step_limit);
            let last = self.show_last_good(time, self.integrator.last().steps.accepted);
            return Err(EngineError::StepLimit { time, steps, last });
        }
        self.work += self.work_of_last_step(self.integrator.last().t);
        if let Err(stop) = self.integrator.step(&mut self.mechanism, end) {
            let failure = self.load_failure();
            let last = self.show_last_good(self.integrator.last().t, self.integrator.last().steps.accepted);
            return Err(match failure {
                Some(error) => EngineError::CustomLoad { error, last: Some(last) },
                None => EngineError::stopped(stop, last),
            });
        }
        let skip = self.model().settings.skip;
        if !(skip.checks && self.integrator.proves_constraints()) {
            self.check_step()?;
        }
        self.singularities.step(&mut self.mechanism, &mut self.integrator);
        self.look_for_events();
        if !skip.reports {
            self.report_step();
        }
        Ok(())
    }

    /// Measures the constraints at the end of the last step, which the integrator has not proved.
    fn check_step(&mut self) -> Result<(), EngineError> {
        self.counted.checks += 1;
        let time = self.integrator.last().t;
        if let Err(error) = self.mechanism.check(time, &self.integrator.last().y) {
            let start = time - self.integrator.last().h;
            let last = self.show_last_good(start, self.integrator.last().steps.accepted.saturating_sub(1));
            return Err(EngineError::from(error).after(last));
        }
        let Mechanism { system, state, .. } = &self.mechanism;
        self.kinetic = self.kinetic.max(state.kinetic_energy(system));
        Ok(())
    }

    /// Finds what is otherwise found when somebody asks, at the end of the last step.
    fn report_step(&mut self) {
        let shown = self.shown.clone();
        let (time, y) = (self.integrator.last().t, self.integrator.last().y.clone());
        self.show_state(time, &y);
        // The dense output that the work needs is prepared for the step, not for a copy of it.
        let work = self.work_of_last_step(time);
        self.shown.work(|| work);
        let _ = (self.summary(), self.multipliers(), self.jacobian());
        self.shown = shown;
        self.counted.reports += 1;
    }

    /// Why a load that is a function of the state could not act in the step that has just failed.
    fn load_failure(&self) -> Option<CustomLoadError> {
        let failure = self.mechanism.elimination.load_failure()?;
        // One that was met on the way to a step that was taken in the end has done no harm.
        let in_this_step =
            !matches!(failure, CustomLoadError::NotFinite { time, .. } if *time < self.integrator.last().t);
        in_this_step.then(|| failure.clone())
    }

    /// Shows the last good state of a run that cannot go on, and tells what it is like.
    fn show_last_good(&mut self, time: f64, steps: u64) -> LastGood {
        if time >= self.time() {
            self.show(time);
        }
        LastGood { steps, cause: self.cause().map(Box::new) }
    }

    /// Shows the state of a time within the last step, not after the end of the run.
    fn show(&mut self, t: f64) {
        let Self { mechanism, integrator, shown, end, .. } = self;
        let t = t.min(*end);
        shown.replace(mechanism, t, |mechanism, y| integrator.interpolate(mechanism, t, y));
    }

    /// Shows the state y = (q, q̇) at time t, s.
    fn show_state(&mut self, t: f64, y: &[f64]) {
        self.shown.replace(&mut self.mechanism, t, |_, shown| shown.copy_from_slice(y));
    }
}
