//! Events to be located, with their points in principal frames.

use super::error::NamedElement;
use super::reader::ModelReader;
use super::{BodyRef, ModelError, ModelMarker};
use crate::scene::{Event, Passing, Quantity};
use nalgebra::Vector3;

/// Greatest |value| that an event may wait for, m or rad.
const MAX_VALUE: f64 = 1e9;

/// A checked event.
#[derive(Clone, Debug)]
pub struct ModelEvent {
    /// Name.
    pub name: String,
    /// The number.
    pub of: EventQuantity,
    /// The value that it passes.
    pub value: f64,
    /// In which direction.
    pub passing: Passing,
    /// Whether the run ends there.
    pub stop: bool,
}

/// A number that changes with the motion; local coordinates are in principal frames.
#[derive(Clone, Debug)]
pub enum EventQuantity {
    /// A point's coordinate along a unit vector of the world.
    Coordinate {
        /// The body.
        body: BodyRef,
        /// The point.
        local: Vector3<f64>,
        /// The unit vector.
        direction: Vector3<f64>,
    },
    /// The distance of two points.
    Distance {
        /// The two bodies.
        bodies: [BodyRef; 2],
        /// The two points.
        locals: [Vector3<f64>; 2],
    },
    /// The angle of a joint.
    Angle {
        /// The joint.
        joint: usize,
    },
    /// The displacement of a joint.
    Slide {
        /// The joint.
        joint: usize,
    },
}

impl ModelEvent {
    /// Checks an event.
    pub(super) fn new(
        event: &Event,
        reader: &ModelReader,
        markers: &[ModelMarker],
    ) -> Result<Self, ModelError> {
        let of = match &event.of {
            Quantity::Coordinate { body, point, direction } => {
                let body = BodyRef::Moving(reader.moving_body("of/body", body)?);
                let local = reader.local_point(body, &reader.vector("of/point", *point)?);
                EventQuantity::Coordinate { body, local, direction: reader.unit("of/direction", *direction)? }
            }
            Quantity::Marker { marker, direction } => {
                let ModelMarker { body, local, .. } = *named(marker, markers, reader)?;
                if body == BodyRef::Ground {
                    return Err(reader.wrong("of/marker", "it is a point of the ground, which cannot move"));
                }
                EventQuantity::Coordinate { body, local, direction: reader.unit("of/direction", *direction)? }
            }
            Quantity::Distance { body_i, point_i, body_j, point_j } => {
                let bodies = [reader.body("of/body_i", body_i)?, reader.body("of/body_j", body_j)?];
                if bodies[0] == bodies[1] {
                    return Err(reader.wrong("of/body_j", "points of one body keep their distance"));
                }
                let points = [reader.vector("of/point_i", *point_i)?, reader.vector("of/point_j", *point_j)?];
                EventQuantity::Distance {
                    bodies,
                    locals: [0, 1].map(|side| reader.local_point(bodies[side], &points[side])),
                }
            }
            Quantity::Angle { joint } => EventQuantity::Angle { joint: reader.joint_with_angle(joint)? },
            Quantity::Slide { joint } => {
                EventQuantity::Slide { joint: reader.joint_with_displacement(joint)? }
            }
        };
        Ok(Self {
            name: event.name.clone(),
            of,
            value: reader.number("value", event.value, -MAX_VALUE, MAX_VALUE)?,
            passing: event.passing,
            stop: event.stop,
        })
    }
}

/// A marker by its name.
fn named<'a>(
    name: &str,
    markers: &'a [ModelMarker],
    reader: &ModelReader,
) -> Result<&'a ModelMarker, ModelError> {
    markers.iter().find(|marker| marker.name == name).ok_or_else(|| {
        reader.unknown(
            "of/marker",
            NamedElement::Marker,
            name,
            markers.iter().map(|marker| marker.name.as_str()),
        )
    })
}
