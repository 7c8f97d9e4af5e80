//! Names that later calls take, and how the parts of a scene are added.

use crate::{Body, Driver, Event, GROUND, Joint, Load, Scene};
use std::fmt;

/// The fixed body that every scene has, where a body is asked for.
///
/// ```
/// use triad_scene::{BodyHandle, Ground};
///
/// assert_eq!(BodyHandle::from(Ground).name(), "ground");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Ground;

macro_rules! handles {
    ($($(#[$text:meta])* $handle:ident of $part:ident in $list:ident;)*) => {$(
        $(#[$text])*
        #[derive(Clone, Debug, PartialEq, Eq, Hash)]
        pub struct $handle(String);

        impl $handle {
            /// The name that it stands for.
            pub fn name(&self) -> &str {
                &self.0
            }
        }

        impl AsRef<str> for $handle {
            fn as_ref(&self) -> &str {
                &self.0
            }
        }

        impl fmt::Display for $handle {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&self.0)
            }
        }

        impl From<&Self> for $handle {
            fn from(handle: &Self) -> Self {
                handle.clone()
            }
        }

        impl From<&str> for $handle {
            fn from(name: &str) -> Self {
                Self(name.to_owned())
            }
        }

        impl From<String> for $handle {
            fn from(name: String) -> Self {
                Self(name)
            }
        }

        impl From<&String> for $handle {
            fn from(name: &String) -> Self {
                Self(name.clone())
            }
        }

        impl From<$handle> for String {
            fn from(handle: $handle) -> Self {
                handle.0
            }
        }

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

/// What [`Scene::add`] takes: bodies, joints, drivers, loads and events.
pub trait SceneElement {
    /// What stands for it in later calls.
    type Handle;

    /// Puts it at the end of its list in the scene.
    fn add_to(self, scene: &mut Scene) -> Self::Handle;
}

handles! {
    /// A body, by its name: what [`Scene::add`] gives for one, and what takes a body takes as well as [`Ground`] or text.
    BodyHandle of Body in bodies;
    /// A joint, by its name.
    JointHandle of Joint in joints;
    /// A driver, by its name.
    DriverHandle of Driver in drivers;
    /// A load, by its name.
    LoadHandle of Load in loads;
    /// An event, by its name.
    EventHandle of Event in events;
}

impl AsRef<str> for Ground {
    fn as_ref(&self) -> &str {
        GROUND
    }
}

impl From<Ground> for BodyHandle {
    fn from(_: Ground) -> Self {
        Self(GROUND.to_owned())
    }
}
