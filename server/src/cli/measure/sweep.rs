//! `triad sweep`: many runs of one scene with varied numbers.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use axum::http::StatusCode;
use clap::Args;
use serde_json::{Value, json};
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Output, Scene};
use triad_lab::csv::quoted;
use triad_lab::sweep::{
    Reached, Sweep, SweepError, SweepPlan, SweepRun, Values, Variation, Watch, svg, sweep,
};

use crate::cli::choice;
use crate::cli::clock::Clock;
use crate::cli::interrupt::Interrupt;
use crate::cli::output::{Form, apart, is_standard, make_room, write};
use crate::cli::scene::run::{LEAVE_OUT, as_asked};
use crate::cli::terminal::{Outcome, TimeBar, counted, print_json, print_line, progress};
use crate::problem::Problem;
use crate::scenes;
use crate::table::with_errors;

/// Columns that are summed up on the terminal; the table has all of them.
const SHOWN: usize = 12;
/// Failed runs that are told on the terminal; the table has all of them.
const TOLD: usize = 5;

#[derive(Debug, Args)]
pub(in crate::cli) struct Options {
    /// A built-in scene's name (`triad scenes` lists them), or a file.
    scene: String,
    /// A number that varies, and its values: FROM:TO:COUNT for a grid, uniform:FROM:TO or normal:MEAN:DEVIATION for
    /// numbers drawn at random. NAME is a parameter of the scene or a JSON pointer like /bodies/0/mass. May be given
    /// more than once: grids are crossed.
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
    /// Write all runs as CSV.
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
    if let Some(path) = &options.out {
        write(path, table(&found))?;
    }
    if let Some(path) = &options.svg {
        write(path, svg(&found, drawn))?;
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
        let files = [&options.out, &options.svg].into_iter().flatten();
        for file in files.filter(|file| !is_standard(file)) {
            print_line(&format!("  written                {}", file.display()));
        }
    }
    Ok(if left == 0 && found.runs.iter().all(|run| run.result.is_ok()) { Outcome::Done } else { Outcome::No })
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
    let varied: Vec<_> = options.vary.iter().map(|text| variation(&scene, text)).collect::<Result<_, _>>()?;
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

/// Reads `NAME=FROM:TO:COUNT`, `NAME=uniform:FROM:TO` or `NAME=normal:MEAN:DEVIATION`.
fn variation(scene: &Scene, text: &str) -> Result<Variation, Problem> {
    let read = || {
        let (name, values) = text.rsplit_once('=')?;
        let parts: Vec<&str> = values.split(':').collect();
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        let values = match parts[..] {
            ["uniform", from, to] => Values::Uniform { from: number(from)?, to: number(to)? },
            ["normal", mean, deviation] => {
                Values::Normal { mean: number(mean)?, deviation: number(deviation).filter(|x| *x >= 0.0)? }
            }
            [from, to, count] => {
                let count = count.trim().parse().ok().filter(|count| *count > 0)?;
                Values::Grid { from: number(from)?, to: number(to)?, count }
            }
            _ => return None,
        };
        Some((name, values))
    };
    let (name, values) = read().ok_or_else(|| {
        Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "vary-syntax",
            format!("--vary {text} is no name with values"),
            "write NAME=FROM:TO:COUNT, NAME=uniform:FROM:TO or NAME=normal:MEAN:DEVIATION, like /bodies/0/mass=1:2:11",
        )
    })?;
    Ok(Variation::new(scene, name, values).map_err(EngineError::from)?)
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

/// All runs as CSV: the varied numbers, the time at the end, with its error where an event chose it, the outputs there; of a failed run the
/// code of its error.
fn table(found: &Sweep) -> String {
    let timed = found.runs.iter().any(|run| run.result.as_ref().is_ok_and(|end| end.time_error.is_some()));
    let mut out = String::from("run");
    for name in &found.varied {
        let _ = write!(out, ",{}", quoted(name));
    }
    out.push_str(if timed { ",time,time_error" } else { ",time" });
    for column in &found.columns {
        let _ = write!(out, ",{}", quoted(&format!("{} [{}]", column.name, column.unit)));
    }
    out.push_str(",evaluations,doubts,stopped\n");
    let mut digits = zmij::Buffer::new();
    for run in &found.runs {
        let _ = write!(out, "{}", run.index);
        let mut number = |x: f64, out: &mut String| {
            out.push(',');
            out.push_str(digits.format(x));
        };
        run.values.iter().for_each(|x| number(*x, &mut out));
        match &run.result {
            Ok(end) => {
                number(end.time, &mut out);
                if timed {
                    number(end.time_error.unwrap_or(0.0), &mut out);
                }
                end.outputs.iter().for_each(|x| number(*x, &mut out));
                let _ = writeln!(out, ",{},{},", end.evaluations, end.doubts);
            }
            Err(error) => {
                let times = 1 + usize::from(timed);
                let _ = writeln!(out, "{},,,{}", ",".repeat(found.columns.len() + times), error.code());
            }
        }
    }
    out
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
    for run in found.runs.iter().filter(|run| run.result.is_err()).take(TOLD) {
        if let Err(error) = &run.result {
            print_line(&format!("  run {} with {:?}: {error}", run.index, run.values));
        }
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
