//! What a side-car says of links that are parts of bodies, said of the bodies.

use nalgebra::{Isometry3, Point3, Vector3};
use triad_scene::{Driver, Joint, Load, LoadFrame, VectorMotion};

use crate::omissions::UrdfError;
use crate::placed::Placed;

/// The links in their places.
#[derive(Clone, Copy)]
pub(super) struct Links<'a>(pub &'a [Placed<'a>]);

impl Links<'_> {
    /// A joint.
    pub fn joint(self, joint: &Joint) -> Joint {
        let mut joint = joint.clone();
        let on_body = |name: &mut String, point: &mut Option<[f64; 3]>, axis: &mut Option<[f64; 3]>| {
            if let Some(frame) = self.body_of(name) {
                *point = point.map(|p| on(&frame, p));
                *axis = axis.map(|a| turned(&frame, a));
            }
        };
        on_body(&mut joint.body_i, &mut joint.point_i, &mut joint.axis_i);
        on_body(&mut joint.body_j, &mut joint.point_j, &mut joint.axis_j);
        joint
    }

    /// A load.
    ///
    /// Errors if its components vary along axes of a link that is turned in its body.
    pub fn load(self, load: &Load) -> Result<Load, UrdfError> {
        let mut load = load.clone();
        match &mut load {
            Load::Force { name, body, point, force, frame } => {
                let link = body.clone();
                if let Some(at) = self.body_of(body) {
                    *point = on(&at, *point);
                    self.turn((name, &link), *frame, &at, force)?;
                }
            }
            Load::Moment { name, body, moment, frame } => {
                let link = body.clone();
                if let Some(at) = self.body_of(body) {
                    self.turn((name, &link), *frame, &at, moment)?;
                }
            }
            Load::Spring { body_i, point_i, body_j, point_j, .. } => {
                for (body, point) in [(body_i, point_i), (body_j, point_j)] {
                    if let Some(at) = self.body_of(body) {
                        *point = on(&at, *point);
                    }
                }
            }
            Load::Torsion { .. } | Load::Slider { .. } => {}
        }
        Ok(load)
    }

    /// A driver.
    pub fn driver(self, driver: &Driver) -> Driver {
        let mut driver = driver.clone();
        match &mut driver {
            Driver::Point { body, point, .. } => {
                if let Some(at) = self.body_of(body) {
                    *point = on(&at, *point);
                }
            }
            Driver::Vector { body, vector, .. } | Driver::AngleToWorld { body, vector, .. } => {
                if let Some(at) = self.body_of(body) {
                    *vector = turned(&at, *vector);
                }
            }
            Driver::AngleCosine { body_i, vector_i, body_j, vector_j, .. } => {
                for (body, vector) in [(body_i, vector_i), (body_j, vector_j)] {
                    if let Some(at) = self.body_of(body) {
                        *vector = turned(&at, *vector);
                    }
                }
            }
            Driver::Angle { .. } | Driver::Slide { .. } => {}
        }
        driver
    }

    /// Replaces the name of a link by that of its body; the frame of the link in that of the body.
    fn body_of(self, name: &mut String) -> Option<Isometry3<f64>> {
        let placed = self.0.iter().find(|placed| placed.link.name == *name)?;
        name.clone_from(&placed.carrier.name);
        Some(placed.carrier.frame)
    }

    /// A vector along axes of a link, along those of its body.
    fn turn(
        self,
        (load, link): (&str, &str),
        frame: LoadFrame,
        at: &Isometry3<f64>,
        vector: &mut VectorMotion,
    ) -> Result<(), UrdfError> {
        match vector {
            _ if frame == LoadFrame::World || at.rotation.angle() == 0.0 => {}
            VectorMotion::Fixed { vector } => *vector = turned(at, *vector),
            VectorMotion::Turning { start, axis, .. } => {
                (*start, *axis) = (turned(at, *start), turned(at, *axis));
            }
            VectorMotion::Components { .. } => {
                let placed = self.0.iter().find(|placed| placed.link.name == link);
                return Err(UrdfError::Wrong {
                    line: placed.map_or(1, |placed| placed.link.line),
                    what: format!(
                        "load \"{load}\" of the side-car has components along link \"{link}\", which is a turned part of a body"
                    ),
                    hint: "name the link that the body is called after, with components along its axes",
                });
            }
        }
        Ok(())
    }
}

fn on(frame: &Isometry3<f64>, point: [f64; 3]) -> [f64; 3] {
    (frame * Point3::from(point)).into()
}

fn turned(frame: &Isometry3<f64>, vector: [f64; 3]) -> [f64; 3] {
    (frame * Vector3::from(vector)).into()
}
