//! Applied forces in lifted coordinates — THEORY section 6.
//!
//! A force f at a point adds Cᵀ f; a moment τ adds ½ τ × e_k to each director, so that its power is τ · ω whatever
//! its direction — eq. (6.8).

use crate::elimination::Elimination;
use crate::feature::{Difference, Feature, FeatureId};
use crate::lift::Lift;
use crate::model::{BodyRef, Element, LoadKind, Model, ModelLoad};
use crate::motion::VectorCurve;
use crate::scene::LoadFrame;
use crate::writer::Writer;
use nalgebra::Vector3;

/// A load, its geometry as features.
#[derive(Clone, Debug)]
pub enum Load {
    /// Force at a point of a body.
    Force {
        /// The body.
        body: usize,
        /// The point.
        local: Vector3<f64>,
        /// The force.
        force: VectorCurve,
        /// Its frame.
        frame: LoadFrame,
    },
    /// Moment on a body.
    Moment {
        /// The body.
        body: usize,
        /// The moment.
        moment: VectorCurve,
        /// Its frame.
        frame: LoadFrame,
    },
    /// Along the line between two points.
    Spring {
        /// Point on body i.
        from: FeatureId,
        /// Point on body j.
        to: FeatureId,
        /// Law of the length.
        element: Element,
    },
    /// About the axis of a joint.
    Torsion {
        /// The angle.
        angle: usize,
        /// Bodies i and j.
        bodies: [BodyRef; 2],
        /// Law of the angle.
        element: Element,
    },
    /// Along the axis of a joint.
    Slider {
        /// The axis, on body i.
        axis: FeatureId,
        /// P_j − P_i.
        between: Difference,
        /// Law of the displacement.
        element: Element,
    },
}

impl Load {
    /// Writes the features of a load.
    pub fn new(model: &Model, load: &ModelLoad, writer: &mut Writer) -> Self {
        match &load.kind {
            LoadKind::Force { body, local, force, frame } => {
                Self::Force { body: *body, local: *local, force: force.clone(), frame: *frame }
            }
            LoadKind::Moment { body, moment, frame } => {
                Self::Moment { body: *body, moment: moment.clone(), frame: *frame }
            }
            LoadKind::Spring { bodies, locals, element } => {
                let [from, to] = [0, 1].map(|side| writer.point(bodies[side], locals[side]));
                Self::Spring { from, to, element: element.clone() }
            }
            LoadKind::Torsion { joint, element } => {
                let joint = &model.joints[*joint];
                let angle = writer.angle(joint);
                Self::Torsion { angle, bodies: joint.bodies, element: element.clone() }
            }
            LoadKind::Slider { joint, element } => {
                let (axis, between) = writer.slide(&model.joints[*joint]);
                Self::Slider { axis: axis.plus, between, element: element.clone() }
            }
        }
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        match self {
            Self::Force { .. } | Self::Moment { .. } | Self::Torsion { .. } => {}
            Self::Spring { from, to, .. } => {
                *from = place[*from];
                *to = place[*to];
            }
            Self::Slider { axis, between, .. } => {
                *axis = place[*axis];
                between.plus = place[between.plus];
                between.minus = between.minus.map(|f| place[f]);
            }
        }
    }

    /// Adds its generalized force at time t; positions and velocities must be in place.
    pub fn apply(&self, at: &Elimination, t: f64, forces: &mut Forces) {
        match self {
            Self::Force { body, local, force, frame } => {
                let force = in_world(at, *body, *frame, force.at(t)[0]);
                forces.add_force(*body, local, &force);
            }
            Self::Moment { body, moment, frame } => {
                let moment = in_world(at, *body, *frame, moment.at(t)[0]);
                forces.add_moment(*body, &moment, &at.bodies[*body].q);
            }
            Self::Spring { element, .. } | Self::Torsion { element, .. } | Self::Slider { element, .. } => {
                if let Some((x, rate)) = self.coordinate(at) {
                    self.push(at, element.value(x, rate, t), forces);
                }
            }
        }
    }

