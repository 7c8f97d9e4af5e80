//! A scene exactly as its author wrote it.
//!
//! Nothing here is checked beyond its type: that is the work of the engine's `Model`. Unknown keys are
//! refused, so that a misspelt key cannot silently mean its default. SI units, radians, right-handed axes.
//!
//! ```
//! use triad_scene::{Body, Ground, Joint, Scene};
//!
//! let mut scene = Scene::new("pendulum").gravity([0.0, -9.81, 0.0]);
//! let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
//! scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
//! assert_eq!(Scene::from_json(&scene.to_json())?, scene);
//! # Ok::<(), triad_scene::SceneError>(())
//! ```

pub mod text;

mod body;
pub mod catalogue;
mod driver;
mod error;
mod event;
mod handle;
mod joint;
mod load;
mod motion;
mod orientation;
mod parameter;
mod settings;

pub use body::{Body, Coordinates, Inertia, Shape};
pub use driver::Driver;
pub use error::SceneError;
pub use event::{Event, Passing, Quantity};
pub use handle::{BodyHandle, DriverHandle, EventHandle, Ground, JointHandle, LoadHandle, SceneElement};
pub use joint::{AxisRows, Joint, JointKind};
pub use load::{Friction, Load, LoadFrame};
pub use motion::{Motion, VectorMotion};
pub use orientation::{Orientation, WrittenOrientation};
pub use parameter::{MAX_PARAMETERS, OnChange, Parameter, Place, Places, WrittenScene};
pub use settings::{ConstraintMethod, IntegratorKind, Settings, Skip};
pub use text::UnknownWord;

use error::{plain_error, syntax_error};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of bodies that a scene may have.
pub const MAX_BODIES: usize = 5_000;
/// Largest number of joints, drivers or loads that a scene may have (each).
pub const MAX_JOINTS: usize = 20_000;
/// Largest number of events that a scene may look for.
pub const MAX_EVENTS: usize = 1_000;
/// Largest text of a scene, in bytes.
pub const MAX_TEXT: usize = 16 << 20;

/// Name of the fixed body that every scene has.
pub const GROUND: &str = "ground";

/// A vector of three numbers.
pub type Triple = [f64; 3];

/// A mechanism, its surroundings and how to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Short name in lower case, used in file names and addresses.
    pub name: String,
    /// Title for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// What the scene shows and where its data come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Acceleration of gravity in the world frame, m/s².
    #[serde(default = "standard_gravity")]
    pub gravity: Triple,
    /// Coordinates of every body that does not choose for itself.
    #[serde(default, skip_serializing_if = "is_default")]
    pub coordinates: Coordinates,
    /// The moving bodies.
    pub bodies: Vec<Body>,
    /// The joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<Joint>,
    /// What moves as prescribed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drivers: Vec<Driver>,
    /// Forces and moments besides gravity.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// Moments to look for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
    /// How to run the scene.
    #[serde(default, skip_serializing_if = "is_default")]
    pub simulation: Settings,
    /// Numbers of the scene that may be changed while it runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<Parameter>,
}

