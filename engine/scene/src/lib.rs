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

pub mod expression;

mod value;

mod limits;

mod handle;

mod outputs;

mod times;

mod settings;

mod elements;

mod parameter;

mod error;

mod scene;

mod changes;

pub mod catalogue;

pub use changes::WrittenScene;
pub use elements::{
    AttachedMass, AxisRows, Body, Coordinates, Driver, Event, Friction, Inertia, Joint, JointKind,
    JointStart, Load, LoadFrame, Marker, Motion, Orientation, Passing, Quantity, Shape, VectorMotion,
    WrittenOrientation,
};
pub use error::SceneError;
pub use handle::{
    BodyHandle, DriverHandle, EventHandle, GROUND, Ground, JointHandle, LoadHandle, MarkerHandle,
};
pub use limits::{MAX_BODIES, MAX_EVENTS, MAX_JOINTS, MAX_TEXT};
pub use outputs::{Output, OutputKind};
pub use parameter::{MAX_PARAMETERS, OnChange, Parameter, Place, Places};
pub use scene::{Scene, SceneElement, schema};
pub use settings::{ConstraintMethod, IntegratorKind, Settings, Skip};
pub use text::UnknownWord;
pub use times::OutputTimes;
pub use value::Triple;
