//! A system with its changing state: what integrators move, and where consistency is made and kept.

use crate::constraints::ConstraintError;
use crate::constraints::changed;
use crate::constraints::given;
use crate::constraints::violation;
use crate::dynamics::elimination::{Accelerations, Elimination, ProjectableState};
use crate::model::{BodyRef, DriverKind, Model};
use crate::newton::rules::{self, CONSISTENT};
use crate::newton::{AsWanted, project_positions, project_velocities};
use crate::ode::OdeSystem;
use crate::scene::ConstraintMethod;
use crate::state::{self, State};
use crate::system::System;
use crate::system::index::ConstraintId;
use nalgebra::Vector3;
use triad_linalg::largest_size;

/// A projection that moves the state by more than this part of the tolerance calls for a new evaluation.
const NEGLIGIBLE: f64 = 0.1;
/// |Φ̇| of a row, relative to its size, that the correction of the velocities of a start may leave, as a part of the largest one
/// before it.
const MAX_RATE_LEFT: f64 = 1e-6;
/// The same as a part of the angular velocity of the fastest body, where rounding does not let it become smaller.
const RATE_ROUNDING: f64 = 1e-9;
/// |Φ̇| of a row, relative to its size, below which the velocities at the end of a step satisfy the constraints, 1/s for each
/// unit of the tolerance.
const RATE_TOLERANCE: f64 = 1e3;
/// A start that must be moved by more than this part of the mechanism's length is not corrected but refused.
pub(super) const MAX_MOVE: f64 = 0.5;

/// A system, a state, and the solver of its equations.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// What never changes.
    pub system: System,
    /// The state that was set last.
    pub state: State,
    /// The solver.
    pub elimination: Elimination,
    /// Projections of steps so far.
    pub projections: u64,
}

impl Mechanism {
    /// Allocates for a system.
    pub fn new(system: System) -> Self {
        Self { state: State::new(&system), elimination: Elimination::new(&system), system, projections: 0 }
    }

    /// A checked model as a mechanism, and its start y = (q, q̇) as the author gives it.
    pub fn from_model(model: Model) -> (Self, Vec<f64>) {
        let mechanism = Self::new(System::new(model));
        let n = mechanism.system.coordinates;
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        mechanism.system.start(q, q_dot);
        (mechanism, y)
    }

    /// Sets t and y = (q, q̇) without evaluating anything else.
    pub fn set_state(&mut self, t: f64, y: &[f64]) {
        let (q, q_dot) = y.split_at(self.system.coordinates);
        self.state.set(&self.system, t, q, q_dot);
    }

    /// The state in place with its numbers y = (q, q̇), to be moved onto the constraints.
    pub fn projectable<'a>(&'a mut self, y: &'a mut [f64]) -> ProjectableState<'a> {
        let Self { system, state, elimination, .. } = self;
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        ProjectableState { system, state, elimination, q, q_dot }
    }