    /// The length, angle or displacement that it acts along, and its rate. A spring of no length has no direction to
    /// pull in.
    fn coordinate(&self, at: &Elimination) -> Option<(f64, f64)> {
        match self {
            Self::Force { .. } | Self::Moment { .. } => None,
            Self::Spring { from, to, .. } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let rate = at.feature_rate(*to) - at.feature_rate(*from);
                let direction = between.try_normalize(f64::MIN_POSITIVE)?;
                Some((between.norm(), direction.dot(&rate)))
            }
            Self::Torsion { angle, .. } => Some((at.angles[*angle].value, at.angles[*angle].rate)),
            Self::Slider { axis, between, .. } => {
                let s = at.feature_value(*axis);
                let (d, rate) = (between.of(|f| at.feature_value(f)), between.of(|f| at.feature_rate(f)));
                Some((s.dot(&d), s.dot(&rate) + at.feature_rate(*axis).dot(&d)))
            }
        }
    }

    /// Adds the generalized force of a force or moment `value` along its coordinate: the gradient of the coordinate
    /// times that.
    fn push(&self, at: &Elimination, value: f64, forces: &mut Forces) {
        match self {
            Self::Force { .. } | Self::Moment { .. } => {}
            Self::Spring { from, to, .. } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let Some(direction) = between.try_normalize(f64::MIN_POSITIVE) else { return };
                forces.add_at_feature(*to, &(direction * value));
                forces.add_at_feature(*from, &(direction * -value));
            }
            Self::Torsion { angle, bodies, .. } => {
                let moment = at.feature_value(at.angle_axis(*angle)) * value;
                for (body, sign) in [(bodies[0], -1.0), (bodies[1], 1.0)] {
                    if let BodyRef::Moving(index) = body {
                        forces.add_moment(index, &(moment * sign), &at.bodies[index].q);
                    }
                }
            }
            Self::Slider { axis, between, .. } => {
                let s = at.feature_value(*axis);
                let d = between.of(|f| at.feature_value(f));
                forces.add_at_feature(between.plus, &(s * value));
                if let Some(minus) = between.minus {
                    forces.add_at_feature(minus, &(s * -value));
                }
                forces.add_at_feature(*axis, &(d * value));
            }
        }
    }

    /// Adds the generalized force of a unit force or moment along its coordinate, and returns its stiffness −∂f/∂x and
    /// its damping −∂f/∂ẋ; `None` for a load without a law. Positions and velocities must be in place.
    pub fn linearized(&self, at: &Elimination, forces: &mut Forces) -> Option<(f64, f64)> {
        let (Self::Spring { element, .. } | Self::Torsion { element, .. } | Self::Slider { element, .. }) =
            self
        else {
            return None;
        };
        let (_, rate) = self.coordinate(at)?;
        self.push(at, 1.0, forces);
        Some((element.stiffness, element.slope(rate)))
    }

    /// The greatest damping −∂f/∂ẋ that its law has at any speed.
    pub fn steepest_damping(&self) -> f64 {
        match self {
            Self::Force { .. } | Self::Moment { .. } => 0.0,
            Self::Spring { element, .. } | Self::Torsion { element, .. } | Self::Slider { element, .. } => {
                element.slope(0.0)
            }
        }
    }

    /// Whether it is a spring alone.
    pub fn is_conservative(&self) -> bool {
        match self {
            Self::Force { .. } | Self::Moment { .. } => false,
            Self::Spring { element, .. } | Self::Torsion { element, .. } | Self::Slider { element, .. } => {
                element.damping == 0.0 && element.drive.is_none() && element.friction.is_none()
            }
        }
    }

    /// Power of all that is not its spring, W; positions and velocities must be in place.
    pub fn power(&self, at: &Elimination) -> f64 {
        let t = at.time();
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
            Self::Spring { from, to, element } => {
                let between = at.feature_value(*to) - at.feature_value(*from);
                let rate = at.feature_rate(*to) - at.feature_rate(*from);
                let speed = between.try_normalize(f64::MIN_POSITIVE).map_or(0.0, |d| d.dot(&rate));
                element.without_spring(speed, t) * speed
            }
            Self::Torsion { angle, element, .. } => {
                let speed = at.angles[*angle].rate;
                element.without_spring(speed, t) * speed
            }
            Self::Slider { axis, between, element } => {
                let (d, rate) = (between.of(|f| at.feature_value(f)), between.of(|f| at.feature_rate(f)));
                let speed = at.feature_value(*axis).dot(&rate) + at.feature_rate(*axis).dot(&d);
                element.without_spring(speed, t) * speed
            }
        }
    }

    /// Potential energy of its spring, J.
    pub fn potential(&self, at: &Elimination) -> f64 {
        let (element, value) = match self {
            Self::Force { .. } | Self::Moment { .. } => return 0.0,
            Self::Spring { from, to, element } => {
                (element, (at.feature_value(*to) - at.feature_value(*from)).norm())
            }
            Self::Torsion { angle, element, .. } => (element, at.angles[*angle].value),
            Self::Slider { axis, between, element } => {
                (element, at.feature_value(*axis).dot(&between.of(|f| at.feature_value(f))))
            }
        };
        0.5 * element.stiffness * (value - element.free).powi(2)
    }
}

