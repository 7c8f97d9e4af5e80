//! Drivers as lists of rows — THEORY section 5.

use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, DriverKind, Model, ModelDriver};
use crate::system::feature::{Difference, Target};
use crate::system::row::Form;
use crate::system::row_builder::{ConstraintBlock, LabelledForm, RowBuilder};
use nalgebra::Vector3;

/// Writes the rows of a driver.
pub fn build(model: &Model, driver: &ModelDriver, builder: &mut RowBuilder) {
    let origin = Vector3::zeros();
    let ground = BodyRef::Ground;
    let (bodies, points, label, form) = match &driver.kind {
        DriverKind::Point { body, local, motion } => {
            let body = BodyRef::Moving(*body);
            let a = builder.point(body, *local);
            let b = builder.moving(ground, true, motion.clone());
            ([ground, body], [origin, *local], "TP", Form::Coincidence { a, b })
        }
        DriverKind::Vector { body, local, motion } => {
            let body = BodyRef::Moving(*body);
            let a = builder.vector(body, *local);
            let b = builder.moving(ground, false, motion.clone());
            ([ground, body], [origin; 2], "OV", Form::CommonVector { a, b })
        }
        DriverKind::Angle { joint, motion } => {
            // b stays perpendicular to a₂ of body i turned by θ*(t): regular at every angle — eq. (5.3).
            let joint = &model.joints[*joint];
            let [i, j] = joint.bodies;
            let turned = VectorCurve::turning(&joint.cross[0][1], &joint.axes[0], motion.clone());
            let a = Difference::one(builder.moving(i, false, turned));
            let b = Difference::one(builder.vector(j, joint.cross[1][0]));
            let form = Form::Product { a, b, target: Target::Constant(0.0) };
            (joint.bodies, joint.points, "ANGLE", form)
        }
        DriverKind::Slide { joint, motion } => {
            let joint = &model.joints[*joint];
            let (a, b) = builder.slide(joint);
            let target = builder.target(motion.clone(), false);
            (joint.bodies, joint.points, "SLIDE", Form::Product { a, b, target })
        }
        DriverKind::Cosine { bodies, locals, motion } => {
            let [a, b] = [0, 1].map(|side| Difference::one(builder.vector(bodies[side], locals[side])));
            let target = builder.target(motion.clone(), true);
            (*bodies, [origin; 2], "AR", Form::Product { a, b, target })
        }
        DriverKind::CosineToWorld { body, local, reference, motion } => {
            let body = BodyRef::Moving(*body);
            let a = Difference::one(builder.vector(body, *local));
            let b = Difference::one(builder.moving(ground, false, reference.clone()));
            let target = builder.target(motion.clone(), true);
            ([ground, body], [origin; 2], "AR*", Form::Product { a, b, target })
        }
    };
    let (name, forms) = (driver.name.clone(), vec![LabelledForm::new(label, form)]);
    builder.constraints.push(ConstraintBlock { name, forms, bodies, points, driver: true });
}
