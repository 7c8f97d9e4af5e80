//! The islands of a model, which nothing connects, without the bodies that cannot move — THEORY section 7.
//!
//! Bodies that no joint, driver or load connects move each on its own: their series take steps of their own. A body
//! that rigid connections tie to the ground is ground.

use crate::model::{BodyRef, DriverKind, JointGeometry, LoadKind, Model, ModelJoint};
use crate::scene::Settings;
use crate::system::System;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;

/// An island as a system of its own; its columns are those of the whole system.
#[derive(Clone, Debug)]
pub struct Island {
    /// The system.
    pub system: System,
    /// Its bodies, as places in the whole.
    pub bodies: Vec<usize>,
}

/// The islands of a model.
#[derive(Clone, Debug)]
pub struct Islands {
    /// The islands; none where the whole is one.
    pub islands: Vec<Island>,
    /// Bodies that cannot move.
    pub fixed: usize,
}

/// What became of a body of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Assignment {
    /// It is ground, at its place.
    Ground(NaturalCoordinates),
    /// Body `index` of island `island`.
    Moves { island: usize, index: usize },
}

/// Divides a system at positions q: into islands if `islands`, and without fixed bodies if `fixed`.
pub fn split(system: &System, q: &[f64], islands: bool, fixed: bool) -> Islands {
    let model = &system.model;
    let grounded = if fixed { tied_to_ground(model) } else { vec![false; model.bodies.len()] };
    let mut label: Vec<usize> = (0..model.bodies.len()).collect();
    if islands {
        for [i, j] in links(model) {
            if let (BodyRef::Moving(i), BodyRef::Moving(j)) = (i, j)
                && !grounded[i]
                && !grounded[j]
            {
                join(&mut label, i, j);
            }
        }
    } else {
        label.fill(0);
    }
    let (mut assignments, mut bodies, mut island_of) =
        (Vec::new(), Vec::<Vec<usize>>::new(), vec![None; label.len()]);
    for body in 0..label.len() {
        if grounded[body] {
            assignments.push(Assignment::Ground(system.bodies[body].layout.position(q)));
            continue;
        }
        let island = *island_of[root(&mut label, body)].get_or_insert_with(|| {
            bodies.push(Vec::new());
            bodies.len() - 1
        });
        assignments.push(Assignment::Moves { island, index: bodies[island].len() });
        bodies[island].push(body);
    }
    let fixed = grounded.iter().filter(|grounded| **grounded).count();
    if bodies.len() < 2 && fixed == 0 {
        return Islands { islands: Vec::new(), fixed };
    }
    let mut models: Vec<Model> = bodies.iter().map(|list| without_rows(model, list)).collect();
    distribute(model, &assignments, &mut models);
    let own = models.into_iter().zip(bodies).map(|(model, bodies)| {
        let mut island = System::new(model);
        island.coordinates = system.coordinates;
        for (own, &body) in island.bodies.iter_mut().zip(&bodies) {
            own.layout = system.bodies[body].layout;
        }
        Island { system: island, bodies }
    });
    Islands { islands: own.collect(), fixed }
}

/// Bodies that rigid connections tie to the ground. Scenes with gears, whose joints must stay, keep all bodies, and a
/// driven body is never taken for fixed.
fn tied_to_ground(model: &Model) -> Vec<bool> {
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

fn driver_bodies(model: &Model, kind: &DriverKind) -> [BodyRef; 2] {
    match kind {
        DriverKind::Point { body, .. }
        | DriverKind::Vector { body, .. }
        | DriverKind::CosineToWorld { body, .. } => [BodyRef::Ground, BodyRef::Moving(*body)],
        DriverKind::Angle { joint, .. } | DriverKind::Slide { joint, .. } => model.joints[*joint].bodies,
        DriverKind::Cosine { bodies, .. } => *bodies,
    }
}

fn load_bodies(model: &Model, kind: &LoadKind) -> [BodyRef; 2] {
    match kind {
        LoadKind::Force { body, .. } | LoadKind::Moment { body, .. } => {
            [BodyRef::Ground, BodyRef::Moving(*body)]
        }
        LoadKind::Spring { bodies, .. } => *bodies,
        LoadKind::Torsion { joint, .. } | LoadKind::Slider { joint, .. } => model.joints[*joint].bodies,
    }
}

/// Pairs of bodies that something connects.
fn links(model: &Model) -> impl Iterator<Item = [BodyRef; 2]> + '_ {
    let geared = model.joints.iter().filter_map(ModelJoint::coupled_joints).flat_map(move |[a, b]| {
        let moving = |joint: usize| model.joints[joint].bodies;
        let ends: Vec<BodyRef> =
            moving(a).into_iter().chain(moving(b)).filter(|b| *b != BodyRef::Ground).collect();
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
    });
    let joints = model.joints.iter().map(|joint| joint.bodies);
    let drivers = model.drivers.iter().map(move |driver| driver_bodies(model, &driver.kind));
    let loads = model.loads.iter().map(move |load| load_bodies(model, &load.kind));
    joints.chain(geared).chain(drivers).chain(loads)
}

