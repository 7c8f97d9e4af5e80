//! The motion of a scene as a function of time: a run that is kept, with its state at any time.
//!
//! ```
//! use triad_engine::prelude::*;
//!
//! let mut scene = Scene::new("drop").gravity([0.0, 0.0, -9.81]);
//! let stone = scene.add(Body::new("stone", 2.0));
//! let motion = scene.simulate(0.0..2.0)?;
//! let fallen = motion.at(1.5)?.position(&stone)?[2];
//! assert!((fallen + 0.5 * 9.81 * 1.5 * 1.5).abs() < 1e-9);
//! # Ok::<(), EngineError>(())
//! ```

mod checkpoints;
mod state;

pub use state::SolutionState;

use crate::error::EngineError;
use crate::model::CustomLoad;
use crate::reactions::report::{Convention, Reaction as ReportedReaction, ReactionReport};
use crate::run::{EventOccurrence, Simulation, Summary};
use crate::scene::{DriverHandle, EventHandle, JointHandle, Scene, Triple};
use checkpoints::{Checkpoint, Checkpoints};
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Simulation of a scene in one call.
pub trait Simulate {
    /// Runs the scene from its start, t = 0, to the end of `times`, s, and returns the motion within the range, which replaces
    /// the scene's `simulation.duration`. An event that stops the run ends the motion earlier.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::new`] and [`Simulation::advance_to`]: an invalid scene, constraints that cannot be satisfied, a
    /// run that cannot go on, each with the joint, body or time; [`EngineError::TimeOutside`] for a range that
    /// is empty or begins before 0.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("loose");
    /// scene.add(Joint::spherical("hook", Ground, "lamp").at([0.0; 3]));
    /// scene.add(Body::new("lantern", 1.0));
    /// let error = scene.simulate(0.0..1.0).unwrap_err();
    /// assert!(error.to_string().contains("lamp"), "{error}");
    /// ```
    fn simulate(&self, times: Range<f64>) -> Result<Solution, EngineError> {
        self.simulate_with([], times)
    }

    /// The same with further loads, each a function of the state: see [`CustomLoad`].
    ///
    /// # Errors
    ///
    /// Those of [`Simulate::simulate`], and [`EngineError::CustomLoad`] with the name of the load, the time and the reason.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("drop").gravity([0.0, 0.0, -9.81]);
    /// let ball = scene.add(Body::sphere("ball", 0.5, 0.1, [0.0; 3]));
    /// let falling = ball.clone();
    /// let drag = CustomLoad::new("drag", &ball, move |state| {
    ///     Wrench::force(state.velocity(&falling).map(|v| -0.2 * v * v.abs()))
    /// });
    /// let motion = scene.simulate_with([drag], 0.0..5.0)?;
    /// let limit = f64::sqrt(0.5 * 9.81 / 0.2);
    /// assert!((motion.at(5.0)?.velocity(&ball)?[2] + limit).abs() < 1e-6);
    /// # Ok::<(), EngineError>(())
    /// ```
    fn simulate_with(
        &self,
        loads: impl IntoIterator<Item = CustomLoad>,
        times: Range<f64>,
    ) -> Result<Solution, EngineError>;
}

impl Simulate for Scene {
    fn simulate_with(
        &self,
        loads: impl IntoIterator<Item = CustomLoad>,
        times: Range<f64>,
    ) -> Result<Solution, EngineError> {
        if !(0.0 <= times.start && times.start < times.end) {
            return Err(EngineError::TimeOutside { time: times.start, from: 0.0, to: times.end });
        }
        let scene = self.clone().duration(times.end);
        let mut solution = Solution::new(Simulation::with_loads(&scene, loads)?)?;
        solution.start = times.start.min(solution.end());
        Ok(solution)
    }
}

/// A motion: the states y(t) = (q, q̇) of a run for each t from its start to its end.
///
/// Its state at t is that of [`Simulation::advance_to`], to the last bit: the states at which the steps of the run begin are
/// kept (of a long run or a large mechanism, some of them), and the step that covers t is repeated. Requests in the order of
/// time repeat no step more than once.
#[derive(Debug)]
pub struct Solution {
    start: f64,
    checkpoints: Checkpoints,
    cursor: Mutex<Cursor>,
    summary: Summary,
    events: Vec<EventOccurrence>,
}

/// The time that was requested last.
#[derive(Clone, Debug)]
struct Cursor {
    /// A run whose last step covers that time.
    covering: Checkpoint,
    /// The same run, with the state at that time as its current one.
    current: Simulation,
}

