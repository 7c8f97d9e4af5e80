//! Bodies that a joint holds in a point of the ground, described about that point — THEORY section 7, eq. (7.10).
//!
//! With the frame of such a body in its pivot, along the principal axes there, its r stays where it is: what holds the point needs no
//! rows, and what acts on r says nothing.

use crate::model::{BodyRef, ModelBody};
use crate::system::body::{BodyPart, GroundPivot, RigidBody, least_inertia};
use crate::system::index::FeatureId;
use crate::system::natural::NaturalCoordinates;
use crate::system::planar::Plane;
use crate::system::row::Form;
use crate::system::{Constraint, Row, System};
use nalgebra::Vector3;
use std::convert::Infallible;

/// Distance, in lengths of the mechanism, of a body's other joints from its pivot below which it keeps its rows: a second hinge on the same
/// axis would have rows without gradients, which are to be found dependent.
const NEAR: f64 = 1e-3;

/// A row that holds a point of a body in a point of the ground.
#[derive(Clone, Copy, Debug)]
struct Pivot {
    body: usize,
    /// The point, in the frame of the body.
    point: Vector3<f64>,
    ground: Vector3<f64>,
    /// Its first row in the solver.
    solver: usize,
}

/// The system with bodies about their pivots, if there are any: one for each body, at positions q. In space joints that have other rows
/// as well keep all of them; those of a hinge hold the plane, if the system moves in one, and are left out of it.
pub fn about_pivots(system: &System, q: &[f64], plane: Option<&Plane>) -> Option<System> {
    let mut pivots = system.constraints.iter().filter_map(|own| pivot(system, own, q, plane)).peekable();
    pivots.peek()?;
    let (mut held, mut needless) = (system.clone(), Vec::new());
    for pivot in pivots {
        if held.bodies[pivot.body].pivot.is_none() {
            pivot.describe_body(&mut held);
            needless.push(pivot.solver);
        }
    }
    let choose = |_: &System, rows: &[Row], _: &str| {
        Ok::<_, Infallible>(rows.iter().filter(|row| !needless.contains(&row.solver)).cloned().collect())
    };
    held.keep_rows(choose, Form::independent).ok()?;
    Some(held)
}

/// The point of the ground in which a joint holds a body, if the body can be described about it.
fn pivot(system: &System, own: &Constraint, q: &[f64], plane: Option<&Plane>) -> Option<Pivot> {
    let rows = &system.rows[own.forms.clone()];
    if plane.is_none() && rows.len() > 1 {
        return None;
    }
    rows.iter().find_map(|row| {
        let Form::Coincidence { a, b } = row.form else { return None };
        let (body, point, ground) = match (system[a].body, system[b].body) {
            (BodyRef::Moving(body), BodyRef::Ground) => (body, a, b),
            (BodyRef::Ground, BodyRef::Moving(body)) => (body, b, a),
            _ => return None,
        };
        let fixed = |f: FeatureId| system[f].curve.is_none();
        let (pivot, normal) =
            (system[point].local, plane.map(|p| p.normal_in(&system.bodies[body].position(q))));
        let counts = |f: &FeatureId| system[*f].body == BodyRef::Moving(body) && system[*f].point;
        let is_apart = |f: FeatureId| {
            let arm = system[f].local - pivot;
            let across = normal.map_or(arm, |normal| arm - normal * normal.dot(&arm));
            fixed(f) && across.norm() > NEAR * system.length
        };
        let touching =
            system.incidences_of_body[body].iter().map(|&i| &system[system.incidences[i].constraint]);
        let mut others = touching
            .flat_map(|constraint| &system.rows[constraint.forms.clone()])
            .filter(|other| other.solver != row.solver)
            .flat_map(|other| other.form.features(&system.angles));
        (fixed(a) && fixed(b) && others.all(|f| !counts(&f) || is_apart(f))).then_some(Pivot {
            body,
            point: pivot,
            ground: system[ground].local,
            solver: row.solver,
        })
    })
}

impl Pivot {
    /// Describes the body about the point, and all that belongs to it.
    fn describe_body(&self, held: &mut System) {
        let &Self { body: index, point, ground, .. } = self;
        let model = &held.model.bodies[index];
        let (principal, axes) = model.principal_about(&point);
        let model = ModelBody { principal, ..model.clone() };
        let mut arm = 0.0f64;
        for feature in held.features.iter_mut().filter(|f| f.body == BodyRef::Moving(index)) {
            if feature.point {
                feature.local -= point;
                arm = arm.max(feature.local.norm());
            }
            feature.local = axes.tr_mul(&feature.local);
            if let Some(curve) = feature.curve {
                held.curves[curve] = held.curves[curve].clone().rotated(&axes.transpose());
            }
        }
        let old = &held.bodies[index];
        let mut parts = old.parts.clone();
        if parts.is_empty() {
            let itself =
                NaturalCoordinates { r: Vector3::zeros(), e: [Vector3::x(), Vector3::y(), Vector3::z()] };
            parts.push(BodyPart { layout: old.layout, place: itself });
        }
        for BodyPart { place, .. } in &mut parts {
            place.r = axes.tr_mul(&(place.r - point));
            place.e = place.e.map(|e| axes.tr_mul(&e));
        }
        let pivot = Some(GroundPivot { ground, center: axes.tr_mul(&-point) });
        let least = least_inertia(held.bodies.iter().map(|body| &body.principal));
        let mut body = RigidBody::new(&model, old.layout, arm, held.length, least);
        body.regularize_as(old.regularizing_inertia);
        held.bodies[index] = RigidBody { parts, pivot, ..body };
        for load in &mut held.loads {
            load.turn(|body| (body == index).then(|| (axes.transpose(), point)), None);
        }
    }
}
