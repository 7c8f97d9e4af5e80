//! What is known at (t, q, q̇) without solving anything: bodies, features, angles, prescribed motions.
//!
//! A state is taken over whole with [`State::set`], or in its three stages: time, positions, velocities. A later stage
//! needs the earlier ones, and what depends on velocities refuses to be read while they belong to other positions.

mod angle;
mod difference;
mod energy;
mod event;
mod forces;
mod frame;
mod pace;
mod rows;

pub use angle::AngleState;
pub(crate) use angle::nearest;
pub use difference::{Apart, Difference};
pub use energy::kinetic_of_step;
pub use forces::AppliedForces;
pub use frame::BodyFrame;
pub use pace::{fastest, pace};
pub use rows::{Residual, ScalarState};

use crate::model::BodyRef;
use crate::model::motion::Jet;
use crate::system::System;
use crate::system::feature::Target;
use crate::system::index::FeatureId;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;

/// What is known of a body at one state.
#[derive(Clone, Debug, Default)]
pub struct BodyState {
    /// Position Q.
    pub q: NaturalCoordinates,
    /// Velocity Q̇.
    pub q_dot: NaturalCoordinates,
}

/// What is known of a feature at one state.
#[derive(Clone, Copy, Debug, Default)]
struct FeatureState {
    /// Position of the point, or the vector.
    value: Vector3<f64>,
    /// C^s Q: from the centre of mass to the point, or the vector.
    arm: Vector3<f64>,
    /// Rate of change of `value`.
    rate: Vector3<f64>,
}

/// How much of a state belongs together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Stage {
    /// The time.
    Time,
    /// Positions at that time.
    Positions,
    /// Velocities at these positions.
    Velocities,
}

/// What is known at (t, q, q̇) without solving anything.
#[derive(Clone, Debug)]
pub struct State {
    time: f64,
    bodies: Vec<BodyState>,
    features: Vec<FeatureState>,
    angles: Vec<AngleState>,
    /// Prescribed vectors and numbers with their derivatives.
    curves: Vec<Jet<Vector3<f64>>>,
    targets: Vec<Jet<f64>>,
    /// When the last accepted step ended, s, where whole turns are counted by rates from there on.
    counted: Option<f64>,
    /// The same before that step.
    counted_before: Option<f64>,
    /// The time at which it was told which angles are expected, s.
    told: Option<f64>,
    stage: Stage,
}

impl State {
    /// Allocates for a system, at time zero and without positions.
    pub fn new(system: &System) -> Self {
        let mut features = vec![FeatureState::default(); system.features.len()];
        for (state, feature) in features.iter_mut().zip(&system.features) {
            if feature.is_fixed() {
                state.value = feature.local;
            }
        }
        let mut state = Self {
            time: 0.0,
            bodies: vec![BodyState::default(); system.bodies.len()],
            features,
            angles: vec![AngleState::default(); system.angles.len()],
            curves: vec![[Vector3::zeros(); 3]; system.curves.len()],
            targets: vec![[0.0; 3]; system.targets.len()],
            counted: None,
            counted_before: None,
            told: None,
            stage: Stage::Time,
        };
        state.set_time(system, 0.0);
        state
    }

    /// The state (q, q̇) at time t, s, angles counted from less than half a turn.
    pub fn at(system: &System, t: f64, q: &[f64], q_dot: &[f64]) -> Self {
        let mut state = Self::new(system);
        state.set(system, t, q, q_dot);
        state
    }

    /// Takes over the time t, s, positions q and velocities q̇.
    pub fn set(&mut self, system: &System, t: f64, q: &[f64], q_dot: &[f64]) {
        self.set_time(system, t);
        self.set_positions(system, q);
        self.set_velocities(system, q_dot);
    }

    /// Takes over the time t, s, on which drivers and loads depend; positions and velocities are to follow.
    pub fn set_time(&mut self, system: &System, t: f64) {
        self.time = t;
        for (jet, curve) in self.curves.iter_mut().zip(&system.curves) {
            *jet = curve.at(t);
        }
        for (jet, target) in self.targets.iter_mut().zip(&system.targets) {
            *jet = target.at(t);
        }
        let (since, told) = (self.since(t), self.told == Some(t));
        for angle in self.angles.iter_mut().filter(|angle| !(told && angle.told)) {
            (angle.expected, angle.told) = (angle.foreseen(since), false);
        }
        self.stage = Stage::Time;
    }

