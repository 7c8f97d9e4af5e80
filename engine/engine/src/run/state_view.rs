//! A state of a run, and what is computed from it.

use super::{Frame, MarkerFrame, Simulation, Snapshot};
use crate::error::EngineError;
use crate::reactions::matrices::{self, Symmetric};
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::reactions::{self, JointMultipliers};
use crate::scene::ConstraintMethod;
use nalgebra::Vector3;
use std::borrow::Cow;
use std::sync::{Mutex, OnceLock, PoisonError};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::dynamics::elimination::{Accelerations, Elimination, Multipliers};
use triad_dynamics::equations;
use triad_dynamics::equations::jacobian::Jacobian;
use triad_dynamics::model::{BodyRef, ModelMarker};
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_dynamics::state::{AngleState, BodyFrame, State};
use triad_dynamics::system::System;

/// A state of a run, with the results that have been computed from it so far.
#[derive(Debug)]
pub(super) struct CachedState {
    time: f64,
    y: Vec<f64>,
    state: LateState,
    results: Results,
}

/// A state that is taken over when it is first looked at: rows of a table are written by other threads, with states of their own.
#[derive(Debug, Default)]
struct LateState {
    known: OnceLock<State>,
    /// Angles from which whole turns are counted on, as long as the state is not known.
    turns: Vec<f64>,
    /// A state of another time, whose memory is used again.
    spare: Mutex<Option<State>>,
}

impl LateState {
    fn known(state: State) -> Self {
        Self { known: OnceLock::from(state), ..Self::default() }
    }

    /// At the next time, whole turns being counted from these angles on.
    fn go_on(&mut self, turns: impl Iterator<Item = f64>) {
        self.turns.clear();
        self.turns.extend(turns);
        if let Some(known) = self.known.take() {
            *self.spare.get_mut().unwrap_or_else(PoisonError::into_inner) = Some(known);
        }
    }
}

impl Clone for LateState {
    fn clone(&self) -> Self {
        Self { known: self.known.clone(), turns: self.turns.clone(), spare: Mutex::default() }
    }
}

/// Results that are computed at most once for each state.
#[derive(Debug, Default)]
struct Results {
    /// A solver with the accelerations and multipliers of the state.
    solved: OnceLock<Box<Elimination>>,
    /// What each joint and driver exerts: force and moment, zero where it meets no moving body.
    wrenches: OnceLock<Vec<[Vector3<f64>; 2]>>,
    /// The solver of the state before, to be used again: a table asks for one row after the other.
    spare: Mutex<Option<Box<Elimination>>>,
    /// Work of drivers and of loads without potential since the start of the last step, J.
    work: OnceLock<f64>,
    /// The state without its error, where that is known.
    better: OnceLock<Option<Box<CachedState>>>,
    /// That of the state before, likewise to be used again.
    spare_better: Mutex<Option<Box<CachedState>>>,
}

impl Results {
    /// What another state can use again.
    fn spare(self) -> Self {
        let Self { solved, spare, better, spare_better, .. } = self;
        let spare =
            solved.into_inner().or_else(|| spare.into_inner().unwrap_or_else(PoisonError::into_inner));
        let better = better
            .into_inner()
            .flatten()
            .or_else(|| spare_better.into_inner().unwrap_or_else(PoisonError::into_inner));
        Self { spare: Mutex::new(spare), spare_better: Mutex::new(better), ..Self::default() }
    }
}

/// Without the results: a copy of a run is made to go on from there, and can compute them again.
impl Clone for CachedState {
    fn clone(&self) -> Self {
        Self { time: self.time, y: self.y.clone(), state: self.state.clone(), results: Results::default() }
    }
}

impl CachedState {
    /// The state y = (q, q̇) at time t, s, which is in place in `state`.
    pub fn new(time: f64, y: &[f64], state: &State) -> Self {
        Self { time, y: y.to_vec(), state: LateState::known(state.clone()), results: Results::default() }
    }

