//! Joints as their author writes them.

use crate::handle::{BodyHandle, JointHandle};
use crate::text::{UnknownWord, choice};
use crate::value::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

macro_rules! joint_kinds {
    ($($(#[$text:meta])* $kind:ident = $word:literal,)*) => {
        /// What a joint is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        pub enum JointKind {$(
            $(#[$text])*
            $kind,
        )*}

        impl JointKind {
            /// All of them.
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$kind),*];

            /// What a scene writes for it.
            const fn as_str(self) -> &'static str {
                match self {$(
                    Self::$kind => $word,
                )*}
            }
        }
    };
}

joint_kinds! {
    /// A common point.
    Spherical = "spherical",
    /// A common point and a common axis.
    Revolute = "revolute",
    /// A common point and two axes that stay perpendicular, one in each body.
    Universal = "universal",
    /// A common axis, along and about which body j moves.
    Cylindrical = "cylindrical",
    /// A common axis, along which body j slides without turning.
    Prismatic = "prismatic",
    /// A common plane: body j slides in the plane of body i through its point, normal to the axis, and turns about
    /// the axis.
    Planar = "planar",
    /// A common axis, along which body j moves as it turns: `pitch` metres a turn.
    Screw = "screw",
    /// No relative motion.
    Fixed = "fixed",
    /// A rigid massless bar between a point of each body.
    Rod = "rod",
    /// The point of body j stays on the line of body i through its point along the axis.
    PointOnLine = "point-on-line",
    /// The point of body j stays in the plane of body i through its point, normal to the axis.
    PointInPlane = "point-in-plane",
    /// The angle of one revolute joint is `ratio` times that of another.
    Gear = "gear",
}

impl fmt::Display for JointKind {
    /// As a scene writes it.
    ///
    /// ```
    /// use triad_scene::JointKind;
    ///
    /// for kind in JointKind::ALL {
    ///     assert_eq!(serde_json::to_value(kind).unwrap(), kind.to_string());
    ///     assert_eq!(kind.to_string().parse(), Ok(kind));
    /// }
    /// ```
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for JointKind {
    type Err = UnknownWord;

    fn from_str(word: &str) -> Result<Self, UnknownWord> {
        choice(word, Self::ALL.into_iter())
    }
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

/// Where a joint stands at the start, and how fast it moves. The stated positions of the bodies are those at the angle 0 or at
/// `stated_angle`; the bodies that hang on the joint are carried from there, and loops are closed with what is given here held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct JointStart {
    /// Angle of body j relative to body i about the axis (revolute, cylindrical, screw), rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Rate of the angle, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Displacement along the axis from the joint's point on body i to that on body j (prismatic, cylindrical), m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slide: Option<f64>,
    /// Rate of the displacement, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
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
    /// Axis in the frame of body i. The line of `point-on-line` and the normal of `point-in-plane` belong to body i: there
    /// `axis_i` is enough.
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
    /// Angle of a gear's second joint where that of its first is zero, rad; without it, zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Angle of a revolute joint where the bodies are stated, rad, from which it is counted; without it, zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stated_angle: Option<f64>,
    /// Where the joint stands at the start, and how fast it moves there, in place of positions and velocities of bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<JointStart>,
}

impl Joint {
    /// A joint of which only name, kind and bodies are given.
    pub fn new(
        name: impl Into<String>,
        kind: JointKind,
        body_i: impl Into<BodyHandle>,
        body_j: impl Into<BodyHandle>,
    ) -> Self {
        Self {
            name: name.into(),
            kind,
            body_i: body_i.into().into(),
            body_j: body_j.into().into(),
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
            offset: None,
            stated_angle: None,
            start: None,
        }
    }

    /// The angle of the revolute joint `second` is `ratio` times that of `first`: φ₂ = ratio φ₁.
    ///
    /// ```
    /// use triad_scene::Joint;
    ///
    /// let gear = Joint::gear("reduction", "motor", "arm", 0.1);
    /// assert_eq!(gear.joints, Some(["motor".to_owned(), "arm".to_owned()]));
    /// ```
    pub fn gear(
        name: impl Into<String>,
        first: impl Into<JointHandle>,
        second: impl Into<JointHandle>,
        ratio: f64,
    ) -> Self {
        let mut gear = Self::new(name, JointKind::Gear, "", "");
        gear.joints = Some([first.into().into(), second.into().into()]);
        gear.ratio = Some(ratio);
        gear
    }

    /// A common axis, along which body j moves by `pitch` metres a turn as it turns; positive for a right-handed thread.
    pub fn screw(
        name: impl Into<String>,
        body_i: impl Into<BodyHandle>,
        body_j: impl Into<BodyHandle>,
        pitch: f64,
    ) -> Self {
        let mut screw = Self::new(name, JointKind::Screw, body_i, body_j);
        screw.pitch = Some(pitch);
        screw
    }

