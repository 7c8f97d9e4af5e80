//! Loads with their motions ready to be evaluated.

use super::error::GeometryFault;
use super::reader::ModelReader;
use super::{BodyRef, ModelError};
use crate::model::motion::{Curve, VectorCurve};
use crate::scene::{Friction, JointKind, Load, LoadFrame};
use nalgebra::Vector3;

/// Greatest stiffness, damping or friction that a load may have, SI units: far above steel, far below overflow.
const MAX_COEFFICIENT: f64 = 1e15;
/// Greatest coefficient of friction: rubber on rubber has about 1.
const MAX_FRICTION: f64 = 100.0;
/// Least radius of a pin and length of a guide, m.
const MIN_LENGTH: f64 = 1e-9;

/// A checked load.
#[derive(Clone, Debug)]
pub struct ModelLoad {
    /// Name.
    pub name: String,
    /// What it does.
    pub kind: LoadKind,
}

/// −stiffness (x − free) − damping ẋ + drive(t) − friction, along one freedom.
#[derive(Clone, Debug)]
pub struct ForceLaw {
    /// Stiffness.
    pub stiffness: f64,
    /// x without force.
    pub free: f64,
    /// Damping.
    pub damping: f64,
    /// Prescribed force or torque.
    pub drive: Option<Curve>,
    /// Friction.
    pub friction: Option<Friction>,
}

impl ForceLaw {
    /// The first moment after t at which what is prescribed has another piece, s, or infinity.
    pub fn next_break(&self, t: f64) -> f64 {
        self.first(|drive| drive.next_break(t))
    }

    /// What is said of the prescribed force, or infinity.
    pub fn first(&self, of: impl Fn(&Curve) -> f64) -> f64 {
        self.drive.as_ref().map_or(f64::INFINITY, of)
    }

    /// Whether the length as such matters along the line between two points, so that the force turns round where they meet: not for the
    /// spring −k x.
    pub fn is_directed(&self) -> bool {
        self.free != 0.0 || self.damping != 0.0 || self.drive.is_some() || self.friction.is_some()
    }
}

/// What a load does; local coordinates are in principal frames.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Force at a point.
    Force {
        /// The body.
        body: usize,
        /// The point.
        local: Vector3<f64>,
        /// The force, in the world or in the principal frame.
        force: VectorCurve,
        /// Its frame.
        frame: LoadFrame,
    },
    /// Moment.
    Moment {
        /// The body.
        body: usize,
        /// The moment, in the world or in the principal frame.
        moment: VectorCurve,
        /// Its frame.
        frame: LoadFrame,
    },
    /// Between two points, along the line that joins them; x is the length.
    Spring {
        /// The two bodies.
        bodies: [BodyRef; 2],
        /// The two points.
        locals: [Vector3<f64>; 2],
        /// Its law.
        law: ForceLaw,
    },
    /// About the axis of a joint; x is the angle.
    Torsion {
        /// The joint.
        joint: usize,
        /// Its law.
        law: ForceLaw,
    },
    /// Along the axis of a joint; x is the displacement.
    Slider {
        /// The joint.
        joint: usize,
        /// Its law.
        law: ForceLaw,
    },
}

impl ModelLoad {
    /// Whether what it prescribes depends on the time.
    pub fn changes(&self) -> bool {
        match &self.kind {
            LoadKind::Force { force: curve, .. } | LoadKind::Moment { moment: curve, .. } => curve.changes(),
            LoadKind::Spring { law, .. } | LoadKind::Torsion { law, .. } | LoadKind::Slider { law, .. } => {
                law.drive.as_ref().is_some_and(Curve::changes)
            }
        }
    }

