//! Integration in independent coordinates: any method for ordinary differential equations, applied to (η, η̇) of a
//! [`Chart`]. The constraints of position and velocity hold at every stage and at every output.

mod spatial;

mod edge;
mod tree;

mod tree_dynamics;
mod tree_lanes;

mod numbers;

mod tilt;

mod guess;

mod chart;

mod within;

mod bridged;

pub use bridged::Bridged;
pub use chart::{Chart, IndependentCoordinates};
pub use within::Start;
