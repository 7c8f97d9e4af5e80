//! From links and joints to bodies and joints of a scene.
//!
//! A link's frame is its body's frame. Links without mass that are fixed to another become part of it.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use nalgebra::{Isometry3, Vector3};
use triad_scene::{
    AxisRows, Body, Friction, GROUND, Inertia, Joint, JointKind, Load, Orientation, Scene, Shape,
};

use crate::attached::Links;
use crate::follow::{StartOf, starts};
use crate::omissions::{OmittedItem, UrdfError, go_on};
use crate::placed::{Carrier, Placed};
use crate::read::{Geometry, JointType, Link, Robot, UrdfJoint, Visual};
use crate::side_car::{Root, SideCar};

/// Friction reaches three quarters at this speed, m/s or rad/s.
const SMOOTHING: f64 = 1e-2;

pub(super) fn scene(
    robot: &Robot,
    side_car: &SideCar,
    left_out: &mut Vec<OmittedItem>,
    wanted: &dyn Fn() -> bool,
) -> Result<Scene, UrdfError> {
    check_names(robot, side_car, wanted)?;
    let placed = place(robot, side_car)?;
    let mut scene =
        Scene::new(slug(&robot.name)).title(robot.name.as_str()).description("Imported from a URDF.");
    if let Some(gravity) = side_car.gravity {
        scene.gravity = gravity;
    }
    let links = Links(&placed);
    scene.drivers = side_car.drivers.iter().map(|driver| links.driver(driver)).collect();
    scene.loads = side_car.loads.iter().map(|load| links.load(load)).collect::<Result<_, _>>()?;
    scene.simulation = side_car.simulation.clone();
    for link in &placed {
        add_body(&mut scene, link, left_out);
    }
    for link in &placed {
        go_on(wanted)?;
        add_shapes(&mut scene, link, left_out);
        add_joint(&mut scene, link, &placed, left_out);
    }
    add_gears(&mut scene, robot, left_out);
    tell_idle_starts(robot, side_car, left_out);
    for joint in &side_car.joints {
        go_on(wanted)?;
        scene.joints.push(links.joint(joint));
    }
    Ok(scene)
}

fn check_names(robot: &Robot, side_car: &SideCar, wanted: &dyn Fn() -> bool) -> Result<(), UrdfError> {
    named_once("link", robot.links.iter().map(|link| (link.name.as_str(), link.line)))?;
    named_once("joint", robot.joints.iter().map(|joint| (joint.name.as_str(), joint.line)))?;
    let joints: BTreeSet<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    let mut links: BTreeSet<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    links.insert(GROUND);
    let known = |what: &'static str, names: &BTreeSet<&str>, name: &str| {
        go_on(wanted)?;
        if names.contains(name) || name.is_empty() {
            return Ok(());
        }
        let known = names.iter().map(|name| (*name).to_owned()).collect();
        Err(UrdfError::Unknown { what, name: name.to_owned(), known })
    };
    for name in side_car.positions.keys().chain(side_car.velocities.keys()) {
        known("joint", &joints, name)?;
    }
    for joint in &side_car.joints {
        known("link", &links, &joint.body_i)?;
        known("link", &links, &joint.body_j)?;
    }
    Ok(())
}

fn named_once<'a>(what: &str, mut all: impl Iterator<Item = (&'a str, u32)>) -> Result<(), UrdfError> {
    let mut names = BTreeSet::new();
    all.find(|(name, _)| !names.insert(*name)).map_or(Ok(()), |(name, line)| {
        let what = format!("there are two {what}s \"{name}\"");
        Err(UrdfError::Wrong { line, what, hint: "give each a name of its own" })
    })
}

/// Tells which positions and velocities of the side-car belong to joints that one number does not place.
fn tell_idle_starts(robot: &Robot, side_car: &SideCar, left_out: &mut Vec<OmittedItem>) {
    for joint in &robot.joints {
        let why = match joint.kind {
            JointType::Revolute | JointType::Prismatic => continue,
            JointType::Fixed => "a fixed joint has none",
            JointType::Floating | JointType::Planar => {
                "one number does not place such a joint: write the body's place into the scene"
            }
        };
        for (what, given) in [("position", &side_car.positions), ("velocity", &side_car.velocities)] {
            if given.get(&joint.name).is_some_and(|number| *number != 0.0) {
                left_out.push(OmittedItem {
                    line: joint.line,
                    of: format!("joint {}", joint.name),
                    what: format!("its {what} at the start: {why}"),
                });
            }
        }
    }
}

