//! Numbers of the mechanism whose passing of a value is an event — THEORY section 10.

use crate::model::{BodyRef, EventQuantity, Model, ModelEvent};
use crate::scene::Passing;
use crate::system::row_builder::Writer;
use nalgebra::Vector3;

/// The number of an event in terms of the system.
#[derive(Clone, Debug)]
pub(crate) enum Number {
    /// Of a point along a direction of the world.
    Coordinate { point: Spot, direction: Vector3<f64> },
    /// Between two points.
    Distance([Spot; 2]),
    /// Of a joint.
    Angle(usize),
    /// Of two points along an axis.
    Slide { axis: Spot, points: [Spot; 2] },
}

/// A point or vector of a body or of the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
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
    pub(crate) number: Number,
    /// The value.
    pub value: f64,
    /// In which direction it is to be passed.
    pub passing: Passing,
    /// Whether the run ends there.
    pub stop: bool,
}

impl EventFunction {
    /// Of a checked event; angles are written into the system.
    pub fn new(model: &Model, event: &ModelEvent, writer: &mut Writer) -> Self {
        let spot = |body, local| Spot { body, local };
        let number = match &event.of {
            EventQuantity::Coordinate { body, local, direction } => {
                Number::Coordinate { point: spot(*body, *local), direction: *direction }
            }
            EventQuantity::Distance { bodies, locals } => {
                Number::Distance([0, 1].map(|side| spot(bodies[side], locals[side])))
            }
            EventQuantity::Angle { joint } => Number::Angle(writer.angle(&model.joints[*joint])),
            EventQuantity::Slide { joint } => {
                let joint = &model.joints[*joint];
                let points = [0, 1].map(|side| spot(joint.bodies[side], joint.points[side]));
                Number::Slide { axis: spot(joint.bodies[0], joint.axes[0]), points }
            }
        };
        Self {
            name: event.name.clone(),
            number,
            value: event.value,
            passing: event.passing,
            stop: event.stop,
        }
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