    /// The time t less that from which whole turns are counted by rates, s; zero where they are not.
    fn since(&self, t: f64) -> f64 {
        self.counted.map_or(0.0, |counted| t - counted)
    }

    /// Takes over the positions q; velocities are to follow.
    pub fn set_positions(&mut self, system: &System, q: &[f64]) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q = body.layout.position(q);
        }
        self.update_positions(system);
    }

    /// Takes over positions that are given body by body; the third director of a reduced body need not be a product.
    /// Velocities are to follow.
    pub fn set_natural_positions(&mut self, system: &System, positions: &[NaturalCoordinates]) {
        for (state, q) in self.bodies.iter_mut().zip(positions) {
            state.q = *q;
        }
        self.update_positions(system);
    }

    /// Takes over the velocities q̇.
    pub fn set_velocities(&mut self, system: &System, q_dot: &[f64]) {
        self.require(Stage::Positions);
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q_dot = body.layout.velocity(&state.q, q_dot);
        }
        self.update_rates(system);
    }

    /// Takes over velocities that are given body by body.
    pub fn set_natural_velocities(&mut self, system: &System, velocities: &[NaturalCoordinates]) {
        self.require(Stage::Positions);
        for (state, q_dot) in self.bodies.iter_mut().zip(velocities) {
            state.q_dot = *q_dot;
        }
        self.update_rates(system);
    }

    /// Points C^P Q and vectors C^s Q of bodies — eq. (2.2).
    fn update_positions(&mut self, system: &System) {
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                let q = &self.bodies[body].q;
                state.arm = q.arm(&feature.local);
                state.value = if feature.point { q.r + state.arm } else { state.arm };
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let local = self.curves[curve][0];
            let state = &mut self.features[place];
            match feature.body {
                BodyRef::Ground => state.value = local,
                BodyRef::Moving(body) => {
                    let q = &self.bodies[body].q;
                    state.arm = q.arm(&local);
                    state.value = if feature.point { q.r + state.arm } else { state.arm };
                }
            }
        }
        for (state, angle) in self.angles.iter_mut().zip(&system.angles) {
            state.set_position(angle.features().map(|f| self.features[f.index()].value), state.expected);
        }
        self.stage = Stage::Positions;
    }

    /// Their rates C Q̇, with the same constant C — eq. (2.4).
    fn update_rates(&mut self, system: &System) {
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                let q_dot = &self.bodies[body].q_dot;
                let arm = q_dot.arm(&feature.local);
                state.rate = if feature.point { q_dot.r + arm } else { arm };
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let [local, local_rate, _] = self.curves[curve];
            self.features[place].rate = match feature.body {
                BodyRef::Ground => local_rate,
                BodyRef::Moving(body) => {
                    let BodyState { q, q_dot } = &self.bodies[body];
                    let turning = q_dot.arm(&local) + q.arm(&local_rate);
                    if feature.point { q_dot.r + turning } else { turning }
                }
            };
        }
        let since = self.since(self.time);
        for (state, angle) in self.angles.iter_mut().zip(&system.angles) {
            let features = angle.features();
            state.set_velocity(
                features.map(|f| self.features[f.index()].value),
                features.map(|f| self.features[f.index()].rate),
            );
            if since != 0.0 {
                state.count_by_rates(since);
            }
        }
        self.stage = Stage::Velocities;
    }

    /// Velocities that belong to other positions must not be read: an error of the program, not of its input.
    fn require(&self, stage: Stage) {
        assert!(self.stage >= stage, "the state has {:?}, but {stage:?} are asked for", self.stage);
    }

    /// Refuses to go on where velocities have not been taken over at the current positions.
    pub(crate) fn require_velocities(&self) {
        self.require(Stage::Velocities);
    }

    /// The time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The bodies.
    pub fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    /// Position and velocity in the world of a point of a body's principal frame — eq. (2.2).
    pub fn point(&self, body: BodyRef, local: &Vector3<f64>) -> [Vector3<f64>; 2] {
        self.require(Stage::Velocities);
        match body {
            BodyRef::Ground => [*local, Vector3::zeros()],
            BodyRef::Moving(body) => {
                let BodyState { q, q_dot } = &self.bodies[body];
                [q.r + q.arm(local), q_dot.r + q_dot.arm(local)]
            }
        }
    }

    /// The angles of joints.
    pub fn angles(&self) -> &[AngleState] {
        &self.angles
    }

    /// Counts whole turns of angles from the current positions on: to others from which no angle is half a turn away.
    pub fn commit_revolutions(&mut self) {
        self.counted = None;
        for angle in &mut self.angles {
            angle.count_from(angle.value, 0.0);
        }
    }

    /// Counts whole turns of angles from the current state on, by rates: at the end of a step, however far the next one turns them. Where
    /// there are no velocities, as at the end of a step to where there is no state, as [`Self::commit_revolutions`].
    pub fn commit_motion(&mut self) {
        self.counted_before = self.counted;
        self.angles.iter_mut().for_each(AngleState::remember);
        if self.stage < Stage::Velocities {
            self.commit_revolutions();
            return;
        }
        self.counted = Some(self.time);
        for angle in &mut self.angles {
            angle.count_from(angle.value, angle.rate);
        }
    }

    /// Counts whole turns from where they were counted before the last [`Self::commit_motion`]: its step is taken back.
    pub fn take_back_motion(&mut self) {
        self.counted = self.counted_before;
        self.angles.iter_mut().for_each(AngleState::count_back);
    }

    /// Counts whole turns of angles from the given values on, rad.
    pub fn set_revolutions(&mut self, values: impl Iterator<Item = f64>) {
        self.counted = None;
        for (angle, value) in self.angles.iter_mut().zip(values) {
            angle.count_from(value, 0.0);
        }
    }

    /// Counts whole turns of angles from another state of the same rows on, by rates.
    pub fn follow_motion(&mut self, from: &Self) {
        self.counted = Some(from.time);
        for (angle, from) in self.angles.iter_mut().zip(&from.angles) {
            angle.count_from(from.value, from.rate);
        }
    }

    /// Says to less than half a turn which angle, rad, the positions have that are taken over next, and again at the same time.
    pub fn expect_angle(&mut self, angle: usize, expected: f64) {
        self.told = Some(self.time);
        (self.angles[angle].expected, self.angles[angle].told) = (expected, true);
    }

    /// What angles are to less than half a turn at time t, rad, as far as that is known before positions are.
    pub fn expected_angles(&self, t: f64) -> impl Iterator<Item = f64> {
        let (since, told) = (self.since(t), self.told == Some(t));
        self.angles.iter().map(
            move |angle| {
                if told && angle.told { angle.expected } else { angle.foreseen(since) }
            },
        )
    }

    /// Whether whole turns since the last accepted step are known, of all angles on which something but outputs depends.
    pub fn knows_turns(&self, system: &System) -> bool {
        let since = self.since(self.time);
        self.angles[..system.needed_angles].iter().all(|angle| angle.is_counted(since))
    }

    /// Counts whole turns of angles from the angles of another state of the same rows on.
    pub fn copy_revolutions(&mut self, from: &Self) {
        self.set_revolutions(from.angles.iter().map(|angle| angle.value));
    }

    /// A prescribed number and its derivatives at the current time.
    pub fn target(&self, target: Target) -> Jet<f64> {
        match target {
            Target::Constant(c) => [c, 0.0, 0.0],
            Target::Driven(curve) => self.targets[curve],
        }
    }

    /// A prescribed vector and its derivatives at the current time.
    pub fn curve(&self, curve: usize) -> Jet<Vector3<f64>> {
        self.curves[curve]
    }

    /// From the centre of mass to a feature's point, or its vector.
    pub fn feature_arm(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature.index()].arm
    }

    /// Position of a feature's point, or its vector.
    pub fn feature_value(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature.index()].value
    }

    /// Rate of change of [`Self::feature_value`].
    pub fn feature_rate(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature.index()].rate
    }

    /// Local coordinates of a feature at the current time.
    pub fn feature_local(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system[feature];
        feature.curve.map_or(feature.local, |curve| self.curves[curve][0])
    }

    /// The part of a feature's rate that its prescribed motion makes.
    pub fn driven_rate(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let rate = self.curves[curve][1];
        match feature.body {
            BodyRef::Ground => rate,
            BodyRef::Moving(body) => self.bodies[body].q.arm(&rate),
        }
    }

    /// The part of a feature's second derivative that its prescribed motion makes.
    pub fn driven_acceleration(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let [_, rate, acceleration] = self.curves[curve];
        match feature.body {
            BodyRef::Ground => acceleration,
            BodyRef::Moving(body) => {
                let BodyState { q, q_dot } = &self.bodies[body];
                q.arm(&acceleration) + q_dot.arm(&rate) * 2.0
            }
        }
    }
}
