//! A joint with its geometry in the principal frames of its two bodies.

use super::reader::ModelReader;
use super::{BodyRef, ModelError};
use crate::scene::{AxisRows, Coordinates, Joint, JointKind};
use nalgebra::Vector3;
use triad_linalg::orthonormal_basis;

/// How near a unit axis must be to a director.
const ALONG: f64 = 1e-9;

/// The director (0, 1, 2 for u, v, w) that a local unit axis lies along, and its sign.
pub fn director_along(axis: &Vector3<f64>) -> Option<(usize, f64)> {
    let k = axis.iamax();
    ((axis[k].abs() - 1.0).abs() < ALONG).then(|| (k, axis[k].signum()))
}

/// A checked joint. Ground points and vectors are in the world frame, others in the principal frame of the body.
#[derive(Clone, Debug)]
pub struct ModelJoint {
    /// Name.
    pub name: String,
    /// What it is.
    pub kind: JointKind,
    /// Bodies i and j (of a gear: body j of its two joints).
    pub bodies: [BodyRef; 2],
    /// The joint's point on body i and on body j, m.
    pub points: [Vector3<f64>; 2],
    /// The joint's unit axis on body i and on body j (zero where the joint has none).
    pub axes: [Vector3<f64>; 2],
    /// Two vectors across the axis on body i and the vectors on body j that coincide with them at the start; with
    /// the axis they are right-handed. The angle of the joint is that from the first on i to the first on j.
    pub cross: [[Vector3<f64>; 2]; 2],
    /// How the axis of a revolute joint is written.
    pub rows: AxisRows,
    /// Length of a rod, m.
    pub length: f64,
    /// Advance of a screw, m/rad.
    pub pitch: f64,
    /// Joints that a gear couples, and the angle of the second for each radian of the first.
    pub gear: Option<([usize; 2], f64)>,
}

