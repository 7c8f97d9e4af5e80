//! A body as strokes: its shapes, or a bar from its centre of mass to each of its joints.

use super::Clock;
use super::view::View;
use nalgebra::{Matrix3, Vector3};
use std::fmt::Write as _;
use triad_engine::model::{BodyRef, Model};
use triad_engine::scene::{Scene, Shape};
use triad_engine::state::BodyFrame;

/// Widths of bars, edges of boxes and pins, px.
const BAR: f64 = 7.0;
const EDGE: f64 = 2.0;
const PIN: f64 = 5.0;
/// Width of the ball of a body that nobody drew, px.
const BALL: f64 = 16.0;
/// Least width of a ball that somebody drew, px: so that it is seen.
const LEAST_BALL: f64 = 6.0;

/// Strokes of one width: pieces of lines, each from point to point.
#[derive(Clone, Debug)]
struct Strokes {
    /// In the principal frame of the body, m.
    lines: Vec<Vec<Vector3<f64>>>,
    width: Width,
}

/// How wide strokes are.
#[derive(Clone, Copy, Debug)]
enum Width {
    /// On the paper, px.
    Pixels(f64),
    /// In the world, m.
    Metres(f64),
}

/// A body as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    strokes: Vec<Strokes>,
    /// Points of its joints in its principal frame, m.
    pins: Vec<Vector3<f64>>,
}

impl Drawn {
    /// The body of that number.
    pub fn new(scene: &Scene, model: &Model, body: usize) -> Self {
        let sides = model.joints.iter().flat_map(|joint| joint.bodies.iter().zip(&joint.points));
        let pins: Vec<Vector3<f64>> =
            sides.filter(|(side, _)| **side == BodyRef::Moving(body)).map(|(_, point)| *point).collect();
        let shapes = scene.bodies.get(body).map_or(&[][..], |written| &written.shape);
        let mut strokes: Vec<Strokes> = shapes
            .iter()
            .map(|shape| strokes(shape, |point| model.bodies[body].point_to_principal(&Vector3::from(point))))
            .collect();
        if strokes.is_empty() {
            let bars = pins.iter().map(|pin| vec![Vector3::zeros(), *pin]).collect();
            strokes.push(Strokes { lines: bars, width: Width::Pixels(BAR) });
            strokes.push(Strokes { lines: vec![vec![Vector3::zeros()]], width: Width::Pixels(BALL) });
        }
        Self { strokes, pins }
    }

    /// How many points one picture of it has.
    pub fn count(&self) -> usize {
        self.strokes.iter().flat_map(|strokes| &strokes.lines).map(Vec::len).sum::<usize>() + self.pins.len()
    }

    /// Where they are in the world, m.
    pub fn points(&self, at: &BodyFrame) -> Vec<[f64; 3]> {
        let place = placed(at);
        let strokes = self.strokes.iter().flat_map(|strokes| &strokes.lines).flatten();
        strokes.chain(&self.pins).map(place).collect()
    }

    /// Writes it with its motion.
    pub fn write(&self, frames: &[&BodyFrame], view: &View, colour: &str, clock: &Clock, out: &mut String) {
        for strokes in &self.strokes {
            let width = match strokes.width {
                Width::Pixels(width) => width,
                Width::Metres(width) => view.long(width).max(LEAST_BALL),
            };
            path(
                &strokes.lines,
                frames,
                view,
                &format!("stroke=\"{colour}\" stroke-width=\"{width:.1}\""),
                clock,
                out,
            );
        }
        let pins: Vec<Vec<Vector3<f64>>> = self.pins.iter().map(|pin| vec![*pin]).collect();
        path(&pins, frames, view, &format!("class=\"pin\" stroke-width=\"{PIN}\""), clock, out);
    }
}

/// The strokes of a shape, whose points `local` takes into the principal frame.
fn strokes(shape: &Shape, local: impl Fn([f64; 3]) -> Vector3<f64>) -> Strokes {
    match shape {
        Shape::Rod { from, to, .. } => {
            Strokes { lines: vec![vec![local(*from), local(*to)]], width: Width::Pixels(BAR) }
        }
        Shape::Sphere { center, radius } => {
            Strokes { lines: vec![vec![local(*center)]], width: Width::Metres(2.0 * radius) }
        }
        Shape::Box { center, size } => {
            let corner =
                |signs: [f64; 3]| local(std::array::from_fn(|k| center[k] + 0.5 * signs[k] * size[k]));
            let round = |z: f64| {
                let around = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
                around.map(|[x, y]| corner([x, y, z])).to_vec()
            };
            let (low, high) = (round(-1.0), round(1.0));
            let posts = (0..4).map(|k| vec![low[k], high[k]]);
            let lines = posts.chain([low.clone(), high.clone()]).collect();
            Strokes { lines, width: Width::Pixels(EDGE) }
        }
    }
}

/// From the principal frame of a body into the world.
fn placed(at: &BodyFrame) -> impl Fn(&Vector3<f64>) -> [f64; 3] + use<> {
    let directors = Matrix3::from_columns(&[at.u, at.v, at.w].map(Vector3::from));
    let centre = Vector3::from(at.position);
    move |point| (centre + directors * point).into()
}

/// Lines as one path that moves; a line of one point is a dot.
fn path(
    lines: &[Vec<Vector3<f64>>],
    frames: &[&BodyFrame],
    view: &View,
    look: &str,
    clock: &Clock,
    out: &mut String,
) {
    if lines.is_empty() {
        return;
    }
    let pictures: Vec<String> = frames.iter().map(|frame| picture(lines, frame, view)).collect();
    let _ = write!(out, "<path {look} d=\"{}\">", pictures.first().map_or("", String::as_str));
    clock.animate("d", &pictures, clock.times.as_deref(), out);
    out.push_str("</path>\n");
}

fn picture(lines: &[Vec<Vector3<f64>>], frame: &BodyFrame, view: &View) -> String {
    let place = placed(frame);
    let mut text = String::new();
    for line in lines {
        for (k, point) in line.iter().enumerate() {
            let [x, y] = view.place(place(point));
            let _ = write!(text, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
        }
        if line.len() == 1 {
            text.push_str("h0");
        }
    }
    text
}
