//! Loads, their geometry written in features — THEORY section 6.

use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, ForceLaw, LoadKind, Model, ModelLoad};
use crate::scene::{Friction, LoadFrame};
use crate::system::feature::Difference;
use crate::system::index::FeatureId;
use crate::system::row_builder::RowBuilder;
use nalgebra::{Matrix3, Vector3};

/// A load, its geometry as features.
#[derive(Clone, Debug)]
pub enum SystemLoad {
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
        law: ForceLaw,
    },
    /// About the axis of a joint.
    Torsion {
        /// The angle.
        angle: usize,
        /// Its axis.
        axis: FeatureId,
        /// Bodies i and j.
        bodies: [BodyRef; 2],
        /// Law of the angle.
        law: ForceLaw,
    },
    /// Along the axis of a joint.
    Slider {
        /// The axis, on body i.
        axis: FeatureId,
        /// P_j − P_i.
        between: Difference,
        /// Law of the displacement.
        law: ForceLaw,
    },
}

impl SystemLoad {
    /// Writes the features of a load.
    pub fn new(model: &Model, load: &ModelLoad, builder: &mut RowBuilder) -> Self {
        match &load.kind {
            LoadKind::Force { body, local, force, frame } => {
                Self::Force { body: *body, local: *local, force: force.clone(), frame: *frame }
            }
            LoadKind::Moment { body, moment, frame } => {
                Self::Moment { body: *body, moment: moment.clone(), frame: *frame }
            }
            LoadKind::Spring { bodies, locals, law } => {
                let [from, to] = [0, 1].map(|side| builder.point(bodies[side], locals[side]));
                Self::Spring { from, to, law: law.clone() }
            }
            LoadKind::Torsion { joint, law } => {
                let joint = &model.joints[*joint];
                let angle = builder.angle(joint);
                let axis = builder.angles[angle].axis;
                Self::Torsion { angle, axis, bodies: joint.bodies, law: law.clone() }
            }
            LoadKind::Slider { joint, law } => {
                let (axis, between) = builder.slide(&model.joints[*joint]);
                Self::Slider { axis: axis.plus, between, law: law.clone() }
            }
        }
    }

    /// The features that its force depends on or acts on.
    pub fn features(&self) -> Vec<FeatureId> {
        match self {
            Self::Force { .. } | Self::Moment { .. } => Vec::new(),
            Self::Spring { from, to, .. } => vec![*from, *to],
            Self::Torsion { axis, .. } => vec![*axis],
            Self::Slider { axis, between, .. } => {
                [*axis, between.plus].into_iter().chain(between.minus).collect()
            }
        }
    }

    /// Writes it in frames that stand otherwise: in a body's new one a point is `turn` times what lies between `origin` and it. What has
    /// no new frame stays.
    pub fn turn(
        &mut self,
        of_body: impl Fn(usize) -> Option<(Matrix3<f64>, Vector3<f64>)>,
        of_world: Option<&Matrix3<f64>>,
    ) {
        let (body, curve, frame) = match self {
            Self::Force { body, local, force, frame } => {
                if let Some((turn, origin)) = of_body(*body) {
                    *local = turn * (*local - origin);
                }
                (*body, force, *frame)
            }
            Self::Moment { body, moment, frame } => (*body, moment, *frame),
            Self::Spring { .. } | Self::Torsion { .. } | Self::Slider { .. } => return,
        };
        let turn = match frame {
            LoadFrame::Body => of_body(body).map(|(turn, _)| turn),
            LoadFrame::World => of_world.copied(),
        };
        if let Some(turn) = turn {
            *curve = curve.clone().rotated(&turn);
        }
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        match self {
            Self::Force { .. } | Self::Moment { .. } => {}
            Self::Torsion { axis, .. } => *axis = place[axis.index()],
            Self::Spring { from, to, .. } => {
                *from = place[from.index()];
                *to = place[to.index()];
            }
            Self::Slider { axis, between, .. } => {
                *axis = place[axis.index()];
                between.rename(place);
            }
        }
    }

    /// The law of one that acts along a length, an angle or a displacement; `None` for a force or moment.
    pub fn law(&self) -> Option<&ForceLaw> {
        match self {
            Self::Force { .. } | Self::Moment { .. } => None,
            Self::Spring { law, .. } | Self::Torsion { law, .. } | Self::Slider { law, .. } => Some(law),
        }
    }

    /// Its dry friction.
    pub fn dry_friction(&self) -> Option<Friction> {
        let friction = self.law()?.friction?;
        (friction.coulomb > 0.0 || friction.coefficient > 0.0).then_some(friction)
    }

    /// The greatest damping −∂f/∂ẋ that its law has at any speed.
    pub fn steepest_damping(&self) -> f64 {
        self.law().map_or(0.0, |law| law.slope(0.0))
    }

    /// Whether it is a spring alone.
    pub fn is_conservative(&self) -> bool {
        self.law().is_some_and(|law| law.damping == 0.0 && law.drive.is_none() && law.friction.is_none())
    }
}

impl ForceLaw {
    /// Potential energy of its spring at x, J.
    pub(crate) fn potential(&self, x: f64) -> f64 {
        let stretch = x - self.free;
        0.5 * self.stiffness * stretch * stretch
    }

    /// Force or moment in the direction of growing x — eq. (6.9).
    pub(crate) fn value(&self, x: f64, rate: f64, t: f64) -> f64 {
        self.without_spring(rate, t) - self.stiffness * (x - self.free)
    }

    /// The largest of the parts that it is the sum of at rest, where lengths are known as well as `reach` is.
    pub(crate) fn largest_part(&self, x: f64, reach: f64, t: f64) -> f64 {
        let drive = self.drive.as_ref().map_or(0.0, |drive| drive.at(t)[0].abs());
        drive.max(self.stiffness * x.abs().max(self.free.abs()).max(reach))
    }

    /// −∂f/∂ẋ.
    pub(crate) fn slope(&self, rate: f64) -> f64 {
        let friction = self.friction.map_or(0.0, |friction| {
            let tanh = libm::tanh(rate / friction.smoothing);
            friction.viscous + friction.coulomb / friction.smoothing * (1.0 - tanh * tanh)
        });
        self.damping + friction
    }

    /// Force or moment without that of the spring.
    pub fn without_spring(&self, rate: f64, t: f64) -> f64 {
        let mut value = -self.damping * rate;
        if let Some(drive) = &self.drive {
            value += drive.at(t)[0];
        }
        if let Some(friction) = self.friction {
            value -= friction.viscous * rate + friction.coulomb * libm::tanh(rate / friction.smoothing);
        }
        value
    }
}
