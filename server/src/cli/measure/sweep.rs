//! `triad sweep`: many runs of one scene with varied numbers.

mod table;
mod vary;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use axum::http::StatusCode;
use clap::Args;
use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Output, Scene};
use triad_lab::sweep::{Reached, Sweep, SweepError, SweepPlan, SweepRun, Variation, Watch, svg, sweep};

use crate::cli::choice;
use crate::cli::clock::Clock;
use crate::cli::interrupt::Interrupt;
use crate::cli::output::{Form, apart, is_standard, make_room, write};
use crate::cli::scene::run::{LEAVE_OUT, as_asked};
use crate::cli::table::TableKind;
use crate::cli::terminal::{Outcome, TimeBar, counted, print_json, print_line, progress};
use crate::problem::Problem;
use crate::scenes;
use crate::table::with_errors;

/// Columns that are summed up on the terminal; the table has all of them.
const SHOWN: usize = 12;
/// Failed runs that are told on the terminal; for machines all of them are.
const TOLD: usize = 5;

#[derive(Debug, Args)]
pub(in crate::cli) struct Options {
    /// A built-in scene's name (`triad scenes` lists them), or a file.
    scene: String,
    /// A number that varies, and its values: FROM:TO:COUNT for a grid, uniform:FROM:TO or normal:MEAN:DEVIATION for
    /// numbers drawn at random. NAME is a parameter of the scene, all of whose places follow it, or a JSON pointer like
    /// /bodies/0/mass, which changes that place alone; the ranges of parameters are for the page and bind no run. May be
    /// given more than once: grids are crossed.
    #[arg(long, value_name = "NAME=VALUES", required = true)]
    vary: Vec<String>,
    /// Runs with numbers drawn at random, at each point of the grids.
    #[arg(long, value_name = "N", default_value_t = 1)]
    samples: usize,
    /// Where the drawn numbers come from: the same seed gives the same runs.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Threads; 0 takes one for each core. The results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// End of each run in seconds, instead of the scene's.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    until: Option<f64>,
    /// Tolerance of the integrator, instead of the scene's.
    #[arg(long, value_name = "TOL", allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Integrator, instead of the scene's.
    #[arg(long, value_name = "NAME", value_parser = choice::integrator)]
    integrator: Option<IntegratorKind>,
    /// Carry no estimate of the error along, which takes a third of the time: doubts that follow from it are then missing.
    #[arg(long)]
    no_estimate: bool,
    /// What is told of each run at its end, instead of the scene's choice; see `triad run --help`. Estimated errors stand
    /// beside it, unless --no-estimate leaves them out.
    #[arg(long, value_name = "WORD,…", value_delimiter = ',', value_parser = choice::output)]
    outputs: Vec<Output>,
    /// Write all runs: CSV (`-` for standard output), or Arrow (Feather) if the file ends in .arrow or .feather.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Draw an output over the first varied number, as SVG.
    #[arg(long, value_name = "FILE.svg")]
    svg: Option<PathBuf>,
    /// The output that is drawn, by the name of its column; without it the first.
    #[arg(long, value_name = "COLUMN", requires = "svg")]
    draw: Option<String>,
}

/// Shows how far a sweep is, and ends it with Ctrl-C.
struct Watcher {
    interrupt: Interrupt,
    done: AtomicUsize,
    bar: TimeBar,
}

impl Watch for Watcher {
    fn done(&self) {
        self.bar.reached((self.done.fetch_add(1, Ordering::Relaxed) + 1) as f64);
    }

    fn cancelled(&self) -> bool {
        self.interrupt.asked()
    }
}

impl From<SweepError> for Problem {
    fn from(error: SweepError) -> Self {
        let (code, hint) = match error {
            SweepError::Engine(error) => return error.into(),
            SweepError::Count { .. } => ("sweep-size", "give grids fewer points, and --samples at least 1"),
            SweepError::Twice { .. } => ("varied-twice", "leave one of the two --vary out"),
            SweepError::Undrawn { .. } => (
                "nothing-drawn",
                "leave --samples out, or vary a number by uniform:FROM:TO or normal:MEAN:DEVIATION",
            ),
            SweepError::Threads { .. } => ("threads", "give fewer --threads, or leave it out"),
        };
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, code, error.to_string(), hint)
    }
}

