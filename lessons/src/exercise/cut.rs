//! Bodies cut free: what acts on them at the moment that is shown, and their picture.

use std::fmt::Write as _;

use triad_engine::EngineError;
use triad_engine::model::{Model, ModelBody};
use triad_engine::scene::{Scene, Shape};
use triad_engine::state::BodyFrame;

use super::diagram::Diagram;
use crate::answers::diagram::{Arrow, ArrowKind, Axis, CENTRE, Sense, place_in_words};
use crate::rendering::html::escape;
use crate::scenario::measure::{MeasureError, Observation, run_to};
use crate::text::plain;

/// Width and height of the picture, px.
pub(crate) const SIZE: [f64; 2] = [560.0, 320.0];
/// Room around the bodies for arrows and numbers, px.
const MARGIN: f64 = 78.0;
/// Length of an arrow and radius of a moment, px.
const ARROW: f64 = 52.0;
const MOMENT: f64 = 24.0;
/// Colours of forces and moments, seen on light and on dark paper.
const FORCE_COLOUR: &str = "#d9480f";
const MOMENT_COLOUR: &str = "#1c7ed6";

/// A place of a body in the picture, px.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    pub name: String,
    pub at: [f64; 2],
}

/// Bodies cut free, with all that the run tells of them.
pub(crate) struct Cut<'a> {
    task: &'a Diagram,
    /// Places of each body, px.
    pub places: Vec<Vec<Place>>,
    /// Every force in the plane of the picture and every moment out of it, SI; zeros too.
    pub values: Vec<(Arrow, f64)>,
    shapes: String,
}

impl<'a> Cut<'a> {
    /// Runs the scene to the moment that is shown.
    pub(crate) fn new(task: &'a Diagram) -> Result<Self, MeasureError> {
        let simulation = run_to(&task.scene, task.time)?;
        let seen = Observation::of(&simulation);
        let model = Model::new(&task.scene).map_err(EngineError::from)?;
        let mut bodies = Vec::new();
        let mut values = Vec::new();
        for name in &task.bodies {
            let frame = seen.body(&task.scene, name)?;
            let body = model.bodies.iter().find(|b| b.name == *name);
            let body = body.ok_or_else(|| MeasureError::NoBody(name.clone()))?;
            let mut places = Vec::new();
            for place in task.places(name) {
                places.push((place.to_owned(), point(task, &seen, frame, place)));
                values.extend(acting(task, &seen, body, place)?);
            }
            bodies.push((outlines(&task.scene, body, frame), places));
        }
        let (shapes, places) = laid_out(task.view, &bodies);
        let shapes = shapes + &titles(&task.bodies, &places);
        Ok(Self { task, places, values, shapes })
    }

    /// The arrows that the run shows: all that are not zero beside the largest of their kind.
    pub(crate) fn acting(&self) -> Vec<(Arrow, f64)> {
        /// Below this share of the largest value it is rounding.
        const ROUNDING: f64 = 1e-7;
        let largest = |kind: ArrowKind| {
            let sizes = self.values.iter().filter(|(a, _)| a.kind == kind).map(|(_, value)| value.abs());
            sizes.fold(0.0, f64::max)
        };
        // A moment that is nothing beside a force at the length of the bodies is no moment.
        let least =
            [largest(ArrowKind::Force), largest(ArrowKind::Moment).max(largest(ArrowKind::Force) * 0.01)];
        let counts = |(arrow, value): &&(Arrow, f64)| {
            value.abs() > ROUNDING * least[usize::from(arrow.kind == ArrowKind::Moment)]
        };
        self.values.iter().filter(counts).cloned().collect()
    }

