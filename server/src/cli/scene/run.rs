//! `triad run`.

use std::time::Instant;

use axum::http::StatusCode;
use serde_json::json;
use triad_engine::EngineError;
use triad_engine::VERSION;
use triad_engine::run::{Simulation, SkippedItem, Summary};
use triad_engine::scene::{Scene, Skip};
use triad_lab::verify::{Verification, Verifier};

use super::csv::Table;
use super::options::Run;
use crate::cli::interrupt::Interrupt;
use crate::cli::output::{make_room, unwritable};
use crate::cli::terminal::{Outcome, TimeBar, print_json, print_line, progress};
use crate::problem::Problem;
use crate::scenes;
use crate::session::{describe, sample};
use crate::stream::{RecordError, Recorder, Sample};

/// Samples that are encoded together.
const BATCH: usize = 256;
/// Rows that a table or recording may have.
const MAX_OUTPUTS: f64 = 1e7;

/// Runs a scene to its end.
pub(in crate::cli) fn run(options: &Run, json: bool) -> Result<Outcome, Problem> {
    let scene = scene(options)?;
    let mut simulation = Simulation::new(&scene)?;
    if let Some(steps) = options.most_steps {
        simulation.set_step_limit(steps);
    }
    let mut verifier = options.verify.then(|| Verifier::new(&scene, &simulation)).transpose()?;
    let mut outputs = Outputs::open(options, &scene, &simulation)?;
    let bar = progress(&scene.name, simulation.duration(), json);
    let bounds = Bounds::new(options);
    let stopped =
        advance(&mut simulation, verifier.as_mut(), &mut outputs, scene.simulation.every, &bounds, &bar);
    drop(bar);
    // What was reached before an error is kept.
    outputs.finish()?;
    let stopped = match stopped {
        Ok(()) => None,
        Err(Stop::Engine(problem)) => Some(problem),
        Err(Stop::Output(problem)) => return Err(problem),
    };
    let verified = verifier.as_ref().map(Verifier::found);
    report(&scene, &simulation, options, (stopped.as_ref(), verified), json);
    Ok(if stopped.is_none() { Outcome::Done } else { Outcome::No })
}

fn scene(options: &Run) -> Result<Scene, Problem> {
    let mut scene = scenes::named_or_in_file(&options.scene)?;
    let simulation = &mut scene.simulation;
    simulation.duration = options.until.unwrap_or(simulation.duration);
    simulation.every = options.every.unwrap_or(simulation.every);
    simulation.tolerance = options.tolerance.unwrap_or(simulation.tolerance);
    for word in &options.no_skip {
        if word == "all" {
            simulation.skip = Skip::nothing();
        } else if let Some(on) = simulation.skip.word_mut(word) {
            *on = false;
        }
    }
    simulation.integrator = options.integrator.unwrap_or(simulation.integrator);
    simulation.constraint_method = options.treatment.unwrap_or(simulation.constraint_method);
    simulation.step = options.step.or(simulation.step);
    let writes = options.out.is_some() || options.rrd.is_some() || options.rerun.is_some();
    let outputs = simulation.duration / simulation.every;
    if writes && outputs > MAX_OUTPUTS {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "too-many-outputs",
            format!("{} s in steps of {} s make {outputs:.0} outputs", simulation.duration, simulation.every),
            "give a larger --every, or a smaller --until",
        ));
    }
    Ok(scene)
}

/// Why a run ended early.
enum Stop {
    /// The engine could not go on.
    Engine(Problem),
    /// An output could not be written.
    Output(Problem),
}

/// Integrator steps between two looks at the clock and at the keyboard.
const PIECE: u64 = 64;

/// What ends a run before its end.
struct Bounds {
    interrupt: Interrupt,
    started: Instant,
    seconds: Option<f64>,
}

impl Bounds {
    fn new(options: &Run) -> Self {
        Self { interrupt: Interrupt::listen(), started: Instant::now(), seconds: options.most_seconds }
    }

