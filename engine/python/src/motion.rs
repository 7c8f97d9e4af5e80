//! A run and its numbers at all outputs.

mod reactions;
mod record;

use crate::arrays::{Numbers, shaped, vector};
use crate::refusal::Refusal;
use crate::scene::{self, Options};
use crate::watch::{LOOK, Watcher};
use pyo3::prelude::*;
use record::Record;
use serde_json::json;
use std::sync::Mutex;
use std::time::Instant;
use triad_engine::run::{Outputs, Simulation, Snapshot, StateView};
use triad_engine::scene::{OutputKind, OutputTimes, Scene};
use triad_lab::film::Film;
use triad_lab::verify::Verifier;

/// Rows that a run may have.
const MAX_OUTPUTS: f64 = 1e7;
/// Steps of the integrator between two looks at the clock.
const PIECE: u64 = 64;

/// A run that is over.
#[pyclass(frozen, module = "triad._native")]
pub struct Motion {
    scene: Scene,
    run: Simulation,
    snapshots: Vec<Snapshot>,
    outputs: Outputs,
    verified: Option<serde_json::Value>,
    /// Arrays that are handed over when they are asked for the first time.
    record: Mutex<Option<Record>>,
}

/// Runs a scene to its end. What was reached is returned also where the run could not go on, with the reason.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    kind: &str,
    text: &str,
    options: &str,
    verify: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Motion, Option<PyErr>)> {
    let options = Options::from_json(options)?;
    let mut scene = scene::read(kind, text)?;
    options.apply(&mut scene)?;
    py.detach(|| advance(scene, &options, verify, progress.as_ref()))
}

fn advance(
    scene: Scene,
    options: &Options,
    verify: bool,
    progress: Option<&Py<PyAny>>,
) -> PyResult<(Motion, Option<PyErr>)> {
    let settings = &scene.simulation;
    let times = settings.output_times();
    let rows = times.intervals();
    if rows > MAX_OUTPUTS {
        let what = format!("{} s in steps of {} s make {rows:.0} outputs", settings.duration, settings.every);
        return Err(Refusal::new("too-many-outputs", what, "give a larger every, or a smaller until").into());
    }
    let mut run = Simulation::new(&with_energy(&scene)).map_err(Refusal::from)?;
    options.check_choice(&run)?;
    if let Some(steps) = options.most_steps {
        run.set_step_limit(steps);
    }
    let verifier = if verify { Some(Verifier::new(&scene, &run).map_err(Refusal::from)?) } else { None };
    let outputs = Outputs::new(&run);
    let mut course = Course {
        record: Record::new(&run, &outputs, rows),
        snapshots: Vec::new(),
        verifier,
        watcher: Watcher::new(progress),
        began: Instant::now(),
        most_seconds: options.most_seconds,
    };
    let stopped = course.follow(&mut run, &outputs, &times).err();
    let Course { record, snapshots, verifier, .. } = course;
    let verified = verifier.map(|verifier| {
        let found = verifier.found();
        json!({ "found": found, "doubts": found.doubts(&run) })
    });
    Ok((Motion { scene, run, snapshots, outputs, verified, record: Mutex::new(Some(record)) }, stopped))
}

/// The scene with the energy among its outputs.
fn with_energy(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let outputs = &mut scene.simulation.outputs;
    if outputs.iter().all(|output| output.kind != OutputKind::Energy) {
        outputs.push(OutputKind::Energy.into());
    }
    scene
}

/// A run under way.
struct Course<'a> {
    record: Record,
    snapshots: Vec<Snapshot>,
    verifier: Option<Verifier>,
    watcher: Watcher<'a>,
    began: Instant,
    most_seconds: Option<f64>,
}

impl Course<'_> {
    /// From output to output to the end. The last good state before an error is an output too.
    fn follow(&mut self, run: &mut Simulation, outputs: &Outputs, times: &OutputTimes) -> PyResult<()> {
        self.write(run, outputs);
        let mut index = 0;
        while !run.finished() {
            index += 1;
            let time = times.at(index);
            let written = run.time();
            if let Err(stop) = self.go_on(run, time) {
                let reached = run.reached();
                if run.time() > written || (reached > written && run.advance_to(reached).is_ok()) {
                    self.write(run, outputs);
                }
                return Err(stop);
            }
            while let Some(verifier) = &mut self.verifier
                && !verifier.compare(run, PIECE)
            {
                self.watcher.look(run.time(), run.duration())?;
            }
            self.write(run, outputs);
        }
        self.watcher.look_now(run.time(), run.duration())
    }

    fn write(&mut self, run: &Simulation, outputs: &Outputs) {
        self.record.write(run, outputs);
        self.snapshots.push(run.snapshot());
    }

    /// Goes on to a time, in pieces, and looks at the clock and at the keyboard in between.
    fn go_on(&mut self, run: &mut Simulation, time: f64) -> PyResult<()> {
        loop {
            self.watcher.look(run.time(), run.duration())?;
            if let Some(most) = self.most_seconds
                && self.began.elapsed().as_secs_f64() > most
            {
                let what = format!("the run stops at t = {:.6} s: its {most} s are used up", run.reached());
                return Err(Refusal::new("time-limit", what, "allow it more most_seconds").into());
            }
            if run.advance_towards(time, PIECE).map_err(Refusal::from)? {
                return Ok(());
            }
        }
    }
}