/// Runs all, and tells what came out; what was done before Ctrl-C is kept.
pub(in crate::cli) fn run(options: &Options, json: bool) -> Result<Outcome, Problem> {
    let mut clock = Clock::start();
    let scene = Some(Path::new(&options.scene)).filter(|path| path.is_file());
    let files = [
        ("the scene", scene, Form::Read),
        ("--out", options.out.as_deref(), Form::Text),
        ("--svg", options.svg.as_deref(), Form::Text),
    ];
    apart(&files, json)?;
    let kind = options.out.as_deref().map_or(Ok(TableKind::Csv), TableKind::of)?;
    let plan = plan(options)?;
    let count = plan.count()?;
    let mut notes = replaced(options, &plan.scene)?;
    let drawn = drawn(options, &plan)?;
    for file in [&options.out, &options.svg].into_iter().flatten() {
        make_room(file)?;
    }
    clock.lap("read");
    let bar = progress(&plan.scene.name, count as f64, json);
    let watcher = Watcher { interrupt: Interrupt::listen(), done: AtomicUsize::new(0), bar };
    let found = sweep(&plan, options.threads, &watcher)?;
    drop(watcher);
    notes.extend(found.note.map(str::to_owned));
    let of_runs = found.notes().into_iter().filter(|(note, ..)| !notes.iter().any(|known| known == note));
    let of_runs: Vec<String> = of_runs.map(of_run).collect();
    notes.extend(of_runs);
    clock.lap("run");
    let written = written(options, kind, &plan.scene, &found, drawn)?;
    if written.len() < [&options.out, &options.svg].into_iter().flatten().count() {
        notes.push("no picture is written, as no run came to a number that it could show".to_owned());
    }
    clock.lap("write");
    let left = count - found.runs.len();
    if json {
        print_json(&json!({
            "scene": plan.scene.name,
            "varied": found.varied,
            "seed": plan.seed,
            "columns": found.columns.iter().map(|c| json!({"name": c.name, "unit": c.unit})).collect::<Vec<_>>(),
            "runs": found.runs.iter().map(told).collect::<Vec<_>>(),
            "cancelled": left,
            "notes": notes,
            "seconds": clock,
        }));
    } else {
        print(&plan.scene, &found, left);
        for note in &notes {
            print_line(&format!("  note                   {note}"));
        }
        print_line(&clock.line());
        for file in written.into_iter().filter(|file| !is_standard(file)) {
            print_line(&format!("  written                {}", file.display()));
        }
    }
    Ok(if left == 0 && found.runs.iter().all(|run| run.result.is_ok()) { Outcome::Done } else { Outcome::No })
}

/// Writes what is asked for, and tells which files there are now: a picture that would be empty is none.
fn written<'a>(
    options: &'a Options,
    kind: TableKind,
    scene: &Scene,
    found: &Sweep,
    drawn: usize,
) -> Result<Vec<&'a Path>, Problem> {
    let mut written = Vec::new();
    if let Some(path) = options.out.as_deref() {
        table::write(path, kind, &scene.name, found)?;
        written.push(path);
    }
    if let Some(path) = options.svg.as_deref()
        && let Some(picture) = svg(found, drawn)
    {
        write(path, picture)?;
        written.push(path);
    }
    Ok(written)
}

/// What was told of a run, and of others likewise.
fn of_run((note, run, runs): (&str, usize, usize)) -> String {
    let likewise =
        if runs > 1 { format!(" (the like of {} more)", counted(runs - 1, "run")) } else { String::new() };
    format!("run {run}: {note}{likewise}")
}

fn plan(options: &Options) -> Result<SweepPlan, Problem> {
    let mut scene = scenes::named_or_in_file(&options.scene)?;
    let settings = &mut scene.simulation;
    settings.duration = options.until.unwrap_or(settings.duration);
    settings.tolerance = options.tolerance.unwrap_or(settings.tolerance);
    settings.integrator = options.integrator.unwrap_or(settings.integrator);
    settings.error_estimate &= !options.no_estimate;
    let asked = !options.outputs.is_empty();
    if asked {
        settings.outputs.clone_from(&options.outputs);
    }
    with_errors(settings, asked, LEAVE_OUT)?;
    let read = |text: &String| vary::variation(&scene, text);
    let varied: Vec<_> = options.vary.iter().map(read).collect::<Result<_, _>>()?;
    given_once("--until", options.until, "/simulation/duration", &varied)?;
    given_once("--tolerance", options.tolerance, "/simulation/tolerance", &varied)?;
    Ok(SweepPlan { varied, samples: options.samples, seed: options.seed, ..SweepPlan::with_errors(scene) })
}

/// Refuses an option whose number is varied too: it would be replaced in every run.
fn given_once(option: &str, given: Option<f64>, pointer: &str, varied: &[Variation]) -> Result<(), Problem> {
    let twice = varied.iter().find(|variation| given.is_some() && variation.varies(pointer));
    twice.map_or(Ok(()), |variation| {
        Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "varied-twice",
            format!("{option} sets {pointer}, which is varied by {}", variation.name),
            format!("leave {option} or that --vary out"),
        ))
    })
}

/// Refuses to run by another integrator than the one that the command line asks for; tells of one that the scene asks for. A scene
/// that is none before its numbers are varied is judged run by run.
fn replaced(options: &Options, scene: &Scene) -> Result<Vec<String>, Problem> {
    let Ok(simulation) = Simulation::new(scene) else { return Ok(Vec::new()) };
    if options.integrator.is_some() {
        as_asked(&simulation)?;
    }
    Ok(simulation.notes().iter().filter(|note| note.starts_with("runs by ")).cloned().collect())
}

