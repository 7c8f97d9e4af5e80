//! What the numbers of a run are worth: estimates of their errors — THEORY section 11.

use super::Simulation;
use super::companion::{self, Lost};
use super::state_view::{CachedState, sign};
use crate::error::EngineError;
use crate::reactions::report::{Convention, ReactionComponent, ReactionReport, report};
use crate::scene::{IntegratorKind, OutputKind};
use nalgebra::Vector3;
use serde::Serialize;
use triad_dynamics::model::{BodyRef, ModelBody};
use triad_dynamics::state::{BodyFrame, State, fastest};
use triad_dynamics::system::body::RigidBody;

/// How far from a singular start, in lengths of the mechanism, reactions are those of the motion.
const BESIDE_START: f64 = 1e-3;
/// Part of what the errors of all bodies would make of the energy, did each change it the same way, below which they are not taken to cancel.
const CANCELLED: f64 = 0.05;
/// How far from it, in lengths of the mechanism, velocities have not yet found to that motion: what they have changed by is not known.
const LEAVING_START: f64 = 3e-4;
/// Part of the error of all positions, over the length of the mechanism, below which that of directors is not told, since what moves one
/// body turns another; likewise of velocities.
const TURNED: f64 = 0.1;
/// Part of the error of positions at the start of a step below which none within is told: what a series carries along may pass through
/// zero where the error itself does not.
const PASSING: f64 = 0.1;
/// Part of the relative error of the state below which that of forces or moments is looked at more closely: contributions may cancel.
const SUSPICIOUS: f64 = 0.05;
/// Part of itself by which the error of each number is then changed.
const CHANGED: f64 = 0.2;
/// All these parts are smaller where a tighter solution tells the error: so many times its tolerance over that of the run.
const UNKNOWN: f64 = 100.0;

/// Roundings of what forces do over the length of the mechanism below which moments are nothing but that, and forces likewise; and of that
/// length below which an error of positions may be nothing else.
const NOTHING: f64 = 100.0 * f64::EPSILON;

/// Estimated errors of the numbers of one state, each the largest over all bodies: what the run has collected since its start,
/// not what one step adds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// Of centres of mass and markers, m; also of where the frames of bodies begin, if those are chosen as outputs.
    pub position: f64,
    /// Of directors: an angle for small ones, rad.
    pub turn: f64,
    /// Of their velocities, m/s.
    pub velocity: f64,
    /// Of angular velocities, rad/s.
    pub angular_velocity: f64,
    /// Of the kinetic plus potential energy, J.
    pub energy: f64,
}

/// Estimated errors of the reactions of one state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ReactionErrors {
    /// Largest error of a force of a joint or driver, N.
    pub force: f64,
    /// Largest of these forces, N; zero if it is but rounding of moments.
    pub largest_force: f64,
    /// Largest error of a moment, N m.
    pub moment: f64,
    /// Largest of these moments, N m; zero if it is but rounding of forces.
    pub largest_moment: f64,
}

impl ReactionErrors {
    /// The larger of both errors, as a part of the largest force and moment; zero where there are none.
    pub fn relative(&self) -> f64 {
        let part = |error: f64, largest: f64| if largest > 0.0 { error / largest } else { 0.0 };
        part(self.force, self.largest_force).max(part(self.moment, self.largest_moment))
    }
}

impl Simulation {
    /// Estimated errors of the current state. `None` where the scene's `error_estimate` is switched off, and from
    /// [`Simulation::error_unknown_from`] on.
    ///
    /// A series carries its error along; beside other methods goes a second solution: [`Simulation::error_method`]. The error is
    /// that of the method and of its rounding; that of the model is not in it. Of penalties it is what they are off from rigid
    /// joints.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut run = Simulation::new(&catalogue::scene("simple-pendulum")?)?;
    /// run.advance_to(10.0)?;
    /// let error = run.error_estimate().expect("it is on by default");
    /// assert!((1e-11..1e-8).contains(&error.position));
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn error_estimate(&self) -> Option<ErrorEstimate> {
        let mut error = self.compare(self.better()?);
        error.position = error.position.max(PASSING * self.off_at_start());
        if self.is_near_singular_start(LEAVING_START) {
            self.doubt_what_changed(&mut error);
        }
        Some(error)
    }

