//! Joints as their author writes them.

use crate::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// A common point.
    Spherical,
    /// A common point and a common axis.
    Revolute,
    /// A common point and two axes that stay perpendicular, one in each body.
    Universal,
    /// A common axis, along and about which body j moves.
    Cylindrical,
    /// A common axis, along which body j slides without turning.
    Prismatic,
    /// A common plane: body j slides in the plane of body i through its point, normal to the axis, and turns about
    /// the axis.
    Planar,
    /// A common axis, along which body j moves as it turns: `pitch` metres a turn.
    Screw,
    /// No relative motion.
    Fixed,
    /// A rigid massless bar between a point of each body.
    Rod,
    /// The point of body j stays on the line of body i through its point along the axis.
    PointOnLine,
    /// The point of body j stays in the plane of body i through its point, normal to the axis.
    PointInPlane,
    /// The angle of one revolute joint is `ratio` times that of another.
    Gear,
}

/// How the axis of a revolute joint is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxisRows {
    /// Two perpendicularity rows (CAR): no dependent row.
    #[default]
    #[serde(rename = "cp-2car")]
    TwoCar,
    /// One common vector (CV): three rows, of which one is dependent, as the formulation first writes it.
    #[serde(rename = "cp-cv")]
    Cv,
    /// The axis is a director of both bodies (or of one, and fixed in the ground), whose coordinates they share: no
    /// row at all. Needs full coordinates and an axis along a principal axis of each body.
    #[serde(rename = "shared")]
    Shared,
}

/// A joint between two bodies, or between a body and the ground.
///
/// Its points and axes are given in the world at the start (`point`, `points`, `axis`, `axes`) or in the frames of
/// the two bodies (`point_i`, `point_j`, `axis_i`, `axis_j`; for the ground this is the world).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Unique name.
    pub name: String,
    /// What it is.
    #[serde(rename = "type")]
    pub kind: JointKind,
    /// First body, or `ground` (not for a gear).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub body_i: String,
    /// Second body, or `ground` (not for a gear).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub body_j: String,
    /// Common point in the world at the start, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Triple>,
    /// Two points in the world at the start, m: the first fixed in body i, the second in body j.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<[Triple; 2]>,
    /// Point in the frame of body i, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_i: Option<Triple>,
    /// Point in the frame of body j, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point_j: Option<Triple>,
    /// Common axis in the world at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Triple>,
    /// Two axes in the world at the start: the first fixed in body i, the second in body j.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[Triple; 2]>,
    /// Axis in the frame of body i.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_i: Option<Triple>,
    /// Axis in the frame of body j.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_j: Option<Triple>,
    /// Which rows hold the axis of a revolute joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<AxisRows>,
    /// Length of a rod, m; without it, the distance of its points at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Advance of a screw, m a turn; positive for a right-handed thread.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch: Option<f64>,
    /// The two revolute joints that a gear couples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joints: Option<[String; 2]>,
    /// Angle of a gear's second joint for each radian of its first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
}

impl Joint {
    /// A joint of which only name, kind and bodies are given.
    pub fn between(name: &str, kind: JointKind, body_i: &str, body_j: &str) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            body_i: body_i.to_owned(),
            body_j: body_j.to_owned(),
            point: None,
            points: None,
            point_i: None,
            point_j: None,
            axis: None,
            axes: None,
            axis_i: None,
            axis_j: None,
            rows: None,
            length: None,
            pitch: None,
            joints: None,
            ratio: None,
        }
    }
}
