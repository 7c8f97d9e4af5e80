//! When what is prescribed goes on by another piece: integrators end a step there.

use super::System;
use super::load::SystemLoad;

impl System {
    /// The first moment after t at which a prescribed motion, force or torque has another piece, s, or infinity.
    pub fn next_break(&self, t: f64) -> f64 {
        let features = self.curves.iter().map(|curve| curve.next_break(t));
        let numbers = self.targets.iter().map(|target| target.curve.next_break(t));
        let loads = self.loads.iter().map(|load| load.next_break(t));
        features.chain(numbers).chain(loads).fold(f64::INFINITY, f64::min)
    }
}

impl SystemLoad {
    fn next_break(&self, t: f64) -> f64 {
        match self {
            Self::Force { force: curve, .. } | Self::Moment { moment: curve, .. } => curve.next_break(t),
            Self::Spring { law, .. } | Self::Torsion { law, .. } | Self::Slider { law, .. } => {
                law.next_break(t)
            }
        }
    }
}