    /// Accelerations and multipliers at t and y = (q, q̇), with the terms of Baumgarte's stabilization where it is used.
    pub fn accelerations(&mut self, t: f64, y: &[f64]) -> Accelerations<'_> {
        self.set_state(t, y);
        let baumgarte = self.baumgarte();
        self.elimination.accelerate(&self.system, &self.state, baumgarte)
    }

    /// Refuses the state at the end of a step that is off the constraints: it must not be taken for a result.
    ///
    /// # Errors
    ///
    /// [`ConstraintError`]: constraints that are lost, or rates of a driver that no velocities satisfy.
    pub fn check(&mut self, t: f64, y: &[f64]) -> Result<(), ConstraintError> {
        self.set_state(t, y);
        violation::check(&self.system, &self.state, t)?;
        let settings = &self.system.model.settings;
        if self.system.model.drivers.is_empty() || settings.constraint_method != ConstraintMethod::Projection
        {
            return Ok(());
        }
        // What remains after a projection cannot be removed by any choice of velocities.
        let most = RATE_TOLERANCE * settings.tolerance + MAX_RATE_LEFT * state::fastest(&self.system, y);
        if violation::largest_rate(&self.system, &self.state) <= most {
            return Ok(());
        }
        self.check_motion(t, most)
    }

    /// Whether something may turn a body about an axis about which it has no inertia.
    pub fn may_lose_balance(&self) -> bool {
        let System { model, loads, .. } = &self.system;
        !model.custom_loads.is_empty() || loads.iter().any(|load| load.turns_without_inertia(&self.system))
    }

    /// Accelerations at a state that something beside the run asks for: counters stay.
    pub fn accelerations_aside(&mut self, t: f64, y: &[f64]) {
        let counters = self.elimination.counters;
        self.accelerations(t, y);
        self.elimination.counters = counters;
    }

    /// Refuses accelerations, the last that were computed, where something turns a body about an axis about which it has no inertia and
    /// nothing holds it: what is computed there is none.
    ///
    /// # Errors
    ///
    /// [`ConstraintError::NothingHolds`].
    pub fn check_balance(&self, t: f64) -> Result<(), ConstraintError> {
        let Some((body, left)) = self.elimination.out_of_balance(&self.system) else { return Ok(()) };
        let moment = left.norm();
        Err(ConstraintError::NothingHolds {
            time: t,
            body: self.system.model.bodies[body].name.clone(),
            pointer: format!("/bodies/{body}"),
            moment,
            axis: (left / moment).into(),
        })
    }

    /// Moves a start onto the constraints. Returns what was corrected, in words.
    ///
    /// # Errors
    ///
    /// Those of [`Mechanism::assemble_at`].
    pub fn assemble(&mut self, y: &mut [f64]) -> Result<Vec<String>, ConstraintError> {
        self.assemble_while(y, &|| true)
    }

    /// As [`Mechanism::assemble`], as long as that is wanted; what is said of it afterwards means nothing.
    ///
    /// # Errors
    ///
    /// Those of [`Mechanism::assemble_at`].
    pub fn assemble_while(
        &mut self,
        y: &mut [f64],
        wanted: &dyn Fn() -> bool,
    ) -> Result<Vec<String>, ConstraintError> {
        self.state.set_revolutions(self.system.start_angles());
        let mut notes = self.assemble_at_while(0.0, y, wanted)?;
        notes.extend(given::lost(&self.system, y));
        Ok(notes)
    }

    /// Moves a state at time t onto the constraints, whole turns of angles counted from those that are kept.
    ///
    /// # Errors
    ///
    /// [`ConstraintError`]: joints that cannot be closed, a start that is too far from a closed one, or a motion that the joints do not
    /// allow; each names the joint or driver.
    pub fn assemble_at(&mut self, t: f64, y: &mut [f64]) -> Result<Vec<String>, ConstraintError> {
        self.assemble_at_while(t, y, &|| true)
    }

    fn assemble_at_while(
        &mut self,
        t: f64,
        y: &mut [f64],
        wanted: &dyn Fn() -> bool,
    ) -> Result<Vec<String>, ConstraintError> {
        let given = y.to_vec();
        self.set_state(t, y);
        let was_redundant = self.elimination.is_redundant();
        self.elimination.set_redundant(true);
        let positions = self.assemble_positions(t, &given, y, wanted)?;
        let velocities = self.assemble_velocities(t, &given, y, wanted)?;
        self.elimination.set_redundant(was_redundant);
        Ok(positions.into_iter().chain(velocities).collect())
    }

    /// Moves the positions of the state in place onto the constraints, and says so if it had to.
    fn assemble_positions(
        &mut self,
        t: f64,
        given: &[f64],
        y: &mut [f64],
        wanted: &dyn Fn() -> bool,
    ) -> Result<Option<String>, ConstraintError> {
        let (n, length) = (self.system.coordinates, self.system.length);
        let violated = self.state.position_violation(&self.system);
        if violated > CONSISTENT * length + rounding(&given[..n]) {
            let mut on = AsWanted { on: self.projectable(y), wanted };
            project_positions(&mut on, &rules::ASSEMBLY_POSITIONS, length);
        }
        let moved = self.system.longest_way(&given[..n], &y[..n]);
        let solved = y.iter().all(|x| x.is_finite()) && violation::is_closed(&self.system, &self.state);
        if !solved {
            return Err(self.assembly_error(t, given, y, moved));
        }
        let limit = MAX_MOVE * length;
        if moved > limit {
            self.set_state(t, given);
            let violated = violation::measure(&self.system, &self.state);
            let (joint, pointer) = (violated.names(&self.system).0, violated.pointer(&self.system));
            return Err(ConstraintError::StartTooFar { joint, pointer, moved, limit });
        }
        if let Some(driver) = half_turned(&self.system, &self.state, t) {
            let (joint, pointer) =
                (self.system[driver].name.clone(), violation::pointer(&self.system, driver));
            let moved = std::f64::consts::PI * length;
            return Err(ConstraintError::StartTooFar { joint, pointer, moved, limit });
        }
        Ok(changed::position_note(&self.system, violated, moved))
    }

    /// Moves the velocities onto the constraints, with the positions in place, and says so if it had to, and if little is left of
    /// one that was given.
    fn assemble_velocities(
        &mut self,
        t: f64,
        given: &[f64],
        y: &mut [f64],
        wanted: &dyn Fn() -> bool,
    ) -> Result<Option<String>, ConstraintError> {
        let (n, length) = (self.system.coordinates, self.system.length);
        self.state.set_velocities(&self.system, &y[n..]);
        let rate = self.state.velocity_violation(&self.system);
        if rate > CONSISTENT * length + rounding(&given[n..]) {
            let rate = violation::rates(&self.system, &self.state).into_iter().fold(0.0, f64::max);
            let mut on = AsWanted { on: self.projectable(y), wanted };
            project_velocities(&mut on, &rules::ASSEMBLY_VELOCITIES, length);
            self.check_motion(t, MAX_RATE_LEFT * rate + RATE_ROUNDING * state::fastest(&self.system, y))?;
        }
        Ok(changed::velocity_note(&self.system, rate, given, y).map(|moved| {
            let lost = changed::velocity_lost(&self.system, given, y);
            lost.map_or(moved.clone(), |lost| format!("{moved}; {lost}"))
        }))
    }

    /// Refuses a step in which an angle gets where its cosine prescribes it no longer.
    ///
    /// # Errors
    ///
    /// [`ConstraintError::AngleLost`].
    pub fn check_angles(&self, step: [f64; 2]) -> Result<(), ConstraintError> {
        let drivers = self.system.model.drivers.iter().enumerate();
        let mut lost = drivers.filter_map(|(k, driver)| Some((k, driver, driver.lost_angle(step)?)));
        lost.next().map_or(Ok(()), |(k, driver, (time, angle))| {
            let (driver, pointer) = (driver.name.clone(), format!("/drivers/{k}"));
            Err(ConstraintError::AngleLost { time, driver, pointer, angle })
        })
    }

    /// Refuses rates of drivers that no velocities satisfy: those in place come nearest, and miss one by more than `most`.
    /// Without drivers there are always velocities: zero.
    fn check_motion(&self, time: f64, most: f64) -> Result<(), ConstraintError> {
        let Self { system, state, .. } = self;
        let rates = violation::rates(system, state);
        let drivers = system.constraint_ids().filter(|&id| system[id].driver);
        let driver = drivers.max_by(|&a, &b| rates[a.index()].total_cmp(&rates[b.index()]));
        let unsolved = rates.iter().any(|rate| *rate > most);
        let Some(driver) = driver.filter(|_| unsolved) else { return Ok(()) };
        let others = violation::worst(&rates).into_iter().filter(|&(id, _)| id != driver);
        let name = |id: ConstraintId| system[id].name.clone();
        Err(ConstraintError::MotionImpossible {
            time,
            driver: name(driver),
            with: others.take(violation::MAX_NAMED).map(|(id, _)| name(id)).collect(),
            pointer: violation::pointer(system, driver),
            missed: rates[driver.index()],
        })
    }

    fn assembly_error(&mut self, t: f64, given: &[f64], reached: &[f64], moved: f64) -> ConstraintError {
        // The best compromise leaves open the joints that contradict each other, and closes all others. Where there
        // is none (bodies were stretched instead), the joint that is open at the given start says most.
        let mut violated = violation::measure(&self.system, &self.state);
        let worst = violated.constraints.first().map_or(0.0, |&(_, open)| open);
        if !reached.iter().all(|x| x.is_finite()) || worst < 0.1 * violated.relative {
            self.set_state(t, given);
            violated = violation::measure(&self.system, &self.state);
        }
        let (joint, with) = violated.names(&self.system);
        let pointer = violated.pointer(&self.system);
        let violation = violated.constraints.first().map_or(violated.relative, |&(_, violation)| violation);
        ConstraintError::Assembly { joint, with, pointer, violation, moved }
    }

    /// α and β of Baumgarte's stabilization, or zero.
    pub fn baumgarte(&self) -> (f64, f64) {
        match self.system.model.settings.constraint_method {
            ConstraintMethod::Baumgarte { alpha, beta } => (alpha, beta),
            _ => (0.0, 0.0),
        }
    }
}