    /// The picture, with arrows and their values.
    pub(crate) fn svg(&self, arrows: &[(Arrow, f64)]) -> String {
        let [width, height] = SIZE;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\" class=\"cut-free\" font-size=\"13\">{}",
            escape(&self.summary(arrows)),
            self.shapes
        );
        for (arrow, value) in arrows {
            let body = self.task.bodies.iter().position(|name| *name == arrow.on);
            let place = body.and_then(|k| self.places[k].iter().find(|place| place.name == arrow.at));
            if let Some(place) = place {
                self.draw(arrow, *value, place.at, &mut svg);
            }
        }
        svg + "</svg>"
    }

    fn summary(&self, arrows: &[(Arrow, f64)]) -> String {
        let bodies = self.task.bodies.join(", ");
        let lines = arrows.iter().map(|(arrow, value)| format!("; {}", in_words(arrow, Some(*value))));
        format!("Cut free: {bodies}{}", lines.collect::<String>())
    }

    fn draw(&self, arrow: &Arrow, value: f64, [x, y]: [f64; 2], svg: &mut String) {
        let [right, _, _] = self.task.view.picture();
        let sign = arrow.along.sign();
        let number = plain(rounded(value.abs()));
        if arrow.kind == ArrowKind::Moment {
            let sign = sign * handedness(self.task.view);
            let sweep = i32::from(sign < 0.0);
            let (from, to) = (x - MOMENT * sign, x + MOMENT * sign);
            let _ = write!(
                svg,
                "<path d=\"M{from:.1} {y:.1}A{MOMENT} {MOMENT} 0 0 {sweep} {to:.1} {y:.1}l-6 6m6 -6l6 6\" fill=\"none\" stroke=\"{MOMENT_COLOUR}\" stroke-width=\"2.4\"/>\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{MOMENT_COLOUR}\">{number} N m</text>",
                y + MOMENT + 20.0
            );
            return;
        }
        let (dx, dy) = if arrow.along.axis() == right { (sign, 0.0) } else { (0.0, -sign) };
        let (ex, ey) = (x + ARROW * dx, y + ARROW * dy);
        let (bx, by) = (ex - 9.0 * dx, ey - 9.0 * dy);
        let (anchor, shift) = if dx < 0.0 { ("end", -6.0) } else { ("start", 6.0) };
        let _ = write!(
            svg,
            "<path d=\"M{x:.1} {y:.1}L{ex:.1} {ey:.1}M{:.1} {:.1}L{ex:.1} {ey:.1}L{:.1} {:.1}\" fill=\"none\" stroke=\"{FORCE_COLOUR}\" stroke-width=\"2.4\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{FORCE_COLOUR}\">{number} N</text>",
            bx - 5.0 * dy,
            by + 5.0 * dx,
            bx + 5.0 * dy,
            by - 5.0 * dx,
            ex + shift,
            ey + 4.0,
        );
    }
}

/// 1 if the axis out of the picture completes right and up to a right-handed frame: then a positive moment turns
/// anticlockwise.
pub(crate) fn handedness(view: Axis) -> f64 {
    if view == Axis::Y { -1.0 } else { 1.0 }
}

/// An arrow in words, with its value if that is told.
pub(crate) fn in_words(arrow: &Arrow, value: Option<f64>) -> String {
    let (kind, about, unit) = match arrow.kind {
        ArrowKind::Force => ("force", "along", "N"),
        ArrowKind::Moment => ("moment", "about", "N m"),
    };
    let at = place_in_words(&arrow.at);
    let size = value.map_or(String::new(), |value| format!(" of {} {unit}", plain(rounded(value.abs()))));
    format!("{kind}{size} {about} {} at {at} on {}", arrow.along.text(), arrow.on)
}

/// Four significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Where a place of a body lies in the world, m.
fn point(task: &Diagram, seen: &Observation, frame: &BodyFrame, place: &str) -> [f64; 3] {
    if let Some(empty) = task.points.iter().find(|p| p.name == place) {
        let [a, b, c] = empty.point;
        return std::array::from_fn(|k| frame.position[k] + a * frame.u[k] + b * frame.v[k] + c * frame.w[k]);
    }
    seen.reactions.iter().find(|r| r.joint == place).map_or(frame.position, |r| r.about)
}

