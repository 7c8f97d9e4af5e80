//! Points that an author names.

use crate::handle::BodyHandle;
use crate::value::{Triple, is_default};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point of a body that has a name: tables, pictures and events know where it is. It has no influence on the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Marker {
    /// Unique name among the markers.
    pub name: String,
    /// The body, or `ground`.
    pub body: String,
    /// The point in the body's frame, m; its reference point if it is left out.
    #[serde(default, skip_serializing_if = "is_default")]
    pub point: Triple,
}

impl Marker {
    /// A point of a body (in its frame, m), by a name.
    ///
    /// ```
    /// use triad_scene::{Body, Marker, Scene};
    ///
    /// let mut scene = Scene::new("pendulum");
    /// let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
    /// let tip = scene.add(Marker::new("tip", &rod, [0.5, 0.0, 0.0]));
    /// assert_eq!((tip.name(), scene.markers.len()), ("tip", 1));
    /// ```
    pub fn new(name: impl Into<String>, body: impl Into<BodyHandle>, point: Triple) -> Self {
        Self { name: name.into(), body: body.into().into(), point }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}