/// A driver that asks for an angle half a turn from that of its joint: there as well b is perpendicular to a₂ turned by θ*, and the row
/// of eq. (5.3) holds.
fn half_turned(system: &System, state: &State, t: f64) -> Option<ConstraintId> {
    let model = &system.model;
    let in_world = |body: BodyRef, local: &Vector3<f64>| match body {
        BodyRef::Ground => *local,
        BodyRef::Moving(body) => state.bodies()[body].q.e.iter().zip(local.iter()).map(|(e, x)| e * *x).sum(),
    };
    let mut drivers = system.constraint_ids().filter(|&id| system[id].driver);
    model.drivers.iter().find_map(|driver| {
        let id = drivers.next()?;
        let DriverKind::Angle { joint, motion } = &driver.kind else { return None };
        let joint = &model.joints[*joint];
        let b = in_world(joint.bodies[1], &joint.cross[1][0]);
        let [x, y] = joint.cross[0].map(|a| in_world(joint.bodies[0], &a).dot(&b));
        let asked = motion.at(t)[0];
        (x * libm::cos(asked) + y * libm::sin(asked) < 0.0).then_some(id)
    })
}

/// What rounding makes of differences of these numbers: differences of large numbers are no more exact than the numbers.
fn rounding(x: &[f64]) -> f64 {
    2.0 * f64::EPSILON * largest_size(x)
}

impl OdeSystem for Mechanism {
    /// ẏ = (q̇, q̈).
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        let n = self.system.coordinates;
        rate[..n].copy_from_slice(&y[n..]);
        self.accelerations(t, y).write(&mut rate[n..]);
    }

    fn knows_turns(&self) -> bool {
        self.state.knows_turns(&self.system)
    }

    /// Counts revolutions from here, and moves y onto the constraints where projection keeps them.
    fn after_step(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]) {
        self.state.commit_motion();
        let method = self.system.model.settings.constraint_method;
        if !matches!(method, ConstraintMethod::Projection | ConstraintMethod::Partitioning) {
            return;
        }
        self.projections += 1;
        let n = self.system.coordinates;
        let length = self.system.length;
        let moved = project_positions(&mut self.projectable(y), &rules::STEP_POSITIONS, length).moved;
        self.state.set_velocities(&self.system, &y[n..]);
        let moved =
            moved + project_velocities(&mut self.projectable(y), &rules::STEP_VELOCITIES, length).moved;
        let tolerance = self.system.model.settings.tolerance;
        if moved > NEGLIGIBLE * tolerance {
            self.rhs(t, y, rate);
        } else {
            rate[..n].copy_from_slice(&y[n..]);
        }
    }
}