    /// Checks a load.
    pub(super) fn new(load: &Load, reader: &ModelReader) -> Result<Self, ModelError> {
        let kind = match load {
            Load::Force { body, point, force, frame, .. } => {
                let body = reader.moving_body("body", body)?;
                let point = reader.vector("point", *point)?;
                LoadKind::Force {
                    body,
                    local: reader.local_point(BodyRef::Moving(body), &point),
                    force: framed(reader, body, *frame, reader.vector_curve("force", force)?),
                    frame: *frame,
                }
            }
            Load::Moment { body, moment, frame, .. } => {
                let body = reader.moving_body("body", body)?;
                LoadKind::Moment {
                    body,
                    moment: framed(reader, body, *frame, reader.vector_curve("moment", moment)?),
                    frame: *frame,
                }
            }
            Load::Spring {
                body_i, point_i, body_j, point_j, stiffness, free_length, damping, force, ..
            } => {
                let bodies = [reader.body("body_i", body_i)?, reader.body("body_j", body_j)?];
                if bodies[0] == bodies[1] {
                    return Err(reader.wrong("body_j", "it acts between a body and itself"));
                }
                let points = [reader.vector("point_i", *point_i)?, reader.vector("point_j", *point_j)?];
                let locals = [0, 1].map(|side| reader.local_point(bodies[side], &points[side]));
                let ends = [0, 1].map(|side| reader.point_to_world(bodies[side], &locals[side]));
                let free = free_length.unwrap_or_else(|| (ends[1] - ends[0]).norm());
                let free = reader.number("free_length", free, 0.0, 1e9)?;
                // A spring pulls its ends together; a law pushes along growing length.
                let drive = force.as_ref().map(|f| reader.curve("force", f)).transpose()?.map(negated);
                let law = law(reader, *stiffness, free, *damping, drive, None)?;
                LoadKind::Spring { bodies, locals, law }
            }
            Load::Torsion { joint, stiffness, free_angle, damping, torque, friction, .. } => {
                let drive = torque.as_ref().map(|t| reader.curve("torque", t)).transpose()?;
                check_dry(reader, friction.as_ref(), true)?;
                LoadKind::Torsion {
                    joint: reader.joint(joint, &[JointKind::Revolute, JointKind::Cylindrical])?,
                    law: law(reader, *stiffness, *free_angle, *damping, drive, *friction)?,
                }
            }
            Load::Slider { joint, stiffness, free_length, damping, force, friction, .. } => {
                let drive = force.as_ref().map(|f| reader.curve("force", f)).transpose()?;
                check_dry(reader, friction.as_ref(), false)?;
                LoadKind::Slider {
                    joint: reader.joint(joint, &[JointKind::Prismatic, JointKind::Cylindrical])?,
                    law: law(reader, *stiffness, *free_length, *damping, drive, *friction)?,
                }
            }
        };
        Ok(Self { name: load.name().to_owned(), kind })
    }
}

/// Refuses friction with a coefficient that lacks the radius of its pin, or has what it does not use.
fn check_dry(reader: &ModelReader, friction: Option<&Friction>, turning: bool) -> Result<(), ModelError> {
    let Some(friction) = friction else { return Ok(()) };
    reader.number("friction/coefficient", friction.coefficient, 0.0, MAX_FRICTION)?;
    for (key, length) in [("friction/radius", friction.radius), ("friction/guide", friction.guide)] {
        if let Some(length) = length {
            reader.number(key, length, MIN_LENGTH, 1e9)?;
            if friction.coefficient == 0.0 {
                let reason = "its friction has a length, but no coefficient";
                return Err(reader.faulty(key, GeometryFault::TooMuch, reason));
            }
        }
    }
    match friction.radius {
        None if turning && friction.coefficient > 0.0 => Err(reader.wrong(
            "friction/coefficient",
            "friction with a coefficient about an axis needs the radius of its pin: give friction.radius, in m",
        )),
        Some(_) if !turning => {
            let reason = "friction along an axis has no radius: leave it out";
            Err(reader.faulty("friction/radius", GeometryFault::TooMuch, reason))
        }
        _ => Ok(()),
    }
}

/// A vector curve of the author's frame in the frame in which the load is evaluated.
fn framed(reader: &ModelReader, body: usize, frame: LoadFrame, curve: VectorCurve) -> VectorCurve {
    match frame {
        LoadFrame::World => curve,
        LoadFrame::Body => curve.rotated(&reader.bodies[body].principal_axes.transpose()),
    }
}

fn negated(curve: Curve) -> Curve {
    curve.scaled(-1.0)
}

fn law(
    reader: &ModelReader,
    stiffness: f64,
    free: f64,
    damping: f64,
    drive: Option<Curve>,
    friction: Option<Friction>,
) -> Result<ForceLaw, ModelError> {
    reader.number("stiffness", stiffness, 0.0, MAX_COEFFICIENT)?;
    reader.number("free", free, -1e9, 1e9)?;
    reader.number("damping", damping, 0.0, MAX_COEFFICIENT)?;
    if let Some(friction) = friction {
        reader.number("friction/viscous", friction.viscous, 0.0, MAX_COEFFICIENT)?;
        reader.number("friction/coulomb", friction.coulomb, 0.0, MAX_COEFFICIENT)?;
        reader.number("friction/smoothing", friction.smoothing, 1e-9, 1e9)?;
    }
    Ok(ForceLaw { stiffness, free, damping, drive, friction })
}
