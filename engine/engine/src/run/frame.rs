//! A picture of the bodies at one moment.

use serde::Serialize;
use triad_dynamics::state::BodyFrame;

/// All bodies at one moment, in the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Time t, s.
    pub time: f64,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyFrame>,
}
