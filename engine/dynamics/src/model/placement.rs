//! Starts that are given by joints: bodies are placed along the tree of joints, from the ground outwards.
//!
//! The positions that a scene states are where the joints have the angle 0, or the one that is told of them. A joint with a start carries all bodies that
//! hang on it. Joints that close loops are left open here: `constraints::start` closes them.

use super::error::GeometryFault;
use super::reader::ModelReader;
use super::{BodyRef, JointGeometry, ModelBody, ModelError, ModelJoint};
use crate::scene::{Joint, JointKind};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::fmt::Display;

/// Greatest angle, displacement or rate of a joint at the start, SI units.
const MAX_START: f64 = 1e6;

/// Largest part of a turn, rad, that a driver begins beyond whole ones: nearer to half a turn the scene is refused as if there were none.
const CARRIED: f64 = 2.5;

/// Change of a velocity, m/s and rad/s, relative to its size, below which it counts as kept.
const KEPT: f64 = 1e-6;

/// What an author gives of a joint at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelStart {
    /// The joint.
    pub joint: usize,
    /// Its angle, rad.
    pub angle: Option<f64>,
    /// The rate of its angle, rad/s.
    pub rate: Option<f64>,
    /// Its displacement, m.
    pub slide: Option<f64>,
    /// The rate of its displacement, m/s.
    pub speed: Option<f64>,
}

impl ModelStart {
    /// A joint of which nothing is given.
    pub(super) fn of(joint: usize) -> Self {
        Self { joint, angle: None, rate: None, slide: None, speed: None }
    }

    /// Checks the start of joint `reader.index`, if it has one.
    pub(super) fn new(joint: &Joint, reader: &ModelReader) -> Result<Option<Self>, ModelError> {
        let Some(start) = joint.start else { return Ok(None) };
        let (turns, slides) = match joint.kind {
            JointKind::Revolute | JointKind::Screw => (true, false),
            JointKind::Prismatic => (false, true),
            JointKind::Cylindrical => (true, true),
            JointKind::Spherical
            | JointKind::Universal
            | JointKind::Planar
            | JointKind::Fixed
            | JointKind::Rod
            | JointKind::PointOnLine
            | JointKind::PointInPlane
            | JointKind::Gear => {
                let reason = "only revolute, prismatic, cylindrical and screw joints have a start; \
                              place the bodies of others by their positions";
                return Err(reader.faulty("start", GeometryFault::TooMuch, reason));
            }
        };
        let numbers = [
            ("angle", start.angle, turns, "an angle"),
            ("rate", start.rate, turns, "the rate of an angle"),
            ("slide", start.slide, slides, "a displacement of its own"),
            ("speed", start.speed, slides, "a displacement of its own"),
        ];
        for (key, number, known, what) in numbers {
            let key = format!("start/{key}");
            match number {
                Some(_) if !known => {
                    let reason = format!("a {} joint has not {what}", joint.kind);
                    return Err(reader.faulty(&key, GeometryFault::TooMuch, reason));
                }
                Some(number) => reader.number(&key, number, -MAX_START, MAX_START)?,
                None => 0.0,
            };
        }
        let (angle, rate, slide, speed) = (start.angle, start.rate, start.slide, start.speed);
        Ok(Some(Self { joint: reader.index, angle, rate, slide, speed }))
    }
}

/// A joint that a driver turns, and the angle from which on.
pub(super) struct DrivenFrom {
    pub driver: String,
    pub joint: usize,
    pub angle: f64,
}

/// A joint that is driven from some whole turns on, and a part of one, starts there, as if that were given: directors tell nothing of
/// whole turns. What is given instead is told.
pub(super) fn begin_where_driven(
    driven: &[DrivenFrom],
    joints: &[ModelJoint],
    starts: &mut Vec<ModelStart>,
    notes: &mut Vec<String>,
) {
    for DrivenFrom { driver, joint, angle } in driven {
        let at = starts.iter().position(|start| start.joint == *joint);
        let given = at.and_then(|at| starts[at].angle);
        let away = angle - given.unwrap_or(joints[*joint].stated);
        let turns = (away / TAU).round() * TAU;
        if turns == 0.0 || (away - turns).abs() > CARRIED || angle.abs() > MAX_START {
            continue;
        }
        if let Some(given) = given {
            notes.push(driven_instead(&joints[*joint].name, given, driver, angle, "rad"));
        }
        match at {
            Some(at) => starts[at].angle = Some(*angle),
            None => starts.push(ModelStart { angle: Some(*angle), ..ModelStart::of(*joint) }),
        }
    }
}

