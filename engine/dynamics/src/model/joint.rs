//! A joint with its geometry in the principal frames of its two bodies.

use super::error::GeometryFault;
use super::gear::wheels;
use super::joint_keys::{AxisKeys, KnownKeys, OwnKeys, PointKeys, refuse_strangers};
use super::reader::ModelReader;
use super::{BodyRef, ModelError};
use crate::scene::{AxisRows, Coordinates, Joint, JointKind};
use nalgebra::{Rotation3, Vector3};
use triad_linalg::orthonormal_basis;

/// Greatest difference of |component| from 1 at which a unit axis lies along a director: rounding of an axis that was turned
/// into the principal frame.
const ALONG: f64 = 1e-9;
/// Least and greatest length of a rod, m.
const MIN_ROD: f64 = 1e-9;
const MAX_ROD: f64 = 1e9;

/// The director (0, 1, 2 for u, v, w) that a local unit axis lies along, and its sign.
pub fn director_along(axis: &Vector3<f64>) -> Option<(usize, f64)> {
    let k = axis.iamax();
    ((axis[k].abs() - 1.0).abs() < ALONG).then(|| (k, axis[k].signum()))
}

/// What a joint is, with the data of its kind alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointGeometry {
    /// A common point.
    Spherical,
    /// A common point and a common axis.
    Revolute {
        /// How the axis is written.
        rows: AxisRows,
    },
    /// A common point and two axes that stay perpendicular, one in each body.
    Universal,
    /// A common axis, along and about which body j moves.
    Cylindrical,
    /// A common axis, along which body j slides without turning.
    Prismatic,
    /// A common plane, normal to the axis.
    Planar,
    /// A common axis, along which body j moves as it turns.
    Screw {
        /// Advance, m/rad.
        pitch: f64,
    },
    /// No relative motion.
    Fixed,
    /// A rigid massless bar between a point of each body.
    Rod {
        /// Its length, m.
        length: f64,
    },
    /// The point of body j stays on the line of body i through its point along the axis.
    PointOnLine,
    /// The point of body j stays in the plane of body i through its point, normal to the axis.
    PointInPlane,
    /// The angle of one revolute joint is a multiple of that of another, or that far from one.
    Gear {
        /// The two joints.
        joints: [usize; 2],
        /// Angle of the second for each radian of the first.
        ratio: f64,
        /// Angle of the second where that of the first is zero, rad.
        offset: f64,
    },
}

impl JointGeometry {
    /// Whether its axis is the normal of the plane in which one body moves relative to the other.
    pub fn has_plane_normal(&self) -> bool {
        match self {
            Self::Revolute { .. } | Self::Planar => true,
            Self::Spherical
            | Self::Universal
            | Self::Cylindrical
            | Self::Prismatic
            | Self::Screw { .. }
            | Self::Fixed
            | Self::Rod { .. }
            | Self::PointOnLine
            | Self::PointInPlane
            | Self::Gear { .. } => false,
        }
    }

    /// Whether it makes one rigid body of its two bodies.
    pub fn is_rigid(&self) -> bool {
        match self {
            Self::Fixed => true,
            Self::Spherical
            | Self::Revolute { .. }
            | Self::Universal
            | Self::Cylindrical
            | Self::Prismatic
            | Self::Planar
            | Self::Screw { .. }
            | Self::Rod { .. }
            | Self::PointOnLine
            | Self::PointInPlane
            | Self::Gear { .. } => false,
        }
    }

    /// Whether its two bodies share the coordinates of the director along its axis.
    pub fn shares_director(&self) -> bool {
        match self {
            Self::Revolute { rows } => match rows {
                AxisRows::Shared => true,
                AxisRows::TwoCar | AxisRows::Cv => false,
            },
            Self::Spherical
            | Self::Universal
            | Self::Cylindrical
            | Self::Prismatic
            | Self::Planar
            | Self::Screw { .. }
            | Self::Fixed
            | Self::Rod { .. }
            | Self::PointOnLine
            | Self::PointInPlane
            | Self::Gear { .. } => false,
        }
    }
}