/// Walks the tree from its root.
fn place<'a>(robot: &'a Robot, side_car: &SideCar) -> Result<Vec<Placed<'a>>, UrdfError> {
    let index: BTreeMap<&str, &Link> = robot.links.iter().map(|link| (link.name.as_str(), link)).collect();
    let mut children: BTreeMap<&str, Vec<&UrdfJoint>> = BTreeMap::new();
    let mut carried: BTreeMap<&str, &UrdfJoint> = BTreeMap::new();
    for joint in &robot.joints {
        for end in [&joint.parent, &joint.child] {
            if !index.contains_key(end.as_str()) {
                let what = format!("joint {} names link \"{end}\", which there is not", joint.name);
                return Err(UrdfError::Wrong {
                    line: joint.line,
                    what,
                    hint: "check the spelling of the link",
                });
            }
        }
        if let Some(other) = carried.insert(&joint.child, joint) {
            let what =
                format!("link {} is the child of joint {} and of {}", joint.child, other.name, joint.name);
            let hint = "URDF describes a tree: close the loop by a joint of the side-car instead";
            return Err(UrdfError::Wrong { line: joint.line, what, hint });
        }
        children.entry(&joint.parent).or_default().push(joint);
    }
    let positions = starts(robot, &side_car.positions, StartOf::Positions)?;
    let velocities = starts(robot, &side_car.velocities, StartOf::Velocities)?;
    let root = root(robot, &carried)?;
    let mut placed: Vec<Placed> = Vec::with_capacity(robot.links.len());
    let own = Carrier { name: root.name.clone(), frame: Isometry3::identity() };
    let carrier = match side_car.root {
        Root::Ground => Carrier { name: GROUND.to_owned(), ..own },
        Root::Free if has_mass(root) => own,
        Root::Free => return Err(without_mass(root)),
    };
    let (pose, rest) = (Isometry3::identity(), Vector3::zeros());
    placed.push(Placed { link: root, pose, velocity: rest, spin: rest, joint: None, carrier });
    let mut queue = VecDeque::from([0]);
    while let Some(at) = queue.pop_front() {
        let name = placed[at].link.name.clone();
        for joint in children.get(name.as_str()).into_iter().flatten() {
            let number = |of: &BTreeMap<String, f64>| of.get(&joint.name).copied().unwrap_or(0.0);
            let start = [number(&positions), number(&velocities)];
            let next = moved(&placed[at], joint, index[joint.child.as_str()], start)?;
            queue.push_back(placed.len());
            placed.push(next);
        }
    }
    if placed.len() < robot.links.len() {
        let lost = robot.joints.iter().find(|joint| !placed.iter().any(|p| p.link.name == joint.child));
        let line = lost.map_or(1, |joint| joint.line);
        let what = "these links hang on each other in a ring, not on the root".to_owned();
        return Err(UrdfError::Wrong { line, what, hint: "close loops by joints of the side-car instead" });
    }
    Ok(placed)
}

/// The one link that is nobody's child.
fn root<'a>(robot: &'a Robot, carried: &BTreeMap<&str, &UrdfJoint>) -> Result<&'a Link, UrdfError> {
    let roots: Vec<&Link> =
        robot.links.iter().filter(|link| !carried.contains_key(link.name.as_str())).collect();
    if let [root] = roots[..] {
        return Ok(root);
    }
    let line = roots.get(1).map_or(1, |link| link.line);
    let what = match &roots[..] {
        [first, second, ..] => {
            format!("{} links have no parent, among them {} and {}", roots.len(), first.name, second.name)
        }
        [] | [_] => "no link is the root: the joints make a ring".to_owned(),
    };
    Err(UrdfError::Wrong { line, what, hint: "every link but one must be the child of a joint" })
}

