//! Points with names, in principal frames.

use super::reader::ModelReader;
use super::{BodyRef, ModelError};
use crate::scene::Marker;
use nalgebra::Vector3;

/// A checked marker.
#[derive(Clone, Debug)]
pub struct ModelMarker {
    /// Name.
    pub name: String,
    /// The body.
    pub body: BodyRef,
    /// The point in its principal frame; of the ground, in the world, m.
    pub local: Vector3<f64>,
}

impl ModelMarker {
    /// Checks a marker.
    pub(super) fn new(marker: &Marker, reader: &ModelReader) -> Result<Self, ModelError> {
        let body = reader.body("body", &marker.body)?;
        let local = reader.local_point(body, &reader.vector("point", marker.point)?);
        Ok(Self { name: marker.name.clone(), body, local })
    }
}
