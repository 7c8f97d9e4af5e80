//! Which keys of a scene each kind of joint knows: others are errors, not noise.

use super::ModelError;
use super::error::GeometryFault;
use super::reader::ModelReader;
use crate::scene::{Joint, JointKind};

/// How the points of a kind of joint are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PointKeys {
    /// One point of both bodies, or one of each.
    Common,
    /// One of each body; why not one of both.
    Two(&'static str),
    /// Not at all; why.
    None(&'static str),
}

/// How the axes of a kind of joint are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisKeys {
    /// One axis of both bodies, or one of each.
    Common,
    /// One axis of both bodies, one of each, or that of body i alone, to which line or plane belong.
    OfFirst,
    /// The same, or none: the axis only says in which directions the reaction is shown.
    Optional,
    /// One of each body; why not one of both.
    Two(&'static str),
    /// Not at all; why.
    None(&'static str),
}

/// The keys that one kind of joint knows alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OwnKeys {
    /// None.
    None,
    /// `rows` and `stated_angle`.
    Rows,
    /// `length`.
    Length,
    /// `pitch`.
    Pitch,
    /// `joints`, `ratio` and perhaps `offset` in place of two bodies.
    Gear,
}

/// The keys that a kind of joint knows besides its name, its type and its two bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnownKeys {
    pub point: PointKeys,
    pub axis: AxisKeys,
    pub own: OwnKeys,
}

impl KnownKeys {
    /// Those of a kind of joint.
    pub fn of(kind: JointKind) -> Self {
        let plain = Self { point: PointKeys::Common, axis: AxisKeys::Common, own: OwnKeys::None };
        match kind {
            JointKind::Spherical => Self { axis: AxisKeys::None("a spherical joint has no axis"), ..plain },
            JointKind::Revolute => Self { own: OwnKeys::Rows, ..plain },
            JointKind::Universal => {
                Self { axis: AxisKeys::Two("a universal joint has two axes: give \"axes\""), ..plain }
            }
            JointKind::Cylindrical | JointKind::Prismatic | JointKind::Planar => plain,
            JointKind::PointOnLine | JointKind::PointInPlane => Self { axis: AxisKeys::OfFirst, ..plain },
            JointKind::Screw => Self { own: OwnKeys::Pitch, ..plain },
            JointKind::Fixed => Self { axis: AxisKeys::Optional, ..plain },
            JointKind::Rod => Self {
                point: PointKeys::Two(
                    "a rod has two points: give \"points\", or \"point_i\" and \"point_j\"",
                ),
                axis: AxisKeys::None("a rod has no axis"),
                own: OwnKeys::Length,
            },
            JointKind::Gear => Self {
                point: PointKeys::None("a gear has no point: it couples the angles of two joints"),
                axis: AxisKeys::None("a gear has no axis: it couples the angles of two joints"),
                own: OwnKeys::Gear,
            },
        }
    }
}

/// Refuses keys that the kind of a joint does not know.
pub(super) fn refuse_strangers(
    joint: &Joint,
    keys: &KnownKeys,
    reader: &ModelReader,
) -> Result<(), ModelError> {
    let has_point =
        joint.point.is_some() || joint.points.is_some() || joint.point_i.is_some() || joint.point_j.is_some();
    let has_axis =
        joint.axis.is_some() || joint.axes.is_some() || joint.axis_i.is_some() || joint.axis_j.is_some();
    let named = !joint.body_i.is_empty() || !joint.body_j.is_empty();
    let no_point = match keys.point {
        PointKeys::None(reason) => Some(reason),
        PointKeys::Common | PointKeys::Two(_) => None,
    };
    let no_axis = match keys.axis {
        AxisKeys::None(reason) => Some(reason),
        AxisKeys::Common | AxisKeys::OfFirst | AxisKeys::Optional | AxisKeys::Two(_) => None,
    };
    let only = |own: OwnKeys, reason: &'static str| (keys.own != own).then_some(reason);
    let no_bodies = (keys.own == OwnKeys::Gear).then_some("a gear names two joints, not two bodies");
    let rules = [
        ("rows", joint.rows.is_some(), only(OwnKeys::Rows, "only a revolute joint chooses its rows")),
        ("stated_angle", joint.stated_angle.is_some(), only(OwnKeys::Rows, "only a revolute joint has one")),
        ("length", joint.length.is_some(), only(OwnKeys::Length, "only a rod has a length")),
        ("pitch", joint.pitch.is_some(), only(OwnKeys::Pitch, "only a screw has a pitch")),
        ("joints", joint.joints.is_some(), only(OwnKeys::Gear, "only a gear couples two joints")),
        ("ratio", joint.ratio.is_some(), only(OwnKeys::Gear, "only a gear has a ratio")),
        ("offset", joint.offset.is_some(), only(OwnKeys::Gear, "only a gear has an offset")),
        ("point", has_point, no_point),
        ("axis", has_axis, no_axis),
        ("body_i", named, no_bodies),
    ];
    let broken =
        rules.into_iter().find_map(|(key, given, refused)| refused.filter(|_| given).map(|why| (key, why)));
    match broken {
        Some((key, reason)) => Err(reader.faulty(key, GeometryFault::TooMuch, reason)),
        None => Ok(()),
    }
}