/// Everything at a place of a body that the picture can show, zeros included.
fn acting(
    task: &Diagram,
    seen: &Observation,
    body: &ModelBody,
    place: &str,
) -> Result<Vec<(Arrow, f64)>, MeasureError> {
    let (force, moment) = if place == CENTRE {
        (task.scene.gravity.map(|g| g * body.mass), [0.0; 3])
    } else if task.points.iter().any(|p| p.name == place) {
        ([0.0; 3], [0.0; 3])
    } else {
        let reaction = seen.reactions.iter().find(|r| r.joint == place);
        let reaction = reaction.ok_or_else(|| MeasureError::NoJoint(place.to_owned()))?;
        if reaction.on == body.name {
            (reaction.force, reaction.moment)
        } else {
            (reaction.force.map(|x| -x), reaction.moment.map(|x| -x))
        }
    };
    let mut all = Vec::new();
    for (kind, vector) in [(ArrowKind::Force, force), (ArrowKind::Moment, moment)] {
        for axis in [Axis::X, Axis::Y, Axis::Z].into_iter().filter(|axis| task.shows(kind, *axis)) {
            let value = vector[axis.index()];
            let (at, on) = (place.to_owned(), body.name.clone());
            all.push((Arrow { kind, at, on, along: Sense::of(axis, value) }, value));
        }
    }
    Ok(all)
}

/// The outline of a shape: points in the world, m, and the radius around each, m.
struct Outline {
    points: Vec<[f64; 3]>,
    radius: f64,
    closed: bool,
}

/// The outlines of a body's shapes, in the world.
fn outlines(scene: &Scene, body: &ModelBody, frame: &BodyFrame) -> Vec<Outline> {
    let to_world = |p: [f64; 3]| -> [f64; 3] {
        let arm: [f64; 3] = std::array::from_fn(|k| p[k] - body.center_of_mass[k]);
        let a: [f64; 3] = std::array::from_fn(|j| (0..3).map(|k| body.principal_axes[(k, j)] * arm[k]).sum());
        std::array::from_fn(|k| frame.position[k] + a[0] * frame.u[k] + a[1] * frame.v[k] + a[2] * frame.w[k])
    };
    let written = scene.bodies.iter().find(|b| b.name == body.name).map_or(&[][..], |b| &b.shape);
    let outline = |shape: &Shape| match shape {
        Shape::Rod { from, to, radius } => {
            Outline { points: vec![to_world(*from), to_world(*to)], radius: *radius, closed: false }
        }
        Shape::Sphere { center, radius } => {
            Outline { points: vec![to_world(*center)], radius: *radius, closed: false }
        }
        Shape::Box { center, size } => {
            let corner = |k: usize| {
                let sign = |bit: usize| if k & (1 << bit) == 0 { -0.5 } else { 0.5 };
                to_world(std::array::from_fn(|j| center[j] + sign(j) * size[j]))
            };
            Outline { points: (0..8).map(corner).collect(), radius: 0.0, closed: true }
        }
    };
    written.iter().map(outline).collect()
}

/// A body with the outlines of its shapes and its places, m.
type Measured = (Vec<Outline>, Vec<(String, [f64; 3])>);

