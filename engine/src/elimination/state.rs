//! A state taken over: bodies, the features of rows and loads, angles, prescribed motions, and what can be told of them
//! without solving anything.

use super::Elimination;
use crate::feature::{Difference, FeatureId, Target};
use crate::lift::Lift;
use crate::model::BodyRef;
use crate::motion::Jet;
use crate::row::Form;
use crate::system::System;
use nalgebra::{Matrix3, Vector3};

/// What is known of a body at one state.
#[derive(Clone, Debug, Default)]
pub struct BodyState {
    /// Position Q.
    pub q: Lift,
    /// Velocity Q̇.
    pub q_dot: Lift,
    /// Particular acceleration Q̈ᵖ that satisfies the rigid-body rows.
    pub particular: Lift,
    /// Generalized applied force G.
    pub force: Lift,
    /// Resultant force and moment (F, T) about the centre of mass, inertial part of Q̈ᵖ included.
    pub wrench: [Vector3<f64>; 2],
    /// Inverse of the inertia used by the factorization.
    pub inverse: Matrix3<f64>,
    /// Solution ξ̇ = (v̇, ω̇).
    pub twist: [Vector3<f64>; 2],
    /// ω̇ for which lent inertia has been returned so far.
    pub(super) returned: Vector3<f64>,
}

/// What is known of a feature at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FeatureState {
    /// Position of the point, or the vector.
    pub value: Vector3<f64>,
    /// C^s Q: from the centre of mass to the point, or the vector.
    pub arm: Vector3<f64>,
    /// Rate of change of `value`.
    pub rate: Vector3<f64>,
    /// C Q̈ᵖ.
    pub particular: Vector3<f64>,
}

/// A scalar function of features at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ScalarState {
    pub value: f64,
    pub rate: f64,
    /// Its second derivative along Q̈ᵖ.
    pub particular: f64,
    /// The part of its second derivative that is quadratic in the velocities.
    pub curvature: f64,
}

impl Elimination {
    /// Takes over the time t, s, on which drivers and loads depend.
    pub fn set_time(&mut self, system: &System, t: f64) {
        self.time = t;
        for (jet, curve) in self.curves.iter_mut().zip(&system.curves) {
            *jet = curve.at(t);
        }
        for (jet, target) in self.targets.iter_mut().zip(&system.targets) {
            *jet = target.at(t);
        }
    }

    /// The time on which drivers and loads depend, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Counts whole turns of angles from the current positions on.
    pub fn keep_turns(&mut self) {
        for angle in &mut self.angles {
            angle.reference = angle.value;
        }
    }

    /// Forgets whole turns.
    pub fn forget_turns(&mut self) {
        for angle in &mut self.angles {
            angle.reference = 0.0;
        }
    }

    /// Counts whole turns of angles as another evaluation of the same rows does.
    pub fn take_turns(&mut self, from: &Self) {
        for (angle, other) in self.angles.iter_mut().zip(&from.angles) {
            angle.reference = other.value;
        }
    }

    /// The feature that is the axis of an angle.
    pub fn angle_axis(&self, angle: usize) -> FeatureId {
        self.angle_axes[angle]
    }

