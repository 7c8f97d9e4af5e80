//! Joints as lists of rows — THEORY section 5. A joint has no object at run time: it only writes rows.

use crate::model::{BodyRef, ModelJoint};
use crate::row::{Difference, Feature, FeatureId, Form, across};
use crate::scene::{AxisRows, JointKind};
use nalgebra::Vector3;

/// A row form with the label under which its equations are shown.
pub type LabelledForm = (&'static str, Form);

/// Writes the rows of a joint; `feature` stores a feature and returns its place.
pub fn rows(joint: &ModelJoint, mut feature: impl FnMut(Feature) -> FeatureId) -> Vec<LabelledForm> {
    let [i, j] = joint.bodies;
    let mut point = |body: BodyRef, local: Vector3<f64>| feature(Feature { body, point: true, local });
    let [a, b] = [point(i, joint.points[0]), point(j, joint.points[1])];
    let mut vector = |body: BodyRef, local: Vector3<f64>| feature(Feature { body, point: false, local });
    let mut forms = vec![("CP", Form::Coincidence { a, b })];
    let [axis_i, axis_j] = joint.axes;
    match (joint.kind, joint.rows) {
        (JointKind::Spherical, _) => {}
        (JointKind::Revolute, AxisRows::Cv) => {
            forms.push(("CV", Form::CommonVector { a: vector(i, axis_i), b: vector(j, axis_j) }));
        }
        (JointKind::Revolute, AxisRows::TwoCar) => {
            let s = vector(j, axis_j);
            for (label, t) in ["CAR1", "CAR2"].into_iter().zip(across(&axis_i)) {
                forms.push((label, perpendicular(vector(i, t), s)));
            }
        }
        (JointKind::Universal, _) => {
            forms.push(("CAR", perpendicular(vector(i, axis_i), vector(j, axis_j))));
        }
    }
    forms
}

/// s₁ · s₂ = 0 (CAR of 90°).
fn perpendicular(a: FeatureId, b: FeatureId) -> Form {
    let one = |plus| Difference { plus, minus: None };
    Form::Product { a: one(a), b: one(b), constant: 0.0 }
}
