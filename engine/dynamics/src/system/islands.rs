//! The islands of a model, which nothing connects, without the bodies that cannot move — THEORY section 7.
//!
//! Bodies that no joint, driver or load connects move each on its own: their series take steps of their own. A body
//! that rigid connections tie to the ground is ground, and bodies that they tie to each other are one.

mod rigid;

use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, DriverKind, JointGeometry, LoadKind, Model, ModelBody, ModelJoint};
use crate::scene::{LoadFrame, Settings};
use crate::system::System;
use crate::system::body::BodyPart;
use crate::system::natural::NaturalCoordinates;
use nalgebra::{Matrix3, Vector3};
use rigid::{Merged, driver_bodies};

/// An island as a system of its own; its columns are those of the whole system.
#[derive(Clone, Debug)]
pub struct Island {
    /// The system.
    pub system: System,
    /// Its bodies, as places in the whole; of bodies that are merged the first.
    pub bodies: Vec<usize>,
}

/// The islands of a model.
#[derive(Clone, Debug)]
pub struct Islands {
    /// The islands; none where the whole is one.
    pub islands: Vec<Island>,
    /// Bodies that cannot move.
    pub fixed: usize,
    /// Bodies that move as parts of others.
    pub merged: usize,
}

/// What became of a body of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Assignment {
    /// It is ground, at its place.
    Ground(NaturalCoordinates),
    /// Body `index` of island `island`, or part of it at its place in the frame of that body.
    Moves { island: usize, index: usize, place: Option<NaturalCoordinates> },
}

/// The bodies of an island while it is put together.
#[derive(Default)]
struct Members {
    /// As places in the whole; of bodies that are merged the first.
    bodies: Vec<usize>,
    /// What those that stand for several are made of.
    merged: Vec<(usize, Merged)>,
}

/// The part of a model to which each body belongs, as one of its bodies: what joints, drivers and loads connect.
pub fn parts(model: &Model) -> Vec<usize> {
    let bodies = model.bodies.len();
    let mut label = labels(model, &vec![false; bodies], true);
    (0..bodies).map(|body| rigid::root(&mut label, body)).collect()
}

/// Divides a system at positions q: into islands if `islands`, and, if `rigid`, without fixed bodies and with those that are rigidly
/// joined merged.
pub fn split(system: &System, q: &[f64], islands: bool, rigid: bool) -> Islands {
    let model = &system.model;
    let grounded = if rigid { rigid::tied_to_ground(model) } else { vec![false; model.bodies.len()] };
    let leaders = if rigid { rigid::leaders(model, &grounded) } else { (0..model.bodies.len()).collect() };
    let mut label = labels(model, &grounded, islands);
    let mut parts_of = vec![Vec::new(); leaders.len()];
    leaders.iter().enumerate().for_each(|(body, &leader)| parts_of[leader].push(body));
    let mut assignments = vec![Assignment::Moves { island: 0, index: 0, place: None }; leaders.len()];
    let (mut members, mut island_of) = (Vec::<Members>::new(), vec![None; leaders.len()]);
    for body in 0..leaders.len() {
        if grounded[body] {
            assignments[body] = Assignment::Ground(system.bodies[body].layout.position(q));
            continue;
        }
        if leaders[body] != body {
            continue;
        }
        let island = *island_of[rigid::root(&mut label, body)].get_or_insert_with(|| {
            members.push(Members::default());
            members.len() - 1
        });
        let Members { bodies, merged } = &mut members[island];
        let index = bodies.len();
        assignments[body] = Assignment::Moves { island, index, place: None };
        if parts_of[body].len() > 1 {
            let whole = Merged::new(system, q, &parts_of[body]);
            for &(part, place) in &whole.parts {
                assignments[part] = Assignment::Moves { island, index, place: Some(place) };
            }
            merged.push((index, whole));
        }
        bodies.push(body);
    }
    let fixed = grounded.iter().filter(|grounded| **grounded).count();
    let merged = leaders.iter().enumerate().filter(|(body, leader)| *body != **leader).count();
    if members.len() < 2 && fixed + merged == 0 {
        return Islands { islands: Vec::new(), fixed, merged };
    }
    let mut models: Vec<Model> = members.iter().map(|members| without_rows(model, members)).collect();
    distribute(model, &assignments, &mut models);
    let own = models.into_iter().zip(members).map(|(model, members)| assembled(system, model, members));
    Islands { islands: own.collect(), fixed, merged }
}