/// A checked joint. Ground points and vectors are in the world frame, others in the principal frame of the body.
#[derive(Clone, Debug)]
pub struct ModelJoint {
    /// Name.
    pub name: String,
    /// What it is.
    pub geometry: JointGeometry,
    /// Bodies i and j (of a gear: its wheels).
    pub bodies: [BodyRef; 2],
    /// The joint's point on body i and on body j, m.
    pub points: [Vector3<f64>; 2],
    /// The joint's unit axis on body i and on body j (zero where the joint has none).
    pub axes: [Vector3<f64>; 2],
    /// Two vectors across the axis on body i and the vectors on body j that coincide with them at the start; with
    /// the axis they are right-handed. The angle of the joint is that from the first on i to the first on j.
    pub cross: [[Vector3<f64>; 2]; 2],
    /// The angle where the bodies are stated, rad: the vectors on body j are turned by it.
    pub stated: f64,
}

impl ModelJoint {
    /// Checks joint `reader.index` of a scene; `reader.joints` are those before it.
    pub(super) fn new(
        joint: &Joint,
        reader: &ModelReader,
        notes: &mut Vec<String>,
    ) -> Result<Self, ModelError> {
        let keys = KnownKeys::of(joint.kind);
        refuse_strangers(joint, &keys, reader)?;
        if keys.own == OwnKeys::Gear {
            return gear(joint, reader);
        }
        let bodies = [reader.body("body_i", &joint.body_i)?, reader.body("body_j", &joint.body_j)?];
        if bodies[0] == bodies[1] {
            return Err(ModelError::SameBody {
                joint: joint.name.clone(),
                pointer: reader.at("body_j"),
                body: joint.body_j.clone(),
            });
        }
        let points = points(joint, &keys, reader, bodies)?;
        let axes = axes(joint, &keys, reader, bodies)?;
        let geometry = match joint.kind {
            JointKind::Spherical => JointGeometry::Spherical,
            JointKind::Revolute => {
                JointGeometry::Revolute { rows: revolute_rows(joint, reader, bodies, axes, notes)? }
            }
            JointKind::Universal => JointGeometry::Universal,
            JointKind::Cylindrical => JointGeometry::Cylindrical,
            JointKind::Prismatic => JointGeometry::Prismatic,
            JointKind::Planar => JointGeometry::Planar,
            JointKind::Screw => JointGeometry::Screw { pitch: pitch(joint, reader)? },
            JointKind::Fixed => JointGeometry::Fixed,
            JointKind::Rod => JointGeometry::Rod { length: rod_length(joint, reader, bodies, points)? },
            JointKind::PointOnLine => JointGeometry::PointOnLine,
            JointKind::PointInPlane => JointGeometry::PointInPlane,
            JointKind::Gear => return gear(joint, reader),
        };
        let stated = reader.number("stated_angle", joint.stated_angle.unwrap_or(0.0), -1e6, 1e6)?;
        let mut cross = [[Vector3::zeros(); 2]; 2];
        if axes[0] != Vector3::zeros() {
            cross = cross_vectors(reader, bodies, axes);
        }
        if stated != 0.0 {
            cross[1] = cross[1].map(|b| Rotation3::from_scaled_axis(axes[1] * stated) * b);
        }
        Ok(Self { name: joint.name.clone(), geometry, bodies, points, axes, cross, stated })
    }

    /// What the author calls it.
    pub fn kind(&self) -> JointKind {
        match self.geometry {
            JointGeometry::Spherical => JointKind::Spherical,
            JointGeometry::Revolute { .. } => JointKind::Revolute,
            JointGeometry::Universal => JointKind::Universal,
            JointGeometry::Cylindrical => JointKind::Cylindrical,
            JointGeometry::Prismatic => JointKind::Prismatic,
            JointGeometry::Planar => JointKind::Planar,
            JointGeometry::Screw { .. } => JointKind::Screw,
            JointGeometry::Fixed => JointKind::Fixed,
            JointGeometry::Rod { .. } => JointKind::Rod,
            JointGeometry::PointOnLine => JointKind::PointOnLine,
            JointGeometry::PointInPlane => JointKind::PointInPlane,
            JointGeometry::Gear { .. } => JointKind::Gear,
        }
    }

    /// The joints whose angles it couples, if it is a gear: then it connects no bodies of its own.
    pub fn coupled_joints(&self) -> Option<[usize; 2]> {
        match self.geometry {
            JointGeometry::Gear { joints, .. } => Some(joints),
            JointGeometry::Spherical
            | JointGeometry::Revolute { .. }
            | JointGeometry::Universal
            | JointGeometry::Cylindrical
            | JointGeometry::Prismatic
            | JointGeometry::Planar
            | JointGeometry::Screw { .. }
            | JointGeometry::Fixed
            | JointGeometry::Rod { .. }
            | JointGeometry::PointOnLine
            | JointGeometry::PointInPlane => None,
        }
    }
}

