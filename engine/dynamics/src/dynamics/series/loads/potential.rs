//! What springs hold — eq. (6.10).

use super::{Load, Loads};
use crate::dynamics::series::bodies::LanePlace;
use crate::dynamics::series::constraints::AngleSeries;
use crate::dynamics::series::lanes::LaneVector;
use nalgebra::Vector3;

impl Loads {
    /// Potential energy of all springs at a state, J, whose values of features and angles are in place.
    pub fn potential<const L: usize>(&self, values: &[LaneVector<L>], angles: &[AngleSeries]) -> f64 {
        let each = self.list.iter().map(|load| {
            let (law, x) = match load {
                Load::Given { .. } => return 0.0,
                Load::Spring { from, to, law, .. } => {
                    (law, LanePlace::difference([Some(*to), Some(*from)], values).norm())
                }
                Load::Torsion { angle, law, .. } => (law, angles[*angle].state.value),
                Load::Slider { axis, ends, law, .. } => {
                    let between = LanePlace::difference(*ends, values);
                    (law, Vector3::from(axis.get(values)).dot(&between))
                }
            };
            law.law.potential(x)
        });
        each.sum()
    }
}