/// Labels of bodies, the same for those of an island, as [`rigid::join`] gives them.
fn labels(model: &Model, grounded: &[bool], islands: bool) -> Vec<usize> {
    if !islands {
        return vec![0; model.bodies.len()];
    }
    let mut label: Vec<usize> = (0..model.bodies.len()).collect();
    for [i, j] in links(model) {
        if let (BodyRef::Moving(i), BodyRef::Moving(j)) = (i, j)
            && !grounded[i]
            && !grounded[j]
        {
            rigid::join(&mut label, i, j);
        }
    }
    label
}

/// The system of an island, in the coordinates of the whole.
fn assembled(whole: &System, model: Model, members: Members) -> Island {
    let mut system = System::new(model);
    system.coordinates = whole.coordinates;
    for (own, &body) in system.bodies.iter_mut().zip(&members.bodies) {
        own.layout = whole.bodies[body].layout;
    }
    for (index, merged) in members.merged {
        let part = |(body, place): (usize, _)| BodyPart { layout: whole.bodies[body].layout, place };
        system.bodies[index].parts = merged.parts.into_iter().map(part).collect();
    }
    Island { system, bodies: members.bodies }
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

/// Whether the joints are those of a tree and nothing else: their rows are independent whatever the position.
pub fn is_tree(model: &Model) -> bool {
    let simple =
        model.drivers.is_empty() && model.joints.iter().all(|joint| joint.coupled_joints().is_none());
    simple && !has_loops(model)
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
        let joined = rigid::root(&mut label, i) == rigid::root(&mut label, j);
        rigid::join(&mut label, i, j);
        joined
    })
}

fn without_rows(model: &Model, Members { bodies, merged }: &Members) -> Model {
    let mut bodies: Vec<ModelBody> = bodies.iter().map(|&body| model.bodies[body].clone()).collect();
    for (index, whole) in merged {
        bodies[*index] = whole.body.clone();
    }
    Model {
        name: model.name.clone(),
        gravity: model.gravity,
        bodies,
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
                Self::Moves { island, index, .. } => (BodyRef::Moving(index), Some(island)),
            },
        }
    }

    /// The island that two bodies belong to and their indices there, if they are not one body.
    fn pair(assignments: &[Self], bodies: [BodyRef; 2]) -> Option<(usize, [BodyRef; 2])> {
        let [(i, island_i), (j, island_j)] = bodies.map(|body| Self::of(assignments, body));
        (i != j).then_some((island_i.or(island_j)?, [i, j]))
    }

    /// The place of a body in the frame that its island uses for it, if it is not its own.
    fn place(assignments: &[Self], body: BodyRef) -> Option<&NaturalCoordinates> {
        match body {
            BodyRef::Ground => None,
            BodyRef::Moving(body) => match &assignments[body] {
                Self::Ground(place) => Some(place),
                Self::Moves { place, .. } => place.as_ref(),
            },
        }
    }

    /// A point of a body in the frame that its island uses for it.
    fn point(assignments: &[Self], body: BodyRef, local: &Vector3<f64>) -> Vector3<f64> {
        Self::place(assignments, body).map_or(*local, |place| place.r + place.arm(local))
    }

    /// A vector of a body in the frame that its island uses for it.
    fn vector(assignments: &[Self], body: BodyRef, local: &Vector3<f64>) -> Vector3<f64> {
        Self::place(assignments, body).map_or(*local, |place| place.arm(local))
    }
}

