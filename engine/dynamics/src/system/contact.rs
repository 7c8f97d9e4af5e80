//! Dry friction that the reaction of its own joint loads — eq. (6.11).

use crate::model::{LoadKind, Model};
use crate::system::index::ConstraintId;
use nalgebra::Vector3;

/// Friction with a coefficient, of one load.
#[derive(Clone, Copy, Debug)]
pub struct DryFriction {
    /// The load.
    pub load: usize,
    /// The joint whose reaction presses.
    pub joint: ConstraintId,
    /// Coefficient of friction, times the radius of the pin for one about an axis.
    pub coefficient: f64,
    /// Rate at which it has reached three quarters.
    smoothing: f64,
    /// Distance of the ends at which the parts touch, if moments press as well.
    guide: Option<f64>,
}

impl DryFriction {
    /// Of all loads of a model, in their order.
    pub fn all(model: &Model) -> Vec<Self> {
        let of = |(load, kind): (usize, &LoadKind)| {
            let (LoadKind::Torsion { joint, law } | LoadKind::Slider { joint, law }) = kind else {
                return None;
            };
            let friction = law.friction.filter(|friction| friction.coefficient > 0.0)?;
            Some(Self {
                load,
                joint: ConstraintId(*joint),
                coefficient: friction.coefficient * friction.radius.unwrap_or(1.0),
                smoothing: friction.smoothing,
                guide: friction.guide,
            })
        };
        model.loads.iter().map(|load| &load.kind).enumerate().filter_map(of).collect()
    }

    /// The forces across a unit axis at both ends, of which the parts press with the sum of the lengths: from the reaction's force
    /// and its moment about the middle, in which they are linear.
    pub fn ends(&self, axis: &Vector3<f64>, [force, moment]: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        let across = force - axis * axis.dot(&force);
        match self.guide {
            None => [across, Vector3::zeros()],
            Some(length) => {
                let couple = axis.cross(&moment) / length;
                [across * 0.5 + couple, across * 0.5 - couple]
            }
        }
    }

    /// The friction at a rate of the load's coordinate, for each newton with which the parts press.
    pub fn factor(&self, rate: f64) -> f64 {
        -self.coefficient * libm::tanh(rate / self.smoothing)
    }

    /// The greatest damping −∂f/∂ẋ that it has at any rate, for each newton with which the parts press.
    pub fn steepest_damping(&self) -> f64 {
        self.coefficient / self.smoothing
    }
}
