//! Values read off runs of a scene: [`measure`] (as it is), [`wrong_model`] (with a misconception in it),
//! [`worlds`] (with each of the usual mistakes), and [`equations`] (what is written at a state).

pub(crate) mod equations;
pub(crate) mod measure;
pub(crate) mod worlds;
pub(crate) mod wrong_model;
