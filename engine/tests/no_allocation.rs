//! Steps allocate nothing: what a run needs is there before its first step.

#![allow(clippy::unwrap_used, missing_docs)]

use triad_engine::catalogue;
use triad_engine::scene::IntegratorKind;
use triad_engine::simulation::Simulation;

#[test]
fn steps_allocate_nothing() {
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5] {
        for name in ["spatial-chain:20", "n-four-bar:3", "simple-pendulum"] {
            let mut scene = catalogue::scene(name).unwrap();
            scene.simulation.integrator = integrator;
            let mut simulation = Simulation::new(&scene).unwrap();
            simulation.step().unwrap();
            let made = allocation_counter::measure(|| {
                for _ in 0..20 {
                    simulation.step().unwrap();
                }
            });
            assert_eq!(made.count_total, 0, "{name} with {integrator:?}");
        }
    }
}