    /// Why the run must not go on, at time t.
    fn reached(&self, t: f64) -> Result<(), Stop> {
        let stop = |code, why: String| {
            let hint = "what was reached is kept; the same command without the bound goes to the end";
            Err(Stop::Engine(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, code, why, hint)))
        };
        if self.interrupt.asked() {
            return stop("cancelled", format!("the run was cancelled at t = {t:.6} s"));
        }
        match self.seconds {
            Some(seconds) if self.started.elapsed().as_secs_f64() > seconds => {
                stop("time-limit", format!("the run stops at t = {t:.6} s: its {seconds} s are used up"))
            }
            _ => Ok(()),
        }
    }
}

fn advance(
    simulation: &mut Simulation,
    mut verifier: Option<&mut Verifier>,
    outputs: &mut Outputs,
    every: f64,
    bounds: &Bounds,
    bar: &TimeBar,
) -> Result<(), Stop> {
    let engine = |error: EngineError| Stop::Engine(error.into());
    outputs.write(simulation).map_err(Stop::Output)?;
    let mut index = 0_u64;
    while !simulation.finished() {
        index += 1;
        let time = (index as f64 * every).min(simulation.duration());
        let written = simulation.time();
        if let Err(stop) = to(simulation, time, bounds) {
            // The last good state is an output too.
            let reached = simulation.reached();
            let lost = matches!(&stop, Stop::Engine(problem)
                if ["constraints-lost", "motion-impossible"].contains(&problem.code()));
            let shown = simulation.time() > written;
            if shown || (!lost && reached > written && simulation.advance_to(reached).is_ok()) {
                outputs.write(simulation).map_err(Stop::Output)?;
            }
            return Err(stop);
        }
        if let Some(verifier) = verifier.as_deref_mut() {
            while !verifier.compare(simulation, PIECE).map_err(engine)? {
                bounds.reached(simulation.time())?;
            }
        }
        outputs.write(simulation).map_err(Stop::Output)?;
        bar.reached(time);
    }
    Ok(())
}

/// Goes on to a time, in pieces.
fn to(simulation: &mut Simulation, time: f64, bounds: &Bounds) -> Result<(), Stop> {
    loop {
        bounds.reached(simulation.reached())?;
        if simulation.advance_towards(time, PIECE).map_err(|error| Stop::Engine(error.into()))? {
            return Ok(());
        }
    }
}

/// Where a run goes.
struct Outputs {
    table: Option<Table>,
    recorders: Vec<Recorder>,
    waiting: Vec<Sample>,
}

impl Outputs {
    fn open(options: &Run, scene: &Scene, simulation: &Simulation) -> Result<Self, Problem> {
        let mut table = None;
        if let Some(path) = &options.out {
            make_room(path)?;
            let joints = simulation.multipliers();
            let bodies: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
            let opened = Table::create(path, &scene.name, &bodies, &joints);
            table = Some(opened.map_err(|error| unwritable(path, &error))?);
        }
        let mut recorders = Vec::new();
        let id = uuid::Uuid::new_v4().simple().to_string();
        if let Some(path) = &options.rrd {
            make_room(path)?;
            let recorder = Recorder::to_file(path, &id, describe(scene, simulation));
            recorders.push(recorder.map_err(|error| unwritable(path, &error))?);
        }
        if let Some(url) = &options.rerun {
            let recorder = Recorder::to_viewer(url, &id, describe(scene, simulation));
            recorders.push(recorder.map_err(|error| no_viewer(url, &error))?);
        }
        Ok(Self { table, recorders, waiting: Vec::new() })
    }

    fn write(&mut self, simulation: &Simulation) -> Result<(), Problem> {
        if let Some(table) = &mut self.table {
            let frame = simulation.frame();
            let joints = simulation.multipliers();
            let summary = simulation.summary();
            table.row(&frame, &joints, &summary).map_err(|error| output_failed(&error))?;
        }
        if !self.recorders.is_empty() {
            self.waiting.push(sample(simulation));
            if self.waiting.len() >= BATCH {
                self.encode()?;
            }
        }
        Ok(())
    }

    fn encode(&mut self) -> Result<(), Problem> {
        for recorder in &mut self.recorders {
            recorder.write(&self.waiting).map_err(|error| output_failed(&error))?;
        }
        self.waiting.clear();
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Problem> {
        self.encode()?;
        for recorder in &self.recorders {
            recorder.flush().map_err(|error| output_failed(&error))?;
        }
        self.table.take().map_or(Ok(()), |table| table.finish().map_err(|error| output_failed(&error)))
    }
}

fn no_viewer(url: &str, error: &RecordError) -> Problem {
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "no-viewer",
        format!("no viewer can be reached at {url}: {error}"),
        "start the viewer with `rerun`, and give its address, like rerun+http://127.0.0.1:9876/proxy",
    )
}