/// The reaction of a joint or driver at one moment: what body i does to body j (to body i where j is the ground).
#[derive(Clone, Debug, PartialEq)]
pub struct JointReaction {
    /// The joint or driver.
    pub joint: String,
    /// The body that the reaction acts on.
    pub on: String,
    /// The body that exerts it.
    pub by: String,
    /// Force f in the world, N — eq. (9.1).
    pub force: Triple,
    /// Moment τ about `point` in the world, N m — eq. (9.1).
    pub moment: Triple,
    /// The joint's point in the world, m.
    pub point: Triple,
    /// Whether the equations of motion determine all six numbers. Where joints are redundant they may not, and the
    /// numbers are those of the smallest multipliers — THEORY section 9.
    pub unique: bool,
}

impl Solution {
    /// Runs a simulation from its current state to its end, and keeps the motion. For a run with settings of its own, such as
    /// that of [`Simulation::set_step_limit`]; otherwise [`Simulate::simulate`] is shorter.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::advance_to`].
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
    /// run.set_step_limit(3);
    /// let error = Solution::new(run).unwrap_err();
    /// assert_eq!(error.code(), "step-limit");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn new(mut run: Simulation) -> Result<Self, EngineError> {
        run.interpolate_outputs();
        let start = run.time();
        let (duration, mut checkpoints) = (run.duration(), Checkpoints::new(&run));
        loop {
            let from = run.reached();
            let done = run.advance_towards(duration, 1)?;
            if done {
                break;
            }
            checkpoints.keep(from, &run);
        }
        let (summary, events) = (run.summary(), run.events().to_vec());
        let cursor = Cursor { covering: checkpoints.before(start).clone(), current: run };
        Ok(Self { start, checkpoints, cursor: Mutex::new(cursor), summary, events })
    }

    /// First time, s.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Last time, s: the end of the requested range, or the time of an event that stopped the run.
    pub fn end(&self) -> f64 {
        self.summary.time
    }

    /// The times from the first to the last in steps of `step`, s, the last included if a step ends there. None for a
    /// step that is not positive.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let motion = catalogue::scene("free-fall")?.simulate(0.0..1.0)?;
    /// assert_eq!(motion.every(0.25).collect::<Vec<_>>(), [0.0, 0.25, 0.5, 0.75, 1.0]);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn every(&self, step: f64) -> impl Iterator<Item = f64> + use<> {
        let (start, end) = (self.start, self.end());
        // A last time that rounding puts beyond the end is the end.
        let last = if step > 0.0 { (end - start) / step + 1e-9 } else { -1.0 };
        let whole = (0_u64..).map(|k| k as f64).take_while(move |&k| k <= last);
        whole.map(move |k| (start + k * step).min(end))
    }

    /// The state at time t, s.
    ///
    /// # Errors
    ///
    /// [`EngineError::TimeOutside`] for a time outside the motion.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let motion = catalogue::scene("simple-pendulum")?.simulate(0.0..1.0)?;
    /// let state = motion.at(0.3)?;
    /// assert_eq!(state.time(), 0.3);
    /// let error = motion.at(1.5).unwrap_err();
    /// assert_eq!(error.to_string(), "t = 1.5 s is outside the run, which goes from 0 s to 1 s");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn at(&self, t: f64) -> Result<SolutionState<'_>, EngineError> {
        let model = self.checkpoints.model();
        self.with_run_at(t, |run| SolutionState::of(model, run))
    }

    /// The reaction of a joint at time t, s: force and moment on body j (on body i where j is the ground), in the
    /// world, from the multipliers by eq. (9.1).
    ///
    /// # Errors
    ///
    /// [`EngineError::UnknownName`] for a joint that the scene does not have, [`EngineError::TimeOutside`].
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("hanging").gravity([0.0, -9.81, 0.0]);
    /// let rod = scene.add(Body::rod("rod", 2.0, [0.0; 3], [0.0, -1.0, 0.0]));
    /// let pin = scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    /// let reaction = scene.simulate(0.0..1.0)?.reaction(&pin, 0.5)?;
    /// assert!((reaction.force[1] - 2.0 * 9.81).abs() < 1e-9 && reaction.unique);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn reaction(&self, joint: impl Into<JointHandle>, t: f64) -> Result<JointReaction, EngineError> {
        self.reaction_of("joint", joint.into().name(), false, t)
    }

    /// The reaction of a driver at time t, s: what it must exert so that the motion is as prescribed. For an angle, the moment
    /// about the axis is the torque on body j.
    ///
    /// # Errors
    ///
    /// As for [`Solution::reaction`].
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("turntable");
    /// let disc = scene.add(Body::new("disc", 1.0).inertia(Inertia::Principal([0.5, 0.5, 1.0])));
    /// let shaft = scene.add(Joint::revolute("shaft", Ground, &disc).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    /// let motor = scene.add(Driver::angle("motor", &shaft, Motion::polynomial([0.0, 0.0, 2.0])));
    /// let torque = scene.simulate(0.0..1.0)?.driver_reaction(&motor, 0.5)?.moment[2];
    /// assert!((torque - 4.0).abs() < 1e-9, "I φ̈ = 1 kg m² × 4 rad/s², not {torque}");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn driver_reaction(
        &self,
        driver: impl Into<DriverHandle>,
        t: f64,
    ) -> Result<JointReaction, EngineError> {
        self.reaction_of("driver", driver.into().name(), true, t)
    }

    fn reaction_of(
        &self,
        what: &'static str,
        name: &str,
        driver: bool,
        t: f64,
    ) -> Result<JointReaction, EngineError> {
        let report = self.reactions(t, Convention::default())?;
        let known = || report.reactions.iter().filter(|found| found.driver == driver);
        let found = known().find(|found| found.joint == name).map(JointReaction::from);
        found.ok_or_else(|| EngineError::unknown(what, name, known().map(|found| found.joint.as_str())))
    }

    /// All reactions at time t, s, on the bodies, about the points and in the frames that the convention names, with
    /// what is unique about them.
    ///
    /// # Errors
    ///
    /// [`EngineError::TimeOutside`], and [`EngineError::Uniqueness`] where it cannot be decided which of them are unique.
    pub fn reactions(&self, t: f64, convention: Convention) -> Result<ReactionReport, EngineError> {
        self.with_run_at(t, |run| run.reactions(convention))?
    }

    /// The times at which an event happened, s, in ascending order.
    ///
    /// # Errors
    ///
    /// [`EngineError::UnknownName`] for an event that the scene does not have.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("drop").gravity([0.0, 0.0, -2.0]);
    /// let stone = scene.add(Body::new("stone", 1.0).position([0.0, 0.0, 4.0]));
    /// let ground = Quantity::coordinate(&stone, [0.0; 3], [0.0, 0.0, 1.0]);
    /// let landing = scene.add(Event::new("landing", ground, 0.0).stop());
    /// let motion = scene.simulate(0.0..10.0)?;
    /// assert!((motion.times_of(&landing)?[0] - 2.0).abs() < 1e-12);
    /// assert_eq!(motion.end(), motion.times_of(&landing)?[0]);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn times_of(&self, event: impl Into<EventHandle>) -> Result<Vec<f64>, EngineError> {
        let event = event.into();
        let known = || self.checkpoints.model().events.iter().map(|known| known.name.as_str());
        if known().all(|known| known != event.name()) {
            return Err(EngineError::unknown("event", event.name(), known()));
        }
        let times = self.events.iter().filter(|found| found.name == event.name()).map(|found| found.time);
        Ok(times.collect())
    }

    /// All events, in the order of time.
    pub fn events(&self) -> &[EventOccurrence] {
        &self.events
    }

    /// Energy at the end less that at the start and the work of drivers and loads between, J: zero but for errors —
    /// eq. (6.10).
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let motion = catalogue::scene("spatial-double-pendulum")?.simulate(0.0..1.0)?;
    /// assert!(motion.energy_drift().abs() < 1e-7);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn energy_drift(&self) -> f64 {
        self.summary.energy_drift
    }

    /// Cost and accuracy of the run at its end.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let motion = catalogue::scene("n-four-bar:1")?.simulate(0.0..1.0)?;
    /// assert!(motion.summary().position_violation < 1e-9 && motion.summary().finished);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn summary(&self) -> &Summary {
        &self.summary
    }

    /// Calls `evaluate` on the run at time t.
    fn with_run_at<T>(&self, t: f64, evaluate: impl FnOnce(&Simulation) -> T) -> Result<T, EngineError> {
        if !(self.start <= t && t <= self.end()) {
            return Err(EngineError::TimeOutside { time: t, from: self.start, to: self.end() });
        }
        let mut cursor = self.cursor();
        if cursor.current.time() != t {
            let checkpoint = self.checkpoints.before(t);
            if checkpoint.is_nearer(&cursor.covering, t) {
                cursor.covering = checkpoint.clone();
            }
            cursor.covering.cover(t)?;
            // From a copy: an interpolated state may depend, within rounding, on the one interpolated before it.
            cursor.current = cursor.covering.run.clone();
            cursor.current.advance_to(t)?;
        }
        Ok(evaluate(&cursor.current))
    }

    fn cursor(&self) -> MutexGuard<'_, Cursor> {
        // A panic leaves a valid run, if at another time: the next request moves it.
        self.cursor.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clone for Solution {
    fn clone(&self) -> Self {
        Self {
            start: self.start,
            checkpoints: self.checkpoints.clone(),
            cursor: Mutex::new(self.cursor().clone()),
            summary: self.summary.clone(),
            events: self.events.clone(),
        }
    }
}

impl From<&ReportedReaction> for JointReaction {
    fn from(found: &ReportedReaction) -> Self {
        Self {
            joint: found.joint.clone(),
            on: found.on.clone(),
            by: found.by.clone(),
            force: found.force.map(|component| component.value),
            moment: found.moment.map(|component| component.value),
            point: found.about_at,
            unique: found.force.iter().chain(&found.moment).all(|component| component.unique),
        }
    }
}