/// Bodies side by side in the picture: their shapes as SVG, and their places, px.
fn laid_out(view: Axis, bodies: &[Measured]) -> (String, Vec<Vec<Place>>) {
    let [right, up, _] = view.picture();
    let flat = |p: &[f64; 3]| [p[right.index()], p[up.index()]];
    // Each body is moved aside until it lies to the right of the one before.
    let mut aside = Vec::with_capacity(bodies.len());
    let (mut end, mut low, mut high, mut widths) = (0.0, f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for (outlines, places) in bodies {
        let shape = outlines.iter().flat_map(|o| o.points.iter().map(|p| (flat(p), o.radius)));
        let all: Vec<([f64; 2], f64)> = shape.chain(places.iter().map(|(_, p)| (flat(p), 0.0))).collect();
        let left = all.iter().map(|(p, r)| p[0] - r).fold(f64::INFINITY, f64::min);
        let width = all.iter().map(|(p, r)| p[0] + r - left).fold(0.0, f64::max);
        low = all.iter().map(|(p, r)| p[1] - r).fold(low, f64::min);
        high = all.iter().map(|(p, r)| p[1] + r).fold(high, f64::max);
        aside.push(end - left);
        end += width;
        widths += width;
    }
    let gaps = (bodies.len().saturating_sub(1)) as f64 * 2.0 * MARGIN;
    let room = [SIZE[0] - 2.0 * MARGIN - gaps, SIZE[1] - 2.0 * MARGIN];
    let scale = (room[0] / widths.max(1e-9)).min(room[1] / (high - low).max(1e-9));
    let margin = [(SIZE[0] - gaps - scale * widths) / 2.0, (SIZE[1] - scale * (high - low)) / 2.0];
    let mut svg = String::new();
    let mut placed = Vec::with_capacity(bodies.len());
    for (k, (outlines, places)) in bodies.iter().enumerate() {
        let pixel = |p: &[f64; 3]| {
            let [x, y] = flat(p);
            let x = margin[0] + scale * (x + aside[k]) + 2.0 * MARGIN * k as f64;
            [x, margin[1] + scale * (high - y)]
        };
        for outline in outlines {
            let points: Vec<[f64; 2]> = outline.points.iter().map(pixel).collect();
            drawn(&points, outline, scale, &mut svg);
        }
        let places = places.iter().map(|(name, p)| Place { name: name.clone(), at: pixel(p) });
        let places: Vec<Place> = places.collect();
        for place in &places {
            let [x, y] = place.at;
            let _ = write!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"currentColor\"/>");
        }
        placed.push(places);
    }
    (svg, placed)
}

/// The name of each body above it.
fn titles(names: &[String], places: &[Vec<Place>]) -> String {
    /// Height of the names, px from above.
    const LINE: f64 = 24.0;
    let title = |(name, places): (&String, &Vec<Place>)| {
        let (left, right) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), place| {
            (left.min(place.at[0]), right.max(place.at[0]))
        });
        format!(
            "<text x=\"{:.1}\" y=\"{LINE}\" text-anchor=\"middle\" font-weight=\"bold\" fill=\"currentColor\">{}</text>",
            f64::midpoint(left, right),
            escape(name)
        )
    };
    names.iter().zip(places).map(title).collect()
}

/// A shape, grey on light and on dark paper.
fn drawn(points: &[[f64; 2]], outline: &Outline, scale: f64, svg: &mut String) {
    /// Thinnest bar and smallest ball, px.
    const THINNEST: f64 = 5.0;
    let radius = (outline.radius * scale).max(THINNEST);
    match points {
        [[x, y]] => {
            let _ = write!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"currentColor\" fill-opacity=\"0.22\"/>"
            );
        }
        [[a, b], [c, d]] if !outline.closed => {
            let _ = write!(
                svg,
                "<path d=\"M{a:.1} {b:.1}L{c:.1} {d:.1}\" stroke=\"currentColor\" stroke-opacity=\"0.22\" stroke-width=\"{:.1}\" stroke-linecap=\"round\"/>",
                2.0 * radius
            );
        }
        _ => {
            let corners: Vec<String> = hull(points).iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            let _ = write!(
                svg,
                "<polygon points=\"{}\" fill=\"currentColor\" fill-opacity=\"0.22\"/>",
                corners.join(" ")
            );
        }
    }
}

/// Corners of the convex hull (Andrew's monotone chain).
fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn =
        |o: [f64; 2], a: [f64; 2], b: [f64; 2]| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., o, a] = chain[..]
                && turn(o, a, point) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut corners = chain(&mut sorted.iter().copied());
    corners.extend(chain(&mut sorted.iter().rev().copied()));
    corners
}
