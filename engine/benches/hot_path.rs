//! Time of one acceleration evaluation and of its parts, in nanoseconds a body: `cargo bench -p triad-engine`.
//!
//! Medians of many short repeats, because the machine may be shared; compare ratios rather than numbers.

use std::hint::black_box;
use std::time::Instant;
use triad_engine::catalogue;
use triad_engine::integrate::Plant;
use triad_engine::mechanism::Mechanism;
use triad_engine::model::Model;
use triad_engine::series::Series;
use triad_engine::system::System;

/// Median and least of the time of `work`, in nanoseconds.
fn nanoseconds(mut work: impl FnMut()) -> (f64, f64) {
    let once = Instant::now();
    work();
    let repeats = u32::try_from(200_000 / once.elapsed().as_nanos().max(1) + 1).unwrap_or(1);
    let mut times: Vec<f64> = (0..101)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..repeats {
                work();
            }
            start.elapsed().as_nanos() as f64 / f64::from(repeats)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (times[50], times[0])
}

fn report(what: &str, bodies: usize, work: impl FnMut()) {
    let (median, least) = nanoseconds(work);
    let n = bodies as f64;
    println!("{what:<44} {:>9.1} ns a body (least {:.1})", median / n, least / n);
}

fn main() -> Result<(), triad_engine::EngineError> {
    let names =
        ["spatial-chain:1", "spatial-chain:10", "spatial-chain:100", "spatial-chain:2000", "n-four-bar:40"];
    for name in names {
        let scene = catalogue::scene(name)?;
        let mut mechanism = Mechanism::new(System::new(Model::new(&scene)?));
        let n = mechanism.system.coordinates;
        let bodies = mechanism.system.bodies.len();
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        mechanism.system.start(q, q_dot);
        mechanism.assemble(&mut y)?;
        let mut rate = vec![0.0; 2 * n];
        report(&format!("{name}: evaluation"), bodies, || {
            mechanism.rate(0.0, black_box(&y), &mut rate);
        });
        report(&format!("{name}: place and velocity"), bodies, || mechanism.set_state(0.0, black_box(&y)));
        let mut series = Series::<4>::new(&mechanism.system, 2, mechanism.elimination.is_redundant(), &[]);
        report(&format!("{name}: evaluation, in bundles"), bodies, || {
            series.place(&mechanism.system, 0.0, black_box(&y));
            series.evaluate();
            series.store_accelerations(&mechanism.system, &mut rate[n..]);
        });
        let (system, elimination) = (&mechanism.system, &mut mechanism.elimination);
        report(&format!("{name}: linearize and factor"), bodies, || elimination.linearize(system));
        report(&format!("{name}: projection of positions"), bodies, || {
            elimination.correct_positions(system, black_box(&mut y[..n]));
        });
    }
    Ok(())
}