/// That a driver prescribes something else than is given of a joint for the start.
pub(crate) fn driven_instead(
    joint: &str,
    given: f64,
    driver: &str,
    found: impl Display,
    unit: &str,
) -> String {
    format!(
        "joint \"{joint}\": {given} {unit} are given for the start, but driver \"{driver}\" prescribes {found} {unit} there"
    )
}

/// How far a body was carried from where its author states it, and how it moves.
#[derive(Clone, Copy)]
struct Carried {
    by: Isometry3<f64>,
    /// Where its centre of mass is.
    center: Vector3<f64>,
    /// Velocity of the centre of mass, and angular velocity.
    motion: [Vector3<f64>; 2],
    /// Whether a joint gives them.
    moved: bool,
}

/// Places the bodies as the starts say, and tells of velocities that they replace.
pub(super) fn place(
    bodies: &mut [ModelBody],
    joints: &[ModelJoint],
    starts: &[ModelStart],
    notes: &mut Vec<String>,
) {
    if starts.is_empty() {
        return;
    }
    let tree = tree(bodies.len(), joints, starts);
    let ground = Carried {
        by: Isometry3::identity(),
        center: Vector3::zeros(),
        motion: [Vector3::zeros(); 2],
        moved: false,
    };
    let carried = walk(bodies.len(), joints, &tree, ground, |from, child| match from {
        Some((index, side, parent)) => {
            let start = starts.iter().find(|start| start.joint == index);
            carry(bodies, &joints[index], start, (side, parent), child)
        }
        None => follow(&bodies[child], ground, Isometry3::identity(), None),
    });
    for (body, carried) in bodies.iter_mut().zip(carried) {
        notes.extend(replaced(body, &carried));
        put(body, &carried);
    }
}

/// What `next` makes of each body, from the ground outwards along the tree: from the joint, the side of it and what was made of the body
/// there. What does not hang on the ground has none of these, the first of the list first.
pub(super) fn walk<C: Copy>(
    bodies: usize,
    joints: &[ModelJoint],
    tree: &[usize],
    ground: C,
    mut next: impl FnMut(Option<(usize, usize, C)>, usize) -> C,
) -> Vec<C> {
    let mut made: Vec<Option<C>> = vec![None; bodies];
    let mut queue: VecDeque<(BodyRef, C)> = VecDeque::from([(BodyRef::Ground, ground)]);
    let mut next_root = 0;
    loop {
        while let Some((parent, at)) = queue.pop_front() {
            for &index in tree {
                let [i, j] = joints[index].bodies;
                let side = usize::from(j == parent);
                let BodyRef::Moving(child) = (if side == 0 { j } else { i }) else { continue };
                if (i != parent && j != parent) || made[child].is_some() {
                    continue;
                }
                let child_at = next(Some((index, side, at)), child);
                made[child] = Some(child_at);
                queue.push_back((BodyRef::Moving(child), child_at));
            }
        }
        let Some(root) = (next_root..bodies).find(|&body| made[body].is_none()) else { break };
        next_root = root + 1;
        let at = next(None, root);
        made[root] = Some(at);
        queue.push_back((BodyRef::Moving(root), at));
    }
    made.into_iter().flatten().collect()
}

/// The joints along which bodies are placed: those with a start, then those that leave the least freedom, without loops.
pub(super) fn tree(bodies: usize, joints: &[ModelJoint], starts: &[ModelStart]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..joints.len()).filter(|&k| joints[k].coupled_joints().is_none()).collect();
    order.sort_by_key(|&k| {
        let given = starts.iter().any(|start| start.joint == k);
        (!given, freedoms(&joints[k].geometry))
    });
    // Bodies that are already connected have the same label; the ground's is that behind all bodies.
    let mut label: Vec<usize> = (0..=bodies).collect();
    order.retain(|&k| {
        let [a, b] = joints[k].bodies.map(|body| match body {
            BodyRef::Ground => label[bodies],
            BodyRef::Moving(body) => label[body],
        });
        for l in &mut label {
            if *l == b {
                *l = a;
            }
        }
        a != b
    });
    order
}

/// Freedoms that a joint leaves between its two bodies.
fn freedoms(geometry: &JointGeometry) -> usize {
    match geometry {
        JointGeometry::Fixed => 0,
        JointGeometry::Revolute { .. } | JointGeometry::Prismatic | JointGeometry::Screw { .. } => 1,
        JointGeometry::Universal | JointGeometry::Cylindrical => 2,
        JointGeometry::Spherical | JointGeometry::Planar => 3,
        JointGeometry::PointOnLine => 4,
        JointGeometry::Rod { .. } | JointGeometry::PointInPlane | JointGeometry::Gear { .. } => 5,
    }
}