    /// Changes to the state y = (q, q̇) at another time, s, which `write` fills in; whole turns of angles are counted as the
    /// run has counted them.
    pub fn replace(
        &mut self,
        mechanism: &mut Mechanism,
        time: f64,
        write: impl FnOnce(&mut Mechanism, &mut [f64]),
    ) {
        self.results = std::mem::take(&mut self.results).spare();
        self.time = time;
        write(mechanism, &mut self.y);
        self.state.go_on(mechanism.state.expected_angles(time));
    }

    /// Changes to a snapshot of the same run, with its error where that is known; no work is added to what the run has counted.
    pub fn take_over(&mut self, system: &System, snapshot: &Snapshot, error: Option<&[f64]>) {
        self.results = std::mem::take(&mut self.results).spare();
        self.time = snapshot.time;
        self.y.copy_from_slice(&snapshot.state);
        self.state.go_on(snapshot.angles.iter().copied());
        self.work(|| 0.0);
        self.better(system, |out| {
            if let Some(error) = error {
                out.copy_from_slice(error);
            }
            error.is_some()
        });
    }

    /// The state y = (q, q̇) at another time, s, whose angles, rad, are known to less than half a turn.
    pub fn at(&self, system: &System, time: f64, y: &[f64], angles: &[f64]) -> Self {
        let mut state = self.state(system).clone();
        state.set_revolutions(angles.iter().copied());
        let (q, q_dot) = y.split_at(system.coordinates);
        state.set(system, time, q, q_dot);
        Self { time, y: y.to_vec(), state: LateState::known(state), results: Results::default() }
    }

    /// This state less its error, which `error` writes on the first request; `None` if it does not know it. A rounding of each number
    /// is taken for a part of that, so that what is computed of both differs by what rounding makes of it.
    pub fn better(&self, system: &System, error: impl FnOnce(&mut [f64]) -> bool) -> Option<&Self> {
        let find = || {
            let spare = self.results.spare_better.lock().unwrap_or_else(PoisonError::into_inner).take();
            let mut better = spare.unwrap_or_else(|| Box::new(self.clone()));
            better.results = std::mem::take(&mut better.results).spare();
            better.time = self.time;
            if !error(&mut better.y) {
                return None;
            }
            for ((k, x), y) in better.y.iter_mut().enumerate().zip(&self.y) {
                *x = y - *x + sign(k) * f64::EPSILON * y;
            }
            better.state.go_on(self.angles(system).iter().map(|angle| angle.value));
            Some(better)
        };
        self.results.better.get_or_init(find).as_deref()
    }

    /// Multipliers of a state nearby, which is this one without its error.
    pub fn multipliers_of<'a>(&'a self, better: &'a Self, run: &'a Simulation) -> Multipliers<'a> {
        let solver = better.solver(run, Some(self.solver(run, None)));
        solver.last_accelerations(run.system(), better.state(run.system())).multipliers
    }

    /// Force and moment of each joint and driver: see [`Multipliers::joint_wrench`].
    pub fn wrenches(&self, run: &Simulation) -> &[[Vector3<f64>; 2]] {
        let find = || {
            let system = run.system();
            let at = self.solver(run, None).last_accelerations(system, self.state(system)).multipliers;
            let exerted =
                |constraint| at.joint_wrench(constraint).map(|wrench| [wrench.force, wrench.moment]);
            system.constraints.iter().map(|constraint| exerted(constraint).unwrap_or_default()).collect()
        };
        self.results.wrenches.get_or_init(find)
    }

    /// A solver with the accelerations and multipliers of this state, and what is known of one nearby.
    fn solver(&self, run: &Simulation, near: Option<&Elimination>) -> &Elimination {
        self.results.solved.get_or_init(|| {
            let spare = self.results.spare.lock().unwrap_or_else(PoisonError::into_inner).take();
            let mut solver =
                spare.unwrap_or_else(|| Box::new(run.examiner.solver(&run.mechanism, &run.start)));
            solver.examine(run.system(), self.state(run.system()), run.mechanism.baumgarte(), near);
            solver
        })
    }

    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// y = (q, q̇).
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// The state.
    pub fn state(&self, system: &System) -> &State {
        self.state.known.get_or_init(|| {
            let spare = self.state.spare.lock().unwrap_or_else(PoisonError::into_inner).take();
            let mut state = spare.unwrap_or_else(|| State::new(system));
            state.set_revolutions(self.state.turns.iter().copied());
            let (q, q_dot) = self.y.split_at(system.coordinates);
            state.set(system, self.time, q, q_dot);
            state
        })
    }

    /// The angles of joints; where there are none the state is not asked for them.
    pub fn angles(&self, system: &System) -> &[AngleState] {
        if system.angles.is_empty() { &[] } else { self.state(system).angles() }
    }

    /// Work since the start of the last step, J, computed by `find` on the first request.
    pub fn work(&self, find: impl FnOnce() -> f64) -> f64 {
        *self.results.work.get_or_init(find)
    }
}

