//! When what is prescribed goes on by another piece: integrators end a step there.

use super::System;
use super::load::SystemLoad;
use crate::model::motion::{Curve, TRIED};

/// Moments, of those at which a formula is tried, for which it is looked at closely after it began to change: the first of them may be as
/// good as quiet. And the parts of each that are not passed in one step.
const CLOSE: f64 = 2.0;
const PARTS: f64 = 64.0;

impl System {
    /// The first moment after t at which a prescribed motion, force or torque has another piece, s, or infinity.
    pub fn next_break(&self, t: f64) -> f64 {
        self.first(&|curve| curve.next_break(t))
    }

    /// Where a step from time t ends at the latest so that it does not pass unseen what a formula does after it has rested, s, or infinity.
    pub fn look_until(&self, t: f64) -> f64 {
        let moment = self.model.settings.duration / f64::from(TRIED);
        let wake = self.first(&|curve| curve.next_wake(t - CLOSE * moment));
        if wake > t { wake } else { t + moment / PARTS }
    }

    /// The least of what functions of time say.
    fn first(&self, of: &impl Fn(&Curve) -> f64) -> f64 {
        let features = self.curves.iter().map(|curve| curve.first(of));
        let numbers = self.targets.iter().map(|target| of(&target.curve));
        let loads = self.loads.iter().map(|load| load.first(of));
        features.chain(numbers).chain(loads).fold(f64::INFINITY, f64::min)
    }
}

impl SystemLoad {
    fn first(&self, of: &impl Fn(&Curve) -> f64) -> f64 {
        match self {
            Self::Force { force: curve, .. } | Self::Moment { moment: curve, .. } => curve.first(of),
            Self::Spring { law, .. } | Self::Torsion { law, .. } | Self::Slider { law, .. } => law.first(of),
        }
    }
}