    /// Raises errors of velocities to what these have changed by since the start, and of positions to as large a part of the way.
    fn doubt_what_changed(&self, error: &mut ErrorEstimate) {
        let (system, length) = (self.system(), self.system().length);
        let (q, q_dot) = self.start.split_at(system.coordinates);
        let mut changed = 0.0f64;
        for (body, now) in system.bodies.iter().zip(self.frame().bodies) {
            let at = body.layout.position(q);
            let before = BodyFrame::new(&at, &body.layout.velocity(&at, q_dot));
            let faster = apart(now.velocity, before.velocity).sqrt();
            let spun = apart(now.angular_velocity, before.angular_velocity).sqrt();
            error.velocity = error.velocity.max(faster);
            error.angular_velocity = error.angular_velocity.max(spun);
            changed = changed.max(faster).max(length * spun);
        }
        if changed > 0.0 {
            let off =
                self.way_from_start() * (changed / (length * fastest(system, self.current.y()))).min(1.0);
            error.position = error.position.max(off);
            error.turn = error.turn.max(off / length);
        }
    }

    /// Estimated errors of the reactions at the current state; `None` as for [`Simulation::error_estimate`]. They are computed
    /// a second time, without the error of the state: with what was found for the state, if that is near enough. Where the two
    /// agree much better than the states do, twice more, without errors that are a little different: parts of it may cancel.
    pub fn reaction_errors(&self) -> Option<ReactionErrors> {
        if self.is_beside_singular_start() {
            return None;
        }
        let better = self.better()?;
        let [mut force, largest_force, mut moment, largest_moment] = self.compare_reactions(better);
        let part = self.unknown(SUSPICIOUS) * self.relative_error(better);
        if force < part * largest_force || moment < part * largest_moment {
            let mut at = better;
            for first in [true, false] {
                let Some(changed) = at.better(self.system(), |out| self.change(better, first, out)) else {
                    break;
                };
                let [other_force, _, other_moment, _] = self.compare_reactions(changed);
                (force, moment) = (force.max(other_force), moment.max(other_moment));
                at = changed;
            }
        }
        // Nor is a reaction better than its rounding.
        let length = self.system().length;
        let of_moments = largest_moment.max(length * largest_force);
        let [force, moment] =
            [(force, largest_force), (moment, of_moments)].map(|(error, of)| error.max(f64::EPSILON * of));
        let unless_rounding = |largest: f64, of: f64| if largest > NOTHING * of { largest } else { 0.0 };
        Some(ReactionErrors {
            force,
            largest_force: unless_rounding(largest_force, largest_moment / length),
            moment,
            largest_moment: unless_rounding(largest_moment, length * largest_force),
        })
    }

    /// Whether rows lose their hold at the start, which bodies have hardly left: accelerations and reactions are not those of the branch of
    /// the motion, which higher derivatives of the rows alone determine at the start, and rounding beside it.
    pub fn is_beside_singular_start(&self) -> bool {
        self.is_near_singular_start(BESIDE_START)
    }

    /// Whether rows lose their hold at the start, and bodies have moved by no more than so many lengths of the mechanism since.
    fn is_near_singular_start(&self, lengths: f64) -> bool {
        if self.rank().lost_at_start() == 0 {
            return false;
        }
        self.way_from_start() < lengths * self.system().length
    }

    /// The longest way of a body since the start, m.
    fn way_from_start(&self) -> f64 {
        let positions = self.system().coordinates;
        self.system().longest_way(&self.start[..positions], &self.current.y()[..positions])
    }

    /// The same of reactions as [`Simulation::reactions`] has told them in a convention: about other points, and along axes that turn, their
    /// numbers have other errors than in the world.
    ///
    /// # Errors
    ///
    /// [`EngineError::Uniqueness`] where it cannot be decided which of them are unique.
    pub fn reaction_errors_as_told(
        &self,
        told: &ReactionReport,
        convention: Convention,
    ) -> Result<Option<ReactionErrors>, EngineError> {
        let (Some(mut errors), Some(better)) = (self.reaction_errors(), self.better()) else {
            return Ok(None);
        };
        let there = report(&self.current.multipliers_of(better, self), convention)?;
        let off = |a: [ReactionComponent; 3], b: [ReactionComponent; 3]| {
            Vector3::from_fn(|k, _| a[k].value - b[k].value).norm()
        };
        for (here, there) in told.reactions.iter().zip(&there.reactions) {
            errors.force = errors.force.max(off(here.force, there.force));
            errors.moment = errors.moment.max(off(here.moment, there.moment));
        }
        Ok(Some(errors))
    }