/// A state of a run, and what can be computed from it; [`Simulation::state`] and [`Simulation::at_snapshot`] return it.
///
/// Accelerations and multipliers are solved for once, when the first method needs them. No method changes the run, its
/// counters or the bits that it goes on with.
///
/// ```
/// use triad_engine::prelude::*;
///
/// let mut run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
/// run.advance_to(0.3)?;
/// let state = run.state();
/// assert_eq!(state.q().len(), state.accelerations().len());
/// assert_eq!(state.multipliers()[0].force, state.multipliers()[0].force);
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct StateView<'a> {
    run: &'a Simulation,
    cached: Cow<'a, CachedState>,
}

impl<'a> StateView<'a> {
    pub(super) fn new(run: &'a Simulation, cached: Cow<'a, CachedState>) -> Self {
        Self { run, cached }
    }

    /// The assembled system.
    #[doc(hidden)]
    pub fn system(&self) -> &'a System {
        self.run.system()
    }

    /// What is known at this state without solving.
    pub(crate) fn known(&self) -> &State {
        self.cached.state(self.system())
    }

    /// Φ of all rows.
    #[doc(hidden)]
    pub fn constraints(&self) -> Vec<f64> {
        equations::constraints(self.system(), self.known())
    }

    /// Rank of the joint rows near the start — THEORY section 8.
    pub fn rank(&self) -> &'a Rank {
        self.run.rank()
    }

    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.cached.time
    }

    /// Generalized coordinates q, in the order of the columns of [`StateView::jacobian`]: m for positions, 1 for directors.
    pub fn q(&self) -> &[f64] {
        &self.cached.y[..self.system().coordinates]
    }

    /// Generalized velocities q̇: m/s and 1/s.
    pub fn q_dot(&self) -> &[f64] {
        &self.cached.y[self.system().coordinates..]
    }

    /// All bodies in the world: position, directors, velocity, angular velocity; and all markers.
    pub fn frame(&self) -> Frame {
        let bodies = self.known().bodies().iter().map(BodyFrame::from).collect();
        Frame { time: self.cached.time, bodies, markers: self.markers() }
    }

    /// Positions and velocities of the scene's markers, in its order.
    pub fn markers(&self) -> Vec<MarkerFrame> {
        let markers = &self.system().model.markers;
        markers.iter().map(|marker| MarkerFrame::new(marker, self.known())).collect()
    }

    /// Accelerations of the scene's markers in the world, m/s², in its order.
    pub fn marker_accelerations(&self) -> Vec<[f64; 3]> {
        let markers = &self.system().model.markers;
        if markers.is_empty() {
            return Vec::new();
        }
        let solved = self.solved();
        let of = |marker: &ModelMarker| match marker.body {
            BodyRef::Ground => [0.0; 3],
            BodyRef::Moving(body) => {
                let q_ddot = solved.of_body(body);
                (q_ddot.r + q_ddot.arm(&marker.local)).into()
            }
        };
        markers.iter().map(of).collect()
    }

    /// The constraint Jacobian Φ_q, rigid-body rows first — eq. (4.1).
    pub fn jacobian(&self) -> Jacobian {
        Jacobian::new(self.system(), self.known())
    }

    /// Accelerations q̈ — eq. (7.2): m/s² for positions, 1/s² for directors.
    pub fn accelerations(&self) -> Vec<f64> {
        let mut q_ddot = vec![0.0; self.system().coordinates];
        self.solved().write(&mut q_ddot);
        q_ddot
    }

    /// Accelerations r̈ of the centres of mass in the world, m/s², in the scene's order of bodies.
    pub fn mass_accelerations(&self) -> Vec<[f64; 3]> {
        let q_ddot = self.accelerations();
        self.system().bodies.iter().map(|body| body.layout.position(&q_ddot).r.into()).collect()
    }

    /// Multipliers λ and reactions of each joint and driver — eqs. (6.6) and (9.1).
    pub fn multipliers(&self) -> Vec<JointMultipliers> {
        reactions::multipliers(&self.solved().multipliers)
    }

    /// Reactions of joints and drivers as the convention names bodies, points and frames, with what is unique about
    /// them — THEORY section 9.
    ///
    /// # Errors
    ///
    /// [`EngineError::Uniqueness`] where it cannot be decided which of them are unique.
    pub fn reactions(&self, convention: Convention) -> Result<ReactionReport, EngineError> {
        let Some(held) = self.held() else { return Ok(report(&self.solved().multipliers, convention)?) };
        let solver = held.solver(self.run, None);
        Ok(report(
            &solver.last_accelerations(self.system(), held.state(self.system())).multipliers,
            convention,
        )?)
    }

    /// The state moved onto the constraints, where rows depend on others: as far off as a tolerance allows, some do not, and what they
    /// leave open would seem to be determined. `None` also where there is no such state nearby, and where a method leaves joints open.
    fn held(&self) -> Option<CachedState> {
        let run = self.run;
        let closes = [ConstraintMethod::Projection, ConstraintMethod::Partitioning];
        if run.rank().dependent.is_empty() || !closes.contains(&run.model().settings.constraint_method) {
            return None;
        }
        let (mut mechanism, mut y) = (run.mechanism.clone(), self.cached.y.clone());
        mechanism.state = self.known().clone();
        let (length, mut on) = (mechanism.system.length, mechanism.projectable(&mut y));
        let closed = project_positions(&mut on, &rules::ASSEMBLY_POSITIONS, length).has_converged();
        mechanism.set_state(self.cached.time, &y);
        project_velocities(&mut mechanism.projectable(&mut y), &rules::ASSEMBLY_VELOCITIES, length);
        closed.then(|| CachedState::new(self.cached.time, &y, &mechanism.state))
    }

    /// The augmented matrix of the equations of motion — eq. (6.6).
    pub fn augmented(&self) -> Symmetric {
        matrices::augmented(self.system(), self.known())
    }

    /// S, which the solver factors — eq. (7.6).
    pub fn schur(&self) -> Symmetric {
        matrices::schur(self.system(), self.known(), &mut self.run.mechanism.elimination.clone())
    }

    /// Accelerations and multipliers of the state.
    pub(super) fn solved(&self) -> Accelerations<'_> {
        self.cached.solver(self.run, None).last_accelerations(self.system(), self.known())
    }
}

/// A sign of each number, in an order that repeats itself nowhere.
pub(super) fn sign(k: usize) -> f64 {
    if k.count_ones().is_multiple_of(2) { 1.0 } else { -1.0 }
}
