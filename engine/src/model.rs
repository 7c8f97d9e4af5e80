//! A checked scene: names resolved, every physical check made, principal axes found.
//!
//! A [`Model`] can only be made from a [`Scene`], and everything after it relies on what is checked here. Points and
//! vectors of a body are from now on written in its *principal frame*: origin at the centre of mass, axes along the
//! directors u, v, w, which the formulation wants to be principal axes of inertia — THEORY eq. (2.1).

mod body;
mod error;
mod joint;

pub use body::ModelBody;
pub use error::ModelError;
pub use joint::{BodyRef, ModelJoint, nearest_name};

use crate::scene::{Scene, Settings, Stabilization};
use nalgebra::Vector3;
use std::collections::HashMap;

/// A checked scene.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the scene.
    pub name: String,
    /// Acceleration of gravity, m/s².
    pub gravity: Vector3<f64>,
    /// The moving bodies, in the scene's order.
    pub bodies: Vec<ModelBody>,
    /// The joints, in the scene's order.
    pub joints: Vec<ModelJoint>,
    /// How to run it.
    pub settings: Settings,
    /// What was found or corrected, for the author.
    pub notes: Vec<String>,
}

impl Model {
    /// Checks a scene and resolves its names.
    pub fn new(scene: &Scene) -> Result<Self, ModelError> {
        finite(&scene.gravity, "/gravity")?;
        check_settings(&scene.simulation)?;
        if scene.bodies.is_empty() {
            return Err(ModelError::NoBodies);
        }
        let mut notes = Vec::new();
        let mut names = HashMap::new();
        let mut bodies = Vec::with_capacity(scene.bodies.len());
        for (index, written) in scene.bodies.iter().enumerate() {
            unique_name(&mut names, "bodies", index, &written.name)?;
            bodies.push(ModelBody::new(written, index, scene.coordinates, &mut notes)?);
        }
        let mut joint_names = HashMap::new();
        let mut joints = Vec::with_capacity(scene.joints.len());
        for (index, written) in scene.joints.iter().enumerate() {
            unique_name(&mut joint_names, "joints", index, &written.name)?;
            joints.push(ModelJoint::new(written, index, &names, &bodies)?);
        }
        Ok(Self {
            name: scene.name.clone(),
            gravity: Vector3::from(scene.gravity),
            bodies,
            joints,
            settings: scene.simulation.clone(),
            notes,
        })
    }
}

fn unique_name(
    names: &mut HashMap<String, usize>,
    list: &'static str,
    index: usize,
    name: &str,
) -> Result<(), ModelError> {
    if name.is_empty() || name == crate::scene::GROUND {
        return Err(ModelError::ReservedName { list, index, name: name.to_owned() });
    }
    match names.insert(name.to_owned(), index) {
        Some(first) => Err(ModelError::DuplicateName { list, index, first, name: name.to_owned() }),
        None => Ok(()),
    }
}

/// Refuses infinities and NaN.
fn finite(values: &[f64], pointer: &str) -> Result<(), ModelError> {
    match values.iter().find(|x| !x.is_finite()) {
        Some(&value) => Err(ModelError::NotFinite { pointer: pointer.to_owned(), value }),
        None => Ok(()),
    }
}

fn check_settings(settings: &Settings) -> Result<(), ModelError> {
    let range = |key: &'static str, value: f64, low: f64, high: f64| {
        if value >= low && value <= high {
            Ok(())
        } else {
            Err(ModelError::OutOfRange { pointer: format!("/simulation/{key}"), value, low, high })
        }
    };
    range("duration", settings.duration, 0.0, 1e6)?;
    range("every", settings.every, 1e-6, 1e6)?;
    range("tolerance", settings.tolerance, 1e-14, 1e-1)?;
    if let Stabilization::Baumgarte { alpha, beta } = settings.stabilization {
        range("stabilization/alpha", alpha, 0.0, 1e6)?;
        range("stabilization/beta", beta, 0.0, 1e6)?;
    }
    Ok(())
}
