//! Drivers with their motions ready to be evaluated.

use super::error::GeometryFault;
use super::reader::ModelReader;
use super::{BodyRef, ModelError};
use crate::model::motion::{Curve, VectorCurve};
use crate::scene::{Driver, Motion, VectorMotion};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Least sine of an angle that is prescribed through its cosine.
const LEAST_SINE: f64 = 1e-3;
/// Parts of a step in which such an angle is looked at for where it turns back, which so many bisections find.
const LOOKED_AT: u32 = 8;
const BISECTIONS: u32 = 40;
/// Parts of the run at whose ends the length of a direction is looked at.
const LENGTHS: u32 = 16;

/// A checked driver.
#[derive(Clone, Debug)]
pub struct ModelDriver {
    /// Name.
    pub name: String,
    /// What it prescribes.
    pub kind: DriverKind,
}

/// What a driver prescribes; local coordinates are in principal frames.
#[derive(Clone, Debug)]
pub enum DriverKind {
    /// A point follows a path (TP).
    Point {
        /// The body.
        body: usize,
        /// The point.
        local: Vector3<f64>,
        /// Its path.
        motion: VectorCurve,
    },
    /// A vector follows a vector (OV).
    Vector {
        /// The body.
        body: usize,
        /// The vector.
        local: Vector3<f64>,
        /// Its direction.
        motion: VectorCurve,
    },
    /// The angle of a joint.
    Angle {
        /// The joint.
        joint: usize,
        /// The angle, rad.
        motion: Curve,
    },
    /// The displacement of a joint.
    Slide {
        /// The joint.
        joint: usize,
        /// The displacement, m.
        motion: Curve,
    },
    /// The cosine of the angle between two vectors (AR).
    Cosine {
        /// The two bodies.
        bodies: [BodyRef; 2],
        /// The two vectors.
        locals: [Vector3<f64>; 2],
        /// The angle, rad.
        motion: Curve,
    },
    /// The cosine of the angle between a vector and a moving vector of the world (AR*).
    CosineToWorld {
        /// The body.
        body: usize,
        /// Its vector.
        local: Vector3<f64>,
        /// The vector of the world.
        reference: VectorCurve,
        /// The angle, rad.
        motion: Curve,
    },
}

impl DriverKind {
    /// Holds what it prescribes as it is at time t.
    pub fn hold(&mut self, t: f64) {
        match self {
            Self::Point { motion, .. } | Self::Vector { motion, .. } => *motion = motion.held(t),
            Self::Angle { motion, .. } | Self::Slide { motion, .. } | Self::Cosine { motion, .. } => {
                *motion = motion.held(t);
            }
            Self::CosineToWorld { reference, motion, .. } => {
                (*reference, *motion) = (reference.held(t), motion.held(t));
            }
        }
    }
}

impl ModelDriver {
    /// Checks a driver.
    pub(super) fn new(driver: &Driver, reader: &ModelReader) -> Result<Self, ModelError> {
        let vector = |body: usize, key: &str, value| {
            Ok::<_, ModelError>(reader.local_vector(BodyRef::Moving(body), &reader.unit(key, value)?))
        };
        let kind = match driver {
            Driver::Point { body, point, motion, .. } => {
                let body = reader.moving_body("body", body)?;
                let point = reader.vector("point", *point)?;
                DriverKind::Point {
                    body,
                    local: reader.local_point(BodyRef::Moving(body), &point),
                    motion: reader.vector_curve("motion", motion)?,
                }
            }
            Driver::Vector { body, vector: local, motion, .. } => {
                let body = reader.moving_body("body", body)?;
                let local = vector(body, "vector", *local)?;
                DriverKind::Vector { body, local, motion: direction(reader, "motion", motion)? }
            }
            Driver::Angle { joint, motion, .. } => DriverKind::Angle {
                joint: reader.joint_with_angle(joint)?,
                motion: reader.curve("motion", motion)?,
            },
            Driver::Slide { joint, motion, .. } => DriverKind::Slide {
                joint: reader.joint_with_displacement(joint)?,
                motion: reader.curve("motion", motion)?,
            },
            Driver::AngleCosine { body_i, vector_i, body_j, vector_j, motion, .. } => {
                let bodies = [reader.body("body_i", body_i)?, reader.body("body_j", body_j)?];
                if bodies[0] == bodies[1] {
                    return Err(reader.wrong("body_j", "it drives a body relative to itself"));
                }
                DriverKind::Cosine {
                    bodies,
                    locals: [
                        reader.local_vector(bodies[0], &reader.unit("vector_i", *vector_i)?),
                        reader.local_vector(bodies[1], &reader.unit("vector_j", *vector_j)?),
                    ],
                    motion: angle_between(reader, motion)?,
                }
            }
            Driver::AngleToWorld { body, vector: local, reference, motion, .. } => {
                let body = reader.moving_body("body", body)?;
                DriverKind::CosineToWorld {
                    body,
                    local: vector(body, "vector", *local)?,
                    reference: direction(reader, "reference", reference)?,
                    motion: angle_between(reader, motion)?,
                }
            }
        };
        Ok(Self { name: driver.name().to_owned(), kind })
    }

