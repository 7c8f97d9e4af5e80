//! Bodies that rigid connections make one: with the ground, or with each other — THEORY section 7.
//!
//! Scenes with gears, whose joints must stay, keep all bodies.

use crate::model::{BodyRef, DriverKind, Model, ModelBody};
use crate::system::System;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Matrix3;

/// Bodies that rigid connections tie to the ground. A driven body is never taken for fixed.
pub(super) fn tied_to_ground(model: &Model) -> Vec<bool> {
    let mut grounded = vec![false; model.bodies.len()];
    if model.joints.iter().any(|joint| joint.coupled_joints().is_some()) {
        return grounded;
    }
    let mut driven = grounded.clone();
    for driver in &model.drivers {
        for body in driver_bodies(model, &driver.kind) {
            if let BodyRef::Moving(body) = body {
                driven[body] = true;
            }
        }
    }
    let mut changed = true;
    while changed {
        changed = false;
        for joint in model.joints.iter().filter(|joint| joint.geometry.is_rigid()) {
            let tied = |grounded: &[bool], body: BodyRef| match body {
                BodyRef::Ground => true,
                BodyRef::Moving(body) => grounded[body],
            };
            let [i, j] = joint.bodies;
            for (one, other) in [(i, j), (j, i)] {
                if let BodyRef::Moving(body) = other
                    && tied(&grounded, one)
                    && !grounded[body]
                    && !driven[body]
                {
                    grounded[body] = true;
                    changed = true;
                }
            }
        }
    }
    grounded
}

/// For each body the first one of those that rigid connections join it to, itself if there are none. Bodies that are driven
/// against each other stay apart: such a motion is refused, or found to be none, by their rows.
pub(super) fn leaders(model: &Model, grounded: &[bool]) -> Vec<usize> {
    let alone: Vec<usize> = (0..model.bodies.len()).collect();
    if model.joints.iter().any(|joint| joint.coupled_joints().is_some()) {
        return alone;
    }
    let mut label = alone;
    for joint in model.joints.iter().filter(|joint| joint.geometry.is_rigid()) {
        if let [BodyRef::Moving(i), BodyRef::Moving(j)] = joint.bodies
            && !grounded[i]
            && !grounded[j]
        {
            join(&mut label, i, j);
        }
    }
    let mut leaders: Vec<usize> = (0..label.len()).map(|body| root(&mut label, body)).collect();
    for driver in &model.drivers {
        if let [BodyRef::Moving(i), BodyRef::Moving(j)] = driver_bodies(model, &driver.kind)
            && leaders[i] == leaders[j]
        {
            let leader = leaders[i];
            for (body, of) in leaders.iter_mut().enumerate().filter(|(_, of)| **of == leader) {
                *of = body;
            }
        }
    }
    leaders
}

/// The body that rigidly joined bodies make, and the place of each of them in its frame.
pub(super) struct Merged {
    /// The body.
    pub body: ModelBody,
    /// The bodies that it is made of, with their places.
    pub parts: Vec<(usize, NaturalCoordinates)>,
}

impl Merged {
    /// Merges the bodies `list` of a system as they stand at q.
    pub fn new(system: &System, q: &[f64], list: &[usize]) -> Self {
        let bodies = &system.model.bodies;
        let stand: Vec<_> = list
            .iter()
            .map(|&body| {
                let at = system.bodies[body].layout.position(q);
                (&bodies[body], at.r, Matrix3::from_columns(&at.e))
            })
            .collect();
        let frame = stand.first().map_or_else(Matrix3::identity, |(_, _, directors)| *directors);
        let body = bodies[list[0]].joined(&stand, &frame);
        let place = |(_, r, directors): &(&ModelBody, _, Matrix3<f64>)| NaturalCoordinates {
            r: body.directors.tr_mul(&(r - body.position)),
            e: [0, 1, 2].map(|k| body.directors.tr_mul(&directors.column(k))),
        };
        let parts = list.iter().copied().zip(stand.iter().map(place)).collect();
        Self { body, parts }
    }
}

/// The two bodies that a driver moves against each other.
pub(super) fn driver_bodies(model: &Model, kind: &DriverKind) -> [BodyRef; 2] {
    match kind {
        DriverKind::Point { body, .. }
        | DriverKind::Vector { body, .. }
        | DriverKind::CosineToWorld { body, .. } => [BodyRef::Ground, BodyRef::Moving(*body)],
        DriverKind::Angle { joint, .. } | DriverKind::Slide { joint, .. } => model.joints[*joint].bodies,
        DriverKind::Cosine { bodies, .. } => *bodies,
    }
}

/// The first of the bodies that are joined with a body, each labelled with one that stands before it or itself.
pub(super) fn root(label: &mut [usize], mut body: usize) -> usize {
    while label[body] != body {
        label[body] = label[label[body]];
        body = label[body];
    }
    body
}

/// Joins what two bodies are joined with.
pub(super) fn join(label: &mut [usize], i: usize, j: usize) {
    let (i, j) = (root(label, i), root(label, j));
    label[i.max(j)] = i.min(j);
}
