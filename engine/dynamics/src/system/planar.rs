//! Motion in a plane: how it is recognised, and the system with the rows of the plane alone — THEORY section 7, eq. (7.9).
//!
//! If every body is connected to the ground by joints that keep a common direction n and the heights along it (hinges about
//! n, slides across n, planar joints, rigid connections), the joints themselves keep the motion in planes across n,
//! whatever acts. By d'Alembert's principle the motion then follows from the virtual displacements in the plane: three
//! components of a body's twist, and the part of each row in the plane. What the other rows carry is a matter of
//! reactions, which are computed in space on request.

use crate::model::motion::{Curve, VectorCurve};
use crate::model::{BodyRef, JointGeometry, ModelJoint};
use crate::system::body::{PlanarPose, RigidBody, least_inertia, regularizing_inertia};
use crate::system::feature::{Difference, Target};
use crate::system::index::FeatureId;
use crate::system::natural::NaturalCoordinates;
use crate::system::row::Form;
use crate::system::{Row, System};
use nalgebra::{Matrix3, Vector3};
use triad_linalg::orthonormal_basis;

/// Difference up to which unit vectors are the same and components are zero: rounding of an assembled start.
const ALIKE: f64 = 1e-11;

/// Gradient in the plane, of vectors of length one, below which a row is not of the plane: the axis of its joint misses the normal
/// by as little, and alone in a plane it would lock what it lets move in space.
const HARDLY: f64 = 1e-5;

/// Directions in the plane and its normal, as columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The columns.
    pub frame: Matrix3<f64>,
}

/// Why a motion is not known to stay in a plane.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Spatial {
    /// There is nothing that a plane could be read off.
    #[error("no hinge or planar joint tells a plane")]
    NoNormal,
    /// A body that is not held in the plane by joints.
    #[error("the joints do not hold {body} in a plane")]
    Loose {
        /// The body.
        body: String,
    },
    /// A joint or driver whose rows are neither of the plane nor of its normal.
    #[error("the rows of {joint} are neither of the plane nor of its normal")]
    Mixed {
        /// The joint or driver.
        joint: String,
    },
}

/// The plane in which a system moves from the consistent positions q on.
///
/// # Errors
///
/// [`Spatial`]: why it does not move in a plane.
pub fn recognize(system: &System, q: &[f64]) -> Result<Plane, Spatial> {
    let places: Vec<NaturalCoordinates> = system.bodies.iter().map(|b| b.position(q)).collect();
    let axis = |joint: &ModelJoint| {
        let (side, place) = match joint.bodies {
            [BodyRef::Moving(body), _] => (0, &places[body]),
            [_, BodyRef::Moving(body)] => (1, &places[body]),
            _ => return joint.axes[0],
        };
        place.arm(&joint.axes[side])
    };
    let with_normal = system.model.joints.iter().find(|joint| joint.geometry.has_plane_normal());
    let normal = with_normal.map(axis).ok_or(Spatial::NoNormal)?;
    let plane = Plane { frame: frame(&normal.normalize()) };
    let normal = plane.frame.column(2).into_owned();
    let keeps_plane = |joint: &ModelJoint| match joint.geometry {
        JointGeometry::Revolute { .. } | JointGeometry::Planar => axis(joint).cross(&normal).amax() < ALIKE,
        JointGeometry::Prismatic => axis(joint).dot(&normal).abs() < ALIKE,
        JointGeometry::Fixed => true,
        JointGeometry::Spherical
        | JointGeometry::Universal
        | JointGeometry::Cylindrical
        | JointGeometry::Screw { .. }
        | JointGeometry::Rod { .. }
        | JointGeometry::PointOnLine
        | JointGeometry::PointInPlane
        | JointGeometry::Gear { .. } => false,
    };
    if let Some(body) = loose_body(system, keeps_plane) {
        return Err(Spatial::Loose { body: system.model.bodies[body].name.clone() });
    }
    Ok(plane)
}

