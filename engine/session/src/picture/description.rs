//! What appears in a recording: the bodies with their shapes, the joints with their rows, and the scales.

use triad_engine::model::{BodyRef, Model};
use triad_engine::run::Simulation;
use triad_engine::scene::{Scene, Shape};

use super::scale::Scale;

/// A body as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyVisual {
    /// Name.
    pub name: String,
    /// Shapes in the author's frame.
    pub shapes: Vec<Shape>,
    /// Centre of mass in the author's frame.
    pub center_of_mass: [f64; 3],
    /// Principal axes in the author's frame: row k of this table holds the components of axis k.
    pub principal_axes: [[f64; 3]; 3],
    /// Points of its joints, in its principal frame.
    pub joint_points: Vec<[f64; 3]>,
    /// Its markers, in its principal frame.
    pub markers: Vec<MarkerVisual>,
}

/// A marker as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerVisual {
    /// Name.
    pub name: String,
    /// Where it is, in the principal frame of its body; of the ground, in the world.
    pub point: [f64; 3],
}

/// A joint as it is drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JointVisual {
    /// Name.
    pub name: String,
    /// The names of its rows.
    pub rows: Vec<String>,
    /// The body that its recorded force acts on, and the body that exerts it; the ground is no body.
    pub on: Option<usize>,
    /// See `on`.
    pub by: Option<usize>,
}

/// The pattern of the Jacobian.
#[derive(Debug, Clone, Default)]
pub struct Pattern {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Row, column, and whether the entry never changes.
    pub entries: Vec<(usize, usize, bool)>,
}

/// What a recording states once.
#[derive(Debug, Clone)]
pub struct SceneDescription {
    /// Title of the recording.
    pub title: String,
    /// The bodies, in the scene's order.
    pub bodies: Vec<BodyVisual>,
    /// The joints, in the scene's order.
    pub joints: Vec<JointVisual>,
    /// Markers of the ground.
    pub ground_markers: Vec<MarkerVisual>,
    /// The pattern of the Jacobian.
    pub pattern: Pattern,
    /// Gravity, which says what is up.
    pub gravity: [f64; 3],
    /// Extent of the mechanism at the start, in metres.
    pub size: f64,
    /// What the camera looks at: the middle of the points that are fixed to the ground, or of everything.
    pub center: [f64; 3],
    /// How far the mechanism reaches from there at the start, in metres.
    pub reach: f64,
    /// How long arrows are: one scale for the whole scene.
    pub scale: Scale,
}

impl SceneDescription {
    /// Whether y is up rather than z.
    pub fn y_is_up(&self) -> bool {
        self.gravity[1].abs() > self.gravity[2].abs()
    }

    /// The description of a checked scene, its joints' rows and its Jacobian's pattern.
    pub fn new(scene: &Scene, model: &Model, joints: Vec<JointVisual>, pattern: Pattern) -> Self {
        let bodies: Vec<BodyVisual> = scene
            .bodies
            .iter()
            .zip(&model.bodies)
            .enumerate()
            .map(|(index, (written, body))| BodyVisual {
                name: written.name.clone(),
                shapes: written.shape.clone(),
                center_of_mass: body.center_of_mass.into(),
                // nalgebra hands out columns, and column k is axis k.
                principal_axes: body.principal_axes.into(),
                joint_points: joint_points(model, index),
                markers: markers(model, BodyRef::Moving(index)),
            })
            .collect();
        let Extent { size, center, reach } = Extent::of(model, &bodies);
        let weight: f64 = model.mass() * model.gravity.norm();
        let title = if scene.title.is_empty() { &scene.name } else { &scene.title };
        Self {
            title: title.clone(),
            bodies,
            joints,
            ground_markers: markers(model, BodyRef::Ground),
            pattern,
            gravity: model.gravity.into(),
            size,
            center,
            reach,
            scale: Scale::of_weight(weight, size),
        }
    }
}

/// The description of a simulation at its start.
pub fn describe(scene: &Scene, simulation: &Simulation) -> SceneDescription {
    let bodies: Vec<String> = simulation.model().bodies.iter().map(|body| body.name.clone()).collect();
    let body = |name: &str| bodies.iter().position(|body| body == name);
    let joints = simulation.multipliers().into_iter().map(|joint| JointVisual {
        on: body(&joint.on),
        by: body(&joint.by),
        name: joint.joint,
        rows: joint.rows.into_iter().map(|row| row.label).collect(),
    });
    let jacobian = simulation.jacobian();
    let pattern = Pattern {
        rows: jacobian.rows.len(),
        columns: jacobian.columns.len(),
        entries: jacobian.entries.iter().map(|e| (e.row, e.column, e.constant)).collect(),
    };
    SceneDescription::new(scene, simulation.model(), joints.collect(), pattern)
}

fn joint_points(model: &Model, body: usize) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for joint in &model.joints {
        for (side, point) in joint.bodies.iter().zip(&joint.points) {
            if *side == BodyRef::Moving(body) {
                points.push((*point).into());
            }
        }
    }
    points
}

fn markers(model: &Model, of: BodyRef) -> Vec<MarkerVisual> {
    let own = model.markers.iter().filter(|marker| marker.body == of);
    own.map(|marker| MarkerVisual { name: marker.name.clone(), point: marker.local.into() }).collect()
}

/// How large a mechanism is at its start, and where.
struct Extent {
    /// Half the diagonal of the box that holds it.
    size: f64,
    center: [f64; 3],
    reach: f64,
}

impl Extent {
    fn of(model: &Model, bodies: &[BodyVisual]) -> Self {
        let points = points(model, bodies);
        let middle = |points: &[[f64; 3]]| -> [f64; 3] {
            std::array::from_fn(|k| {
                let (low, high) = points
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (p[k].min(l), p[k].max(h)));
                0.5 * (low + high)
            })
        };
        let farthest = |from: [f64; 3]| {
            let distance = |p: &[f64; 3]| (0..3).map(|k| p[k] - from[k]).map(|d| d * d).sum::<f64>().sqrt();
            let farthest = points.iter().map(distance).fold(0.0, f64::max);
            if farthest.is_finite() && farthest > 1e-9 { farthest } else { 1.0 }
        };
        let fixed: Vec<[f64; 3]> = model
            .joints
            .iter()
            .flat_map(|joint| joint.bodies.iter().zip(&joint.points))
            .filter(|(body, _)| **body == BodyRef::Ground)
            .map(|(_, point)| (*point).into())
            .collect();
        let center = middle(if fixed.is_empty() { &points } else { &fixed });
        Self { size: farthest(middle(&points)), center, reach: farthest(center) }
    }
}

/// Ends of shapes, joints and centres of mass in the world, at the start.
fn points(model: &Model, bodies: &[BodyVisual]) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for (body, visual) in model.bodies.iter().zip(bodies) {
        let ends = visual.shapes.iter().flat_map(|shape| match shape {
            Shape::Rod { from, to, .. } => vec![*from, *to],
            Shape::Sphere { center, radius } => {
                vec![center.map(|x| x - radius), center.map(|x| x + radius)]
            }
            Shape::Box { center, size } => {
                let corner = |sign: f64| std::array::from_fn(|k| center[k] + 0.5 * sign * size[k]);
                vec![corner(-1.0), corner(1.0)]
            }
        });
        let drawn = ends.map(|point| body.point_to_principal(&point.into()));
        let joints = visual.joint_points.iter().map(|point| (*point).into());
        points.push(body.position.into());
        points.extend(
            drawn.chain(joints).map(|local| <[f64; 3]>::from(body.position + body.directors * local)),
        );
    }
    points
}
