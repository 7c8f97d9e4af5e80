//! Joints as lists of rows — THEORY section 5. A joint has no object at run time: it is rows.

use crate::model::{JointGeometry, Model, ModelJoint};
use crate::scene::AxisRows;
use crate::system::feature::{Difference, Target};
use crate::system::index::FeatureId;
use crate::system::row::Form;
use crate::system::row_builder::{ConstraintBlock, LabelledForm, RowBuilder};

/// Labels of perpendicularity rows (constant angle, right).
const CAR: [&str; 3] = ["CAR1", "CAR2", "CAR3"];
/// Labels of the rows that keep a point on a line.
const LINE: [&str; 2] = ["LINE1", "LINE2"];

/// Writes the rows of a joint.
pub fn build(model: &Model, joint: &ModelJoint, builder: &mut RowBuilder) {
    let forms = match joint.geometry {
        JointGeometry::Spherical => vec![common_point(joint, builder)],
        JointGeometry::Revolute { rows } => {
            let mut forms = vec![common_point(joint, builder)];
            forms.extend(revolute_axis(joint, rows, builder));
            forms
        }
        JointGeometry::Universal => {
            let [a, b] = [0, 1].map(|side| builder.vector(joint.bodies[side], joint.axes[side]));
            vec![common_point(joint, builder), LabelledForm::new("CAR", perpendicular(a, b))]
        }
        JointGeometry::Cylindrical => on_line(joint, builder).chain(common_axis(joint, builder)).collect(),
        JointGeometry::Prismatic => {
            let forms = on_line(joint, builder).chain(common_axis(joint, builder));
            let mut forms: Vec<LabelledForm> = forms.collect();
            forms.push(no_turn(joint, builder));
            forms
        }
        JointGeometry::Planar => {
            let mut forms = vec![in_plane(joint, builder)];
            forms.extend(common_axis(joint, builder));
            forms
        }
        JointGeometry::Screw { pitch } => {
            let mut forms: Vec<LabelledForm> =
                on_line(joint, builder).chain(common_axis(joint, builder)).collect();
            forms.push(LabelledForm::new("SCREW", thread(joint, pitch, builder)));
            forms
        }
        JointGeometry::Fixed => {
            let mut forms = vec![common_point(joint, builder)];
            forms.extend(common_axis(joint, builder));
            forms.push(no_turn(joint, builder));
            forms
        }
        JointGeometry::Rod { length } => vec![LabelledForm::new("DIST", distance(joint, length, builder))],
        JointGeometry::PointOnLine => on_line(joint, builder).collect(),
        JointGeometry::PointInPlane => vec![in_plane(joint, builder)],
        JointGeometry::Gear { joints, ratio, offset } => {
            let [first, second] = joints.map(|index| builder.angle(&model.joints[index]));
            let angles = [Some((first, -ratio)), Some((second, 1.0))];
            let form = Form::Relation { angles, slide: None, constant: offset };
            vec![LabelledForm::new("GEAR", form)]
        }
    };
    let (name, bodies, points) = (joint.name.clone(), joint.bodies, joint.points);
    builder.constraints.push(ConstraintBlock { name, forms, bodies, points, driver: false });
}

/// P_i = P_j (CP).
fn common_point(joint: &ModelJoint, builder: &mut RowBuilder) -> LabelledForm {
    let [a, b] = [0, 1].map(|side| builder.point(joint.bodies[side], joint.points[side]));
    LabelledForm::new("CP", Form::Coincidence { a, b })
}

/// The axis of a revolute joint: two perpendicularity rows (CAR), or a common vector (CV) that shared directors may satisfy by
/// themselves.
fn revolute_axis(joint: &ModelJoint, rows: AxisRows, builder: &mut RowBuilder) -> Vec<LabelledForm> {
    let (label, implied) = match rows {
        AxisRows::TwoCar => return common_axis(joint, builder),
        AxisRows::Cv => ("CV", false),
        AxisRows::Shared => ("CV (shared)", true),
    };
    let [a, b] = [0, 1].map(|side| builder.vector(joint.bodies[side], joint.axes[side]));
    vec![LabelledForm { label, form: Form::CommonVector { a, b }, implied }]
}

/// The axis of body j is perpendicular to two vectors of body i (2 CAR) — eq. (5.1).
fn common_axis(joint: &ModelJoint, builder: &mut RowBuilder) -> Vec<LabelledForm> {
    let [i, j] = joint.bodies;
    let s = builder.vector(j, joint.axes[1]);
    let across = joint.cross[0].map(|t| builder.vector(i, t));
    CAR.into_iter().zip(across).map(|(label, t)| LabelledForm::new(label, perpendicular(t, s))).collect()
}

/// Vectors across the axis that coincide at the start stay perpendicular in pairs (CAR).
fn no_turn(joint: &ModelJoint, builder: &mut RowBuilder) -> LabelledForm {
    let [i, j] = joint.bodies;
    let (a, b) = (builder.vector(i, joint.cross[0][0]), builder.vector(j, joint.cross[1][1]));
    LabelledForm::new(CAR[2], perpendicular(a, b))
}

/// P_j lies on the line through P_i along the axis of body i.
fn on_line(joint: &ModelJoint, builder: &mut RowBuilder) -> impl Iterator<Item = LabelledForm> + use<> {
    let [i, j] = joint.bodies;
    let between = Difference {
        plus: builder.point(j, joint.points[1]),
        minus: Some(builder.point(i, joint.points[0])),
    };
    let across = joint.cross[0].map(|t| builder.vector(i, t));
    LINE.into_iter().zip(across).map(move |(label, t)| {
        let form = Form::Product { a: Difference::one(t), b: between, target: Target::Constant(0.0) };
        LabelledForm::new(label, form)
    })
}

/// P_j lies in the plane through P_i normal to the axis of body i.
fn in_plane(joint: &ModelJoint, builder: &mut RowBuilder) -> LabelledForm {
    let (a, b) = builder.slide(joint);
    LabelledForm::new("PLANE", Form::Product { a, b, target: Target::Constant(0.0) })
}

/// |P_j − P_i|² = L².
fn distance(joint: &ModelJoint, length: f64, builder: &mut RowBuilder) -> Form {
    let [i, j] = joint.bodies;
    let between = Difference {
        plus: builder.point(j, joint.points[1]),
        minus: Some(builder.point(i, joint.points[0])),
    };
    Form::Product { a: between, b: between, target: Target::Constant(length * length) }
}

/// Displacement − pitch · angle = 0.
fn thread(joint: &ModelJoint, pitch: f64, builder: &mut RowBuilder) -> Form {
    let angle = builder.angle(joint);
    let (a, b) = builder.slide(joint);
    Form::Relation { angles: [Some((angle, -pitch)), None], slide: Some((a, b, 1.0)), constant: 0.0 }
}

/// s₁ · s₂ = 0 (CAR of 90°).
fn perpendicular(a: FeatureId, b: FeatureId) -> Form {
    Form::Product { a: Difference::one(a), b: Difference::one(b), target: Target::Constant(0.0) }
}
