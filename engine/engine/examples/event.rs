//! Task: find when something happens, and stop there.

use triad_engine::prelude::*;

/// Runs it: `cargo run --release -p triad-engine --example event`.
pub fn main() -> Result<(), EngineError> {
    let mut scene = Scene::new("throw").gravity([0.0, 0.0, -9.81]);
    let ball = Body::sphere("ball", 0.4, 0.1, [0.0, 0.0, 1.5]).velocity([6.0, 0.0, 4.0]);
    let ball = scene.add(ball);
    let up = [0.0, 0.0, 1.0];
    let height = || Quantity::coordinate(&ball, [0.0; 3], up);
    let window = scene.add(Event::new("window", height(), 2.0));
    let landing = scene.add(Event::new("landing", height(), 0.1).downwards().stop());
    let motion = scene.simulate(0.0..10.0)?;
    println!("at 2 m at {:?} s", motion.times_of(&window)?);
    let end = motion.times_of(&landing)?[0];
    println!("lands at {end:.6} s, {:.3} m away", motion.at(end)?.position(&ball)?[0]);
    let exact = (4.0 + f64::sqrt(4.0 * 4.0 + 2.0 * 9.81 * 1.4)) / 9.81;
    assert!((end - exact).abs() < 1e-9 && motion.end() == end && motion.times_of(&window)?.len() == 2);
    Ok(())
}
