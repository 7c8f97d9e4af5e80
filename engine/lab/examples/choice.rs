//! Whether the automatic choice of an integrator is the best one: `cargo run --release -p triad-lab --example choice -- SCENE…`,
//! each a built-in name or a file; `all` takes the catalogue, the lessons and the problems with references.
//!
//! Each integrator runs each scene at tolerances from 1e-3 to 1e-10. Times are processor time of whole runs with their estimate of errors,
//! taken in turns, because the machine may be shared: medians of several rounds. Errors are the largest distance of a centre of mass or of the tip of a director from a tight run at twenty times. Beside the time of the automatic choice
//! stands that of the fastest run of another integrator, at any tolerance, whose error is no larger than the one of the
//! automatic choice or than the tolerance.

use std::path::{Path, PathBuf};
use std::time::Instant;
use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

/// Integrators among which there is a choice.
const KINDS: [IntegratorKind; 4] =
    [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Radau];
/// Negative powers of ten of the tolerances.
const TOLERANCES: std::ops::RangeInclusive<i32> = 3..=10;
/// Tolerances of the tight run: the first with which there is one.
const TIGHT: [f64; 3] = [1e-13, 1e-12, 1e-11];
/// Times at which runs are compared.
const SAMPLES: usize = 20;
/// Rounds in which all runs at a tolerance take their turn, and how long each repeats its run in a round, s.
const ROUNDS: usize = 5;
const MEASURED: f64 = 0.004;
/// A run that takes longer than this, or so many times as long as the fastest one at its tolerance, is given up, s. It is no
/// better choice at any error: a run at a tolerance ten times as loose takes more than a sixth of its time.
const TOO_LONG: f64 = 0.5;
const SLOWER: f64 = 6.0;
/// No run is given up earlier than this, s.
const LEAST: f64 = 0.01;
/// Time of the tight run, s.
const TOO_LONG_TIGHT: f64 = 5.0;
/// Steps between two looks at the clock.
const PORTION: u64 = 20;
/// Ratio of the automatic choice's time to the best one above which it is marked.
const GOOD: f64 = 1.3;

/// One integrator at one tolerance.
struct Run {
    kind: IntegratorKind,
    tolerance: f64,
    seconds: f64,
    error: f64,
    steps: String,
    start: Simulation,
}

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let names = if names == ["all"] { everything() } else { names };
    let (mut worst, mut missed, mut counted) = (0.0f64, Vec::new(), 0);
    for name in names {
        let Some(scene) = read(&name) else {
            println!("{name}: no scene");
            continue;
        };
        let ratios = sweep(&name, &scene);
        worst = ratios.iter().copied().fold(worst, f64::max);
        counted += ratios.len();
        let most = ratios.iter().copied().fold(0.0, f64::max);
        if most > GOOD {
            missed.push((name, most, ratios.iter().filter(|ratio| **ratio > GOOD).count()));
        }
    }
    for (name, most, count) in &missed {
        println!("above {GOOD}: {name}, at {count} tolerances, at most {most:.2}");
    }
    let above: usize = missed.iter().map(|(.., count)| count).sum();
    println!("{counted} choices; worst ratio {worst:.2}; {above} above {GOOD}");
}

/// Names of all scenes there are.
fn everything() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut names: Vec<String> =
        catalogue::ENTRIES.iter().map(|scene| scene.name.replace(":N", ":20")).collect();
    for folder in ["tests/data/problems", "lessons/course"] {
        let mut files = Vec::new();
        collect(&root.join(folder), &mut files);
        files.sort();
        names.extend(files.into_iter().map(|file| file.display().to_string()));
    }
    names
}

/// JSON files below a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
}

fn read(name: &str) -> Option<Scene> {
    match std::fs::read_to_string(name) {
        Ok(text) => Scene::from_json(&text).ok(),
        Err(_) => catalogue::scene(name).ok(),
    }
}

