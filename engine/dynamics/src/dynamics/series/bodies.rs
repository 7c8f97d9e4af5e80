//! L bodies side by side, with the kernels that concern each body alone: in space and in a plane.

mod slot;

mod kernels;

mod convolution;

mod inertia;

mod bundle;

mod pair;

mod components;

mod alone;

mod alone_in_plane;

mod single;

mod planar;

mod points;

mod measures;

pub use bundle::Bundle;
pub use kernels::Bodies;
pub use planar::Planar;
pub use single::Single;
pub use slot::{FeatureSlot, LanePlace};
