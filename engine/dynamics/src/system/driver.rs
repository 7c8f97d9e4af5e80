//! Drivers as lists of rows — THEORY section 5.

use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, DriverKind, Model, ModelDriver};
use crate::system::feature::{Difference, Target};
use crate::system::row::Form;
use crate::system::row_builder::{LabelledForm, Writer, WrittenGroup};
use nalgebra::Vector3;

/// Writes the rows of a driver.
pub fn write(model: &Model, driver: &ModelDriver, writer: &mut Writer) {
    let origin = Vector3::zeros();
    let ground = BodyRef::Ground;
    let (bodies, points, label, form) = match &driver.kind {
        DriverKind::Point { body, local, motion } => {
            let body = BodyRef::Moving(*body);
            let a = writer.point(body, *local);
            let b = writer.moving(ground, true, motion.clone());
            ([ground, body], [origin, *local], "TP", Form::Coincidence { a, b })
        }
        DriverKind::Vector { body, local, motion } => {
            let body = BodyRef::Moving(*body);
            let a = writer.vector(body, *local);
            let b = writer.moving(ground, false, motion.clone());
            ([ground, body], [origin; 2], "OV", Form::CommonVector { a, b })
        }
        DriverKind::Angle { joint, motion } => {
            // b stays perpendicular to a₂ of body i turned by θ*(t): regular at every angle — eq. (5.3).
            let joint = &model.joints[*joint];
            let [i, j] = joint.bodies;
            let turned = VectorCurve::turning(&joint.cross[0][1], &joint.axes[0], motion.clone());
            let a = Difference::one(writer.moving(i, false, turned));
            let b = Difference::one(writer.vector(j, joint.cross[1][0]));
            let form = Form::Product { a, b, target: Target::Constant(0.0) };
            (joint.bodies, joint.points, "ANGLE", form)
        }
        DriverKind::Slide { joint, motion } => {
            let joint = &model.joints[*joint];
            let (a, b) = writer.slide(joint);
            let target = writer.target(motion.clone(), false);
            (joint.bodies, joint.points, "SLIDE", Form::Product { a, b, target })
        }
        DriverKind::Cosine { bodies, locals, motion } => {
            let [a, b] = [0, 1].map(|side| Difference::one(writer.vector(bodies[side], locals[side])));
            let target = writer.target(motion.clone(), true);
            (*bodies, [origin; 2], "AR", Form::Product { a, b, target })
        }
        DriverKind::CosineToWorld { body, local, reference, motion } => {
            let body = BodyRef::Moving(*body);
            let a = Difference::one(writer.vector(body, *local));
            let b = Difference::one(writer.moving(ground, false, reference.clone()));
            let target = writer.target(motion.clone(), true);
            ([ground, body], [origin; 2], "AR*", Form::Product { a, b, target })
        }
    };
    let (name, forms) = (driver.name.clone(), vec![LabelledForm::new(label, form)]);
    writer.groups.push(WrittenGroup { name, forms, bodies, points, driver: true });
}
