//! The scene: its elements, its settings, and how it is read and written.

use crate::elements::{Body, Coordinates, Driver, Event, Joint, Load, Marker};
use crate::error::{SceneError, plain_error, syntax_error};
use crate::handle::{BodyHandle, DriverHandle, EventHandle, JointHandle, LoadHandle, MarkerHandle};
use crate::limits::{MAX_BODIES, MAX_EVENTS, MAX_JOINTS, MAX_TEXT};
use crate::parameter::{MAX_PARAMETERS, Parameter};
use crate::settings::{IntegratorKind, Settings};
use crate::value::{Triple, is_default};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Points with names, whose places and velocities are told.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub markers: Vec<Marker>,
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
            markers: Vec::new(),
            events: Vec::new(),
            simulation: Settings::default(),
            parameters: Vec::new(),
        }
    }

    /// Adds a body, joint, driver, load, marker or event, and gives what stands for it in later calls. Names must be unique
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
    /// # Errors
    ///
    /// [`SceneError`]: a text that is too long or no scene, with line and column, or a scene with too many elements.
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
        // Some editors begin a text with a mark of its encoding.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // The place of every value is kept only to say where a text is wrong: it takes as long as reading.
        let scene: Self = serde_json::from_str(text).or_else(|_| Self::from_json_with_places(text))?;
        scene.check_sizes()?;
        Ok(scene)
    }

    fn from_json_with_places(text: &str) -> Result<Self, SceneError> {
        // A list would be read as the values of a scene in their order.
        if !text.trim_start().starts_with('{') {
            return Err(SceneError::Syntax {
                path: "scene".to_owned(),
                pointer: String::new(),
                line: 1,
                column: 1,
                reason: "a scene stands in braces, and this text begins otherwise".to_owned(),
            });
        }
        let mut reader = serde_json::Deserializer::from_str(text);
        let scene: Self = serde_path_to_error::deserialize(&mut reader).map_err(|e| syntax_error(&e))?;
        reader.end().map_err(|e| plain_error(&e, "/"))?;
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
            ("markers", self.markers.len(), MAX_JOINTS),
            ("events", self.events.len(), MAX_EVENTS),
            ("parameters", self.parameters.len(), MAX_PARAMETERS),
        ];
        match lists.into_iter().find(|(_, count, limit)| count > limit) {
            Some((what, count, limit)) => Err(SceneError::TooMany { what, count, limit }),
            None => Ok(()),
        }
    }
}

/// What [`Scene::add`] takes: bodies, joints, drivers, loads, markers and events.
pub trait SceneElement {
    /// What stands for it in later calls.
    type Handle;

    /// Puts it at the end of its list in the scene.
    fn add_to(self, scene: &mut Scene) -> Self::Handle;
}

macro_rules! elements {
    ($($part:ident in $list:ident, by $handle:ident;)*) => {$(
        impl SceneElement for $part {
            type Handle = $handle;

            fn add_to(self, scene: &mut Scene) -> $handle {
                let handle = $handle::from(self.name());
                scene.$list.push(self);
                handle
            }
        }
    )*};
}

elements! {
    Body in bodies, by BodyHandle;
    Joint in joints, by JointHandle;
    Driver in drivers, by DriverHandle;
    Load in loads, by LoadHandle;
    Marker in markers, by MarkerHandle;
    Event in events, by EventHandle;
}

/// The JSON Schema of a scene, generated from the types that read it.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Scene).into()
}