    /// Writes what the error of the current state is changed by, first, and from there to another change of it.
    fn change(&self, better: &CachedState, first: bool, out: &mut [f64]) -> bool {
        let errors = self.current.y().iter().zip(better.y()).map(|(here, there)| here - there);
        let part = self.unknown(CHANGED);
        for (k, (out, error)) in out.iter_mut().zip(errors).enumerate() {
            let by = if first { sign(k) } else { -sign(k) - sign(k + 1) };
            *out = part * by * error;
        }
        true
    }

    /// Largest differences of forces and of moments between the current state and one nearby, each with the largest of them.
    fn compare_reactions(&self, other: &CachedState) -> [f64; 4] {
        let there = self.current.multipliers_of(other, self);
        // The largest squares of their lengths, and one root of each in the end.
        let mut squares = [0.0f64; 4];
        for (constraint, [force, moment]) in self.system().constraints.iter().zip(self.current.wrenches(self))
        {
            let Some(other) = there.joint_wrench(constraint) else { continue };
            let vectors = [force - other.force, *force, moment - other.moment, *moment];
            for (square, vector) in squares.iter_mut().zip(vectors) {
                *square = square.max(vector.norm_squared());
            }
        }
        squares.map(f64::sqrt)
    }

    /// The error of positions as a part of the mechanism, and of velocities as a part of the largest, at most one.
    fn relative_error(&self, better: &CachedState) -> f64 {
        let length = self.system().length;
        let error = self.compare(better);
        let fastest = length * fastest(self.system(), self.current.y());
        let moved = error.position.max(length * error.turn) / length;
        let faster = error.velocity.max(length * error.angular_velocity);
        // At rest nothing is faster.
        let part = if faster > 0.0 { faster / fastest } else { 0.0 };
        (moved + part).min(1.0)
    }

    /// From when on the error is not known, s: it has grown so far that it is no longer small against the mechanism, or the second
    /// solution that it is read off cannot go on.
    pub fn error_unknown_from(&self) -> Option<f64> {
        match &self.companion {
            Some(companion) => companion.lost().map(Lost::from),
            None => self.integrator.error_lost(),
        }
    }

    /// Integrator and tolerance of the second solution that the estimate is read off; `None` where the method carries its error
    /// along.
    pub fn error_method(&self) -> Option<(IntegratorKind, f64)> {
        self.companion.as_ref().map(|companion| companion.method())
    }

