//! A picture of the bodies and markers at one moment.

use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::model::ModelMarker;
use triad_dynamics::state::{BodyFrame, State};

/// All bodies at one moment, in the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Time t, s.
    pub time: f64,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyFrame>,
    /// The points that the scene names, in its order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub markers: Vec<MarkerFrame>,
}

/// A point that the scene names, at one moment, in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MarkerFrame {
    /// Position, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
}

impl MarkerFrame {
    /// A marker at a state.
    pub(crate) fn new(marker: &ModelMarker, at: &State) -> Self {
        let [position, velocity] = at.point(marker.body, &marker.local).map(Into::into);
        Self { position, velocity }
    }
}