fn pitch(joint: &Joint, reader: &ModelReader) -> Result<f64, ModelError> {
    let pitch =
        joint.pitch.ok_or_else(|| reader.faulty("pitch", GeometryFault::Pitch, "a screw needs a pitch"))?;
    if pitch.is_finite() && pitch != 0.0 {
        Ok(pitch / std::f64::consts::TAU)
    } else {
        Err(reader.faulty("pitch", GeometryFault::Pitch, "the pitch of a screw is a number other than zero"))
    }
}

/// As stated, or the distance of the rod's points at the start.
fn rod_length(
    joint: &Joint,
    reader: &ModelReader,
    bodies: [BodyRef; 2],
    points: [Vector3<f64>; 2],
) -> Result<f64, ModelError> {
    if let Some(length) = joint.length {
        return reader.number("length", length, MIN_ROD, MAX_ROD);
    }
    let ends = [0, 1].map(|side| reader.point_to_world(bodies[side], &points[side]));
    let length = (ends[1] - ends[0]).norm();
    let key = if joint.points.is_some() { "points" } else { "point_i" };
    if length < MIN_ROD {
        Err(reader.faulty(key, GeometryFault::Coincident, "its points coincide, and no length is given"))
    } else {
        reader.number(key, length, MIN_ROD, MAX_ROD)
    }
}

/// How the axis of a revolute joint is written: shared where the joint or all of its bodies ask for it. What the joint asks
/// for must be possible; the bodies' word means wherever it is.
fn revolute_rows(
    joint: &Joint,
    reader: &ModelReader,
    bodies: [BodyRef; 2],
    axes: [Vector3<f64>; 2],
    notes: &mut Vec<String>,
) -> Result<AxisRows, ModelError> {
    let rows = joint.rows.unwrap_or_default();
    let by_bodies = bodies.iter().all(|body| match body {
        BodyRef::Ground => true,
        BodyRef::Moving(index) => reader.bodies[*index].coordinates == Coordinates::Shared,
    });
    match sharing_obstacle(reader, bodies, axes) {
        Some(reason) if rows == AxisRows::Shared => Err(reader.wrong("rows", reason)),
        Some(reason) if by_bodies => {
            notes.push(format!("joint \"{}\" shares no director: {reason}", joint.name));
            Ok(rows)
        }
        None if by_bodies => Ok(AxisRows::Shared),
        Some(_) | None => Ok(rows),
    }
}

/// A director can only be shared where the axis is one, and has coordinates.
fn sharing_obstacle(reader: &ModelReader, bodies: [BodyRef; 2], axes: [Vector3<f64>; 2]) -> Option<String> {
    bodies.into_iter().enumerate().find_map(|(side, body)| {
        let BodyRef::Moving(index) = body else { return None };
        let body = &reader.bodies[index];
        if body.coordinates == Coordinates::Reduced {
            return Some(format!(
                "body \"{}\" is reduced; sharing a director needs full coordinates",
                body.name
            ));
        }
        director_along(&axes[side])
            .is_none()
            .then(|| format!("its axis is not along a principal axis of body \"{}\"", body.name))
    })
}

fn gear(joint: &Joint, reader: &ModelReader) -> Result<ModelJoint, ModelError> {
    let Some([first, second]) = &joint.joints else {
        return Err(reader.wrong("joints", "a gear needs the names of two revolute joints"));
    };
    let ratio = joint.ratio.ok_or_else(|| reader.wrong("ratio", "a gear needs a ratio"))?;
    let ratio = reader.number("ratio", ratio, -1e6, 1e6)?;
    let offset = reader.number("offset", joint.offset.unwrap_or(0.0), -1e6, 1e6)?;
    let pair = [reader.joint(first, &[JointKind::Revolute])?, reader.joint(second, &[JointKind::Revolute])?];
    if pair[0] == pair[1] {
        return Err(reader.wrong("joints", "a gear couples two different joints"));
    }
    let [a, b] = pair.map(|index| &reader.joints[index]);
    let [of_a, of_b] = wheels([a.bodies, b.bodies]);
    Ok(ModelJoint {
        name: joint.name.clone(),
        geometry: JointGeometry::Gear { joints: pair, ratio, offset },
        bodies: [a.bodies[of_a], b.bodies[of_b]],
        points: [a.points[of_a], b.points[of_b]],
        axes: [a.axes[of_a], b.axes[of_b]],
        cross: [[Vector3::zeros(); 2]; 2],
        stated: 0.0,
    })
}

