//! Drawing a mechanism from a seed.

use nalgebra::Vector3;
use triad_linalg::random::Random;
use triad_scene::{
    AxisRows, Body, Coordinates, Driver, GROUND, Inertia, Joint, JointKind, Load, LoadFrame, Motion,
    Orientation, Scene, VectorMotion,
};

/// The mechanism of a seed: one to seven bodies.
pub fn scene(seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let count = 1 + random.below(7);
    let mut scene =
        Scene::new(format!("random-{seed}")).gravity(random.triple(10.0)).duration(0.5).tolerance(1e-10);
    scene.bodies = (0..count).map(|i| body(&mut random, i)).collect();
    for index in 0..count {
        let parent = if index == 0 || random.chance(0.2) {
            GROUND.to_owned()
        } else {
            format!("b{}", random.below(index))
        };
        if random.chance(0.92) {
            let joint = joint(&mut random, &format!("j{index}"), &parent, &format!("b{index}"));
            scene.joints.push(joint);
        }
    }
    if count > 2 {
        for index in 0..random.below(3) {
            let first = random.below(count);
            let second = random.below(count + 1);
            let other =
                if second == count || second == first { GROUND.to_owned() } else { format!("b{second}") };
            let kind = if random.chance(0.5) { JointKind::Spherical } else { JointKind::Rod };
            scene.joints.push(ends(
                &mut random,
                Joint::new(format!("loop{index}"), kind, &other, format!("b{first}")),
            ));
        }
    }
    add_gear(&mut random, &mut scene);
    for index in 0..random.below(3) {
        let load = load(&mut random, &scene, index);
        scene.loads.push(load);
    }
    if random.chance(0.3) {
        add_driver(&mut random, &mut scene);
    }
    scene
}

fn body(random: &mut Random, index: usize) -> Body {
    // Second moments of any positive size belong to some body.
    let [a, b, c] = [0; 3].map(|_| random.between(0.02, 0.6));
    let reduced = random.chance(0.3);
    let drawn = Body::new(format!("b{index}"), random.between(0.3, 3.0))
        .inertia(Inertia::Principal([b + c, c + a, a + b]))
        .center_of_mass(random.triple(0.3))
        .position(random.triple(1.5))
        .orientation(Orientation::rotation(random.direction(), random.between(-3.0, 3.0)))
        .velocity(random.triple(1.0))
        .angular_velocity(random.triple(2.0));
    if reduced { drawn.coordinates(Coordinates::Reduced) } else { drawn }
}

/// The kinds of joint that are drawn; gears are added afterwards, between revolute joints.
const KINDS: [JointKind; 11] = [
    JointKind::Spherical,
    JointKind::Revolute,
    JointKind::Universal,
    JointKind::Cylindrical,
    JointKind::Prismatic,
    JointKind::Planar,
    JointKind::Screw,
    JointKind::Fixed,
    JointKind::Rod,
    JointKind::PointOnLine,
    JointKind::PointInPlane,
];

fn joint(random: &mut Random, name: &str, body_i: &str, body_j: &str) -> Joint {
    // Revolute joints are the commonest.
    let kind = if random.chance(0.3) { JointKind::Revolute } else { KINDS[random.below(KINDS.len())] };
    let mut joint = Joint::new(name, kind, body_i, body_j);
    match kind {
        JointKind::Universal => {
            let first = Vector3::from(random.direction()).normalize();
            let helper = if first.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() };
            joint.axes = Some([first.into(), first.cross(&helper).normalize().into()]);
        }
        JointKind::Spherical | JointKind::Rod | JointKind::Gear => {}
        JointKind::Revolute => {
            joint.axis = Some(random.direction());
            joint.rows = Some(if random.chance(0.5) { AxisRows::Cv } else { AxisRows::TwoCar });
        }
        JointKind::Screw => {
            joint.axis = Some(random.direction());
            joint.pitch = Some(random.between(0.2, 2.0));
        }
        JointKind::Cylindrical
        | JointKind::Prismatic
        | JointKind::Planar
        | JointKind::Fixed
        | JointKind::PointOnLine
        | JointKind::PointInPlane => joint.axis = Some(random.direction()),
    }
    ends(random, joint)
}

