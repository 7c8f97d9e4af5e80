//! Task: a load of one's own, a force that was measured or computed elsewhere, as a table over time.
//!
//! The table becomes a spline with two continuous derivatives. A load can also be a polynomial, a sine, a smooth step, or a
//! law of a length or an angle (springs, dampers, friction); one that is a function of the whole state cannot be given.

use triad_engine::prelude::*;

/// Thrust of a model rocket over the time since it was lit: s, N.
const THRUST: [(f64, f64); 6] = [(0.0, 0.0), (0.1, 14.0), (0.3, 9.0), (0.8, 6.0), (1.5, 5.5), (1.6, 0.0)];

/// Runs it: `cargo run --release -p triad-engine --example own_load`.
pub fn main() -> Result<(), EngineError> {
    // A test stand found 98 % of the thrust.
    let (times, values): (Vec<f64>, Vec<f64>) =
        THRUST.into_iter().map(|(t, newton)| (t, 0.98 * newton)).unzip();
    let mut scene = Scene::new("rocket").gravity([0.0, 0.0, -9.81]);
    let rocket = Body::cylinder("rocket", 0.15, 0.02, [0.0; 3], [0.0, 0.0, 0.5]);
    let rocket = scene.add(rocket);
    // u of a cylinder is along it: the force turns with the body.
    let thrust = VectorMotion::components(Motion::table(times, values), 0.0, 0.0);
    scene.add(Load::force("thrust", &rocket, [-0.25, 0.0, 0.0], thrust, LoadFrame::Body));
    let burn = scene.simulate(0.0..1.6)?;
    let speed = burn.at(1.6)?.velocity(&rocket)?[2];
    let work = burn.summary().work;
    println!("{speed:.2} m/s after {work:.1} J of work, energy drift {:.1e} J", burn.energy_drift());
    assert!(speed > 60.0 && burn.energy_drift().abs() < 1e-7 * work);
    Ok(())
}