/// Prints the table of a scene. Returns the ratios of the automatic choice's time to the best one.
fn sweep(name: &str, scene: &Scene) -> Vec<f64> {
    let tight = |tolerance: &f64| places(scene, IntegratorKind::Taylor, *tolerance, TOO_LONG_TIGHT);
    let Some(exact) = TIGHT.iter().find_map(tight) else {
        println!("{name}: no reference");
        return Vec::new();
    };
    let mut runs = Vec::new();
    for exponent in TOLERANCES {
        let tolerance = libm::pow(10.0, -f64::from(exponent));
        let mut fastest = TOO_LONG / SLOWER;
        for kind in KINDS {
            let most = (SLOWER * fastest).max(LEAST);
            let run = measure(scene, kind, tolerance, &exact, most);
            fastest = run.iter().map(|run| run.seconds).fold(fastest, f64::min);
            runs.extend(run);
        }
        let first = runs.partition_point(|run| run.tolerance > tolerance);
        take_turns(&mut runs[first..]);
    }
    println!("{name}");
    let mut ratios = Vec::new();
    for exponent in TOLERANCES {
        let tolerance = libm::pow(10.0, -f64::from(exponent));
        print!("  {tolerance:.0e}");
        for run in runs.iter().filter(|run| run.tolerance == tolerance) {
            print!(" | {} {:.2} ms {:.0e} {}", run.kind, 1e3 * run.seconds, run.error, run.steps);
        }
        let chosen = chosen(scene, tolerance);
        let own = runs.iter().find(|run| Some(run.kind) == chosen && run.tolerance == tolerance);
        if own.is_none() && !runs.iter().any(|run| run.tolerance == tolerance) {
            println!(" | none gets to the end");
            continue;
        }
        let ratio = own.map_or(f64::INFINITY, |own| {
            let enough = own.error.max(tolerance);
            let others = runs.iter().filter(|run| run.kind != own.kind && run.error <= enough);
            own.seconds / others.map(|run| run.seconds).fold(f64::INFINITY, f64::min)
        });
        let chosen = chosen.map_or_else(String::new, |kind| kind.to_string());
        println!(" | auto {chosen} {ratio:.2}{}", if ratio > GOOD { " <<" } else { "" });
        ratios.push(ratio);
    }
    ratios
}

fn with(scene: &Scene, kind: IntegratorKind, tolerance: f64) -> Scene {
    let mut scene = scene.clone();
    (scene.simulation.integrator, scene.simulation.tolerance) = (kind, tolerance);
    scene
}

fn chosen(scene: &Scene, tolerance: f64) -> Option<IntegratorKind> {
    let run = Simulation::new(&with(scene, IntegratorKind::Auto, tolerance)).ok()?;
    Some(run.summary().integrator)
}

/// Places of all bodies at the times of comparison.
fn places(scene: &Scene, kind: IntegratorKind, tolerance: f64, most: f64) -> Option<Vec<f64>> {
    let mut run = Simulation::new(&with(scene, kind, tolerance)).ok()?;
    let began = processor_time();
    let mut places = Vec::new();
    for sample in 1..=SAMPLES {
        while !run.advance_towards(run.duration() * sample as f64 / SAMPLES as f64, PORTION).ok()? {
            if processor_time() - began > most {
                return None;
            }
        }
        for body in &run.frame().bodies {
            places.extend(body.position);
            for direction in [body.u, body.v, body.w] {
                places.extend((0..3).map(|k| body.position[k] + direction[k]));
            }
        }
    }
    Some(places)
}

fn measure(scene: &Scene, kind: IntegratorKind, tolerance: f64, exact: &[f64], most: f64) -> Option<Run> {
    let began = processor_time();
    let found = places(scene, kind, tolerance, most)?;
    let seconds = processor_time() - began;
    let apart = found.chunks_exact(3).zip(exact.chunks_exact(3));
    let error = apart
        .map(|(a, b)| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt())
        .fold(0.0, f64::max);
    let start = Simulation::new(&with(scene, kind, tolerance)).ok()?;
    let mut run = start.clone();
    run.advance_to(run.duration()).ok()?;
    let summary = run.summary();
    let steps = format!("{}+{}/{}", summary.steps, summary.rejected, summary.evaluations);
    Some(Run { kind, tolerance, seconds, error, steps, start })
}

/// Times runs in turns.
fn take_turns(runs: &mut [Run]) {
    let mut found = vec![Vec::new(); runs.len()];
    for _ in 0..ROUNDS {
        for (run, found) in runs.iter().zip(&mut found) {
            let (mut seconds, mut count) = (0.0, 0);
            while seconds < MEASURED {
                let mut copy = run.start.clone();
                let began = processor_time();
                // It has come to its end before.
                let _ = copy.advance_to(copy.duration());
                seconds += processor_time() - began;
                count += 1;
            }
            found.push(seconds / f64::from(count));
        }
    }
    for (run, mut found) in runs.iter_mut().zip(found) {
        found.sort_by(f64::total_cmp);
        run.seconds = found[ROUNDS / 2];
    }
}

/// Processor time of this thread where the system tells it, else time, s.
fn processor_time() -> f64 {
    thread_local!(static START: Instant = Instant::now());
    // Giving way once makes the system bring its count up to date, which otherwise goes by ticks of 4 ms.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|text| text.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.with(|start| start.elapsed().as_secs_f64()), |ns| 1e-9 * ns)
}
