//! The bodies as they are shown.

use super::Simulation;
use crate::error::EngineError;
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

    /// Shows all times from the steps that the run takes on its way to its end, whatever its settings say.
    pub(crate) fn interpolate_outputs(&mut self) {
        self.mechanism.system.model.settings.skip.outputs = true;
    }

    /// Takes one step of the integrator and shows nothing of it.
    pub(crate) fn take_step(&mut self) -> Result<(), EngineError> {
        self.integrate_one(self.duration())
    }
}
