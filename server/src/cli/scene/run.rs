//! `triad run`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use axum::http::StatusCode;
use triad_engine::EngineError;
use triad_engine::model::Model;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, OutputTimes, Scene, Skip};
use triad_lab::film::Film;
use triad_lab::verify::Verifier;
use triad_session::picture::{Sample, describe, sample};

use super::options::Run;
use super::report::{Found, report};
use super::table::Table;
use crate::cli::clock::Clock;
use crate::cli::interrupt::Interrupt;
use crate::cli::output::{apart, make_room, unwritable, write};
use crate::cli::table::TableKind;
use crate::cli::terminal::{Outcome, TimeBar, progress};
use crate::motion::Film as RecordedFilm;
use crate::page::playing;
use crate::problem::Problem;
use crate::stream::{RecordError, Recorder};
use crate::table::with_errors;

/// Samples that are encoded together.
const BATCH: usize = 256;
/// What lets errors be written.
pub(in crate::cli) const LEAVE_OUT: &str = "leave --no-estimate out (and \"error_estimate\": false in the scene), or errors out of \
                                            --outputs (and of \"outputs\" there)";
/// A turn between two pictures, rad, from which on a straight line between them is no longer like the motion.
const COARSE: f64 = 0.8;
/// Rows that a table or recording may have.
const MAX_OUTPUTS: f64 = 1e7;

/// Runs a scene to its end.
pub(in crate::cli) fn run(options: &Run, json: bool) -> Result<Outcome, Problem> {
    let mut clock = Clock::start();
    apart(&options.files(), json)?;
    let scene = scene(options)?;
    clock.lap("read");
    let model = Model::new(&scene).map_err(EngineError::from)?;
    clock.lap("check");
    let mut simulation = Simulation::from_model(model)?;
    clock.lap("assemble");
    if options.integrator.is_some() || options.treatment.is_some() || options.step.is_some() {
        as_asked(&simulation)?;
    }
    if let Some(steps) = options.most_steps {
        simulation.set_step_limit(steps);
    }
    let mut verifier = options.verify.then(|| Verifier::new(&scene, &simulation)).transpose()?;
    let mut outputs = Outputs::open(options, &scene, &simulation)?;
    let bar = progress(&scene.name, simulation.duration(), json);
    let bounds = Bounds::new(options);
    clock.lap("open outputs");
    let course = Course { times: scene.simulation.output_times(), bounds: &bounds, bar: &bar };
    let stopped = advance(&mut simulation, verifier.as_mut(), &mut outputs, &course, &mut clock);
    drop(bar);
    // What was reached before an error is kept.
    let pictured = outputs.finish()?;
    clock.lap("write");
    let stopped = match stopped {
        Ok(()) => None,
        Err(Stop::Engine(problem)) => Some(problem),
        Err(Stop::Output(problem)) => return Err(problem),
    };
    let verified = verifier.as_ref().map(Verifier::found);
    let found = Found { stopped: stopped.as_ref(), verified, pictured: &pictured, clock: &clock };
    report(&scene, &simulation, options, &found, json);
    Ok(if stopped.is_none() { Outcome::Done } else { Outcome::No })
}

fn scene(options: &Run) -> Result<Scene, Problem> {
    let mut scene = options.source.read()?;
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
    simulation.error_estimate &= !options.no_estimate;
    let asked = !options.outputs.is_empty();
    if asked {
        simulation.outputs.clone_from(&options.outputs);
    }
    if asked || options.out.is_some() {
        with_errors(simulation, asked, LEAVE_OUT)?;
    }
    let outputs = simulation.output_times().intervals();
    if options.writes() && outputs > MAX_OUTPUTS {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "too-many-outputs",
            format!("{} s in steps of {} s make {outputs:.0} outputs", simulation.duration, simulation.every),
            "give a larger --every, or a smaller --until",
        ));
    }
    Ok(scene)
}

/// Refuses to run by another integrator than the one that was asked for.
pub(in crate::cli) fn as_asked(simulation: &Simulation) -> Result<(), Problem> {
    let asked = simulation.model().settings.integrator;
    let summary = simulation.summary();
    if asked == IntegratorKind::Auto || asked == summary.integrator {
        return Ok(());
    }
    Err(Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "choices-conflict",
        format!("{} would run by {}: {}", simulation.model().name, summary.integrator, summary.reason),
        format!(
            "leave one of the choices out, or give --integrator auto or --integrator {} to agree",
            summary.integrator
        ),
    ))
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

/// How a run goes on.
struct Course<'a> {
    /// When something is written.
    times: OutputTimes,
    bounds: &'a Bounds,
    bar: &'a TimeBar,
}