fn standard_gravity() -> Triple {
    [0.0, 0.0, -9.81]
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Default for Scene {
    /// Nothing, with gravity of 9.81 m/s² along −z.
    fn default() -> Self {
        Self::new("")
    }
}

impl Scene {
    /// An empty scene, with gravity of 9.81 m/s² along −z.
    ///
    /// ```
    /// let scene = triad_scene::Scene::new("nothing-yet");
    /// assert_eq!(scene.gravity, [0.0, 0.0, -9.81]);
    /// assert!(scene.bodies.is_empty());
    /// ```
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            title: String::new(),
            description: String::new(),
            gravity: standard_gravity(),
            coordinates: Coordinates::default(),
            bodies: Vec::new(),
            joints: Vec::new(),
            drivers: Vec::new(),
            loads: Vec::new(),
            events: Vec::new(),
            simulation: Settings::default(),
            parameters: Vec::new(),
        }
    }

    /// Adds a body, joint, driver, load or event, and gives what stands for it in later calls. Names must be unique
    /// within their list; the model checks it.
    ///
    /// ```
    /// use triad_scene::{Body, Driver, Ground, Joint, Motion, Scene};
    ///
    /// let mut scene = Scene::new("crank");
    /// let crank = scene.add(Body::rod("crank", 0.5, [0.0; 3], [0.1, 0.0, 0.0]));
    /// let hinge = scene.add(Joint::revolute("hinge", Ground, &crank).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    /// let motor = scene.add(Driver::angle("motor", &hinge, Motion::ramp(0.0, 10.0)));
    /// assert_eq!((crank.name(), hinge.name(), motor.name()), ("crank", "hinge", "motor"));
    /// ```
    pub fn add<E: SceneElement>(&mut self, element: E) -> E::Handle {
        element.add_to(self)
    }

    /// Its title for people.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// What it shows and where its data come from.
    #[must_use]
    pub fn description(mut self, description: impl Into<String>) -> Self {
        self.description = description.into();
        self
    }

    /// The acceleration of gravity in the world, m/s².
    #[must_use]
    pub fn gravity(mut self, gravity: Triple) -> Self {
        self.gravity = gravity;
        self
    }

    /// Coordinates of every body that does not choose for itself.
    #[must_use]
    pub fn coordinates(mut self, coordinates: Coordinates) -> Self {
        self.coordinates = coordinates;
        self
    }

    /// The end of the run, s.
    #[must_use]
    pub fn duration(mut self, duration: f64) -> Self {
        self.simulation.duration = duration;
        self
    }

    /// The relative and absolute tolerance of the step control.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.simulation.tolerance = tolerance;
        self
    }

    /// The integrator.
    #[must_use]
    pub fn integrator(mut self, integrator: IntegratorKind) -> Self {
        self.simulation.integrator = integrator;
        self
    }

    /// Reads a scene from JSON.
    ///
    /// ```
    /// use triad_scene::Scene;
    ///
    /// let scene = Scene::from_json(r#"{"name": "drop", "bodies": [{"name": "stone", "mass": 1}]}"#)?;
    /// assert_eq!(scene.simulation.duration, 10.0);
    /// let error = Scene::from_json(r#"{"name": "drop", "bodys": []}"#).unwrap_err();
    /// assert!(error.to_string().contains("bodys"));
    /// # Ok::<(), triad_scene::SceneError>(())
    /// ```
    pub fn from_json(text: &str) -> Result<Self, SceneError> {
        if text.len() > MAX_TEXT {
            return Err(SceneError::TooLong { bytes: text.len() });
        }
        let mut reader = serde_json::Deserializer::from_str(text);
        let scene: Self = serde_path_to_error::deserialize(&mut reader).map_err(|e| syntax_error(&e))?;
        reader.end().map_err(|e| plain_error(&e, "/"))?;
        scene.check_sizes()?;
        Ok(scene)
    }

    /// The scene as JSON, indented.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A checksum that tells scenes apart, to say which one a result belongs to: FNV-1a of its JSON, 64 bits in
    /// hexadecimal digits. It finds changes, not forgeries: collisions can be made on purpose.
    pub fn fingerprint(&self) -> String {
        let hash = self.to_json().bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        format!("{hash:016x}")
    }

    fn check_sizes(&self) -> Result<(), SceneError> {
        let lists = [
            ("bodies", self.bodies.len(), MAX_BODIES),
            ("joints", self.joints.len(), MAX_JOINTS),
            ("drivers", self.drivers.len(), MAX_JOINTS),
            ("loads", self.loads.len(), MAX_JOINTS),
            ("events", self.events.len(), MAX_EVENTS),
            ("parameters", self.parameters.len(), MAX_PARAMETERS),
        ];
        match lists.into_iter().find(|(_, count, limit)| count > limit) {
            Some((what, count, limit)) => Err(SceneError::TooMany { what, count, limit }),
            None => Ok(()),
        }
    }
}

/// The JSON Schema of a scene, generated from the types that read it.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).into()
}
