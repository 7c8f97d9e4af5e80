//! What mechanisms cost as they grow, and in instructions: `cargo run --release -p triad-lab --example costs`.
//!
//! The cost of a step by size, with its exponent; the time to assemble and the memory of the whole process with 2000
//! bodies; and, where valgrind is installed, instructions of whole runs: those of three runs less those of one, so that a
//! restart is in them and the assembly is not. `costs table n-four-bar:20 bodies,reactions,errors,text 1001 1` computes the rows of a
//! table, and writes them as text where that word ends the columns, to be looked at with valgrind.

use std::env;
use std::process::Command;
use std::time::{Duration, Instant};
use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::run::{Outputs, RowWriter, Simulation, append_row};
use triad_engine::scene::Scene;
use triad_lab::sweep::{SweepPlan, Unwatched, Values, Variation, sweep};

/// Scenes of growing size, with their numbers of bodies or windows.
const FAMILIES: [(&str, [usize; 5]); 2] =
    [("spatial-chain", [10, 50, 200, 1000, 2000]), ("n-four-bar", [10, 40, 100, 400, 1000])];
/// Each size is measured for so long in each round.
const MEASURED_TIME: Duration = Duration::from_millis(300);
/// Repetitions of which the median is told.
const ROUNDS: usize = 7;
/// Steps of one measurement: as many as a run surely has.
const STEPS: u32 = 20;
/// Scenes whose memory and assembly are measured.
const LARGE: [&str; 3] = ["spatial-chain:2000", "n-four-bar:666", "n-four-bar:1000"];
/// Scenes and tolerances of the runs whose instructions are counted.
const RUNS: [(&str, [f64; 2]); 8] = [
    ("simple-pendulum", [1e-7, 1e-10]),
    ("n-four-bar:2", [1e-7, 1e-10]),
    ("n-four-bar:40", [1e-7, 1e-10]),
    ("bricard", [1e-7, 1e-10]),
    ("spatial-slider-crank", [1e-8, 1e-10]),
    ("heavy-top", [1e-7, 1e-10]),
    ("spatial-chain:10", [1e-7, 1e-10]),
    ("spatial-chain:100", [1e-7, 1e-10]),
];
/// Scenes whose starts and sweeps are counted.
const STARTS: [&str; 4] = ["simple-pendulum", "n-four-bar:2", "n-four-bar:33", "spatial-chain:100"];
/// Steps that a start is compared with.
const STEPS_OF_A_START: usize = 10;

fn main() -> Result<(), EngineError> {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        // What the process starts itself for.
        ["run", name, tolerance, repeats] => run(name, tolerance, repeats, true),
        ["run-without-estimate", name, tolerance, repeats] => run(name, tolerance, repeats, false),
        ["hold", name] => hold(name),
        ["start", name, repeats] => start(name, repeats),
        ["first", name, repeats] => first(name, repeats),
        ["table", name, columns, rows, repeats] => table(name, columns, rows, repeats),
        ["sweep", name, runs] => sweep_of(name, runs, true),
        ["sweep-without-estimate", name, runs] => sweep_of(name, runs, false),
        _ => {
            growth()?;
            large()?;
            instructions();
            starts();
            Ok(())
        }
    }
}

/// A scene of the catalogue, or of a file.
fn scene(name: &str) -> Result<Scene, EngineError> {
    match std::fs::read_to_string(name) {
        Ok(text) => Ok(Scene::from_json(&text)?),
        Err(_) => Ok(catalogue::scene(name)?),
    }
}

