//! Task: find the forces in the joints of a four-bar.
//!
//! Its four hinges hold the plane more often than needed: forces across the plane are not unique, and that is told.

use triad_engine::prelude::*;

/// Runs it: `cargo run --release -p triad-engine --example four_bar_reactions`.
pub fn main() -> Result<(), EngineError> {
    let (a, b, c, d, z) = ([0.0; 3], [0.0, 1.0, 0.0], [2.0, 1.5, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let mut scene = Scene::new("four-bar").gravity([0.0, -9.81, 0.0]);
    let crank = scene.add(Body::rod("crank", 1.0, a, b));
    let coupler = scene.add(Body::rod("coupler", 2.0, b, c));
    let rocker = scene.add(Body::rod("rocker", 1.5, c, d));
    let hinges = [
        scene.add(Joint::revolute("A", Ground, &crank).at(a).about(z)),
        scene.add(Joint::revolute("B", &crank, &coupler).at(b).about(z)),
        scene.add(Joint::revolute("C", &coupler, &rocker).at(c).about(z)),
        scene.add(Joint::revolute("D", &rocker, Ground).at(d).about(z)),
    ];
    let motion = scene.simulate(0.0..1.0)?;
    for hinge in &hinges {
        let found = motion.reaction(hinge, 0.5)?;
        let [x, y, _] = found.force;
        let unique = if found.unique { "" } else { "; across the plane it is not unique" };
        println!("{hinge}: {x:8.3} N, {y:8.3} N on \"{}\"{unique}", found.on);
    }
    assert!(!motion.reaction(&hinges[0], 0.5)?.unique);
    Ok(())
}
