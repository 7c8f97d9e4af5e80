//! The N-four-bar mechanism — A02 of the IFToMM library of benchmark problems.

use crate::elements::{AxisRows, Body, Inertia, Joint, Orientation, Shape};
use crate::handle::{BodyHandle, Ground};
use crate::scene::Scene;
use crate::value::Triple;

/// N windows: N + 1 uprights pinned to the ground at (i, 0), N couplers between their tips; all links are uniform
/// slender rods of 1 m and 1 kg. It starts upright, the tips moving at 1 m/s along +x.
///
/// The moment about a rod's own axis does not matter to this planar motion; it is given the value across the rod, so
/// that no axis of the rod is without inertia. Redundancy: every hinge is a spatial revolute.
pub fn scene(windows: usize) -> Scene {
    let mut scene = Scene::new(format!("n-four-bar-{windows}"))
        .title(format!("{windows}-four-bar mechanism"))
        .description(
            "Benchmark A02: passes through positions in which all links are horizontal and the mobility \
                      jumps from 1 to N + 1.",
        )
        .gravity([0.0, -9.81, 0.0]);
    let mut uprights = Vec::with_capacity(windows + 1);
    for i in 0..=windows {
        let x = i as f64;
        let upright = link(format!("upright-{i}"), [x, 0.5, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], -1.0);
        uprights.push(scene.add(upright));
        scene.add(pin(format!("A{i}"), Ground, &uprights[i], [x, 0.0, 0.0]));
    }
    for (i, ends) in uprights.windows(2).enumerate() {
        let x = i as f64;
        let coupler =
            link(format!("coupler-{i}"), [x + 0.5, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0);
        let coupler = scene.add(coupler);
        let left = if i == 0 { "B0".to_owned() } else { format!("B{i}-right") };
        scene.add(pin(left, &ends[0], &coupler, [x, 1.0, 0.0]));
        scene.add(pin(format!("B{}", i + 1), &coupler, &ends[1], [x + 1.0, 1.0, 0.0]));
    }
    scene
}

/// A rod along `along` (its u), centred at `position`, moving with the given velocity and spin about z.
fn link(name: String, position: Triple, along: Triple, velocity: Triple, spin: f64) -> Body {
    let across = [-along[1], along[0], 0.0];
    Body::new(name, 1.0)
        .inertia(Inertia::Principal([1.0 / 12.0; 3]))
        .position(position)
        .orientation(Orientation::directors(along, across))
        .velocity(velocity)
        .angular_velocity([0.0, 0.0, spin])
        .shape(Shape::Rod { from: [-0.5, 0.0, 0.0], to: [0.5, 0.0, 0.0], radius: 0.03 })
}

fn pin(
    name: impl Into<String>,
    body_i: impl Into<BodyHandle>,
    body_j: impl Into<BodyHandle>,
    point: Triple,
) -> Joint {
    Joint::revolute(name, body_i, body_j).at(point).about([0.0, 0.0, 1.0]).rows(AxisRows::Cv)
}
