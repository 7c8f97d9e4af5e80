//! The bodies as they are shown.

use super::Simulation;
use serde::Serialize;
use triad_dynamics::state::BodyFrame;

/// All bodies at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyFrame>,
}

impl Simulation {
    /// Bodies at the shown state.
    pub fn frame(&self) -> Frame {
        Frame { time: self.time, bodies: self.current.bodies().iter().map(BodyFrame::from).collect() }
    }
}
