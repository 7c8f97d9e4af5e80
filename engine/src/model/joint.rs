//! A joint with its geometry in the principal frames of its two bodies.

use super::{ModelBody, ModelError, finite};
use crate::scene::{AxisRows, GROUND, Joint, JointKind, Triple};
use nalgebra::Vector3;
use std::collections::HashMap;

/// A body by its place in the model, or the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyRef {
    /// The fixed body, whose frame is the world.
    Ground,
    /// A moving body.
    Moving(usize),
}

/// A checked joint. Ground points and vectors are in the world frame, others in the principal frame of the body.
#[derive(Clone, Debug)]
pub struct ModelJoint {
    /// Name.
    pub name: String,
    /// What it is.
    pub kind: JointKind,
    /// Bodies i and j.
    pub bodies: [BodyRef; 2],
    /// The joint's point on body i and on body j, m.
    pub points: [Vector3<f64>; 2],
    /// The joint's unit axis on body i and on body j (zero where the joint has none).
    pub axes: [Vector3<f64>; 2],
    /// How the axis is written.
    pub rows: AxisRows,
}

impl ModelJoint {
    /// Checks joint `index` of a scene.
    pub(super) fn new(
        joint: &Joint,
        index: usize,
        names: &HashMap<String, usize>,
        bodies: &[ModelBody],
    ) -> Result<Self, ModelError> {
        let reader = Reader { joint, index, bodies };
        let pair =
            [reader.body("body_i", &joint.body_i, names)?, reader.body("body_j", &joint.body_j, names)?];
        if pair[0] == pair[1] {
            return Err(ModelError::SameBody {
                joint: joint.name.clone(),
                pointer: reader.at("body_j"),
                body: joint.body_j.clone(),
            });
        }
        let points = reader.points(pair)?;
        let axes = reader.axes(pair)?;
        if joint.rows.is_some() && joint.kind != JointKind::Revolute {
            return Err(reader.wrong("rows", "only a revolute joint can choose its rows"));
        }
        Ok(Self {
            name: joint.name.clone(),
            kind: joint.kind,
            bodies: pair,
            points,
            axes,
            rows: joint.rows.unwrap_or_default(),
        })
    }
}

struct Reader<'a> {
    joint: &'a Joint,
    index: usize,
    bodies: &'a [ModelBody],
}

impl Reader<'_> {
    fn at(&self, key: &str) -> String {
        format!("/joints/{}/{key}", self.index)
    }

    fn wrong(&self, key: &str, reason: &str) -> ModelError {
        ModelError::Geometry {
            joint: self.joint.name.clone(),
            pointer: self.at(key),
            reason: reason.to_owned(),
        }
    }

    fn body(&self, key: &str, name: &str, names: &HashMap<String, usize>) -> Result<BodyRef, ModelError> {
        if name == GROUND {
            return Ok(BodyRef::Ground);
        }
        names.get(name).map(|&body| BodyRef::Moving(body)).ok_or_else(|| ModelError::UnknownBody {
            joint: self.joint.name.clone(),
            pointer: self.at(key),
            name: name.to_owned(),
            nearest: nearest_name(name, self.bodies.iter().map(|b| b.name.as_str())),
        })
    }

    fn points(&self, pair: [BodyRef; 2]) -> Result<[Vector3<f64>; 2], ModelError> {
        let joint = self.joint;
        match (joint.point, joint.point_i, joint.point_j) {
            (Some(world), None, None) => {
                let world = self.vector("point", world)?;
                Ok(pair.map(|body| self.point_from_world(body, &world)))
            }
            (None, Some(i), Some(j)) => {
                let local = [self.vector("point_i", i)?, self.vector("point_j", j)?];
                Ok([0, 1].map(|side| match pair[side] {
                    BodyRef::Ground => local[side],
                    BodyRef::Moving(body) => self.bodies[body].point_to_principal(&local[side]),
                }))
            }
            (None, None, None) => Err(self.wrong("point", "it has no point")),
            _ => Err(self.wrong("point", "its point is given twice, or on one of its bodies only")),
        }
    }

    fn axes(&self, pair: [BodyRef; 2]) -> Result<[Vector3<f64>; 2], ModelError> {
        let joint = self.joint;
        let given = (joint.axis, joint.axes, joint.axis_i, joint.axis_j);
        let needs_axis = joint.kind != JointKind::Spherical;
        match given {
            (None, None, None, None) if !needs_axis => Ok([Vector3::zeros(); 2]),
            _ if !needs_axis => Err(self.wrong("axis", "a spherical joint has no axis")),
            (None, None, None, None) => Err(self.wrong("axis", "it has no axis")),
            (Some(_), None, None, None) if joint.kind == JointKind::Universal => {
                Err(self.wrong("axis", "a universal joint has two axes: give \"axes\""))
            }
            (Some(world), None, None, None) => {
                let world = self.unit("axis", world)?;
                Ok(pair.map(|body| self.vector_from_world(body, &world)))
            }
            (None, Some([first, second]), None, None) => {
                let world = [self.unit("axes/0", first)?, self.unit("axes/1", second)?];
                Ok([0, 1].map(|side| self.vector_from_world(pair[side], &world[side])))
            }
            (None, None, Some(i), Some(j)) => {
                let local = [self.unit("axis_i", i)?, self.unit("axis_j", j)?];
                Ok([0, 1].map(|side| match pair[side] {
                    BodyRef::Ground => local[side],
                    BodyRef::Moving(body) => self.bodies[body].vector_to_principal(&local[side]),
                }))
            }
            _ => Err(self.wrong("axis", "its axis is given twice, or on one of its bodies only")),
        }
    }

    fn vector(&self, key: &str, value: Triple) -> Result<Vector3<f64>, ModelError> {
        finite(&value, &self.at(key))?;
        Ok(Vector3::from(value))
    }

    fn unit(&self, key: &str, value: Triple) -> Result<Vector3<f64>, ModelError> {
        self.vector(key, value)?.try_normalize(1e-12).ok_or_else(|| self.wrong(key, "the axis has no length"))
    }

    fn point_from_world(&self, body: BodyRef, world: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *world,
            BodyRef::Moving(body) => {
                let body = &self.bodies[body];
                body.directors.tr_mul(&(world - body.position))
            }
        }
    }

    fn vector_from_world(&self, body: BodyRef, world: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *world,
            BodyRef::Moving(body) => self.bodies[body].directors.tr_mul(world),
        }
    }
}

/// The candidate that differs from `name` in the fewest letters, if it is near.
pub fn nearest_name<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    candidates
        .take(1000)
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .min()
        .filter(|(distance, _)| *distance <= name.len().max(3) / 3)
        .map(|(_, candidate)| candidate.to_owned())
}

fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
