//! Numbers of the mechanism whose passing of a value is an event — THEORY section 10.

use crate::model::{BodyRef, EventQuantity, Model, ModelEvent};
use crate::scene::Passing;
use crate::system::row_builder::RowBuilder;
use nalgebra::Vector3;

/// The number of an event in terms of the system.
#[derive(Clone, Debug)]
pub(crate) enum EventMeasure {
    /// Of a point along a direction of the world.
    Coordinate { point: EventFeature, direction: Vector3<f64> },
    /// Between two points.
    Distance([EventFeature; 2]),
    /// Of a joint.
    Angle(usize),
    /// Of two points along an axis.
    Slide { axis: EventFeature, points: [EventFeature; 2] },
}

/// A point or vector of a body or of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EventFeature {
    /// The body.
    pub body: BodyRef,
    /// The point or vector in it.
    pub local: Vector3<f64>,
}

/// A number of the mechanism that passes a value.
#[derive(Clone, Debug)]
pub struct EventFunction {
    /// Name of the event.
    pub name: String,
    pub(crate) measure: EventMeasure,
    /// The value.
    pub value: f64,
    /// In which direction it is to be passed.
    pub passing: Passing,
    /// Whether the run ends there.
    pub stop: bool,
}

impl EventFunction {
    /// Of a checked event; angles are written into the system.
    pub fn new(model: &Model, event: &ModelEvent, builder: &mut RowBuilder) -> Self {
        let feature = |body, local| EventFeature { body, local };
        let measure = match &event.of {
            EventQuantity::Coordinate { body, local, direction } => {
                EventMeasure::Coordinate { point: feature(*body, *local), direction: *direction }
            }
            EventQuantity::Distance { bodies, locals } => {
                EventMeasure::Distance([0, 1].map(|side| feature(bodies[side], locals[side])))
            }
            EventQuantity::Angle { joint } => EventMeasure::Angle(builder.angle(&model.joints[*joint])),
            EventQuantity::Slide { joint } => {
                let joint = &model.joints[*joint];
                let points = [0, 1].map(|side| feature(joint.bodies[side], joint.points[side]));
                EventMeasure::Slide { axis: feature(joint.bodies[0], joint.axes[0]), points }
            }
        };
        Self {
            name: event.name.clone(),
            measure,
            value: event.value,
            passing: event.passing,
            stop: event.stop,
        }
    }

    /// Rounding of the quantity in a mechanism of such a length, m: of the numbers that cancel where it is at its value.
    pub fn rounding(&self, length: f64) -> f64 {
        let size = if matches!(self.measure, EventMeasure::Angle(_)) { 1.0 } else { length };
        f64::EPSILON * (self.value.abs() + size)
    }

    /// Whether it is to be passed in this direction.
    pub fn wants(&self, rising: bool) -> bool {
        match self.passing {
            Passing::Either => true,
            Passing::Upwards => rising,
            Passing::Downwards => !rising,
        }
    }
}