    /// Where an angle that is prescribed through its cosine gets in a step, also by turning back within it, where that tells of it no more:
    /// the time and the angle.
    pub fn lost_angle(&self, [from, to]: [f64; 2]) -> Option<(f64, f64)> {
        let (DriverKind::Cosine { motion, .. } | DriverKind::CosineToWorld { motion, .. }) = &self.kind
        else {
            return None;
        };
        let side = |angle: f64| (angle / PI).floor();
        let start = side(motion.at(0.0)[0]);
        let lost = |t: f64| {
            let angle = motion.at(t)[0];
            (is_along(angle) || side(angle) != start).then_some((t, angle))
        };
        let part = |k: u32| from + (to - from) * f64::from(k) / f64::from(LOOKED_AT);
        (0..LOOKED_AT).find_map(|k| {
            let within = [part(k), part(k + 1)];
            turning_point(motion, within).and_then(lost).or_else(|| lost(within[1]))
        })
    }
}

/// When a motion turns back between two times, if its rates there differ in sign.
fn turning_point(motion: &Curve, [mut before, mut after]: [f64; 2]) -> Option<f64> {
    let rate = |t: f64| motion.at(t)[1];
    if rate(before) * rate(after) >= 0.0 {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (before + after);
        if rate(before) * rate(middle) > 0.0 { before = middle } else { after = middle }
    }
    Some(after)
}

/// A direction in the world: a vector that keeps its length is made a unit vector, and components have to be those of one.
fn direction(reader: &ModelReader, key: &str, motion: &VectorMotion) -> Result<VectorCurve, ModelError> {
    let unit = match motion {
        VectorMotion::Fixed { vector } => {
            VectorMotion::Fixed { vector: reader.unit(&format!("{key}/vector"), *vector)?.into() }
        }
        VectorMotion::Turning { start, axis, angle } => {
            let start = reader.unit(&format!("{key}/start"), *start)?.into();
            VectorMotion::Turning { start, axis: *axis, angle: angle.clone() }
        }
        VectorMotion::Components { .. } => motion.clone(),
    };
    let curve = reader.vector_curve(key, &unit)?;
    for part in 0..=LENGTHS {
        let t = reader.duration * f64::from(part) / f64::from(LENGTHS);
        let length = curve.at(t)[0].norm();
        if (length - 1.0).abs() > 1e-6 {
            let reason =
                format!("the direction that it follows has the length {length} at t = {t:.6} s, not 1");
            return Err(reader.faulty(key, GeometryFault::Unit, reason));
        }
    }
    Ok(curve)
}

/// An angle between vectors that does not begin where its cosine tells nothing of it.
fn angle_between(reader: &ModelReader, motion: &Motion) -> Result<Curve, ModelError> {
    let curve = reader.curve("motion", motion)?;
    let angle = curve.at(0.0)[0];
    if is_along(angle) {
        let reason = format!(
            "it prescribes the cosine of an angle that begins with {angle} rad: at 0 and pi the cosine does not change with the angle, \
             and holds nothing"
        );
        return Err(reader.faulty("motion", GeometryFault::Cosine, reason));
    }
    Ok(curve)
}

/// Whether vectors at this angle are along each other: rounding ε of its cosine is one of ε/sin² in forces.
fn is_along(angle: f64) -> bool {
    libm::sin(angle).abs() < LEAST_SINE
}