    /// The common point in the world at the start, m.
    #[must_use]
    pub fn at(mut self, point: Triple) -> Self {
        self.point = Some(point);
        self
    }

    /// Two points in the world at the start, m: the first fixed in body i, the second in body j.
    #[must_use]
    pub fn from_to(mut self, first: Triple, second: Triple) -> Self {
        self.points = Some([first, second]);
        self
    }

    /// The points in the frames of the two bodies, m; for the ground this is the world.
    #[must_use]
    pub fn at_local(mut self, point_i: Triple, point_j: Triple) -> Self {
        (self.point_i, self.point_j) = (Some(point_i), Some(point_j));
        self
    }

    /// The common axis in the world at the start: about which body j turns, along which it slides, or to which the plane
    /// is normal.
    #[must_use]
    pub fn about(mut self, axis: Triple) -> Self {
        self.axis = Some(axis);
        self
    }

    /// The same as [`about`](Self::about), for joints that slide.
    #[must_use]
    pub fn along(self, axis: Triple) -> Self {
        self.about(axis)
    }

    /// Two axes in the world at the start, at a right angle: the first fixed in body i, the second in body j.
    #[must_use]
    pub fn axes(mut self, first: Triple, second: Triple) -> Self {
        self.axes = Some([first, second]);
        self
    }

    /// The axes in the frames of the two bodies.
    #[must_use]
    pub fn about_local(mut self, axis_i: Triple, axis_j: Triple) -> Self {
        (self.axis_i, self.axis_j) = (Some(axis_i), Some(axis_j));
        self
    }

    /// Which rows hold the axis of a revolute joint.
    #[must_use]
    pub fn rows(mut self, rows: AxisRows) -> Self {
        self.rows = Some(rows);
        self
    }

    /// The angle and its rate at the start, rad and rad/s: the bodies that hang on the joint are carried from their stated
    /// positions.
    ///
    /// ```
    /// use triad_scene::{Ground, Joint};
    ///
    /// let pin = Joint::revolute("pin", Ground, "rod").at([0.0; 3]).about([0.0, 0.0, 1.0]).starting_at(0.5, -2.0);
    /// assert_eq!(pin.start.and_then(|start| start.angle), Some(0.5));
    /// ```
    #[must_use]
    pub fn starting_at(mut self, angle: f64, rate: f64) -> Self {
        let start = self.start.get_or_insert_default();
        (start.angle, start.rate) = (Some(angle), Some(rate));
        self
    }

    /// The displacement and its rate at the start, m and m/s, likewise.
    #[must_use]
    pub fn starting_out(mut self, slide: f64, speed: f64) -> Self {
        let start = self.start.get_or_insert_default();
        (start.slide, start.speed) = (Some(slide), Some(speed));
        self
    }

    /// The length of a rod, m, if it is not the distance of its points at the start.
    #[must_use]
    pub fn length(mut self, length: f64) -> Self {
        self.length = Some(length);
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

macro_rules! joints {
    ($($(#[$text:meta])* $name:ident: $kind:ident;)*) => {
        impl Joint {$(
            $(#[$text])*
            pub fn $name(
                name: impl Into<String>,
                body_i: impl Into<BodyHandle>,
                body_j: impl Into<BodyHandle>,
            ) -> Self {
                Self::new(name, JointKind::$kind, body_i, body_j)
            }
        )*}
    };
}

joints! {
    /// A common point: three rows (CP). Give it [`at`](Self::at).
    spherical: Spherical;
    /// A common point and a common axis: body j turns by an angle φ. Give it [`at`](Self::at) and [`about`](Self::about).
    ///
    /// ```
    /// use triad_scene::{Ground, Joint};
    ///
    /// let pin = Joint::revolute("pin", Ground, "rod").at([0.0; 3]).about([0.0, 0.0, 1.0]);
    /// assert_eq!((pin.body_i.as_str(), pin.body_j.as_str()), ("ground", "rod"));
    /// ```
    revolute: Revolute;
    /// A common point and two axes that stay perpendicular. Give it [`at`](Self::at) and [`axes`](Self::axes).
    universal: Universal;
    /// A common axis, along and about which body j moves. Give it [`at`](Self::at) and [`about`](Self::about).
    cylindrical: Cylindrical;
    /// A common axis, along which body j slides without turning. Give it [`at`](Self::at) and [`along`](Self::along).
    prismatic: Prismatic;
    /// A common plane, normal to the axis. Give it [`at`](Self::at) and [`about`](Self::about).
    planar: Planar;
    /// No relative motion. Give it [`at`](Self::at).
    fixed: Fixed;
    /// A rigid massless bar between a point of each body. Give it [`from_to`](Self::from_to).
    rod: Rod;
    /// The point of body j stays on a line of body i. Give it [`at`](Self::at) and [`along`](Self::along).
    point_on_line: PointOnLine;
    /// The point of body j stays in a plane of body i. Give it [`at`](Self::at) and [`about`](Self::about), the normal.
    point_in_plane: PointInPlane;
}
