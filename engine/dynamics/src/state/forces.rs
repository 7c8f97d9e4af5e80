//! Applied forces in natural coordinates — THEORY section 6.
//!
//! A force f at a point adds Cᵀ f; a moment τ adds ½ τ × e_k to each director, so that its power is τ · ω whatever
//! its direction — eq. (6.8).

use super::{Stage, State};
use crate::model::{BodyRef, CustomLoadError, ModelCustomLoad, Motions};
use crate::scene::LoadFrame;
use crate::system::System;
use crate::system::index::FeatureId;
use crate::system::load::SystemLoad;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;

/// Rate, in the smoothing of a dry friction, from which on it is all there: tanh 20 is one to the last digit.
const STICKING: f64 = 20.0;
/// Part of the length of the mechanism that a point of an axis may lie beside it.
const ON_AXIS: f64 = 1e-9;

/// Generalized applied forces of all bodies.
#[derive(Clone, Debug, Default)]
pub struct AppliedForces {
    /// G of each body.
    pub bodies: Vec<NaturalCoordinates>,
    /// The last failure of a load that a program gives.
    failure: Option<CustomLoadError>,
}

impl AppliedForces {
    /// Room for the bodies of a system, without forces.
    pub fn none(system: &System) -> Self {
        Self { bodies: vec![NaturalCoordinates::default(); system.bodies.len()], failure: None }
    }

    /// Weights and loads at a state.
    pub fn new(system: &System, state: &State) -> Self {
        let mut forces = Self::none(system);
        forces.evaluate(system, state);
        forces
    }

    /// Replaces the forces by weights and loads at a state — eq. (6.7).
    pub fn evaluate(&mut self, system: &System, state: &State) {
        state.require(Stage::Velocities);
        for (force, body) in self.bodies.iter_mut().zip(&system.bodies) {
            *force = NaturalCoordinates { r: system.model.gravity * body.mass, e: [Vector3::zeros(); 3] };
        }
        for load in &system.loads {
            load.apply(system, state, self);
        }
        for load in &system.model.custom_loads {
            self.add_custom(system, state, load);
        }
    }

    /// Adds a load that a program gives; one that fails makes the accelerations NaN, so that no step is taken with it.
    fn add_custom(&mut self, system: &System, state: &State, load: &ModelCustomLoad) {
        let [force, moment] = load.at(&system.model, state.time, state).unwrap_or_else(|failure| {
            self.failure = Some(failure);
            [Vector3::repeat(f64::NAN); 2]
        });
        self.add_force(load.body, &load.local, &force);
        self.add_moment(load.body, &moment, &state.bodies[load.body].q);
    }

    /// Why a load that a program gives could not act at the last state where one could not.
    pub fn failure(&self) -> Option<&CustomLoadError> {
        self.failure.as_ref()
    }

    /// Cᵀ f for the point or vector of a feature.
    fn add_at_feature(&mut self, system: &System, feature: FeatureId, force: &Vector3<f64>) {
        let feature = &system[feature];
        if let BodyRef::Moving(body) = feature.body {
            let lift = &mut self.bodies[body];
            if feature.point {
                lift.r += force;
            }
            for k in 0..3 {
                lift.e[k] += force * feature.local[k];
            }
        }
    }

    /// Cᵀ f for a force at a point of a body.
    fn add_force(&mut self, body: usize, local: &Vector3<f64>, force: &Vector3<f64>) {
        let lift = &mut self.bodies[body];
        lift.r += force;
        for k in 0..3 {
            lift.e[k] += force * local[k];
        }
    }

    /// ½ τ × e_k on each director of a body.
    fn add_moment(&mut self, body: usize, moment: &Vector3<f64>, q: &NaturalCoordinates) {
        for k in 0..3 {
            self.bodies[body].e[k] += moment.cross(&q.e[k]) * 0.5;
        }
    }
}

impl SystemLoad {
    /// Whether it may turn a body about an axis about which that has no inertia: not along lines through points of the axis.
    pub fn turns_without_inertia(&self, system: &System) -> bool {
        let near = ON_AXIS * system.length;
        let lacks = |body: &BodyRef| match body {
            BodyRef::Ground => false,
            BodyRef::Moving(body) => system.bodies[*body].regularizing_inertia > 0.0,
        };
        let beside = |body: &BodyRef, point: &Vector3<f64>| match body {
            BodyRef::Ground => false,
            BodyRef::Moving(body) => system.bodies[*body].beside_lacking_axis(point) > near,
        };
        match self {
            Self::Force { body, local, .. } => beside(&BodyRef::Moving(*body), local),
            Self::Moment { body, .. } => lacks(&BodyRef::Moving(*body)),
            Self::Spring { from, to, .. } => {
                [from, to].into_iter().any(|end| beside(&system[*end].body, &system[*end].local))
            }
            Self::Torsion { bodies, .. } => bodies.iter().any(lacks),
            Self::Slider { .. } => self.features().iter().any(|feature| lacks(&system[*feature].body)),
        }
    }

