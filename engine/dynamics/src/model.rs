//! A checked scene: names resolved, every physical check made, principal axes found.
//!
//! A [`Model`] can only be made from a [`Scene`], and everything after it relies on what is checked here. Points and
//! vectors of a body are from now on written in its *principal frame*: origin at the centre of mass, axes along the
//! directors u, v, w, which the formulation requires to be principal axes of inertia — THEORY eq. (2.1).

pub mod motion;

mod body;
mod custom_load;
mod driver;
mod error;
mod event;
mod gear;
mod joint;
mod joint_keys;
mod load;
mod marker;
mod meshing;
mod moving;
mod output;
mod parameter;
mod placement;
mod reader;

pub use body::ModelBody;
pub use custom_load::{BodyMotion, CustomLoad, CustomLoadError, LoadState, ModelCustomLoad, Motions, Wrench};
pub use driver::{DriverKind, ModelDriver};
pub use error::{ModelError, OTHER_THAN_COSINE};
pub use event::{EventQuantity, ModelEvent};
pub use joint::{JointGeometry, ModelJoint, director_along};
pub use load::{ForceLaw, LoadKind, ModelLoad};
pub use marker::ModelMarker;
pub use output::wants_joint;
pub use placement::ModelStart;
pub(crate) use placement::driven_instead;

use crate::scene::{ConstraintMethod, Driver, Event, Load, Marker, Scene, Settings};
use nalgebra::Vector3;
use placement::DrivenFrom;
use reader::ModelReader;
use std::collections::HashMap;

/// Greatest length, velocity, angular velocity or gravity that a scene may state, SI units: galaxies are within 1e22 m. With
/// [`MAX_MASS`] even the square of a moment of inertia stays far below the largest number.
const MAX_LENGTH: f64 = 1e30;
/// Greatest and least mass of a body, kg: electrons have 1e-30, all that is to be seen of the universe 1e53.
const MAX_MASS: f64 = 1e60;
const MIN_MASS: f64 = 1e-60;
/// Greatest moment of inertia, kg m².
const MAX_INERTIA: f64 = 1e100;

/// A body by its place in the model, or the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyRef {
    /// The fixed body, whose frame is the world.
    Ground,
    /// A moving body.
    Moving(usize),
}

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
    /// Starts that are given by joints.
    pub starts: Vec<ModelStart>,
    /// The drivers, in the scene's order.
    pub drivers: Vec<ModelDriver>,
    /// The loads besides gravity, in the scene's order.
    pub loads: Vec<ModelLoad>,
    /// Loads that a program gives as functions of the state: [`Model::with_loads`].
    pub custom_loads: Vec<ModelCustomLoad>,
    /// Points with names, in the scene's order.
    pub markers: Vec<ModelMarker>,
    /// Events to be located, in the scene's order.
    pub events: Vec<ModelEvent>,
    /// How to run it.
    pub settings: Settings,
    /// What was found or corrected, for the author.
    pub notes: Vec<String>,
}

impl Model {
    /// The mass of all bodies, kg.
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|body| body.mass).sum()
    }

    /// Checks a scene and resolves its names.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: the first thing in the scene that cannot be, with its place as a JSON pointer and what to try.
    pub fn new(scene: &Scene) -> Result<Self, ModelError> {
        within(&scene.gravity, MAX_LENGTH, "/gravity")?;
        check_settings(&scene.simulation)?;
        if scene.bodies.is_empty() {
            return Err(ModelError::NoBodies);
        }
        let mut notes = Vec::new();
        let (names, mut bodies) = read_bodies(scene, &mut notes)?;
        // Joints and drivers share one space of names: both label rows.
        let mut row_names = HashMap::new();
        let (joints, mut starts) = read_joints(scene, &names, &bodies, &mut row_names, &mut notes)?;
        let driven = driven_from(scene, &names, &bodies, &joints);
        placement::begin_where_driven(&driven, &joints, &mut starts, &mut notes);
        meshing::pass_on(&joints, &mut starts, &mut notes)?;
        placement::place(&mut bodies, &joints, &starts, &mut notes);
        let reader = |list, index, name| ModelReader {
            list,
            index,
            name,
            names: &names,
            bodies: &bodies,
            joints: &joints,
            duration: scene.simulation.duration,
        };
        let markers = read_list("markers", &scene.markers, Marker::name, |index, written| {
            ModelMarker::new(written, &reader("markers", index, &written.name))
        })?;
        let mut drivers = Vec::with_capacity(scene.drivers.len());
        for (index, written) in scene.drivers.iter().enumerate() {
            unique_name(
                &mut row_names,
                ("drivers", index),
                written.name(),
                joints.len() + index,
                of_row(joints.len()),
            )?;
            drivers.push(ModelDriver::new(written, &reader("drivers", index, written.name()))?);
        }
        let loads = read_list("loads", &scene.loads, Load::name, |index, written| {
            ModelLoad::new(written, &reader("loads", index, written.name()))
        })?;
        let events = read_list("events", &scene.events, Event::name, |index, written| {
            ModelEvent::new(written, &reader("events", index, &written.name), &markers)
        })?;
        parameter::check(scene)?;
        output::check(scene)?;
        Ok(Self {
            name: scene.name.clone(),
            gravity: Vector3::from(scene.gravity),
            bodies,
            joints,
            starts,
            drivers,
            loads,
            custom_loads: Vec::new(),
            markers,
            events,
            settings: scene.simulation.clone(),
            notes,
        })
    }
}

