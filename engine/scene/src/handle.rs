//! Names that stand for the elements of a scene where others refer to them.

use std::fmt;

/// Name of the fixed body that every scene has.
pub const GROUND: &str = "ground";

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
    ($($(#[$text:meta])* $handle:ident;)*) => {$(
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
    )*};
}

handles! {
    /// A body, by its name: what [`Scene::add`](crate::Scene::add) gives for one, and what takes a body takes as well as [`Ground`] or text.
    BodyHandle;
    /// A joint, by its name.
    JointHandle;
    /// A driver, by its name.
    DriverHandle;
    /// A load, by its name.
    LoadHandle;
    /// A marker, by its name.
    MarkerHandle;
    /// An event, by its name.
    EventHandle;
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