    /// Takes over the positions q.
    pub fn place(&mut self, system: &System, q: &[f64]) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q = body.layout.position(q);
        }
        self.place_features(system);
    }

    pub(super) fn place_features(&mut self, system: &System) {
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
            state.place(angle.features().map(|f| self.features[f].value));
        }
    }

    /// Takes over the velocities q̇; positions must be in place.
    pub fn set_velocity(&mut self, system: &System, q_dot: &[f64]) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q_dot = body.layout.velocity(&state.q, q_dot);
        }
        self.set_feature_rates(system);
    }

    pub(super) fn set_feature_rates(&mut self, system: &System) {
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
                    let BodyState { q, q_dot, .. } = &self.bodies[body];
                    let turning = q_dot.arm(&local) + q.arm(&local_rate);
                    if feature.point { q_dot.r + turning } else { turning }
                }
            };
        }
        for (state, angle) in self.angles.iter_mut().zip(&system.angles) {
            let features = angle.features();
            state.set_velocity(
                features.map(|f| self.features[f].value),
                features.map(|f| self.features[f].rate),
            );
        }
    }

    /// A prescribed number and its derivatives at the current time.
    pub fn target(&self, target: Target) -> Jet<f64> {
        match target {
            Target::Constant(c) => [c, 0.0, 0.0],
            Target::Driven(curve) => self.targets[curve],
        }
    }

    /// a · b and what its derivatives are made of.
    pub(super) fn product(&self, a: Difference, b: Difference) -> ScalarState {
        let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
        let (xr, yr) = (self.difference(a, |f| f.rate), self.difference(b, |f| f.rate));
        let (xp, yp) = (self.difference(a, |f| f.particular), self.difference(b, |f| f.particular));
        ScalarState {
            value: x.dot(&y),
            rate: x.dot(&yr) + xr.dot(&y),
            particular: x.dot(&yp) + xp.dot(&y),
            curvature: 2.0 * xr.dot(&yr),
        }
    }

    /// The left side of a relation between angles and a displacement.
    pub(super) fn relation(&self, system: &System, form: &Form) -> ScalarState {
        let mut sum = ScalarState::default();
        let Form::Relation { angles, slide, constant } = *form else { return sum };
        sum.value = -constant;
        for (angle, factor) in angles.into_iter().flatten() {
            let state = &self.angles[angle];
            let features = system.angles[angle].features();
            let particular: f64 =
                features.iter().zip(&state.gradient).map(|(&f, g)| g.dot(&self.features[f].particular)).sum();
            sum.value += factor * state.value;
            sum.rate += factor * state.rate;
            sum.particular += factor * particular;
            sum.curvature += factor * state.curvature;
        }
        if let Some((a, b, factor)) = slide {
            let product = self.product(a, b);
            sum.value += factor * product.value;
            sum.rate += factor * product.rate;
            sum.particular += factor * product.particular;
            sum.curvature += factor * product.curvature;
        }
        sum
    }

    pub(super) fn difference(
        &self,
        difference: Difference,
        of: impl Fn(&FeatureState) -> Vector3<f64>,
    ) -> Vector3<f64> {
        difference.of(|feature| of(&self.features[feature]))
    }

    /// Position of a feature's point, or its vector.
    pub fn feature_value(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature].value
    }

    /// Rate of change of [`Self::feature_value`].
    pub fn feature_rate(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature].rate
    }

    /// Local coordinates of a feature at the current time.
    pub fn feature_local(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        feature.curve.map_or(feature.local, |curve| self.curves[curve][0])
    }

    /// The part of a feature's rate that its prescribed motion makes.
    pub fn driven_rate(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let rate = self.curves[curve][1];
        match feature.body {
            BodyRef::Ground => rate,
            BodyRef::Moving(body) => self.bodies[body].q.arm(&rate),
        }
    }

    /// The part of a feature's second derivative that its prescribed motion makes.
    pub fn driven_acceleration(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let [_, rate, acceleration] = self.curves[curve];
        match feature.body {
            BodyRef::Ground => acceleration,
            BodyRef::Moving(body) => {
                let BodyState { q, q_dot, .. } = &self.bodies[body];
                q.arm(&acceleration) + q_dot.arm(&rate) * 2.0
            }
        }
    }

    /// Value, rate and curvature of a relation.
    pub fn relation_terms(&self, system: &System, form: &Form) -> (f64, f64, f64) {
        let relation = self.relation(system, form);
        (relation.value, relation.rate, relation.curvature)
    }

    /// Largest |Φ| and |Φ̇| of one row form.
    pub(crate) fn row_violation(&self, system: &System, form: &Form) -> (f64, f64) {
        match *form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                let (a, b) = (&self.features[a], &self.features[b]);
                ((a.value - b.value).amax(), (a.rate - b.rate).amax())
            }
            Form::Product { a, b, target } => {
                let product = self.product(a, b);
                let [c, c_rate, _] = self.target(target);
                ((product.value - c).abs(), (product.rate - c_rate).abs())
            }
            Form::Relation { .. } => {
                let relation = self.relation(system, form);
                (relation.value.abs(), relation.rate.abs())
            }
        }
    }

    /// Largest |Φ| and |Φ̇| over all rows, rigid-body rows included; positions and velocities must be in place.
    pub fn violation(&self, system: &System) -> (f64, f64) {
        let (mut position, mut velocity) = (0.0f64, 0.0f64);
        for state in &self.bodies {
            let (q, q_dot) = (&state.q, &state.q_dot);
            for k in 0..3 {
                for l in 0..=k {
                    let unit = if k == l { 1.0 } else { 0.0 };
                    position = position.max((q.e[k].dot(&q.e[l]) - unit).abs());
                    velocity = velocity.max((q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])).abs());
                }
            }
        }
        for row in &system.rows {
            let (value, rate) = self.row_violation(system, &row.form);
            position = position.max(value);
            velocity = velocity.max(rate);
        }
        (position, velocity)
    }

    /// Kinetic plus potential energy, springs included, J; positions and velocities must be in place.
    pub fn energy(&self, system: &System) -> f64 {
        let gravity = system.model.gravity;
        let springs: f64 = system.loads.iter().map(|load| load.potential(self)).sum();
        let bodies = self.bodies.iter().zip(&system.bodies);
        let weights: f64 = bodies.map(|(state, body)| body.mass * gravity.dot(&state.q.r)).sum();
        self.kinetic_energy(system) - weights + springs
    }

    /// Kinetic energy, J; positions and velocities must be in place.
    pub fn kinetic_energy(&self, system: &System) -> f64 {
        let bodies = self.bodies.iter().zip(&system.bodies);
        let twice = bodies.map(|(state, body)| {
            let turning: f64 = (0..3).map(|k| body.ibar[k] * state.q_dot.e[k].norm_squared()).sum();
            body.mass * state.q_dot.r.norm_squared() + turning
        });
        0.5 * twice.sum::<f64>()
    }
}
