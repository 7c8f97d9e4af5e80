//! Task: a load of one's own, a function of the whole state.
//!
//! A force that is known over time alone is a table (`Motion::table`), a spring, damper or friction a law of a length or an
//! angle (`Load`); both can stand in a scene's JSON. What depends on more is a closure, which stays in the program.

use triad_engine::prelude::*;

/// Runs it: `cargo run --release -p triad-engine --example own_load`.
pub fn main() -> Result<(), EngineError> {
    let mut scene = Scene::new("arrow").gravity([0.0, 0.0, -9.81]);
    let arrow =
        Body::cylinder("arrow", 0.02, 0.003, [-0.4, 0.0, 1.5], [0.4, 0.0, 1.5]).velocity([50.0, 0.0, 8.0]);
    let arrow = scene.add(arrow);
    // Its vanes, 0.35 m behind the middle, feel the air across the shaft, which is along u.
    let vanes = [-0.35, 0.0, 0.0];
    let air = CustomLoad::new("air", &arrow, {
        let arrow = arrow.clone();
        move |state| {
            let (v, [u, ..]) = (state.point_velocity(&arrow, vanes), state.directors(&arrow));
            let along: f64 = (0..3).map(|k| v[k] * u[k]).sum();
            let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
            Wrench::force([0, 1, 2].map(|k| -2e-3 * speed * (v[k] - along * u[k])))
        }
    });
    let flight = scene.simulate_with([air.at(vanes)], 0.0..1.5)?;
    for t in flight.every(0.25) {
        let state = flight.at(t)?;
        let ([x, _, z], [u, ..]) = (state.position(&arrow)?, state.directors(&arrow)?);
        println!("{t:4.2} s: ({x:6.2}, {z:5.2}) m, pitch {:6.2}°", libm::asin(u[2]).to_degrees());
    }
    let (summary, state) = (flight.summary(), flight.at(1.5)?);
    println!("{:.3} J lost to the air; {}: {}", -summary.work, summary.integrator, summary.reason);
    // The vanes turn it into the wind, and the balance of energy holds.
    let (v, [u, ..]) = (state.velocity(&arrow)?, state.directors(&arrow)?);
    assert!((libm::asin(u[2]) - libm::atan(v[2] / v[0])).abs() < 0.1 && summary.energy_drift.abs() < 1e-6);
    Ok(())
}