/// The child of a joint, in its place.
fn moved<'a>(
    parent: &Placed<'a>,
    joint: &'a UrdfJoint,
    link: &'a Link,
    [position, rate]: [f64; 2],
) -> Result<Placed<'a>, UrdfError> {
    let motion = match joint.kind {
        JointType::Revolute => Isometry3::rotation(joint.axis * position),
        JointType::Prismatic => Isometry3::translation_from(joint.axis * position),
        JointType::Fixed | JointType::Floating | JointType::Planar => Isometry3::identity(),
    };
    let local = joint.origin * motion;
    let pose = parent.pose * local;
    let axis = parent.pose * (joint.origin * joint.axis);
    let arm = pose.translation.vector - parent.pose.translation.vector;
    let mut velocity = parent.velocity + parent.spin.cross(&arm);
    let mut spin = parent.spin;
    match joint.kind {
        JointType::Revolute => spin += axis * rate,
        JointType::Prismatic => velocity += axis * rate,
        JointType::Fixed | JointType::Floating | JointType::Planar => {}
    }
    let fixed = joint.kind == JointType::Fixed;
    let carrier = if fixed && (parent.carrier.name == GROUND || !has_mass(link)) {
        Carrier { name: parent.carrier.name.clone(), frame: parent.carrier.frame * local }
    } else if has_mass(link) {
        Carrier { name: link.name.clone(), frame: Isometry3::identity() }
    } else {
        return Err(without_mass(link));
    };
    Ok(Placed { link, pose, velocity, spin, joint: Some((joint, position)), carrier })
}

/// A shift as a motion.
trait Shift {
    fn translation_from(by: Vector3<f64>) -> Self;
}

impl Shift for Isometry3<f64> {
    fn translation_from(by: Vector3<f64>) -> Self {
        Self::translation(by.x, by.y, by.z)
    }
}

fn has_mass(link: &Link) -> bool {
    link.inertial.as_ref().is_some_and(|inertial| inertial.mass > 0.0)
}

fn without_mass(link: &Link) -> UrdfError {
    UrdfError::Wrong {
        line: link.line,
        what: format!("link {} moves but has no mass", link.name),
        hint: "give it an <inertial> with a mass above zero, or fix it to its parent",
    }
}

fn add_body(scene: &mut Scene, placed: &Placed, left_out: &mut Vec<OmittedItem>) {
    let link = placed.link;
    if placed.carrier.name != link.name {
        if has_mass(link) {
            let what = "it does not move: its mass has no meaning".to_owned();
            left_out.push(OmittedItem { line: link.line, of: format!("link {}", link.name), what });
        } else if link.inertial.as_ref().is_some_and(|inertial| inertial.tensor.abs().max() > 0.0) {
            let what = "it has no mass: its inertia is left out".to_owned();
            left_out.push(OmittedItem { line: link.line, of: format!("link {}", link.name), what });
        }
        return;
    }
    let Some(inertial) = &link.inertial else { return };
    let tensor = inertial.tensor;
    let row = |k: usize| [tensor[(k, 0)], tensor[(k, 1)], tensor[(k, 2)]];
    let inertia = (tensor.abs().max() > 0.0).then(|| Inertia::Tensor([row(0), row(1), row(2)]));
    let turn = placed.pose.rotation;
    let mut body = Body::new(&link.name, inertial.mass)
        .center_of_mass(inertial.center.into())
        .position(placed.pose.translation.vector.into())
        .velocity(placed.velocity.into())
        .angular_velocity(placed.spin.into());
    body.inertia = inertia;
    body.orientation =
        (turn.angle() > 0.0).then(|| Orientation::Quaternion([turn.w, turn.i, turn.j, turn.k]));
    scene.add(body);
}

fn add_shapes(scene: &mut Scene, placed: &Placed, left_out: &mut Vec<OmittedItem>) {
    let Some(body) = scene.bodies.iter_mut().find(|body| body.name == placed.carrier.name) else { return };
    for visual in &placed.link.shapes {
        match shape(visual, &placed.carrier.frame) {
            Some(shape) => body.shape.push(shape),
            None => left_out.push(OmittedItem {
                line: visual.line,
                of: format!("link {}", placed.link.name),
                what: "<box> that is turned in its link: a scene's boxes lie along the axes of the body"
                    .to_owned(),
            }),
        }
    }
}