    /// Why the error is not known from then on, in words that follow "from t = … on nothing is known of the error:".
    pub(super) fn why_unknown(&self) -> &'static str {
        match self.companion.as_ref().and_then(|companion| companion.lost()) {
            Some(Lost::Stopped(_)) => "the second solution that it is read off cannot go on",
            Some(Lost::TooLarge(_)) | None => "it has grown beyond a twentieth of the mechanism's length",
        }
    }

    /// The largest error of positions at the start of the last step, m, if the integrator carries errors along.
    pub(super) fn off_at_start(&self) -> f64 {
        *self.off_at_start.get_or_init(|| {
            let Self { integrator, companion: None, mechanism, .. } = self else { return 0.0 };
            let (system, last) = (&mechanism.system, integrator.last());
            let mut there = vec![0.0; last.y.len()];
            if !integrator.error(system, last.t_old, &mut there) {
                return 0.0;
            }
            there.iter_mut().zip(&last.y).for_each(|(x, y)| *x = y - *x);
            let off = |body: &RigidBody| (body.position(&last.y).r - body.position(&there).r).norm();
            system.bodies.iter().map(off).fold(0.0, f64::max)
        })
    }

    /// The current state without its error.
    fn better(&self) -> Option<&CachedState> {
        self.current.better(self.system(), |error| self.write_error(error))
    }

    /// Keeps the error of the current state, and says whether it is known.
    pub(super) fn keep_error(&self, error: &mut Vec<f64>) -> bool {
        error.resize(self.current.y().len(), 0.0);
        self.write_error(error)
    }

    fn write_error(&self, error: &mut [f64]) -> bool {
        let time = self.time();
        match &self.companion {
            Some(companion) => companion.error(time, self.current.y(), error),
            None => self.integrator.error(self.system(), time, error),
        }
    }

    /// A part of an error that may be unknown: all of it of what a series carries along, and where radau goes beside radau.
    fn unknown(&self, part: f64) -> f64 {
        let tolerance = self.model().settings.tolerance;
        match self.kind {
            IntegratorKind::Taylor | IntegratorKind::Radau => part,
            _ => part * (UNKNOWN * companion::tolerance_beside(tolerance) / tolerance).min(1.0),
        }
    }

    /// Error of the energy: exactly, where it stays that of the start. Elsewhere errors of bodies cancel for moments, and it is never taken
    /// to be much below them.
    fn energy_error(&self, here: &State, there: &State) -> f64 {
        let system = self.system();
        let energy = here.energy(system);
        let error = if system.is_conservative() {
            (energy - self.start_energy).abs()
        } else {
            (energy - there.energy(system))
                .abs()
                .max(self.unknown(CANCELLED) * self.changed_energy(here, there))
        };
        let size: f64 = here.energies(system).map(f64::abs).sum();
        error.max(f64::EPSILON * size)
    }

    /// The most that lies between the energies of two states, by the lengths of what lies between their velocities and positions.
    fn changed_energy(&self, here: &State, there: &State) -> f64 {
        let system = self.system();
        let gravity = system.model.gravity.norm();
        let bodies = here.bodies().iter().zip(there.bodies()).zip(&system.bodies);
        let of_bodies = bodies.map(|((a, b), body)| {
            let rate = |a: &Vector3<f64>, b: &Vector3<f64>| a.norm() * (a - b).norm();
            let turning: f64 = (0..3).map(|k| body.ibar[k] * rate(&a.q_dot.e[k], &b.q_dot.e[k])).sum();
            let falling = gravity * (a.q.r - b.q.r).norm();
            body.mass * (rate(&a.q_dot.r, &b.q_dot.r) + falling) + turning
        });
        let loads = system.loads.iter().map(|load| (load.potential(here) - load.potential(there)).abs());
        of_bodies.chain(loads).sum()
    }

    /// Points that are shown beside centres of mass: markers, and where the author's frames begin if those are wanted.
    fn points_shown(&self) -> impl Iterator<Item = (BodyRef, Vector3<f64>)> {
        let model = self.model();
        let frames = model.settings.outputs.iter().any(|output| output.kind == OutputKind::Frames);
        let bodies = model.bodies.iter().enumerate().filter(move |_| frames);
        let begins = |(index, body): (usize, &ModelBody)| {
            (BodyRef::Moving(index), body.point_to_principal(&Vector3::zeros()))
        };
        bodies.map(begins).chain(model.markers.iter().map(|marker| (marker.body, marker.local)))
    }

    /// The current state compared with that without an error.
    fn compare(&self, better: &CachedState) -> ErrorEstimate {
        let (here, there) = (self.current.state(self.system()), better.state(self.system()));
        let energy = self.energy_error(here, there);
        // Largest squares of lengths: of errors, and of the numbers, none of which is better than its own rounding.
        let (mut turn, mut errors, mut numbers) = (0.0f64, [0.0f64; 3], [0.0f64; 3]);
        for (a, b) in here.bodies().iter().zip(there.bodies()) {
            let (a, b) = (BodyFrame::from(a), BodyFrame::from(b));
            turn = turn.max(apart(a.u, b.u)).max(apart(a.v, b.v)).max(apart(a.w, b.w));
            let of = |frame: &BodyFrame| [frame.position, frame.velocity, frame.angular_velocity];
            for (k, (a, b)) in of(&a).into_iter().zip(of(&b)).enumerate() {
                errors[k] = errors[k].max(apart(a, b));
                numbers[k] = numbers[k].max(apart(a, [0.0; 3]));
            }
        }
        for (body, local) in self.points_shown() {
            let [a, b] = [here, there].map(|state| state.point(body, &local).map(<[f64; 3]>::from));
            for k in 0..2 {
                errors[k] = errors[k].max(apart(a[k], b[k]));
                numbers[k] = numbers[k].max(apart(a[k], [0.0; 3]));
            }
        }
        let worth = |k: usize| errors[k].sqrt().max(f64::EPSILON * numbers[k].sqrt());
        let rounding = if here.bodies().is_empty() { 0.0 } else { f64::EPSILON };
        let [mut position, mut velocity, angular_velocity] = [0, 1, 2].map(worth);
        // A number that passes zero keeps the rounding of those that it was before.
        let length = self.system().length;
        if position < NOTHING * length {
            position = position.max(f64::EPSILON * self.way_from_start());
            velocity = velocity.max(f64::EPSILON * length * fastest(self.system(), &self.start));
        }
        // What a director or a rate of turning is off may pass through zero: it is told to be a part of what is known beside it.
        let part = self.unknown(TURNED) / length;
        let turn = turn.sqrt().max(part * position);
        let angular_velocity = angular_velocity.max(part * velocity);
        ErrorEstimate { position, turn: turn.max(rounding), velocity, angular_velocity, energy }
    }
}

/// Square of the distance of two points.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum()
}