fn advance(
    simulation: &mut Simulation,
    mut verifier: Option<&mut Verifier>,
    outputs: &mut Outputs,
    &Course { times, bounds, bar }: &Course,
    clock: &mut Clock,
) -> Result<(), Stop> {
    outputs.write(simulation).map_err(Stop::Output)?;
    clock.lap("write");
    let mut index = 0;
    while !simulation.finished() {
        index += 1;
        let time = times.at(index);
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
        clock.lap("integrate");
        if let Some(verifier) = verifier.as_deref_mut() {
            while !verifier.compare(simulation, PIECE) {
                bounds.reached(simulation.time())?;
            }
            clock.lap("verify");
        }
        outputs.write(simulation).map_err(Stop::Output)?;
        clock.lap("write");
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

/// A recording, and the viewer's address if it does not go into a file.
struct Recording {
    recorder: Recorder,
    viewer: Option<String>,
}

impl Recording {
    fn failed(&self, error: &RecordError) -> Problem {
        self.viewer.as_ref().map_or_else(|| output_failed(error), |url| no_viewer(url, error))
    }
}

/// Where a run goes.
struct Outputs {
    table: Option<Table>,
    recorders: Vec<Recording>,
    waiting: Vec<Sample>,
    film: Option<(PathBuf, Film)>,
    /// A page that plays, and what it will show.
    page: Option<(PathBuf, RecordedFilm)>,
    /// Whether not all reactions are unique.
    shared: bool,
    notes: Vec<String>,
}

impl Outputs {
    fn open(options: &Run, scene: &Scene, simulation: &Simulation) -> Result<Self, Problem> {
        let mut table = None;
        if let Some(path) = &options.out {
            let kind = TableKind::of(path)?;
            make_room(path)?;
            table = Some(Table::create(path, kind, simulation)?);
        }
        let shared = simulation.is_redundant();
        let recorded = [options.rrd.as_ref().map(|path| path.display().to_string()), options.rerun.clone()];
        let notes = recorded.into_iter().flatten().filter(|_| shared).map(|of| shared_note(&of)).collect();
        let mut recorders = Vec::new();
        let id = uuid::Uuid::new_v4().simple().to_string();
        if let Some(path) = &options.rrd {
            make_room(path)?;
            let recorder = Recorder::to_file(path, &id, describe(scene, simulation));
            let recorder = recorder.map_err(|error| unwritable(path, &error))?;
            recorders.push(Recording { recorder, viewer: None });
        }
        if let Some(url) = &options.rerun {
            let recorder = Recorder::to_viewer(url, &id, describe(scene, simulation));
            let recorder = recorder.map_err(|error| no_viewer(url, &error))?;
            recorders.push(Recording { recorder, viewer: Some(url.clone()) });
        }
        let film = match &options.svg {
            None => None,
            Some(path) => {
                make_room(path)?;
                Some((path.clone(), Film::new(scene, simulation.model())))
            }
        };
        let mut page = None;
        if let Some(path) = &options.html {
            make_room(path)?;
            page = Some((path.clone(), RecordedFilm::new(scene, simulation)));
        }
        Ok(Self { table, recorders, waiting: Vec::new(), film, page, shared, notes })
    }

    fn write(&mut self, simulation: &Simulation) -> Result<(), Problem> {
        if let Some(table) = &mut self.table {
            table.row(simulation).map_err(|error| output_failed(&error))?;
        }
        if let Some((_, film)) = &mut self.film {
            film.push(simulation.frame());
        }
        if let Some((_, film)) = &mut self.page {
            film.take(simulation);
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
        for recording in &mut self.recorders {
            let written = recording.recorder.write(&self.waiting);
            written.map_err(|error| recording.failed(&error))?;
        }
        self.waiting.clear();
        Ok(())
    }

    /// Writes what is still held back, and says what pictures do not show.
    fn finish(&mut self) -> Result<Vec<String>, Problem> {
        self.encode()?;
        let mut notes = std::mem::take(&mut self.notes);
        if let Some((path, film)) = self.page.take() {
            let forces = film.tells_forces();
            let (motion, coarse) = film.developed();
            notes.extend(coarse_note(&path, coarse));
            if forces && motion.joints.is_empty() {
                notes.push(format!("{} has no room for the forces of so many joints", path.display()));
            } else if forces && self.shared {
                notes.push(shared_note(&path.display().to_string()));
            }
            write(&path, playing(&motion)?)?;
        }
        for recording in &self.recorders {
            recording.recorder.flush().map_err(|error| recording.failed(&error))?;
        }
        if let Some((path, film)) = &self.film {
            notes.extend(coarse_note(path, film.coarseness()));
            write(path, film.svg(true))?;
        }
        if let Some(table) = self.table.take() {
            table.finish().map_err(|error| output_failed(&error))?;
        }
        Ok(notes)
    }
}

/// That not all forces of a picture are unique.
fn shared_note(picture: &str) -> String {
    format!(
        "{picture}: not all forces that it shows are unique, as rows of this mechanism depend on each other; triad reactions tells \
         which are"
    )
}

/// That the way from one picture to the next is more than a straight line shows.
fn coarse_note(path: &Path, (pictures, turn): (usize, f64)) -> Option<String> {
    (turn > COARSE).then(|| {
        format!(
            "{}: bodies turn by up to {:.0}° from one of its {pictures} pictures to the next, and it draws straight ways between them: \
             a shorter --until or --every shows how they move",
            path.display(),
            turn.to_degrees()
        )
    })
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
