//! A body cut free, as a student sees it.

use schemars::JsonSchema;
use serde::Serialize;

use crate::answers::diagram::{Axis, place_in_words};
use crate::exercise::Diagram;
use crate::exercise::cut::{Cut, SIZE, handedness};

/// Bodies cut free: their picture and the points where arrows may be put.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "DiagramChoices")]
pub struct DiagramView {
    /// The picture without arrows, as SVG that the grader drew; empty if the scene does not run so far.
    pub picture_svg: String,
    /// Width and height of the picture, px.
    pub size: [f64; 2],
    /// Axes of the ground frame to the right, up, and out of the picture.
    pub axes: [Axis; 3],
    /// Whether a positive moment turns anticlockwise in the picture.
    pub anticlockwise: bool,
    /// The moment that is shown, s.
    pub time: f64,
    /// The bodies, each with its points.
    pub bodies: Vec<CutBodyView>,
}

/// A body that is cut free.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "CutBody")]
pub struct CutBodyView {
    /// Its name.
    pub name: String,
    /// Where arrows may be put.
    pub places: Vec<PlaceView>,
}

/// A point of a body.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "CutPlace")]
pub struct PlaceView {
    /// Name to send.
    pub id: String,
    /// Name for people.
    pub label: String,
    /// Its place in the picture, px from the left and from above.
    pub at: [f64; 2],
}

impl DiagramView {
    pub(super) fn new(task: &Diagram) -> Self {
        let cut = Cut::new(task).ok();
        let place = |body: usize, name: &str| {
            let places = cut.as_ref().and_then(|cut| cut.places.get(body));
            let at = places.and_then(|places| places.iter().find(|place| place.name == name));
            let label = place_in_words(name);
            PlaceView {
                id: name.to_owned(),
                label,
                at: at.map_or([0.0; 2], |place| place.at.map(f64::round)),
            }
        };
        let body = |(k, name): (usize, &String)| CutBodyView {
            name: name.clone(),
            places: task.places(name).into_iter().map(|name| place(k, name)).collect(),
        };
        Self {
            picture_svg: cut.as_ref().map_or_else(String::new, |cut| cut.svg(&[])),
            size: SIZE,
            axes: task.view.picture(),
            anticlockwise: handedness(task.view) > 0.0,
            time: task.time,
            bodies: task.bodies.iter().enumerate().map(body).collect(),
        }
    }
}