/// Time of a step, s: the median of rounds over all sizes in turns.
fn growth() -> Result<(), EngineError> {
    println!("| scene | bodies | µs a step | µs a step and body | exponent from the first |");
    println!("|---|---|---|---|---|");
    for (family, sizes) in FAMILIES {
        let mut runs = Vec::new();
        for size in sizes {
            runs.push((Simulation::new(&scene(&format!("{family}:{size}"))?)?, Vec::new()));
        }
        for _ in 0..ROUNDS {
            for (run, times) in &mut runs {
                times.push(step(run)?);
            }
        }
        let mut first = None;
        for ((run, mut times), size) in runs.into_iter().zip(sizes) {
            times.sort_by(f64::total_cmp);
            let (time, bodies) = (times[ROUNDS / 2] * 1e6, run.system().bodies.len() as f64);
            let (time_of_first, size_of_first) = *first.get_or_insert((time, bodies));
            let exponent = libm::log(time / time_of_first) / libm::log(bodies / size_of_first);
            println!(
                "| {family}:{size} | {bodies} | {time:.1} | {:.3} | {} |",
                time / bodies,
                if exponent.is_nan() { "–".to_owned() } else { format!("{exponent:.3}") }
            );
        }
    }
    Ok(())
}

/// Mean time of the first steps of a run, repeated for a while, s.
fn step(run: &mut Simulation) -> Result<f64, EngineError> {
    let (began, mut spent, mut steps) = (Instant::now(), Duration::ZERO, 0);
    while began.elapsed() < MEASURED_TIME {
        run.reset();
        let began = Instant::now();
        for _ in 0..STEPS {
            run.step()?;
        }
        spent += began.elapsed();
        steps += STEPS;
    }
    Ok(spent.as_secs_f64() / f64::from(steps))
}

/// Time to assemble large mechanisms, and the memory of a process that holds one.
fn large() -> Result<(), EngineError> {
    println!(
        "\n| scene | bodies | assembled in, ms (least of {ROUNDS}) | memory of the process, MB |\n|---|---|---|---|"
    );
    for name in LARGE {
        let scene = scene(name)?;
        let (mut least, mut bodies) = (f64::INFINITY, 0);
        for _ in 0..ROUNDS {
            let began = Instant::now();
            bodies = Simulation::new(&scene)?.system().bodies.len();
            least = least.min(began.elapsed().as_secs_f64());
        }
        let memory = own(&["hold", name]).and_then(|mut own| own.output().ok());
        let memory =
            memory.and_then(|output| String::from_utf8(output.stdout).ok()?.trim().parse::<f64>().ok());
        let memory =
            memory.map_or_else(|| "not measured".to_owned(), |kilobytes| format!("{:.1}", kilobytes / 1e3));
        println!("| {name} | {bodies} | {:.1} | {memory} |", 1e3 * least);
    }
    Ok(())
}

/// Assembles a mechanism, takes some steps, and prints the most memory that the process has had, kB.
fn hold(name: &str) -> Result<(), EngineError> {
    let mut run = Simulation::new(&scene(name)?)?;
    step(&mut run)?;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    println!("{}", line.and_then(|line| line.split_whitespace().next()).unwrap_or("unknown"));
    Ok(())
}

/// Instructions of whole runs at two tolerances, in millions.
fn instructions() {
    println!("\n| scene | instructions of a run, millions | at tolerances |\n|---|---|---|");
    for (name, tolerances) in RUNS {
        let counts = tolerances.map(|tolerance| {
            let count = |repeats: &str| counted(&["run", name, &tolerance.to_string(), repeats]);
            Some((count("3")? - count("1")?) / 2.0)
        });
        let [Some(loose), Some(tight)] = counts else {
            println!("Instructions are not counted: is valgrind installed?");
            return;
        };
        println!(
            "| {name} | {:.2} / {:.2} | {:e} / {:e} |",
            loose / 1e6,
            tight / 1e6,
            tolerances[0],
            tolerances[1]
        );
    }
}

/// Runs a scene from beginning to end, so many times.
fn run(name: &str, tolerance: &str, repeats: &str, estimate: bool) -> Result<(), EngineError> {
    let mut scene = scene(name)?;
    scene.simulation.error_estimate = estimate;
    scene.simulation.tolerance = tolerance.parse().unwrap_or(scene.simulation.tolerance);
    let mut run = Simulation::new(&scene)?;
    for _ in 0..repeats.parse().unwrap_or(1) {
        run.reset();
        run.advance_to(scene.simulation.duration)?;
    }
    Ok(())
}

