//! Statistics of error estimates: `cargo run --release -p triad-lab --example estimates [seeds [way,… [tolerance,… [file …]]]]`.
//!
//! For each way to run a scene and each tolerance: how many estimates are within a factor of three of the error, how many below a
//! tenth of it, and the worst. `time` instead of seeds: what estimates cost, the time of a run with over that without.

use std::fmt::Write;
use std::time::Instant;
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_lab::estimates::{Judged, QUANTITIES, WAYS, in_the_way, judge_all, scenes};

/// Tolerances that are judged where none are given.
const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10];
/// Runs of which the fastest counts.
const ROUNDS: usize = 5;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |index: usize| words.get(index).map(String::as_str);
    let ways: Vec<&str> = word(1).map_or(WAYS.to_vec(), |text| text.split(',').collect());
    let tolerances: Vec<f64> = word(2).map_or(TOLERANCES.to_vec(), |text| {
        text.split(',').filter_map(|number| number.parse().ok()).collect()
    });
    let files: Vec<Scene> = words.iter().skip(3).filter_map(|path| read(path)).collect();
    if word(0) == Some("time") {
        let all: Vec<Scene> = scenes(0).into_iter().chain(files).collect();
        costs(&all, &ways, &tolerances);
    } else {
        let seeds = word(0).and_then(|text| text.parse().ok()).unwrap_or(100);
        let all: Vec<Scene> = scenes(seeds).into_iter().chain(files).collect();
        statistics(&all, &ways, &tolerances);
    }
}

fn read(path: &str) -> Option<Scene> {
    let found = std::fs::read_to_string(path).ok().and_then(|text| Scene::from_json(&text).ok());
    if found.is_none() {
        eprintln!("{path} is no scene");
    }
    let mut scene = found?;
    path.clone_into(&mut scene.name);
    Some(scene)
}

fn statistics(all: &[Scene], ways: &[&str], tolerances: &[f64]) {
    for way in ways {
        for &tolerance in tolerances {
            let mut judged: Vec<Judged> = Vec::new();
            for scene in all {
                let Some(scene) = in_the_way(scene, way) else { continue };
                // Not every method can run every scene.
                judged.extend(judge_all(&scene.tolerance(tolerance)).unwrap_or_default());
            }
            for quantity in QUANTITIES {
                let of: Vec<&Judged> = judged.iter().filter(|one| one.quantity == quantity).collect();
                tell(&format!("{way} {tolerance:.0e} {quantity:?}"), of);
            }
        }
    }
}

fn tell(what: &str, mut judged: Vec<&Judged>) {
    let count = |which: fn(&Judged) -> bool| judged.iter().filter(|one| which(one)).count();
    let (good, bad) = (count(Judged::is_good), count(Judged::is_bad));
    let share = 100.0 * good as f64 / judged.len().max(1) as f64;
    println!("{what}: {share:.1} of 100 within three, {bad} of {} below a tenth", judged.len());
    judged.sort_by(|a, b| (a.estimate / a.error).total_cmp(&(b.estimate / b.error)));
    let worst = judged.iter().take(bad.max(4)).chain(judged.iter().rev().take(2));
    for Judged { scene, time, estimate, error, size, unsure, .. } in worst {
        println!(
            "    {scene} at {time:.3} s: {estimate:.1e} for {error:.1e}, known to {unsure:.0e}, of {size:.1e}"
        );
    }
}

fn costs(all: &[Scene], ways: &[&str], tolerances: &[f64]) {
    for way in ways {
        for &tolerance in tolerances {
            let mut line = format!("{way} {tolerance:.0e}:");
            for scene in all {
                let Some(with) = in_the_way(scene, way).map(|scene| scene.tolerance(tolerance)) else {
                    continue;
                };
                let mut without = with.clone();
                without.simulation.error_estimate = false;
                if let (Ok(with), Ok(without)) = (seconds(&with), seconds(&without)) {
                    let _ = write!(line, " {} {:.2}", scene.name, with / without);
                }
            }
            println!("{line}");
        }
    }
}

/// The shortest time that a run takes after its start, s.
fn seconds(scene: &Scene) -> Result<f64, EngineError> {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let mut run = Simulation::new(scene)?;
        run.set_step_limit(100_000);
        let start = Instant::now();
        run.advance_to(run.duration())?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok(least)
}