    /// Adds its generalized force to those of the bodies.
    pub fn apply(&self, system: &System, at: &State, forces: &mut AppliedForces) {
        let t = at.time;
        match self {
            Self::Force { body, local, force, frame } => {
                let force = in_world(at, *body, *frame, force.at(t)[0]);
                forces.add_force(*body, local, &force);
            }
            Self::Moment { body, moment, frame } => {
                let moment = in_world(at, *body, *frame, moment.at(t)[0]);
                forces.add_moment(*body, &moment, &at.bodies[*body].q);
            }
            Self::Spring { law, .. } | Self::Torsion { law, .. } | Self::Slider { law, .. } => {
                if let Some((x, rate)) = self.coordinate(at) {
                    self.push(system, at, law.value(x, rate, t), forces);
                }
            }
        }
    }

    /// The length, angle or displacement that it acts along, and its rate: see [`direction`].
    pub(crate) fn coordinate(&self, at: &State) -> Option<(f64, f64)> {
        match self {
            Self::Force { .. } | Self::Moment { .. } => None,
            Self::Spring { from, to, .. } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let rate = at.feature_rate(*to) - at.feature_rate(*from);
                Some((between.norm(), direction(&between, &rate)?.dot(&rate)))
            }
            Self::Torsion { angle, .. } => Some((at.angles[*angle].value, at.angles[*angle].rate)),
            Self::Slider { axis, between, .. } => {
                let s = at.feature_value(*axis);
                let (d, rate) = (between.of(|f| at.feature_value(f)), between.of(|f| at.feature_rate(f)));
                Some((s.dot(&d), s.dot(&rate) + at.feature_rate(*axis).dot(&d)))
            }
        }
    }

    /// The length, angle or displacement that a load with a law acts along, its rate, and the force or moment in the
    /// direction in which it grows — eq. (6.9). `None` for other loads, and for a spring of no length.
    pub fn acting(&self, at: &State) -> Option<[f64; 3]> {
        let (x, rate) = self.coordinate(at)?;
        Some([x, rate, self.law()?.value(x, rate, at.time)])
    }

    /// Which way its dry friction slides: 1 or −1, or 0 where it sticks or turns round; `None` without any.
    pub fn sliding(&self, at: &State) -> Option<i8> {
        let smoothing = self.dry_friction()?.smoothing;
        let (_, rate) = self.coordinate(at)?;
        let way = if rate > 0.0 { 1 } else { -1 };
        Some(if rate.abs() < STICKING * smoothing { 0 } else { way })
    }

    /// The largest force that it is the sum of at rest, N, moments over a length: rounding is a part of that, even where the sum is
    /// zero. Lengths are known as well as `reach` is.
    pub fn largest_part(&self, at: &State, length: f64, reach: f64) -> f64 {
        match self {
            Self::Force { .. } => self.given(at).map_or(0.0, |vector| vector.norm()),
            Self::Moment { .. } => self.given(at).map_or(0.0, |vector| vector.norm() / length),
            Self::Spring { law, .. } | Self::Slider { law, .. } => {
                self.coordinate(at).map_or(0.0, |(x, _)| law.largest_part(x, reach, at.time))
            }
            Self::Torsion { law, .. } => {
                self.coordinate(at).map_or(0.0, |(x, _)| law.largest_part(x, 1.0, at.time) / length)
            }
        }
    }

    /// The unit axis in the world that a load about or along a joint acts about or along; zero for other loads.
    pub(crate) fn axis(&self, at: &State) -> Vector3<f64> {
        match self {
            Self::Force { .. } | Self::Moment { .. } | Self::Spring { .. } => Vector3::zeros(),
            Self::Torsion { axis, .. } | Self::Slider { axis, .. } => at.feature_value(*axis),
        }
    }

    /// The force or moment in the world of a load that is one.
    pub fn given(&self, at: &State) -> Option<Vector3<f64>> {
        match self {
            Self::Force { body, force: vector, frame, .. } | Self::Moment { body, moment: vector, frame } => {
                Some(in_world(at, *body, *frame, vector.at(at.time)[0]))
            }
            Self::Spring { .. } | Self::Torsion { .. } | Self::Slider { .. } => None,
        }
    }

    /// Adds the generalized force of a force or moment `value` along its coordinate: the gradient of the coordinate
    /// times that.
    pub(crate) fn push(&self, system: &System, at: &State, value: f64, forces: &mut AppliedForces) {
        match self {
            Self::Force { .. } | Self::Moment { .. } => {}
            Self::Spring { from, to, .. } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let rate = at.feature_rate(*to) - at.feature_rate(*from);
                let Some(direction) = direction(&between, &rate) else { return };
                forces.add_at_feature(system, *to, &(direction * value));
                forces.add_at_feature(system, *from, &(direction * -value));
            }
            Self::Torsion { axis, bodies, .. } => {
                let moment = at.feature_value(*axis) * value;
                for (body, sign) in [(bodies[0], -1.0), (bodies[1], 1.0)] {
                    if let BodyRef::Moving(index) = body {
                        forces.add_moment(index, &(moment * sign), &at.bodies[index].q);
                    }
                }
            }
            Self::Slider { axis, between, .. } => {
                let s = at.feature_value(*axis);
                let d = between.of(|f| at.feature_value(f));
                forces.add_at_feature(system, between.plus, &(s * value));
                if let Some(minus) = between.minus {
                    forces.add_at_feature(system, minus, &(s * -value));
                }
                forces.add_at_feature(system, *axis, &(d * value));
            }
        }
    }

    /// Adds the generalized force of a unit force or moment along its coordinate, and returns its stiffness −∂f/∂x and
    /// its damping −∂f/∂ẋ; `None` for a load without a law.
    pub fn linearized(&self, system: &System, at: &State, forces: &mut AppliedForces) -> Option<(f64, f64)> {
        let law = self.law()?;
        let (_, rate) = self.coordinate(at)?;
        self.push(system, at, 1.0, forces);
        Some((law.stiffness, law.slope(rate)))
    }

    /// Power of all that is not its spring, W.
    pub fn power(&self, at: &State) -> f64 {
        let t = at.time;
        match self {
            Self::Force { body, local, force, frame } => {
                let q_dot = &at.bodies[*body].q_dot;
                in_world(at, *body, *frame, force.at(t)[0]).dot(&(q_dot.r + q_dot.arm(local)))
            }
            Self::Moment { body, moment, frame } => {
                let state = &at.bodies[*body];
                let moment = in_world(at, *body, *frame, moment.at(t)[0]);
                (0..3).map(|k| 0.5 * moment.cross(&state.q.e[k]).dot(&state.q_dot.e[k])).sum()
            }
            Self::Spring { from, to, law } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let rate = at.feature_rate(*to) - at.feature_rate(*from);
                let speed = direction(&between, &rate).map_or(0.0, |d| d.dot(&rate));
                law.without_spring(speed, t) * speed
            }
            Self::Torsion { angle, law, .. } => {
                let speed = at.angles[*angle].rate;
                law.without_spring(speed, t) * speed
            }
            Self::Slider { axis, between, law } => {
                let (d, rate) = (between.of(|f| at.feature_value(f)), between.of(|f| at.feature_rate(f)));
                let speed = at.feature_value(*axis).dot(&rate) + at.feature_rate(*axis).dot(&d);
                law.without_spring(speed, t) * speed
            }
        }
    }

    /// Potential energy of its spring, J.
    pub fn potential(&self, at: &State) -> f64 {
        let (law, value) = match self {
            Self::Force { .. } | Self::Moment { .. } => return 0.0,
            Self::Spring { from, to, law } => (law, (at.feature_value(*to) - at.feature_value(*from)).norm()),
            Self::Torsion { angle, law, .. } => (law, at.angles[*angle].value),
            Self::Slider { axis, between, law } => {
                (law, at.feature_value(*axis).dot(&between.of(|f| at.feature_value(f))))
            }
        };
        law.potential(value)
    }
}

impl ModelCustomLoad {
    /// Its power f · v + τ · ω, W.
    pub fn power(&self, system: &System, at: &State) -> f64 {
        let Ok([force, moment]) = self.at(&system.model, at.time, at) else { return f64::NAN };
        let motion = at.motion(self.body);
        let arm = at.bodies[self.body].q.arm(&self.local);
        force.dot(&(motion.velocity + motion.angular_velocity.cross(&arm)))
            + moment.dot(&motion.angular_velocity)
    }
}

fn in_world(at: &State, body: usize, frame: LoadFrame, vector: Vector3<f64>) -> Vector3<f64> {
    match frame {
        LoadFrame::World => vector,
        LoadFrame::Body => at.bodies[body].q.arm(&vector),
    }
}

/// The direction from one point to another. Points that meet part along their velocity; at rest they have none, and nothing between them pulls.
fn direction(between: &Vector3<f64>, rate: &Vector3<f64>) -> Option<Vector3<f64>> {
    between.try_normalize(f64::MIN_POSITIVE).or_else(|| rate.try_normalize(f64::MIN_POSITIVE))
}