/// Instructions of a start, of its first steps, and of a run of a sweep.
fn starts() {
    println!(
        "\n| scene | instructions, millions: read and start | first {STEPS_OF_A_START} steps | a run of a sweep | without estimate |"
    );
    println!("|---|---|---|---|---|");
    for name in STARTS {
        let count = |what: &str, fewer: f64, more: f64| {
            let count = |repeats: f64| counted(&[what, name, &repeats.to_string()]);
            Some((count(more)? - count(fewer)?) / (more - fewer) / 1e6)
        };
        let [Some(start), Some(first), Some(run), Some(bare)] = [
            count("start", 1.0, 3.0),
            count("first", 1.0, 3.0),
            count("sweep", 5.0, 15.0),
            count("sweep-without-estimate", 5.0, 15.0),
        ] else {
            println!("Instructions are not counted: is valgrind installed?");
            return;
        };
        println!("| {name} | {start:.2} | {first:.2} | {run:.3} | {bare:.3} |");
    }
}

/// Reads a scene as text, checks, assembles and starts it, so many times.
fn start(name: &str, repeats: &str) -> Result<(), EngineError> {
    let written = scene(name)?.to_json();
    for _ in 0..repeats.parse().unwrap_or(1) {
        Simulation::new(&Scene::from_json(&written)?)?;
    }
    Ok(())
}

/// Takes the first steps of a run, so many times.
fn first(name: &str, repeats: &str) -> Result<(), EngineError> {
    let mut run = Simulation::new(&scene(name)?)?;
    for _ in 0..repeats.parse().unwrap_or(1) {
        run.reset();
        for _ in 0..STEPS_OF_A_START {
            run.step()?;
        }
    }
    Ok(())
}

/// Runs a scene from beginning to end with so many rows of these columns, so many times.
fn table(name: &str, columns: &str, rows: &str, repeats: &str) -> Result<(), EngineError> {
    let mut scene = scene(name)?;
    let (columns, as_text) =
        columns.strip_suffix(",text").map_or((columns, false), |columns| (columns, true));
    scene.simulation.outputs = columns.split(',').filter_map(|word| word.parse().ok()).collect();
    let mut run = Simulation::new(&scene)?;
    let outputs = Outputs::new(&run);
    let mut writer = RowWriter::new(&run, &outputs);
    let rows: u32 = rows.parse().unwrap_or(1);
    let (mut row, mut text) = (Vec::new(), Vec::new());
    for _ in 0..repeats.parse().unwrap_or(1) {
        run.reset();
        for k in 0..rows {
            run.advance_to(scene.simulation.duration * f64::from(k) / f64::from(rows - 1))?;
            row.clear();
            writer.write(&outputs.moment(&run), &mut row);
            if as_text {
                text.clear();
                append_row(&mut text, &row);
            }
        }
    }
    Ok(())
}

/// A sweep of so many runs over the acceleration of gravity, on one thread.
fn sweep_of(name: &str, runs: &str, estimate: bool) -> Result<(), EngineError> {
    let mut scene = scene(name)?.tolerance(1e-6);
    scene.simulation.error_estimate = estimate;
    let count = runs.parse().unwrap_or(1);
    let gravity = Variation::new(&scene, "/gravity/1", Values::Grid { from: -9.9, to: -9.7, count })?;
    let plan = SweepPlan { varied: vec![gravity], ..SweepPlan::new(scene) };
    match sweep(&plan, 1, &Unwatched) {
        Ok(found) => println!("{} runs", found.runs.len()),
        Err(error) => println!("{error}"),
    }
    Ok(())
}

/// This program, started anew.
fn own(words: &[&str]) -> Option<Command> {
    let mut own = Command::new(env::current_exe().ok()?);
    own.args(words);
    Some(own)
}

/// Instructions of this program with such words, if valgrind can count them.
fn counted(words: &[&str]) -> Option<f64> {
    let mut valgrind = Command::new("valgrind");
    valgrind
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe().ok()?)
        .args(words);
    let report = String::from_utf8(valgrind.output().ok()?.stderr).ok()?;
    let (_, count) = report.rsplit_once("Collected : ")?;
    count.split_whitespace().next()?.parse().ok()
}