#[pymethods]
impl Motion {
    /// What does not change with time, and the summary, as JSON.
    fn about(&self) -> PyResult<String> {
        let (run, model) = (&self.run, self.run.model());
        let columns = self.outputs.columns().iter().map(|column| json!([column.name, column.unit]));
        let rows = run.multipliers().into_iter().flat_map(|joint| {
            let name = joint.joint.clone();
            joint.rows.into_iter().map(move |row| json!([name, row.label]))
        });
        let about = json!({
            "scene": self.scene,
            "bodies": model.bodies.iter().map(|body| &body.name).collect::<Vec<_>>(),
            "joints": model.joints.iter().map(|joint| &joint.name).collect::<Vec<_>>(),
            "drivers": model.drivers.iter().map(|driver| &driver.name).collect::<Vec<_>>(),
            "markers": model.markers.iter().map(|marker| &marker.name).collect::<Vec<_>>(),
            "coordinates": run.jacobian().columns,
            "columns": columns.collect::<Vec<_>>(),
            "conventions": self.outputs.conventions(),
            "multipliers": rows.collect::<Vec<_>>(),
            "summary": run.summary(),
            "notes": run.notes(),
            "events": run.events(),
            "verified": self.verified,
        });
        serde_json::to_string(&about).map_err(|error| Refusal::from(error).into())
    }

    /// The arrays that were written during the run, by name. They are handed over: a second call has none.
    fn arrays(&self, py: Python<'_>) -> PyResult<Option<Vec<(&'static str, Numbers)>>> {
        let record = self.record.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take();
        record.map(|record| record.into_arrays(py)).transpose()
    }

    /// Accelerations q̈ at all outputs.
    fn accelerations(&self, py: Python<'_>) -> PyResult<Numbers> {
        let numbers = self.at_outputs(py, |state| Ok(state.accelerations()))?;
        shaped(py, numbers.concat(), &[numbers.len(), self.run.q().len()])
    }

    /// Multipliers λ of the rows of joints and drivers at all outputs.
    fn multipliers(&self, py: Python<'_>) -> PyResult<Numbers> {
        let of = |state: &StateView<'_>| {
            Ok(state.multipliers().iter().flat_map(|joint| joint.rows.iter().map(|row| row.value)).collect())
        };
        let numbers: Vec<Vec<f64>> = self.at_outputs(py, of)?;
        let rows = numbers.first().map_or(0, Vec::len);
        shaped(py, numbers.concat(), &[numbers.len(), rows])
    }

    /// How far the constraints are open at all outputs: the largest |Φ|.
    fn violations(&self, py: Python<'_>) -> PyResult<Numbers> {
        let of = |state: &StateView<'_>| {
            Ok(state.constraints().into_iter().fold(0.0, |most: f64, x| most.max(x.abs())))
        };
        Ok(vector(py, self.at_outputs(py, of)?))
    }

    /// The reaction of a joint or driver at all outputs, as the convention (JSON) says: see [`reactions`].
    fn reactions(&self, py: Python<'_>, joint: &str, convention: &str) -> PyResult<reactions::Reactions> {
        reactions::of(self, py, joint, convention)
    }

    /// The mechanism as an SVG: moving, or as it is at the end.
    fn svg(&self, py: Python<'_>, moving: bool) -> PyResult<String> {
        let frames = self.at_outputs(py, |state| Ok(state.frame()))?;
        let mut film = Film::new(&self.scene, self.run.model());
        for frame in frames {
            film.push(frame);
        }
        Ok(film.svg(moving))
    }
}

impl Motion {
    /// Something at all outputs, computed without Python's lock; Ctrl-C ends it.
    fn at_outputs<T: Send>(
        &self,
        py: Python<'_>,
        of: impl Fn(&StateView<'_>) -> Result<T, Refusal> + Sync,
    ) -> PyResult<Vec<T>> {
        py.detach(|| {
            let mut looked = Instant::now();
            let mut found = Vec::with_capacity(self.snapshots.len());
            for snapshot in &self.snapshots {
                if looked.elapsed() > LOOK {
                    Python::attach(|py: Python<'_>| py.check_signals())?;
                    looked = Instant::now();
                }
                if let Some(state) = self.run.at_snapshot(snapshot) {
                    found.push(of(&state)?);
                }
            }
            Ok(found)
        })
    }
}