impl ModelJoint {
    /// Checks joint `reader.index` of a scene; `reader.joints` are those before it.
    pub(super) fn new(
        joint: &Joint,
        reader: &ModelReader,
        notes: &mut Vec<String>,
    ) -> Result<Self, ModelError> {
        refuse_strangers(joint, reader)?;
        if joint.kind == JointKind::Gear {
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
        let points = points(joint, reader, bodies)?;
        let axes = axes(joint, reader, bodies)?;
        let mut model = Self {
            name: joint.name.clone(),
            kind: joint.kind,
            bodies,
            points,
            axes,
            cross: [[Vector3::zeros(); 2]; 2],
            rows: joint.rows.unwrap_or_default(),
            length: 0.0,
            pitch: 0.0,
            gear: None,
        };
        if joint.kind == JointKind::Rod {
            let ends = [0, 1].map(|side| reader.point_to_world(bodies[side], &points[side]));
            let length = joint.length.unwrap_or_else(|| (ends[1] - ends[0]).norm());
            model.length = reader.number("length", length, 1e-9, 1e9)?;
        }
        if joint.kind == JointKind::Screw {
            let pitch = joint.pitch.ok_or_else(|| reader.wrong("pitch", "a screw needs a pitch"))?;
            if !(pitch.is_finite() && pitch != 0.0) {
                return Err(reader.wrong("pitch", "the pitch of a screw is a number other than zero"));
            }
            model.pitch = pitch / std::f64::consts::TAU;
        }
        if joint.kind == JointKind::Revolute {
            choose_sharing(&mut model, reader, notes)?;
        }
        if axes[0] != Vector3::zeros() {
            model.cross = cross_vectors(reader, bodies, axes);
        }
        Ok(model)
    }
}

/// Keys that a kind of joint does not know are errors, not noise.
fn refuse_strangers(joint: &Joint, reader: &ModelReader) -> Result<(), ModelError> {
    let kind = joint.kind;
    let gear = kind == JointKind::Gear;
    let has_point =
        joint.point.is_some() || joint.points.is_some() || joint.point_i.is_some() || joint.point_j.is_some();
    let has_axis =
        joint.axis.is_some() || joint.axes.is_some() || joint.axis_i.is_some() || joint.axis_j.is_some();
    let named = !joint.body_i.is_empty() || !joint.body_j.is_empty();
    let rules = [
        (
            "rows",
            joint.rows.is_some() && kind != JointKind::Revolute,
            "only a revolute joint chooses its rows",
        ),
        ("length", joint.length.is_some() && kind != JointKind::Rod, "only a rod has a length"),
        ("pitch", joint.pitch.is_some() && kind != JointKind::Screw, "only a screw has a pitch"),
        ("joints", joint.joints.is_some() && !gear, "only a gear couples two joints"),
        ("ratio", joint.ratio.is_some() && !gear, "only a gear has a ratio"),
        ("point", gear && has_point, "a gear has no point: it couples the angles of two joints"),
        ("axis", gear && has_axis, "a gear has no axis: it couples the angles of two joints"),
        ("body_i", gear && named, "a gear names two joints, not two bodies"),
        ("axis", kind == JointKind::Spherical && has_axis, "a spherical joint has no axis"),
        ("axis", kind == JointKind::Rod && has_axis, "a rod has no axis"),
    ];
    match rules.iter().find(|(_, broken, _)| *broken) {
        Some((key, _, reason)) => Err(reader.wrong(key, *reason)),
        None => Ok(()),
    }
}

/// Shares the axis where the joint or all of its bodies ask for it. What the joint asks for must be possible; the
/// bodies' word means wherever it is.
fn choose_sharing(
    joint: &mut ModelJoint,
    reader: &ModelReader,
    notes: &mut Vec<String>,
) -> Result<(), ModelError> {
    let asked = joint.rows == AxisRows::Shared;
    let by_bodies = joint.bodies.iter().all(|body| match body {
        BodyRef::Ground => true,
        BodyRef::Moving(index) => reader.bodies[*index].coordinates == Coordinates::Shared,
    });
    match sharing_obstacle(joint, reader) {
        Some(reason) if asked => return Err(reader.wrong("rows", reason)),
        Some(reason) if by_bodies => {
            notes.push(format!("joint \"{}\" shares no director: {reason}", joint.name));
        }
        None if by_bodies => joint.rows = AxisRows::Shared,
        _ => {}
    }
    Ok(())
}

/// A director can only be shared where the axis is one, and has coordinates.
fn sharing_obstacle(joint: &ModelJoint, reader: &ModelReader) -> Option<String> {
    joint.bodies.into_iter().enumerate().find_map(|(side, body)| {
        let BodyRef::Moving(index) = body else { return None };
        let body = &reader.bodies[index];
        if body.coordinates == Coordinates::Reduced {
            return Some(format!(
                "body \"{}\" is reduced; sharing a director needs full coordinates",
                body.name
            ));
        }
        director_along(&joint.axes[side])
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
    let pair = [reader.joint(first, &[JointKind::Revolute])?, reader.joint(second, &[JointKind::Revolute])?];
    if pair[0] == pair[1] {
        return Err(reader.wrong("joints", "a gear couples two different joints"));
    }
    let [a, b] = pair.map(|index| &reader.joints[index]);
    Ok(ModelJoint {
        name: joint.name.clone(),
        kind: JointKind::Gear,
        bodies: [a.bodies[1], b.bodies[1]],
        points: [a.points[1], b.points[1]],
        axes: [a.axes[1], b.axes[1]],
        cross: [[Vector3::zeros(); 2]; 2],
        rows: AxisRows::default(),
        length: 0.0,
        pitch: 0.0,
        gear: Some((pair, ratio)),
    })
}

fn points(joint: &Joint, reader: &ModelReader, pair: [BodyRef; 2]) -> Result<[Vector3<f64>; 2], ModelError> {
    match (joint.point, joint.points, joint.point_i, joint.point_j) {
        (Some(_), None, None, None) if joint.kind == JointKind::Rod => {
            Err(reader
                .wrong("point", "a rod has two points: give \"points\", or \"point_i\" and \"point_j\""))
        }
        (Some(world), None, None, None) => {
            let world = reader.vector("point", world)?;
            Ok(pair.map(|body| reader.point_from_world(body, &world)))
        }
        (None, Some([first, second]), None, None) => {
            let world = [reader.vector("points/0", first)?, reader.vector("points/1", second)?];
            Ok([0, 1].map(|side| reader.point_from_world(pair[side], &world[side])))
        }
        (None, None, Some(i), Some(j)) => {
            let local = [reader.vector("point_i", i)?, reader.vector("point_j", j)?];
            Ok([0, 1].map(|side| reader.local_point(pair[side], &local[side])))
        }
        (None, None, None, None) => Err(reader.wrong("point", "it has no point")),
        _ => Err(reader.wrong("point", "its point is given twice, or on one of its bodies only")),
    }
}

fn axes(joint: &Joint, reader: &ModelReader, pair: [BodyRef; 2]) -> Result<[Vector3<f64>; 2], ModelError> {
    let given = (joint.axis, joint.axes, joint.axis_i, joint.axis_j);
    let needs_axis = !matches!(joint.kind, JointKind::Spherical | JointKind::Rod);
    match given {
        (None, None, None, None) if !needs_axis => Ok([Vector3::zeros(); 2]),
        // The axis of a fixed joint only says in which directions its reaction is shown.
        (None, None, None, None) if joint.kind == JointKind::Fixed => {
            let world = Vector3::z();
            Ok(pair.map(|body| reader.vector_from_world(body, &world)))
        }
        (None, None, None, None) => Err(reader.wrong("axis", "it has no axis")),
        (Some(_), None, None, None) if joint.kind == JointKind::Universal => {
            Err(reader.wrong("axis", "a universal joint has two axes: give \"axes\""))
        }
        (Some(world), None, None, None) => {
            let world = reader.unit("axis", world)?;
            Ok(pair.map(|body| reader.vector_from_world(body, &world)))
        }
        (None, Some([first, second]), None, None) => {
            let world = [reader.unit("axes/0", first)?, reader.unit("axes/1", second)?];
            Ok([0, 1].map(|side| reader.vector_from_world(pair[side], &world[side])))
        }
        (None, None, Some(i), Some(j)) => {
            let local = [reader.unit("axis_i", i)?, reader.unit("axis_j", j)?];
            Ok([0, 1].map(|side| reader.local_vector(pair[side], &local[side])))
        }
        _ => Err(reader.wrong("axis", "its axis is given twice, or on one of its bodies only")),
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