fn shape(visual: &Visual, frame: &Isometry3<f64>) -> Option<Shape> {
    let at = frame * visual.origin;
    let center: [f64; 3] = at.translation.vector.into();
    match visual.geometry {
        Geometry::Sphere(radius) => Some(Shape::Sphere { center, radius }),
        Geometry::Cylinder { radius, length } => {
            let half = at.rotation * Vector3::z() * (0.5 * length);
            let [from, to] = [-half, half].map(|end| (at.translation.vector + end).into());
            Some(Shape::Rod { from, to, radius })
        }
        Geometry::Box(size) => {
            // Quarter turns only exchange the edges.
            let turned = at.rotation.to_rotation_matrix().matrix().abs();
            let quarter = turned.iter().all(|part| *part < 1e-6 || (part - 1.0).abs() < 1e-6);
            quarter.then(|| Shape::Box { center, size: (turned.map(f64::round) * size).into() })
        }
    }
}

fn add_joint(scene: &mut Scene, placed: &Placed, all: &[Placed], left_out: &mut Vec<OmittedItem>) {
    let Some((joint, position)) = placed.joint else { return };
    let Some(parent) = all.iter().find(|other| other.link.name == joint.parent) else { return };
    if parent.carrier.name == placed.carrier.name {
        return;
    }
    let kind = match joint.kind {
        JointType::Revolute => JointKind::Revolute,
        JointType::Prismatic => JointKind::Prismatic,
        JointType::Fixed => JointKind::Fixed,
        JointType::Planar => JointKind::Planar,
        JointType::Floating => {
            add_friction(scene, joint, left_out);
            return;
        }
    };
    let on_parent = parent.carrier.frame * joint.origin;
    let mut written = Joint::new(&joint.name, kind, &parent.carrier.name, &placed.carrier.name)
        .at_local(on_parent.translation.vector.into(), [0.0; 3]);
    if kind != JointKind::Fixed {
        // The motion of the joint leaves its axis as it is.
        written = written.about_local((on_parent.rotation * joint.axis).into(), joint.axis.into());
    }
    if kind == JointKind::Revolute {
        written = written.rows(AxisRows::TwoCar);
        // The robot's zero, not the start, is where its angle is counted from.
        written.stated_angle = (position != 0.0).then_some(position);
    }
    scene.add(written);
    add_friction(scene, joint, left_out);
}

fn add_friction(scene: &mut Scene, joint: &UrdfJoint, left_out: &mut Vec<OmittedItem>) {
    if joint.damping == 0.0 && joint.friction == 0.0 {
        return;
    }
    let name = format!("{} friction", joint.name);
    let friction = Friction { smoothing: SMOOTHING, ..Friction::new(joint.damping, joint.friction) };
    let of = joint.name.clone();
    let load = match joint.kind {
        JointType::Revolute => Load::turning_friction(name, &of, friction),
        JointType::Prismatic => Load::sliding_friction(name, &of, friction),
        JointType::Fixed | JointType::Floating | JointType::Planar => {
            let what = "<dynamics>: friction has a word only for turning and sliding joints".to_owned();
            left_out.push(OmittedItem { line: joint.line, of: format!("joint {of}"), what });
            return;
        }
    };
    scene.add(load);
    if joint.friction != 0.0 {
        let what = format!(
            "<dynamics>: dry friction is smoothed, and reaches three quarters at {SMOOTHING} m/s or rad/s"
        );
        left_out.push(OmittedItem { line: joint.line, of: format!("joint {of}"), what });
    }
}

/// Joints that follow others.
fn add_gears(scene: &mut Scene, robot: &Robot, left_out: &mut Vec<OmittedItem>) {
    for joint in &robot.joints {
        let Some((leader, factor, offset)) = &joint.mimic else { continue };
        let turns = |name: &str| scene.joints.iter().any(|j| j.name == name && j.kind == JointKind::Revolute);
        if turns(leader) && turns(&joint.name) {
            let name = format!("{} follows {leader}", joint.name);
            let mut gear = Joint::gear(name, leader, &joint.name, *factor);
            gear.offset = (*offset != 0.0).then_some(*offset);
            scene.add(gear);
        } else {
            let there = robot.joints.iter().any(|joint| joint.name == *leader);
            let why =
                if there { "only turning joints can follow each other" } else { "there is no such joint" };
            let what = format!("<mimic> of {leader}: {why}");
            left_out.push(OmittedItem { line: joint.line, of: format!("joint {}", joint.name), what });
        }
    }
}

/// A name for files and addresses.
fn slug(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    let parts: Vec<&str> = plain.split('-').filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "robot".to_owned() } else { parts.join("-") }
}
