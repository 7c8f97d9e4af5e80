//! What lessons claim of built-in scenes, measured again.

use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::scene::IntegratorKind;

/// Evaluations of a built-in scene up to a time.
fn evaluations(name: &str, until: f64, integrator: IntegratorKind, tolerance: f64) -> f64 {
    let mut scene = catalogue::scene(name).unwrap();
    let settings = &mut scene.simulation;
    (settings.integrator, settings.tolerance, settings.duration) = (integrator, tolerance, until);
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(until).unwrap();
    run.summary().evaluations as f64
}

/// The table of the lesson on stiff systems: tolerance, governor by dopri5 and radau, squeezer by dopri5 and radau.
const TABLE: [(f64, [f64; 4]); 4] = [
    (1e-3, [10100.0, 290.0, 440.0, 1120.0]),
    (1e-5, [9300.0, 330.0, 1100.0, 1720.0]),
    (1e-7, [15800.0, 530.0, 2400.0, 2630.0]),
    (1e-9, [36300.0, 760.0, 5400.0, 3900.0]),
];
/// How far a method may have got better or worse since, before the table has to be measured again.
const CHANGED: f64 = 1.3;

#[test]
fn the_governor_is_stiff_and_the_squeezer_is_only_fast() {
    let text = super::course().lesson("stiff").unwrap().text.html.clone();
    for (tolerance, row) in TABLE {
        let runs = [
            ("governor", 1.0, IntegratorKind::Dopri5),
            ("governor", 1.0, IntegratorKind::Radau),
            ("squeezer", 0.05, IntegratorKind::Dopri5),
            ("squeezer", 0.05, IntegratorKind::Radau),
        ];
        for ((name, until, integrator), told) in runs.into_iter().zip(row) {
            let found = evaluations(name, until, integrator, tolerance);
            let ratio = found / told;
            assert!(
                (1.0 / CHANGED..CHANGED).contains(&ratio),
                "{name} by {integrator} at {tolerance:e}: {found}, the lesson tells {told}"
            );
            let whole = format!("{told}");
            let spaced = format!("{} {}", &whole[..whole.len() - 3], &whole[whole.len() - 3..]);
            assert!(text.contains(&whole) || text.contains(&spaced), "the lesson does not tell {told}");
        }
    }
}