fn output_failed(error: &impl std::fmt::Display) -> Problem {
    Problem::new(
        StatusCode::INTERNAL_SERVER_ERROR,
        "output-failed",
        format!("the output could not be written: {error}"),
        "check that the disk is not full",
    )
}

fn report(
    scene: &Scene,
    simulation: &Simulation,
    options: &Run,
    (stopped, verified): (Option<&Problem>, Option<&Verification>),
    json: bool,
) {
    let summary = simulation.summary();
    let left_out = options.explain.then(|| simulation.left_out());
    if json {
        print_json(&json!({
            "scene": scene.name,
            "settings": scene.simulation,
            "summary": summary,
            "events": simulation.events(),
            "notes": simulation.notes(),
            "left_out": left_out,
            "verified": verified,
            "repeat": { "engine": VERSION, "fingerprint": scene.fingerprint() },
            "stopped": stopped.map(Problem::document),
        }));
        return;
    }
    // A table on standard output must stay a table.
    let to_stderr = options.out.as_deref().is_some_and(|path| path.as_os_str() == "-");
    let say = |line: &str| if to_stderr { eprintln!("{line}") } else { print_line(line) };
    for line in lines(scene, &summary, verified, simulation.notes()) {
        say(&line);
    }
    for event in simulation.events() {
        let end = if event.stop { "; the run ends there" } else { "" };
        say(&format!(
            "  event                  {} at {:.15} s, rate {:.9}{end}",
            event.name, event.time, event.rate
        ));
    }
    for line in left_out.iter().flatten().map(explanation) {
        say(&line);
    }
    for file in [&options.out, &options.rrd].into_iter().flatten() {
        say(&format!("  written                {}", file.display()));
    }
    if let Some(problem) = stopped {
        eprintln!("{} {problem}", crate::cli::terminal::error_label());
    }
}

fn explanation(left: &SkippedItem) -> String {
    let switch = if left.on { "on " } else { "off" };
    format!("  left out: {:<10} {switch}  {}", left.word, left.what)
}

fn lines(scene: &Scene, s: &Summary, verified: Option<&Verification>, notes: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!("{}: {} s of {} s", scene.name, s.time, scene.simulation.duration),
        format!("  energy                 {:.9} J, drift {:.2e} J", s.energy, s.energy_drift),
        format!(
            "  constraint violation   {:.2e} position, {:.2e} velocity",
            s.position_violation, s.velocity_violation
        ),
        format!(
            "  steps                  {} accepted, {} rejected, last {:.3e} s",
            s.steps, s.rejected, s.step_size
        ),
        format!(
            "  work                   {} evaluations, {} factorizations, {} solves, {} projections",
            s.evaluations, s.factorizations, s.solves, s.projections
        ),
    ];
    lines.push(format!("  integrator             {}: {}", s.integrator, s.reason));
    if let Some((first, last)) = s.singularities.first().zip(s.singularities.last()) {
        let (count, joints) = (s.singularities.len(), first.joints.join(", "));
        let times = if count == 1 {
            format!("at {:.6} s", first.time)
        } else {
            format!("{count} times, first at {:.6} s, last at {:.6} s", first.time, last.time)
        };
        lines.push(format!("  singular positions     passed {times}, at {joints}"));
    }
    lines.extend(s.doubts.iter().map(|doubt| format!("  doubt                  {doubt}")));
    if let Some(v) = verified {
        let (by, tolerance) = (v.integrator, v.tolerance);
        lines.push(format!(
            "  error estimate         {:.2e} m, {:.2e} rad ({by} at {tolerance:.0e}, {} times compared)",
            v.position, v.turn, v.compared
        ));
        let bodies =
            v.bodies.iter().map(|b| format!("    {:<20} {:.2e} m, {:.2e} rad", b.body, b.position, b.turn));
        lines.extend(bodies);
    }
    lines.extend(notes.iter().map(|note| format!("  note                   {note}")));
    lines
}