/// The child of a joint whose body `side`, the parent, was carried.
fn carry(
    bodies: &[ModelBody],
    joint: &ModelJoint,
    start: Option<&ModelStart>,
    (side, parent): (usize, Carried),
    child: usize,
) -> Carried {
    let Some(start) = start else { return follow(&bodies[child], parent, parent.by, None) };
    // Body j moves by +, body i by −.
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let point =
        |side: usize| at_start(bodies, joint.bodies[side]) * nalgebra::Point3::from(joint.points[side]);
    let axis = parent.by * (at_start(bodies, joint.bodies[side]).rotation * joint.axes[side]);
    let pivot = (parent.by * point(side)).coords;
    let stated = (at_start(bodies, joint.bodies[0]).rotation * joint.axes[0]).dot(&(point(1) - point(0)));
    let angle = start.angle.map_or(0.0, |angle| angle - joint.stated);
    let (slide, speed) = match joint.geometry {
        JointGeometry::Screw { pitch } => (angle * pitch - stated, start.rate.map(|rate| rate * pitch)),
        _ => (start.slide.map_or(0.0, |slide| slide - stated), start.speed),
    };
    let turn = UnitQuaternion::from_scaled_axis(axis * (sign * angle));
    let shift = Translation3::from(pivot - turn * pivot + axis * (sign * slide));
    let by = Isometry3::from_parts(shift, turn) * parent.by;
    let given = start.rate.is_some() || start.speed.is_some();
    let relative = given.then(|| {
        let spin = axis * (sign * start.rate.unwrap_or(0.0));
        let arm = (by * nalgebra::Point3::from(bodies[child].position)).coords - pivot;
        [axis * (sign * speed.unwrap_or(0.0)) + spin.cross(&arm), spin]
    });
    follow(&bodies[child], parent, by, relative)
}

/// A body that was carried by `by`, with its motion relative to its parent.
fn follow(
    body: &ModelBody,
    parent: Carried,
    by: Isometry3<f64>,
    relative: Option<[Vector3<f64>; 2]>,
) -> Carried {
    let center = (by * nalgebra::Point3::from(body.position)).coords;
    let moved = parent.moved || relative.is_some();
    let motion = if moved {
        let [velocity, spin] = parent.motion;
        let [more, turning] = relative.unwrap_or_default();
        [velocity + spin.cross(&(center - parent.center)) + more, spin + turning]
    } else {
        // The author's reference point keeps the velocity that is stated for it.
        let arm = body.directors * body.principal_axes.tr_mul(&body.center_of_mass);
        let reference = body.velocity - body.angular_velocity.cross(&arm);
        [reference + body.angular_velocity.cross(&(by.rotation * arm)), body.angular_velocity]
    };
    Carried { by, center, motion, moved }
}

/// The principal frame of a body where its author states it.
fn at_start(bodies: &[ModelBody], body: BodyRef) -> Isometry3<f64> {
    match body {
        BodyRef::Ground => Isometry3::identity(),
        BodyRef::Moving(index) => {
            let body = &bodies[index];
            let rotation = nalgebra::Rotation3::from_matrix_unchecked(body.directors);
            Isometry3::from_parts(body.position.into(), UnitQuaternion::from_rotation_matrix(&rotation))
        }
    }
}

/// What to tell of a body whose stated velocity gives way to that of joints.
fn replaced(body: &ModelBody, at: &Carried) -> Option<String> {
    let given = body.velocity.norm() + body.angular_velocity.norm() > 0.0;
    let change = (body.velocity - at.motion[0]).norm() + (body.angular_velocity - at.motion[1]).norm();
    let kept = change < KEPT * (1.0 + body.velocity.norm() + body.angular_velocity.norm());
    (at.moved && given && !kept).then(|| {
        let name = &body.name;
        format!(
            "body \"{name}\" moves as the \"start\" of joints says, not with the velocity that is stated for it: it hangs on a \
             joint whose rate or speed is given; bodies that hang on nothing carry the others, the first of the list first"
        )
    })
}

/// Writes the place and the motion of a body.
fn put(body: &mut ModelBody, at: &Carried) {
    body.directors = at.by.rotation.to_rotation_matrix().matrix() * body.directors;
    body.position = at.center;
    [body.velocity, body.angular_velocity] = at.motion;
}