/// Whether joints or drivers close loops: rows of a tree never depend on each other. Drivers along a joint and gears close
/// none.
pub fn has_loops(model: &Model) -> bool {
    let ground = model.bodies.len();
    let mut label: Vec<usize> = (0..=ground).collect();
    let place = |body: BodyRef| match body {
        BodyRef::Ground => ground,
        BodyRef::Moving(body) => body,
    };
    let joints = model
        .joints
        .iter()
        .filter(|joint| joint.coupled_joints().is_none())
        .map(|joint| joint.bodies.map(place));
    let drivers = model.drivers.iter().filter_map(|driver| match driver.kind {
        DriverKind::Point { body, .. } | DriverKind::Vector { body, .. } => Some([body, ground]),
        DriverKind::Angle { .. }
        | DriverKind::Slide { .. }
        | DriverKind::Cosine { .. }
        | DriverKind::CosineToWorld { .. } => None,
    });
    joints.chain(drivers).any(|[i, j]| {
        let joined = root(&mut label, i) == root(&mut label, j);
        join(&mut label, i, j);
        joined
    })
}

fn root(label: &mut [usize], mut body: usize) -> usize {
    while label[body] != body {
        label[body] = label[label[body]];
        body = label[body];
    }
    body
}

fn join(label: &mut [usize], i: usize, j: usize) {
    let (i, j) = (root(label, i), root(label, j));
    label[i.max(j)] = i.min(j);
}

fn without_rows(model: &Model, bodies: &[usize]) -> Model {
    Model {
        name: model.name.clone(),
        gravity: model.gravity,
        bodies: bodies.iter().map(|&body| model.bodies[body].clone()).collect(),
        joints: Vec::new(),
        starts: Vec::new(),
        drivers: Vec::new(),
        loads: Vec::new(),
        custom_loads: Vec::new(),
        markers: Vec::new(),
        events: Vec::new(),
        // Outputs are read off the whole system.
        settings: Settings { outputs: Vec::new(), ..model.settings.clone() },
        notes: Vec::new(),
    }
}

impl Assignment {
    /// The body's index in its island, and that island.
    fn of(assignments: &[Self], body: BodyRef) -> (BodyRef, Option<usize>) {
        match body {
            BodyRef::Ground => (BodyRef::Ground, None),
            BodyRef::Moving(body) => match assignments[body] {
                Self::Ground(_) => (BodyRef::Ground, None),
                Self::Moves { island, index } => (BodyRef::Moving(index), Some(island)),
            },
        }
    }

    /// The island that two bodies belong to, if it is not the ground, and their indices there.
    fn pair(assignments: &[Self], bodies: [BodyRef; 2]) -> Option<(usize, [BodyRef; 2])> {
        let [(i, island_i), (j, island_j)] = bodies.map(|body| Self::of(assignments, body));
        Some((island_i.or(island_j)?, [i, j]))
    }

    /// A point or vector of a body in the frame that its island uses for it: that of the body, or the world if it is fixed.
    fn turned(assignments: &[Self], body: BodyRef, local: &Vector3<f64>, point: bool) -> Vector3<f64> {
        match body {
            BodyRef::Moving(body) => match &assignments[body] {
                Self::Ground(place) if point => place.r + place.arm(local),
                Self::Ground(place) => place.arm(local),
                Self::Moves { .. } => *local,
            },
            BodyRef::Ground => *local,
        }
    }
}

/// Gives each joint, driver and load to the island that it belongs to. Those between ground and ground have no effect.
fn distribute(model: &Model, assignments: &[Assignment], islands: &mut [Model]) {
    let mut places = vec![usize::MAX; model.joints.len()];
    for (index, joint) in model.joints.iter().enumerate() {
        let Some((island, bodies)) = Assignment::pair(assignments, joint.bodies) else { continue };
        places[index] = islands[island].joints.len();
        let mut own = ModelJoint { bodies, ..joint.clone() };
        for side in 0..2 {
            let turned = |local: &Vector3<f64>, point: bool| {
                Assignment::turned(assignments, joint.bodies[side], local, point)
            };
            own.points[side] = turned(&joint.points[side], true);
            own.axes[side] = turned(&joint.axes[side], false);
            own.cross[side] = joint.cross[side].map(|across| turned(&across, false));
        }
        if let JointGeometry::Gear { joints, .. } = &mut own.geometry {
            *joints = joints.map(|joint| places[joint]);
        }
        islands[island].joints.push(own);
    }
    for driver in &model.drivers {
        let Some((island, pair)) = Assignment::pair(assignments, driver_bodies(model, &driver.kind)) else {
            continue;
        };
        let mut own = driver.clone();
        match &mut own.kind {
            DriverKind::Point { body, .. }
            | DriverKind::Vector { body, .. }
            | DriverKind::CosineToWorld { body, .. } => rename(body, pair[1]),
            DriverKind::Angle { joint, .. } | DriverKind::Slide { joint, .. } => *joint = places[*joint],
            DriverKind::Cosine { bodies, .. } => *bodies = pair,
        }
        islands[island].drivers.push(own);
    }
    for load in &model.loads {
        let Some((island, pair)) = Assignment::pair(assignments, load_bodies(model, &load.kind)) else {
            continue;
        };
        let mut own = load.clone();
        match &mut own.kind {
            LoadKind::Force { body, .. } | LoadKind::Moment { body, .. } => rename(body, pair[1]),
            LoadKind::Spring { bodies, locals, .. } => {
                for (side, local) in locals.iter_mut().enumerate() {
                    *local = Assignment::turned(assignments, bodies[side], local, true);
                }
                *bodies = pair;
            }
            LoadKind::Torsion { joint, .. } | LoadKind::Slider { joint, .. } => *joint = places[*joint],
        }
        islands[island].loads.push(own);
    }
}

fn rename(body: &mut usize, name: BodyRef) {
    if let BodyRef::Moving(index) = name {
        *body = index;
    }
}
