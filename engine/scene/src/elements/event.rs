//! Moments to look for, as their author writes them.

use crate::handle::{BodyHandle, JointHandle, MarkerHandle};
use crate::value::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A moment at which a number of the mechanism passes a value. A run tells when, as exactly as it knows the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// Unique name.
    pub name: String,
    /// The number.
    pub of: Quantity,
    /// The value that it passes, m or rad.
    pub value: f64,
    /// In which direction.
    #[serde(default)]
    pub passing: Passing,
    /// Whether the run ends there.
    #[serde(default)]
    pub stop: bool,
}

/// In which direction a number passes a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Passing {
    /// In either.
    #[default]
    Either,
    /// From below.
    Upwards,
    /// From above.
    Downwards,
}

/// A number that changes with the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Quantity {
    /// The coordinate of a point of a body along a direction of the world, m.
    Coordinate {
        /// The body.
        body: String,
        /// The point in the body's frame, m.
        #[serde(default)]
        point: Triple,
        /// The direction; made a unit vector.
        direction: Triple,
    },
    /// The coordinate of a marker along a direction of the world, m.
    Marker {
        /// The marker.
        marker: String,
        /// The direction; made a unit vector.
        direction: Triple,
    },
    /// The distance of two points, m.
    Distance {
        /// First body, or `ground`.
        body_i: String,
        /// Point in the frame of body i, m.
        #[serde(default)]
        point_i: Triple,
        /// Second body, or `ground`.
        body_j: String,
        /// Point in the frame of body j, m.
        #[serde(default)]
        point_j: Triple,
    },
    /// The angle of a revolute, cylindrical or screw joint from its start, whole turns included, rad.
    Angle {
        /// The joint.
        joint: String,
    },
    /// The displacement of a prismatic, cylindrical or screw joint along its axis, m.
    Slide {
        /// The joint.
        joint: String,
    },
}

impl Event {
    /// The quantity passes a value, m or rad, in either direction; the run goes on.
    ///
    /// ```
    /// use triad_scene::{Event, Passing, Quantity};
    ///
    /// let bottom = Event::new("bottom", Quantity::angle("pin"), 1.5).upwards().stop();
    /// assert!(bottom.stop && bottom.passing == Passing::Upwards);
    /// ```
    pub fn new(name: impl Into<String>, of: Quantity, value: f64) -> Self {
        Self { name: name.into(), of, value, passing: Passing::Either, stop: false }
    }

    /// Only from below.
    #[must_use]
    pub fn upwards(mut self) -> Self {
        self.passing = Passing::Upwards;
        self
    }

    /// Only from above.
    #[must_use]
    pub fn downwards(mut self) -> Self {
        self.passing = Passing::Downwards;
        self
    }

    /// The run ends there.
    #[must_use]
    pub fn stop(mut self) -> Self {
        self.stop = true;
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Quantity {
    /// The coordinate of a point of a body (in its frame, m) along a direction of the world, m.
    pub fn coordinate(body: impl Into<BodyHandle>, point: Triple, direction: Triple) -> Self {
        Self::Coordinate { body: body.into().into(), point, direction }
    }

    /// The coordinate of a marker along a direction of the world, m.
    pub fn marker(marker: impl Into<MarkerHandle>, direction: Triple) -> Self {
        Self::Marker { marker: marker.into().into(), direction }
    }

    /// The distance of a point of each of two bodies (in their frames, m), m.
    pub fn distance(
        (body_i, point_i): (impl Into<BodyHandle>, Triple),
        (body_j, point_j): (impl Into<BodyHandle>, Triple),
    ) -> Self {
        Self::Distance { body_i: body_i.into().into(), point_i, body_j: body_j.into().into(), point_j }
    }

    /// The angle φ of a revolute, cylindrical or screw joint from its start, rad.
    pub fn angle(joint: impl Into<JointHandle>) -> Self {
        Self::Angle { joint: joint.into().into() }
    }

    /// The displacement s of a prismatic, cylindrical or screw joint along its axis, m.
    pub fn slide(joint: impl Into<JointHandle>) -> Self {
        Self::Slide { joint: joint.into().into() }
    }
}