fn points(
    joint: &Joint,
    keys: &KnownKeys,
    reader: &ModelReader,
    pair: [BodyRef; 2],
) -> Result<[Vector3<f64>; 2], ModelError> {
    match (joint.point, joint.points, joint.point_i, joint.point_j) {
        (Some(world), None, None, None) => match keys.point {
            PointKeys::Two(reason) => Err(reader.faulty("point", GeometryFault::Place, reason)),
            PointKeys::None(_) | PointKeys::Common => {
                let world = reader.vector("point", world)?;
                Ok(pair.map(|body| reader.point_from_world(body, &world)))
            }
        },
        (None, Some([first, second]), None, None) => {
            let world = [reader.vector("points/0", first)?, reader.vector("points/1", second)?];
            Ok([0, 1].map(|side| reader.point_from_world(pair[side], &world[side])))
        }
        (None, None, Some(i), Some(j)) => {
            let local = [reader.vector("point_i", i)?, reader.vector("point_j", j)?];
            Ok([0, 1].map(|side| reader.local_point(pair[side], &local[side])))
        }
        (None, None, None, None) => Err(reader.faulty("point", GeometryFault::Place, "it has no point")),
        _ => Err(reader.faulty(
            "point",
            GeometryFault::Place,
            "its point is given twice, or on one of its bodies only",
        )),
    }
}

fn axes(
    joint: &Joint,
    keys: &KnownKeys,
    reader: &ModelReader,
    pair: [BodyRef; 2],
) -> Result<[Vector3<f64>; 2], ModelError> {
    let given = (joint.axis, joint.axes, joint.axis_i, joint.axis_j);
    match given {
        (None, None, None, None) => match keys.axis {
            AxisKeys::None(_) => Ok([Vector3::zeros(); 2]),
            AxisKeys::Optional => {
                let world = Vector3::z();
                Ok(pair.map(|body| reader.vector_from_world(body, &world)))
            }
            AxisKeys::Common | AxisKeys::OfFirst | AxisKeys::Two(_) => {
                Err(reader.faulty("axis", GeometryFault::Place, "it has no axis"))
            }
        },
        (Some(world), None, None, None) => match keys.axis {
            AxisKeys::Two(reason) => Err(reader.faulty("axis", GeometryFault::Place, reason)),
            AxisKeys::None(_) | AxisKeys::Optional | AxisKeys::Common | AxisKeys::OfFirst => {
                let world = reader.unit("axis", world)?;
                Ok(pair.map(|body| reader.vector_from_world(body, &world)))
            }
        },
        (None, Some([first, second]), None, None) => {
            let world = [reader.unit("axes/0", first)?, reader.unit("axes/1", second)?];
            Ok([0, 1].map(|side| reader.vector_from_world(pair[side], &world[side])))
        }
        (None, None, Some(i), Some(j)) => {
            let local = [reader.unit("axis_i", i)?, reader.unit("axis_j", j)?];
            Ok([0, 1].map(|side| reader.local_vector(pair[side], &local[side])))
        }
        // Body j has no part in the line or plane.
        (None, None, Some(i), None) if keys.axis == AxisKeys::OfFirst => {
            let local = reader.local_vector(pair[0], &reader.unit("axis_i", i)?);
            Ok([local, reader.vector_from_world(pair[1], &reader.vector_to_world(pair[0], &local))])
        }
        _ => Err(reader.faulty(
            "axis",
            GeometryFault::Place,
            "its axis is given twice, or on one of its bodies only",
        )),
    }
}

/// Vectors across the axis on body i, and those on body j that coincide with them as nearly as body j's own axis
/// allows.
fn cross_vectors(
    reader: &ModelReader,
    bodies: [BodyRef; 2],
    axes: [Vector3<f64>; 2],
) -> [[Vector3<f64>; 2]; 2] {
    let on_i = orthonormal_basis(&axes[0]);
    let first = reader.vector_from_world(bodies[1], &reader.vector_to_world(bodies[0], &on_i[0]));
    let first = first - axes[1] * axes[1].dot(&first);
    let first = first.try_normalize(1e-6).unwrap_or_else(|| orthonormal_basis(&axes[1])[0]);
    [on_i, [first, axes[1].cross(&first)]]
}
