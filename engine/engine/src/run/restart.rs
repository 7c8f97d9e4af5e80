//! Restarts of a run: at its start, from the state of another run, or backwards.

use super::companion::Companion;
use super::lent_inertia::LentInertia;
use super::seen::Seen;
use super::{Simulation, Snapshot, explain};
use crate::error::EngineError;
use crate::integrate::Integrator;
use nalgebra::{Matrix3, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::turns;
use triad_dynamics::dynamics::elimination::Counters;
use triad_dynamics::model::ModelBody;
use triad_dynamics::state::BodyFrame;

impl Simulation {
    /// Goes back to the start; counters are reset.
    pub fn reset(&mut self) {
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.set_revolutions(system.start_angles());
        self.notes.begin_at_start();
        let start = std::mem::take(&mut self.start);
        self.begin(0.0, &start);
        self.start = start;
    }

    /// Goes on from where another run of the same scene stands, whose numbers may differ: bodies keep their places
    /// and velocities as far as the constraints allow. Counters and energies are counted from here. Returns what was
    /// corrected, in words; the run's notes tell that in place of what was corrected at its start.
    ///
    /// # Errors
    ///
    /// [`EngineError::Constraint`] if no state near that of the other run satisfies the constraints of this one, and
    /// [`EngineError::TimeOutside`] if this one ends before.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let scene = catalogue::scene("simple-pendulum")?;
    /// let mut light = Simulation::new(&scene)?;
    /// light.advance_to(0.4)?;
    /// let mut heavy = Simulation::new(&scene.changed([], [("/bodies/0/mass", &10.into())])?)?;
    /// heavy.continue_from(&light)?;
    /// assert_eq!(heavy.time(), 0.4);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn continue_from(&mut self, other: &Self) -> Result<Vec<String>, EngineError> {
        let (time, to) = (other.time(), self.duration());
        if time > to {
            return Err(EngineError::TimeOutside { time, from: 0.0, to });
        }
        let frames = other.frame().bodies;
        let n = self.system().coordinates;
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        let system = &self.mechanism.system;
        let places = system.model.bodies.iter().zip(&other.model().bodies).zip(&frames);
        let moved: Vec<ModelBody> = places.map(|((body, old), frame)| placed_as(body, old, frame)).collect();
        system.start_of(&moved, q, q_dot);
        let angles = self.angles_of(other);
        self.mechanism.state.set_revolutions(angles.iter().copied());
        self.mechanism.set_state(time, &y);
        let Mechanism { system, state, .. } = &mut self.mechanism;
        let mut notes = turns::go_on(system, state, &angles);
        notes.extend(self.mechanism.assemble_at(time, &mut y)?);
        self.mechanism.state.commit_revolutions();
        self.begin(time, &y);
        let told =
            |note: &String| format!("at t = {time:.3} s, when the numbers of the run were changed: {note}");
        self.notes.begin_elsewhere(notes.iter().map(told).collect());
        Ok(notes)
    }

    /// Where angles stand in another run of the same joints, counted from the zeros of this one.
    fn angles_of(&self, other: &Self) -> Vec<f64> {
        let stated = |run: &Self, name: &str| {
            run.model().joints.iter().find(|joint| joint.name == name).map_or(0.0, |joint| joint.stated)
        };
        let joints = self.system().angle_joints.iter().zip(other.current.angles(other.system()));
        joints.map(|(name, angle)| angle.value + stated(self, name) - stated(other, name)).collect()
    }

    /// Goes on from a state that was kept of a run of the same scene, at its time; false, and nothing is changed, if it cannot be
    /// one of this scene. Counters, energies and errors are counted from here, and what was corrected at the start is told no more.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let scene = catalogue::scene("simple-pendulum")?;
    /// let mut first = Simulation::new(&scene)?;
    /// first.advance_to(0.4)?;
    /// let mut later = Simulation::new(&scene)?;
    /// assert!(later.resume(&first.snapshot()));
    /// assert_eq!((later.time(), later.q()), (0.4, first.q()));
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn resume(&mut self, kept: &Snapshot) -> bool {
        let Snapshot { time, state, angles } = kept;
        let of_this = state.len() == self.current.y().len() && angles.len() == self.system().angles.len();
        let plain = state.iter().chain(angles).chain([time]).all(|x| x.is_finite());
        if !of_this || !plain || !(0.0..=self.duration()).contains(time) {
            return false;
        }
        self.mechanism.state.set_revolutions(angles.iter().copied());
        self.begin(*time, state);
        self.notes.begin_elsewhere(Vec::new());
        true
    }

    /// A run that starts where this one stands, velocities reversed: without drivers and losses it goes the way back.
    #[must_use]
    pub fn turned_back(&self) -> Self {
        let mut back = self.clone();
        let n = self.system().coordinates;
        back.start.copy_from_slice(self.current.y());
        back.start[n..].iter_mut().for_each(|v| *v = -*v);
        back.reset();
        back
    }

    /// Starts to integrate at a consistent state.
    fn begin(&mut self, time: f64, y: &[f64]) {
        self.mechanism.elimination.counters = Counters::default();
        self.mechanism.projections = 0;
        self.counters = explain::RunCounters::default();
        (self.work, self.seen) = (0.0, Seen::new(time, y));
        self.lent_inertia = LentInertia::of(&self.mechanism);
        // What it refuses is refused after the next step.
        let _ = self.lent_inertia.look(&mut self.mechanism, time, y);
        self.singularities.reset(&mut self.mechanism);
        self.before_branching = None;
        self.off_at_start.take();
        self.mechanism.set_state(time, y);
        self.mechanism.state.commit_motion();
        self.companion = Companion::start(self.kind, &self.mechanism, time, y);
        self.integrator = Integrator::start(self.kind, &mut self.mechanism, time, y);
        self.set_current(time, y);
        self.start_energy = self.current.state(self.system()).energy(self.system());
        self.restart_events();
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