/// The joints that drivers turn, and the angles from which on, as far as the drivers can be read.
fn driven_from(
    scene: &Scene,
    names: &HashMap<String, usize>,
    bodies: &[ModelBody],
    joints: &[ModelJoint],
) -> Vec<DrivenFrom> {
    let duration = scene.simulation.duration;
    let angles = scene.drivers.iter().enumerate().filter_map(|(index, written)| {
        if !matches!(written, Driver::Angle { .. }) {
            return None;
        }
        let reader =
            ModelReader { list: "drivers", index, name: written.name(), names, bodies, joints, duration };
        match ModelDriver::new(written, &reader).ok()?.kind {
            DriverKind::Angle { joint, motion } => {
                Some(DrivenFrom { driver: written.name().to_owned(), joint, angle: motion.at(0.0)[0] })
            }
            _ => None,
        }
    });
    angles.collect()
}

/// The bodies of a scene, and the places of their names.
fn read_bodies(
    scene: &Scene,
    notes: &mut Vec<String>,
) -> Result<(HashMap<String, usize>, Vec<ModelBody>), ModelError> {
    let mut names = HashMap::new();
    let mut bodies = Vec::with_capacity(scene.bodies.len());
    for (index, written) in scene.bodies.iter().enumerate() {
        unique_name(&mut names, ("bodies", index), &written.name, index, |k| format!("bodies[{k}]"))?;
        bodies.push(ModelBody::new(written, index, scene.coordinates, notes)?);
    }
    Ok((names, bodies))
}

/// The joints of a scene, and the starts of those that have one. A gear refers to joints that stand before it.
fn read_joints(
    scene: &Scene,
    names: &HashMap<String, usize>,
    bodies: &[ModelBody],
    row_names: &mut HashMap<String, usize>,
    notes: &mut Vec<String>,
) -> Result<(Vec<ModelJoint>, Vec<ModelStart>), ModelError> {
    let mut joints = Vec::with_capacity(scene.joints.len());
    let mut starts = Vec::new();
    for (index, written) in scene.joints.iter().enumerate() {
        unique_name(row_names, ("joints", index), &written.name, index, |k| format!("joints[{k}]"))?;
        let (list, name) = ("joints", written.name.as_str());
        let joint = {
            let duration = scene.simulation.duration;
            let reader = ModelReader { list, index, name, names, bodies, joints: &joints, duration };
            starts.extend(ModelStart::new(written, &reader)?);
            ModelJoint::new(written, &reader, notes)?
        };
        joints.push(joint);
    }
    Ok((joints, starts))
}

/// The elements of a list that share no name.
fn read_list<'a, W, R>(
    list: &'static str,
    written: &'a [W],
    name: impl Fn(&W) -> &str,
    mut read: impl FnMut(usize, &'a W) -> Result<R, ModelError>,
) -> Result<Vec<R>, ModelError> {
    let mut names = HashMap::new();
    let mut elements = Vec::with_capacity(written.len());
    for (index, written) in written.iter().enumerate() {
        unique_name(&mut names, (list, index), name(written), index, |k| format!("{list}[{k}]"))?;
        elements.push(read(index, written)?);
    }
    Ok(elements)
}

/// Where a joint or, behind them, a driver stands.
fn of_row(joints: usize) -> impl Fn(usize) -> String {
    move |number| match number.checked_sub(joints) {
        None => format!("joints[{number}]"),
        Some(driver) => format!("drivers[{driver}]"),
    }
}

/// Keeps the number of a name; `place` tells where that with a number stands.
fn unique_name(
    names: &mut HashMap<String, usize>,
    (list, index): (&'static str, usize),
    name: &str,
    number: usize,
    place: impl Fn(usize) -> String,
) -> Result<(), ModelError> {
    if name.is_empty() || name == crate::scene::GROUND || name.contains(char::is_control) {
        return Err(ModelError::ReservedName { list, index, name: name.to_owned() });
    }
    match names.insert(name.to_owned(), number) {
        Some(first) => {
            Err(ModelError::DuplicateName { list, index, first: place(first), name: name.to_owned() })
        }
        None => Ok(()),
    }
}

/// Refuses infinities, NaN, and numbers above `most`, which products of masses and lengths would carry out of the range of
/// arithmetic.
fn within(values: &[f64], most: f64, pointer: &str) -> Result<(), ModelError> {
    finite(values, pointer)?;
    match values.iter().find(|x| x.abs() > most) {
        Some(&value) => {
            Err(ModelError::OutOfRange { pointer: pointer.to_owned(), value, low: -most, high: most })
        }
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
    if let Some(step) = settings.step {
        range("step", step, 1e-9, 1e3)?;
    }
    match settings.constraint_method {
        ConstraintMethod::Projection | ConstraintMethod::Partitioning => Ok(()),
        ConstraintMethod::Baumgarte { alpha, beta } => {
            range("stabilization/alpha", alpha, 0.0, 1e6)?;
            range("stabilization/beta", beta, 0.0, 1e6)
        }
        ConstraintMethod::Penalty { alpha, omega, mu } => {
            range("stabilization/alpha", alpha, 1e-3, 1e15)?;
            range("stabilization/omega", omega, 0.0, 1e6)?;
            range("stabilization/mu", mu, 0.0, 1e3)
        }
        ConstraintMethod::AugmentedLagrangian { alpha } => range("stabilization/alpha", alpha, 1e-3, 1e15),
    }
}
