//! Task: simulate a pendulum, read its state at any time, and know how good the answer is.

use triad_engine::prelude::*;

/// Runs it: `cargo run --release -p triad-engine --example pendulum`.
pub fn main() -> Result<(), EngineError> {
    let mut scene = Scene::new("pendulum").gravity([0.0, -9.81, 0.0]);
    let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
    scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    let motion = scene.simulate(0.0..5.0)?;
    for t in motion.every(0.5) {
        let state = motion.at(t)?;
        let (tip, spin) = (state.point(&rod, [0.5, 0.0, 0.0])?, state.angular_velocity(&rod)?[2]);
        println!("{t:4.1} s: tip at ({:7.4}, {:7.4}) m, ω = {spin:7.4} rad/s", tip[0], tip[1]);
    }
    println!("energy drift {:.1e} J in {} steps", motion.energy_drift(), motion.summary().steps);
    assert!(motion.energy_drift().abs() < 1e-7);
    Ok(())
}
