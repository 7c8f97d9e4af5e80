//! Collecting features, curves and rows while a system is assembled.

use crate::model::motion::{Curve, VectorCurve};
use crate::model::{BodyRef, ModelJoint};
use crate::system::angle::Angle;
use crate::system::feature::{Difference, Feature, Target, TargetCurve};
use crate::system::index::FeatureId;
use crate::system::row::Form;
use nalgebra::Vector3;
use std::collections::HashMap;

/// A row form with the label under which its equations are shown.
#[derive(Clone, Copy, Debug)]
pub struct LabelledForm {
    /// The label.
    pub label: &'static str,
    /// The form.
    pub form: Form,
    /// Whether shared coordinates satisfy it by themselves.
    pub implied: bool,
}

impl LabelledForm {
    /// A row that is written.
    pub fn new(label: &'static str, form: Form) -> Self {
        Self { label, form, implied: false }
    }
}

/// The rows of one joint or driver.
#[derive(Clone, Debug)]
pub struct ConstraintBlock {
    /// Its name.
    pub name: String,
    /// Its rows.
    pub forms: Vec<LabelledForm>,
    /// Bodies i and j.
    pub bodies: [BodyRef; 2],
    /// The point on each body about which its reaction is stated.
    pub points: [Vector3<f64>; 2],
    /// Whether it is a driver.
    pub driver: bool,
}

/// Bits of a feature, for recognising the same one again.
type FeatureKey = (BodyRef, bool, [u64; 3], Option<usize>);

/// What has been written so far.
#[derive(Debug, Default)]
pub struct RowBuilder {
    /// Features in the order of their first use.
    pub features: Vec<Feature>,
    /// Curves of features.
    pub curves: Vec<VectorCurve>,
    /// Prescribed numbers.
    pub targets: Vec<TargetCurve>,
    /// Angles.
    pub angles: Vec<Angle>,
    /// Joints and drivers.
    pub constraints: Vec<ConstraintBlock>,
    /// The joint of each angle.
    pub angle_joints: Vec<String>,
    known: HashMap<FeatureKey, FeatureId>,
    angle_of_joint: HashMap<String, usize>,
}

impl RowBuilder {
    fn feature(&mut self, feature: Feature) -> FeatureId {
        let bits = [0, 1, 2].map(|k| feature.local[k].to_bits());
        let key = (feature.body, feature.point, bits, feature.curve);
        *self.known.entry(key).or_insert_with(|| {
            self.features.push(feature);
            FeatureId(self.features.len() - 1)
        })
    }

    /// A point fixed in a body.
    pub fn point(&mut self, body: BodyRef, local: Vector3<f64>) -> FeatureId {
        self.feature(Feature { body, point: true, local, curve: None })
    }

    /// A vector fixed in a body.
    pub fn vector(&mut self, body: BodyRef, local: Vector3<f64>) -> FeatureId {
        self.feature(Feature { body, point: false, local, curve: None })
    }

    /// A point or vector that moves in a body, or in the world.
    pub fn moving(&mut self, body: BodyRef, point: bool, curve: VectorCurve) -> FeatureId {
        self.curves.push(curve);
        self.feature(Feature { body, point, local: Vector3::zeros(), curve: Some(self.curves.len() - 1) })
    }

    /// A prescribed number.
    pub fn target(&mut self, curve: Curve, cosine: bool) -> Target {
        self.targets.push(TargetCurve { curve, cosine });
        Target::Driven(self.targets.len() - 1)
    }

    /// The angle of a joint.
    pub fn angle(&mut self, joint: &ModelJoint) -> usize {
        if let Some(&known) = self.angle_of_joint.get(&joint.name) {
            return known;
        }
        let [i, j] = joint.bodies;
        let angle = Angle {
            a1: self.vector(i, joint.cross[0][0]),
            a2: self.vector(i, joint.cross[0][1]),
            b: self.vector(j, joint.cross[1][0]),
            axis: self.vector(i, joint.axes[0]),
        };
        self.angles.push(angle);
        self.angle_joints.push(joint.name.clone());
        self.angle_of_joint.insert(joint.name.clone(), self.angles.len() - 1);
        self.angles.len() - 1
    }

    /// The displacement of a joint as a product: axis · (P_j − P_i).
    pub fn slide(&mut self, joint: &ModelJoint) -> (Difference, Difference) {
        let [i, j] = joint.bodies;
        let axis = self.vector(i, joint.axes[0]);
        let [from, to] = [self.point(i, joint.points[0]), self.point(j, joint.points[1])];
        (Difference::one(axis), Difference { plus: to, minus: Some(from) })
    }

    /// Orders features: fixed in moving bodies, then moving as prescribed, then fixed in the ground.
    pub fn sort_features(&mut self) -> Vec<FeatureId> {
        let mut order: Vec<usize> = (0..self.features.len()).collect();
        order.sort_by_key(|&f| (self.features[f].is_fixed(), self.features[f].curve.is_some()));
        let mut place = vec![FeatureId(0); order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = FeatureId(new);
        }
        self.features = order.iter().map(|&old| self.features[old]).collect();
        for written in self.constraints.iter_mut().flat_map(|g| &mut g.forms) {
            written.form.rename(&place);
        }
        for angle in &mut self.angles {
            angle.rename(&place);
        }
        place
    }
}
