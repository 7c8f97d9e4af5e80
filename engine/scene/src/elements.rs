//! What a scene consists of: bodies, joints, drivers, loads, markers and events, and what they are written with.

mod orientation;

mod motion;

mod body;

mod joint;

mod driver;

mod load;

mod marker;

mod event;

pub use body::{AttachedMass, Body, Coordinates, Inertia, Shape};
pub use driver::Driver;
pub use event::{Event, Passing, Quantity};
pub use joint::{AxisRows, Joint, JointKind, JointStart};
pub use load::{Friction, Load, LoadFrame};
pub use marker::Marker;
pub use motion::{Motion, VectorMotion};
pub use orientation::{Orientation, WrittenOrientation};