fn ends(random: &mut Random, mut joint: Joint) -> Joint {
    let point = random.triple(1.0);
    if joint.kind == JointKind::Rod {
        let away = Vector3::from(random.direction()) * 0.8;
        joint.points = Some([point, (Vector3::from(point) + away).into()]);
    } else {
        joint.point = Some(point);
    }
    joint
}

fn of_kinds(scene: &Scene, kinds: &[JointKind]) -> Vec<String> {
    scene.joints.iter().filter(|j| kinds.contains(&j.kind)).map(|j| j.name.clone()).collect()
}

fn add_gear(random: &mut Random, scene: &mut Scene) {
    let hinges = of_kinds(scene, &[JointKind::Revolute]);
    if hinges.len() < 2 || !random.chance(0.3) {
        return;
    }
    let first = random.below(hinges.len());
    let second = (first + 1) % hinges.len();
    scene.add(Joint::gear("gear", &hinges[first], &hinges[second], random.between(-2.0, 2.0)));
}

fn load(random: &mut Random, scene: &Scene, index: usize) -> Load {
    let name = format!("load{index}");
    let pick = |random: &mut Random| format!("b{}", random.below(scene.bodies.len()));
    let hinges = of_kinds(scene, &[JointKind::Revolute, JointKind::Cylindrical]);
    let slides = of_kinds(scene, &[JointKind::Prismatic, JointKind::Cylindrical]);
    let damping = |random: &mut Random| if random.chance(0.3) { random.between(0.0, 2.0) } else { 0.0 };
    match random.below(5) {
        0 => Load::Force {
            name,
            body: pick(random),
            point: random.triple(0.5),
            force: VectorMotion::Fixed { vector: random.triple(5.0) },
            frame: if random.chance(0.5) { LoadFrame::World } else { LoadFrame::Body },
        },
        1 => Load::Moment {
            name,
            body: pick(random),
            moment: VectorMotion::Fixed { vector: random.triple(2.0) },
            frame: if random.chance(0.5) { LoadFrame::World } else { LoadFrame::Body },
        },
        2 if !hinges.is_empty() => Load::Torsion {
            name,
            joint: hinges[random.below(hinges.len())].clone(),
            stiffness: random.between(0.0, 50.0),
            free_angle: random.between(-0.5, 0.5),
            damping: damping(random),
            torque: None,
            friction: None,
        },
        3 if !slides.is_empty() => Load::Slider {
            name,
            joint: slides[random.below(slides.len())].clone(),
            stiffness: random.between(0.0, 50.0),
            free_length: random.between(-0.5, 0.5),
            damping: damping(random),
            force: None,
            friction: None,
        },
        _ => Load::Spring {
            name,
            body_i: GROUND.to_owned(),
            point_i: random.triple(2.0),
            body_j: pick(random),
            point_j: random.triple(0.5),
            stiffness: random.between(0.0, 200.0),
            free_length: Some(random.between(0.1, 1.0)),
            damping: damping(random),
            force: None,
        },
    }
}

/// A hinge or a guide is driven from its position at the start.
fn add_driver(random: &mut Random, scene: &mut Scene) {
    let hinges = of_kinds(scene, &[JointKind::Revolute, JointKind::Cylindrical]);
    if hinges.is_empty() {
        return;
    }
    scene.drivers.push(Driver::Angle {
        name: "driver".to_owned(),
        joint: hinges[random.below(hinges.len())].clone(),
        motion: Motion::Harmonic {
            mean: 0.0,
            amplitude: random.between(0.1, 0.4),
            frequency: random.between(1.0, 6.0),
            phase: 0.0,
        },
    });
}
