//! Links in their places.

use nalgebra::{Isometry3, Vector3};

use crate::read::{Link, UrdfJoint};

/// A link in its place.
pub(super) struct Placed<'a> {
    pub link: &'a Link,
    /// Its frame in the world.
    pub pose: Isometry3<f64>,
    pub velocity: Vector3<f64>,
    pub spin: Vector3<f64>,
    /// The joint that carries it, and its position.
    pub joint: Option<(&'a UrdfJoint, f64)>,
    /// The body that it is part of, and its frame in that of the body.
    pub carrier: Carrier,
}

#[derive(Clone)]
pub(super) struct Carrier {
    pub name: String,
    pub frame: Isometry3<f64>,
}
