//! The parts of a step, with time for each body: `cargo bench -p triad-engine` (a filter such as `-- factorization` may
//! follow).

#![allow(missing_docs, clippy::unwrap_used)] // made by criterion's macros; a bench that cannot go on says so

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use triad_engine::catalogue;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::dynamics::series::IslandSeries;
use triad_engine::model::Model;
use triad_engine::ode::OdeSystem;
use triad_engine::run::Simulation;

/// What is timed: trees, loops, planar and spatial, small and large.
const SCENES: [&str; 6] = [
    "spatial-chain:1",
    "spatial-chain:10",
    "spatial-chain:100",
    "spatial-chain:2000",
    "n-four-bar:40",
    "bricard",
];

/// A built-in scene with its state at the start.
fn start(name: &str) -> (Mechanism, Vec<f64>) {
    let scene = catalogue::scene(name).unwrap();
    let (mut mechanism, mut y) = Mechanism::from_model(Model::new(&scene).unwrap());
    mechanism.assemble(&mut y).unwrap();
    (mechanism, y)
}

fn parts(criterion: &mut Criterion) {
    for name in SCENES {
        let (mut mechanism, y) = start(name);
        let bodies = Throughput::Elements(mechanism.system.bodies.len() as u64);
        let mut group = |what: &str, work: &mut dyn FnMut()| {
            let mut group = criterion.benchmark_group(what);
            group.throughput(bodies.clone());
            group.bench_function(BenchmarkId::from_parameter(name), |bencher| bencher.iter(&mut *work));
            group.finish();
        };
        let mut series = IslandSeries::in_space(&mechanism.system, 2, &[]);
        series.place(&mechanism.system, 0.0, &y);
        series.find_dependent(mechanism.system.length, false, None);
        group("factorization", &mut || series.linearize());
        group("evaluation", &mut || series.evaluate());
        group("projection", &mut || {
            black_box(series.correct_positions());
        });
        let mut rate = vec![0.0; y.len()];
        group("evaluation of q and q̇, body by body", &mut || mechanism.rhs(0.0, black_box(&y), &mut rate));

        let mut run = Simulation::new(&catalogue::scene(name).unwrap()).unwrap();
        group("step", &mut || {
            if run.finished() {
                run.reset();
            }
            run.step().unwrap();
        });
        group("frame", &mut || {
            black_box(run.frame());
        });
    }
}

criterion_group! {
    name = hot_path;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = parts
}
criterion_main!(hot_path);
