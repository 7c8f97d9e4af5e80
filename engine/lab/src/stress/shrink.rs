//! Making a scene that fails as small as it can be while it still fails.

use triad_scene::{Driver, GROUND, JointKind, Load, Scene};

/// Leaves away whatever is not needed for `fails`: loads, drivers, joints, bodies, then gravity and velocities.
pub fn shrink(scene: &Scene, fails: &dyn Fn(&Scene) -> bool) -> Scene {
    let mut small = scene.clone();
    loop {
        let Some(smaller) = candidates(&small).into_iter().find(|candidate| fails(candidate)) else {
            return small;
        };
        small = smaller;
    }
}

/// Scenes that are simpler by one thing, the boldest first.
fn candidates(scene: &Scene) -> Vec<Scene> {
    let mut list: Vec<Scene> = (0..scene.bodies.len()).rev().map(|body| without_body(scene, body)).collect();
    list.extend((0..scene.joints.len()).rev().map(|joint| without_joint(scene, joint)));
    for (index, _) in scene.loads.iter().enumerate() {
        list.push(changed(scene, |s| drop(s.loads.remove(index))));
    }
    for (index, _) in scene.drivers.iter().enumerate() {
        list.push(changed(scene, |s| drop(s.drivers.remove(index))));
    }
    if scene.gravity != [0.0; 3] {
        list.push(changed(scene, |s| s.gravity = [0.0; 3]));
    }
    for (index, body) in scene.bodies.iter().enumerate() {
        if body.velocity != [0.0; 3] {
            list.push(changed(scene, |s| s.bodies[index].velocity = [0.0; 3]));
        }
        if body.angular_velocity != [0.0; 3] {
            list.push(changed(scene, |s| s.bodies[index].angular_velocity = [0.0; 3]));
        }
    }
    list.retain(|candidate| !candidate.bodies.is_empty());
    list
}

fn changed(scene: &Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = scene.clone();
    change(&mut scene);
    scene
}

fn without_body(scene: &Scene, body: usize) -> Scene {
    let mut scene = scene.clone();
    let name = scene.bodies.remove(body).name;
    let gone: Vec<usize> = (0..scene.joints.len())
        .rev()
        .filter(|&k| scene.joints[k].body_i == name || scene.joints[k].body_j == name)
        .collect();
    for joint in gone {
        // A gear may have gone with an earlier one.
        if joint < scene.joints.len() {
            scene = without_joint(&scene, joint);
        }
    }
    scene.loads.retain(|load| !load_bodies(load).contains(&name.as_str()));
    scene.drivers.retain(|driver| !driver_bodies(driver).contains(&name.as_str()));
    scene
}

fn without_joint(scene: &Scene, joint: usize) -> Scene {
    let mut scene = scene.clone();
    let name = scene.joints.remove(joint).name;
    scene
        .joints
        .retain(|j| j.kind != JointKind::Gear || j.joints.as_ref().is_none_or(|pair| !pair.contains(&name)));
    scene.loads.retain(|load| match load {
        Load::Torsion { joint, .. } | Load::Slider { joint, .. } => *joint != name,
        _ => true,
    });
    scene.drivers.retain(|driver| match driver {
        Driver::Angle { joint, .. } | Driver::Slide { joint, .. } => *joint != name,
        _ => true,
    });
    scene
}

fn load_bodies(load: &Load) -> Vec<&str> {
    match load {
        Load::Force { body, .. } | Load::Moment { body, .. } => vec![body],
        Load::Spring { body_i, body_j, .. } => vec![body_i, body_j],
        Load::Torsion { .. } | Load::Slider { .. } => vec![GROUND],
    }
}

fn driver_bodies(driver: &Driver) -> Vec<&str> {
    match driver {
        Driver::Point { body, .. } | Driver::Vector { body, .. } | Driver::AngleToWorld { body, .. } => {
            vec![body]
        }
        Driver::AngleCosine { body_i, body_j, .. } => vec![body_i, body_j],
        Driver::Angle { .. } | Driver::Slide { .. } => vec![GROUND],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_shrinks_to_what_causes_it() {
        let scene = triad_scene::catalogue::scene("n-four-bar:3").unwrap();
        // Pretend that whatever joins the third upright to the ground fails.
        let fails = |s: &Scene| s.joints.iter().any(|j| j.body_i == GROUND && j.body_j == "upright-2");
        let small = shrink(&scene, &fails);
        assert_eq!((small.bodies.len(), small.joints.len()), (1, 1));
        assert_eq!(small.gravity, [0.0; 3]);
        assert_eq!(small.bodies[0].velocity, [0.0; 3]);
    }
}