/// A frame whose third column is a direction; that of the world where it fits.
fn frame(normal: &Vector3<f64>) -> Matrix3<f64> {
    let k = normal.iamax();
    if (normal[k].abs() - 1.0).abs() < ALIKE * ALIKE || normal[k].abs() > 1.0 {
        let [i, j] = [(k + 1) % 3, (k + 2) % 3];
        return Matrix3::from_columns(&[i, j, k].map(|axis| Vector3::ith(axis, 1.0)));
    }
    let [a, b] = orthonormal_basis(normal);
    Matrix3::from_columns(&[a, b, *normal])
}

/// A body that no chain of such joints connects with the ground.
fn loose_body(system: &System, keeps_plane: impl Fn(&ModelJoint) -> bool) -> Option<usize> {
    // Node 0 is the ground.
    let node = |body: BodyRef| match body {
        BodyRef::Ground => 0,
        BodyRef::Moving(body) => body + 1,
    };
    let mut links = vec![Vec::new(); system.bodies.len() + 1];
    for joint in system.model.joints.iter().filter(|joint| keeps_plane(joint)) {
        let [i, j] = joint.bodies.map(node);
        links[i].push(j);
        links[j].push(i);
    }
    let mut connected = vec![false; links.len()];
    let mut next = vec![0];
    while let Some(node) = next.pop() {
        if !std::mem::replace(&mut connected[node], true) {
            next.extend(&links[node]);
        }
    }
    connected.iter().position(|connected| !connected).map(|node| node - 1)
}

impl Plane {
    /// The normal in the frame of a body at this place.
    pub fn normal_in(&self, place: &NaturalCoordinates) -> Vector3<f64> {
        let normal = self.frame.column(2);
        Vector3::from(place.e.map(|e| e.dot(&normal)))
    }

    /// A system with the coordinates of the plane and the rows that matter there, at positions q.
    ///
    /// # Errors
    ///
    /// [`Spatial`]: what of the system has no counterpart in a plane.
    pub fn reduce(&self, mut flat: System, q: &[f64]) -> Result<System, Spatial> {
        let turned = self.frame.transpose();
        flat.model.gravity = turned * flat.model.gravity;
        for body in &mut flat.bodies {
            let place = body.position(q);
            let directors = turned * Matrix3::from_columns(&place.e);
            let height = (turned * place.r)[2];
            body.planar_pose = Some(PlanarPose::new(self.frame, directors, height));
        }
        turn_features(&mut flat, &turned);
        let System { loads, bodies, .. } = &mut flat;
        for load in loads {
            load.turn(|body| Some((directors(&bodies[body]), Vector3::zeros())), Some(&turned));
        }
        flat.keep_rows(kept, independent)?;
        set_inertia(&mut flat);
        Ok(flat)
    }
}

fn set_inertia(flat: &mut System) {
    let arms = flat.arms(|local| local.xy().norm());
    let least = least_inertia(flat.bodies.iter().map(|body| &body.principal));
    for (body, arm) in flat.bodies.iter_mut().zip(arms) {
        let normal = directors(body).row(2).transpose();
        let inertia = body.principal.dot(&normal.component_mul(&normal));
        body.ibar = Vector3::new(inertia, 0.0, 0.0);
        let [of_arm, of_length] = [arm, flat.length].map(|l| body.mass * l * l);
        let in_space = body.regularizing_inertia;
        body.regularizing_inertia = regularizing_inertia([inertia; 2], of_arm, of_length, least);
        body.regularize_as(in_space);
    }
}

/// Features along the director of their body, or in the frame of the plane.
fn turn_features(flat: &mut System, turned: &Matrix3<f64>) {
    let System { features, curves, bodies, .. } = flat;
    for feature in features {
        let turn = match feature.body {
            BodyRef::Ground => *turned,
            BodyRef::Moving(body) => directors(&bodies[body]),
        };
        feature.local = turn * feature.local;
        if let Some(curve) = feature.curve {
            curves[curve] = curves[curve].clone().rotated(&turn);
        }
    }
}

/// Rows of a form in the plane.
fn independent(form: &Form) -> usize {
    match form {
        Form::Coincidence { .. } => 2,
        other => other.independent(),
    }
}

