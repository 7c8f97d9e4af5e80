//! Many runs of a scene with varied numbers, on all cores and without Python's lock.

use crate::arrays::{Numbers, shaped, vector};
use crate::refusal::Refusal;
use crate::scene::{self, Options};
use crate::watch::{LOOK, Watcher};
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::json;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use triad_engine::run::Simulation;
use triad_lab::sweep::{self as lab, SweepError, SweepPlan, Values, Variation, Watch};

/// How a number varies.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Varied {
    Grid(f64, f64, usize),
    Uniform(f64, f64),
    Normal(f64, f64),
}

/// The runs of a sweep.
#[pyclass(frozen, module = "triad._native")]
pub struct Sweep {
    found: lab::Sweep,
}

#[pymethods]
impl Sweep {
    /// Names, units and errors, as JSON.
    fn about(&self) -> String {
        let stopped = self.found.runs.iter().filter_map(|run| {
            let error = run.result.as_ref().err()?;
            Some(json!({ "run": run.index, "code": error.code(), "what": error.to_string(), "hint": error.hint() }))
        });
        json!({
            "varied": self.found.varied,
            "columns": self.found.columns.iter().map(|column| json!([column.name, column.unit])).collect::<Vec<_>>(),
            "stopped": stopped.collect::<Vec<_>>(),
        })
        .to_string()
    }

    /// The varied numbers: (runs, varied).
    fn values(&self, py: Python<'_>) -> PyResult<Numbers> {
        let numbers = self.found.runs.iter().flat_map(|run| run.values.iter().copied());
        shaped(py, numbers.collect(), &[self.found.runs.len(), self.found.varied.len()])
    }

    /// The outputs at the end of each run: (runs, columns); not a number where a run failed.
    fn outputs(&self, py: Python<'_>) -> PyResult<Numbers> {
        let columns = self.found.columns.len();
        let mut numbers = Vec::with_capacity(columns * self.found.runs.len());
        for run in &self.found.runs {
            match &run.result {
                Ok(end) => numbers.extend(&end.outputs),
                Err(_) => numbers.resize(numbers.len() + columns, f64::NAN),
            }
        }
        shaped(py, numbers, &[self.found.runs.len(), columns])
    }

    /// The time at which each run ended, s.
    fn times(&self, py: Python<'_>) -> Numbers {
        let times = self.found.runs.iter().map(|run| run.result.as_ref().map_or(f64::NAN, |end| end.time));
        vector(py, times.collect())
    }

    /// How many things speak against each result.
    fn doubts(&self) -> Vec<usize> {
        self.found.runs.iter().map(|run| run.result.as_ref().map_or(1, |end| end.doubts)).collect()
    }

    /// An output over the first varied number, as SVG; none if no run has a number to be drawn.
    fn svg(&self, column: usize) -> Option<String> {
        lab::svg(&self.found, column)
    }
}

/// What threads tell the one that Python runs in.
#[derive(Default)]
struct Told {
    done: AtomicUsize,
    cancelled: AtomicBool,
}

impl Watch for Told {
    fn done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Runs all.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "named by the Python around it")]
pub fn sweep(
    py: Python<'_>,
    kind: &str,
    text: &str,
    options: &str,
    vary: &str,
    samples: usize,
    seed: u64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Sweep> {
    let mut scene = scene::read(kind, text)?;
    let options = Options::from_json(options)?;
    options.apply(&mut scene)?;
    let vary: Vec<(String, Varied)> = serde_json::from_str(vary).map_err(Refusal::from)?;
    let mut varied = Vec::with_capacity(vary.len());
    for (name, values) in vary {
        let values = match values {
            Varied::Grid(from, to, count) => Values::Grid { from, to, count },
            Varied::Uniform(from, to) => Values::Uniform { from, to },
            Varied::Normal(mean, deviation) => Values::Normal { mean, deviation },
        };
        varied.push(Variation::new(&scene, &name, values).map_err(Refusal::from)?);
    }
    let plan = SweepPlan { varied, samples, seed, ..SweepPlan::with_errors(scene) };
    if let Ok(run) = Simulation::new(&plan.scene) {
        options.check_choice(&run)?;
    }
    py.detach(|| watched(&plan, threads, progress.as_ref()))
}

/// Runs a plan on other threads, and looks at the keyboard on this one: only Python's first thread hears of Ctrl-C.
fn watched(plan: &SweepPlan, threads: usize, progress: Option<&Py<PyAny>>) -> PyResult<Sweep> {
    let count = plan.count().map_err(Refusal::from)?;
    let told = Told::default();
    let (sender, finished) = channel();
    thread::scope(|scope| {
        scope.spawn(|| {
            let found = lab::sweep(plan, threads, &told);
            drop(sender.send(found));
        });
        let mut watcher = Watcher::new(progress);
        loop {
            #[allow(clippy::cast_precision_loss, reason = "runs stay far below 2^52")]
            let at = |told: &Told| [told.done.load(Ordering::Relaxed) as f64, count as f64];
            match finished.recv_timeout(LOOK) {
                Ok(found) => {
                    let [done, all] = at(&told);
                    let found = found.map_err(Refusal::from)?;
                    watcher.look_now(done, all)?;
                    return Ok(Sweep { found });
                }
                Err(RecvTimeoutError::Timeout) => {
                    let [done, all] = at(&told);
                    if let Err(stop) = watcher.look_now(done, all) {
                        told.cancelled.store(true, Ordering::Relaxed);
                        return Err(stop);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let reason = "the thread of the sweep ended without a result".to_owned();
                    return Err(Refusal::from(SweepError::Threads { threads, reason }).into());
                }
            }
        }
    })
}
