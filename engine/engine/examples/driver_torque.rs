//! Task: prescribe a motion and find the torque that it takes.

use triad_engine::prelude::*;

/// Runs it: `cargo run --release -p triad-engine --example driver_torque`.
pub fn main() -> Result<(), EngineError> {
    let mut scene = Scene::new("arm").gravity([0.0, -9.81, 0.0]);
    let arm = scene.add(Body::rod("arm", 2.0, [0.0; 3], [0.8, 0.0, 0.0]));
    let shoulder = scene.add(Joint::revolute("shoulder", Ground, &arm).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    let (mass, length, turn, time) = (2.0, 0.8, 1.2, 2.0);
    let lift = scene.add(Driver::angle("lift", &shoulder, Motion::smooth_step(0.0, turn, 0.0, time)));
    let motion = scene.simulate(0.0..time)?;
    for t in motion.every(0.25) {
        println!("{t:4.2} s: torque {:7.3} N m", motion.driver_reaction(&lift, t)?.moment[2]);
    }
    // At rest, at the end, it carries the weight at half the length.
    let holding = 9.81 * mass * 0.5 * length * libm::cos(turn);
    assert!((motion.driver_reaction(&lift, time)?.moment[2] - holding).abs() < 1e-6);
    Ok(())
}