impl Element {
    /// Force or moment in the direction of growing x.
    fn value(&self, x: f64, rate: f64, t: f64) -> f64 {
        self.without_spring(rate, t) - self.stiffness * (x - self.free)
    }

    /// −∂f/∂ẋ.
    fn slope(&self, rate: f64) -> f64 {
        let friction = self.friction.map_or(0.0, |friction| {
            let tanh = (rate / friction.smoothing).tanh();
            friction.viscous + friction.coulomb / friction.smoothing * (1.0 - tanh * tanh)
        });
        self.damping + friction
    }

    /// The same without the spring.
    fn without_spring(&self, rate: f64, t: f64) -> f64 {
        let mut value = -self.damping * rate;
        if let Some(drive) = &self.drive {
            value += drive.at(t)[0];
        }
        if let Some(friction) = self.friction {
            value -= friction.viscous * rate + friction.coulomb * (rate / friction.smoothing).tanh();
        }
        value
    }
}

fn in_world(at: &Elimination, body: usize, frame: LoadFrame, vector: Vector3<f64>) -> Vector3<f64> {
    match frame {
        LoadFrame::World => vector,
        LoadFrame::Body => at.bodies[body].q.arm(&vector),
    }
}

/// Generalized applied forces of all bodies.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// G of each body.
    pub lifts: Vec<Lift>,
    features: Vec<Feature>,
}

impl Forces {
    /// For the bodies and features of a system.
    pub fn new(bodies: usize, features: &[Feature]) -> Self {
        Self { lifts: vec![Lift::default(); bodies], features: features.to_vec() }
    }

    /// Cᵀ f for the point or vector of a feature.
    fn add_at_feature(&mut self, feature: FeatureId, force: &Vector3<f64>) {
        let feature = self.features[feature];
        if let BodyRef::Moving(body) = feature.body {
            let lift = &mut self.lifts[body];
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
        let lift = &mut self.lifts[body];
        lift.r += force;
        for k in 0..3 {
            lift.e[k] += force * local[k];
        }
    }

    /// ½ τ × e_k on each director of a body.
    fn add_moment(&mut self, body: usize, moment: &Vector3<f64>, q: &Lift) {
        for k in 0..3 {
            self.lifts[body].e[k] += moment.cross(&q.e[k]) * 0.5;
        }
    }
}