fn directors(body: &RigidBody) -> Matrix3<f64> {
    body.planar_pose.map_or_else(Matrix3::identity, |pose| pose.directors)
}

/// The rows of a joint that constrain the motion in the plane, without repetitions.
fn kept(flat: &System, rows: &[Row], joint: &str) -> Result<Vec<Row>, Spatial> {
    let mut kept: Vec<Row> = Vec::with_capacity(rows.len());
    for row in rows {
        match row.form {
            Form::Coincidence { a, b } if level(flat, a) && level(flat, b) => {}
            Form::Relation { .. } => {}
            Form::Coincidence { .. } => return Err(Spatial::Mixed { joint: joint.to_owned() }),
            Form::CommonVector { a, b } => {
                let along = |f: FeatureId| flat[f].curve.is_none() && flat[f].local.xy().amax() < ALIKE;
                if along(a) && along(b) {
                    continue;
                }
                return Err(Spatial::Mixed { joint: joint.to_owned() });
            }
            Form::Product { a, b, .. } => {
                if across(flat, a) || across(flat, b) {
                    continue;
                }
                if weight(flat, &row.form) < HARDLY {
                    return Err(Spatial::Mixed { joint: joint.to_owned() });
                }
                let same = kept.iter_mut().find(|other| repeats(flat, &other.form, &row.form));
                if let Some(other) = same {
                    // Of two rows with one meaning, that with the larger gradient.
                    if weight(flat, &other.form) < weight(flat, &row.form) {
                        *other = row.clone();
                    }
                    continue;
                }
            }
        }
        kept.push(row.clone());
    }
    Ok(kept)
}

/// Whether a prescribed feature keeps its component along the normal.
fn level(flat: &System, feature: FeatureId) -> bool {
    let constant =
        |curve: &Curve| matches!(curve, Curve::Polynomial(c) if c.iter().skip(1).all(|c| *c == 0.0));
    let Some(curve) = flat[feature].curve else { return true };
    match &flat.curves[curve] {
        VectorCurve::Components(components) => constant(&components[2]),
        VectorCurve::Rotated(turn, components) => {
            components.iter().zip(turn.row(2).iter()).all(|(c, part)| part.abs() < ALIKE || constant(c))
        }
        VectorCurve::Turning { across, turned, .. } => across[2].abs().max(turned[2].abs()) < ALIKE,
    }
}

/// Whether a factor is a vector along the normal.
fn across(flat: &System, factor: Difference) -> bool {
    let vector = &flat[factor.plus];
    factor.minus.is_none() && !vector.point && vector.curve.is_none() && vector.local.xy().amax() < ALIKE
}

/// Whether two constant products of a joint hold the same angle, or a point on the same line.
fn repeats(flat: &System, one: &Form, other: &Form) -> bool {
    let (&Form::Product { a, b, target }, &Form::Product { a: c, b: d, target: t }) = (one, other) else {
        return false;
    };
    let constant = [target, t].iter().all(|t| matches!(t, Target::Constant(_)));
    let vector = |x: Difference| {
        let feature = &flat[x.plus];
        (x.minus.is_none() && !feature.point && feature.curve.is_none()).then_some(feature)
    };
    let (Some(first), Some(second)) = (vector(a), vector(c)) else { return false };
    if !constant || first.body != second.body {
        return false;
    }
    match (vector(b), vector(d)) {
        (Some(b), Some(d)) => b.body == d.body,
        // t₁ · Δ = 0 and t₂ · Δ = 0 are the same if t₁ and t₂ are parallel in the plane.
        (None, None) => b == d && target == t && first.local.xy().perp(&second.local.xy()).abs() < ALIKE,
        _ => false,
    }
}

/// Size of a row's gradient in the plane.
fn weight(flat: &System, form: &Form) -> f64 {
    let Form::Product { a, b, .. } = *form else { return 0.0 };
    let size = |x: Difference| {
        let feature = &flat[x.plus];
        if feature.point || feature.curve.is_some() { 1.0 } else { feature.local.xy().norm() }
    };
    size(a) * size(b)
}