/// Gives each joint, driver and load to the island that it belongs to. Those within one body, or the ground, have no effect.
fn distribute(model: &Model, assignments: &[Assignment], islands: &mut [Model]) {
    let mut places = vec![usize::MAX; model.joints.len()];
    for (index, joint) in model.joints.iter().enumerate() {
        let Some((island, bodies)) = Assignment::pair(assignments, joint.bodies) else { continue };
        places[index] = islands[island].joints.len();
        let mut own = ModelJoint { bodies, ..joint.clone() };
        for (side, &body) in joint.bodies.iter().enumerate() {
            let vector = |local: &Vector3<f64>| Assignment::vector(assignments, body, local);
            own.points[side] = Assignment::point(assignments, body, &joint.points[side]);
            own.axes[side] = vector(&joint.axes[side]);
            own.cross[side] = joint.cross[side].map(|across| vector(&across));
        }
        if let JointGeometry::Gear { joints, .. } = &mut own.geometry {
            *joints = joints.map(|joint| places[joint]);
        }
        islands[island].joints.push(own);
    }
    for driver in &model.drivers {
        if let Some((island, pair)) = Assignment::pair(assignments, driver_bodies(model, &driver.kind)) {
            let mut own = driver.clone();
            give_driver(&mut own.kind, assignments, pair, &places);
            islands[island].drivers.push(own);
        }
    }
    for load in &model.loads {
        if let Some((island, pair)) = Assignment::pair(assignments, load_bodies(model, &load.kind)) {
            let mut own = load.clone();
            give_load(&mut own.kind, assignments, pair, &places);
            islands[island].loads.push(own);
        }
    }
}

/// Writes a driver with the bodies `pair` and the joints `places` of its island.
fn give_driver(kind: &mut DriverKind, assignments: &[Assignment], pair: [BodyRef; 2], places: &[usize]) {
    let vector = |body, local: &Vector3<f64>| Assignment::vector(assignments, body, local);
    match kind {
        DriverKind::Point { body, local, .. } => {
            *local = Assignment::point(assignments, BodyRef::Moving(*body), local);
            rename(body, pair[1]);
        }
        DriverKind::Vector { body, local, .. } | DriverKind::CosineToWorld { body, local, .. } => {
            *local = vector(BodyRef::Moving(*body), local);
            rename(body, pair[1]);
        }
        DriverKind::Angle { joint, .. } | DriverKind::Slide { joint, .. } => *joint = places[*joint],
        DriverKind::Cosine { bodies, locals, .. } => {
            *locals = [0, 1].map(|side| vector(bodies[side], &locals[side]));
            *bodies = pair;
        }
    }
}

/// The same for a load.
fn give_load(kind: &mut LoadKind, assignments: &[Assignment], pair: [BodyRef; 2], places: &[usize]) {
    let turned = |curve: &mut VectorCurve, frame, body| {
        if let (LoadFrame::Body, Some(place)) = (frame, Assignment::place(assignments, body)) {
            *curve = curve.clone().rotated(&Matrix3::from_columns(&place.e));
        }
    };
    match kind {
        LoadKind::Force { body, local, force, frame } => {
            *local = Assignment::point(assignments, BodyRef::Moving(*body), local);
            turned(force, *frame, BodyRef::Moving(*body));
            rename(body, pair[1]);
        }
        LoadKind::Moment { body, moment, frame } => {
            turned(moment, *frame, BodyRef::Moving(*body));
            rename(body, pair[1]);
        }
        LoadKind::Spring { bodies, locals, .. } => {
            *locals = [0, 1].map(|side| Assignment::point(assignments, bodies[side], &locals[side]));
            *bodies = pair;
        }
        LoadKind::Torsion { joint, .. } | LoadKind::Slider { joint, .. } => *joint = places[*joint],
    }
}

fn rename(body: &mut usize, name: BodyRef) {
    if let BodyRef::Moving(index) = name {
        *body = index;
    }
}