/// The column that is drawn: asked before anything runs, which may take hours.
fn drawn(options: &Options, plan: &SweepPlan) -> Result<usize, Problem> {
    let Some(name) = &options.draw else { return Ok(0) };
    let columns = plan.columns()?;
    columns.iter().position(|column| column.name == *name).ok_or_else(|| {
        let names = columns.iter().map(|column| column.name.as_str());
        Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "unknown-column",
            format!("no output is called {name}"),
            crate::problem::suggest(name, names),
        )
    })
}

/// One run, for machines.
fn told(run: &SweepRun) -> Value {
    let mut told = json!({ "run": run.index, "values": run.values });
    match &run.result {
        Ok(end) => {
            told["time"] = json!(end.time);
            if let Some(error) = end.time_error {
                told["time_error"] = json!(error);
            }
            told["outputs"] = json!(end.outputs);
            told["evaluations"] = json!(end.evaluations);
            told["doubts"] = json!(end.doubts);
        }
        Err(error) => {
            told["stopped"] =
                json!({ "code": error.code(), "detail": error.to_string(), "hint": error.hint() });
        }
    }
    told
}

/// What came out, for people.
fn print(scene: &Scene, found: &Sweep, left: usize) {
    let reached: Vec<_> = found.runs.iter().filter_map(|run| run.result.as_ref().ok()).collect();
    let cancelled = if left > 0 { format!(", {left} cancelled") } else { String::new() };
    let failed = found.runs.len() - reached.len();
    print_line(&format!(
        "{}: {} of {}, {failed} failed{cancelled}",
        scene.name,
        reached.len(),
        counted(found.runs.len() + left, "run")
    ));
    let doubted = reached.iter().filter(|end| end.doubts > 0).count();
    if doubted > 0 {
        print_line(&format!(
            "  doubt                  {} with doubts; `triad run` tells them",
            counted(doubted, "run")
        ));
    }
    if let Some(line) = errors(found) {
        print_line(&line);
    }
    if !reached.is_empty() {
        print_columns(found, &reached);
    }
    let failures = found.runs.iter().filter_map(|run| Some((run, run.result.as_ref().err()?)));
    for (run, error) in failures.take(TOLD) {
        print_line(&format!("  run {} with {:?}: {error}", run.index, run.values));
    }
    if failed > TOLD {
        print_line(&format!("  … and {}; --json tells all", counted(failed - TOLD, "more failed run")));
    }
}

/// The greatest errors of all runs; none where they are not estimated.
fn errors(found: &Sweep) -> Option<String> {
    let of = |name: &str| {
        let index = found.columns.iter().position(|column| column.name == name)?;
        let reached = found.runs.iter().filter_map(|run| run.result.as_ref().ok());
        Some(reached.filter_map(|end| end.outputs.get(index).copied()).collect::<Vec<f64>>())
    };
    let positions = of("position_error")?;
    let unknown = positions.iter().filter(|error| error.is_nan()).count();
    if unknown == positions.len() {
        return (unknown > 0)
            .then(|| format!("  error                  unknown of {}", counted(unknown, "run")));
    }
    let greatest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
    let mut line =
        format!("  error                  positions right to about {:.0e} m", greatest(&positions));
    for (name, what, unit) in [
        ("turn_error", "directions", "rad"),
        ("velocity_error", "velocities", "m/s"),
        ("angular_velocity_error", "angular velocities", "rad/s"),
        ("energy_error", "the energy", "J"),
        ("force_error", "forces", "N"),
        ("moment_error", "moments", "N m"),
    ] {
        if let Some(errors) = of(name) {
            let _ = write!(line, ", {what} to {:.0e} {unit}", greatest(&errors));
        }
    }
    let times = found.runs.iter().filter_map(|run| run.result.as_ref().ok()?.time_error);
    if let Some(greatest) = times.max_by(f64::total_cmp) {
        let _ = write!(
            line,
            " at a given time; events that stop runs to {greatest:.0e} s, and outputs at them by what they change in that time besides"
        );
    }
    line.push_str(": the greatest of all runs");
    if unknown > 0 {
        let _ = write!(line, "; unknown of {}", counted(unknown, "run"));
    }
    Some(line)
}

/// The first columns over all runs; errors have a line of their own.
fn print_columns(found: &Sweep, reached: &[&Reached]) {
    print_line(&format!(
        "  {:<28}{:>15}{:>15}{:>15}{:>15}",
        "at the end", "least", "mean", "greatest", "deviation"
    ));
    let columns = found.columns.iter().enumerate().filter(|(_, column)| !column.name.ends_with("_error"));
    let count = columns.clone().count();
    for (index, column) in columns.take(SHOWN) {
        let values: Vec<f64> = reached.iter().filter_map(|end| end.outputs.get(index).copied()).collect();
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0).max(1.0);
        let (least, greatest) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        if !values.is_empty() {
            let name = format!("{}, {}", column.name, column.unit);
            print_line(&format!(
                "  {name:<28}{least:>15.6e}{mean:>15.6e}{greatest:>15.6e}{:>15.6e}",
                square.sqrt()
            ));
        }
    }
    if count > SHOWN {
        print_line(&format!("  … and {} more; --out writes all", counted(count - SHOWN, "column")));
    }
}
