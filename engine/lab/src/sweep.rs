//! Many runs of one scene with varied numbers, in parallel: grids and random samples.
//!
//! The numbers of a run depend on the plan and on its index alone, so that the results are the same for any number of
//! threads. A run that cannot start or go on is listed with its error and ends nothing else.

mod plan;
mod plot;

pub use plan::{SweepError, SweepPlan, Values, Variation};
pub use plot::svg;

use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use triad_engine::EngineError;
use triad_engine::run::{Column, Outputs, Simulation};
use triad_scene::WrittenScene;

/// Most sentences of different wording that are told of the runs of a sweep.
const MOST_NOTES: usize = 20;
/// Steps between two looks at whether the sweep is to end.
const PIECE: u64 = 256;
/// Most threads: so many that starting them takes the machine's memory help nobody.
const MOST_THREADS: usize = 1024;

/// One run of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRun {
    /// Its place in the plan, from 0.
    pub index: usize,
    /// The varied numbers, in the order of the plan.
    pub values: Vec<f64>,
    /// The outputs at its end, or why there are none.
    pub result: Result<Reached, EngineError>,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// Time at the end, s: earlier than the scene's where an event stops the run.
    pub time: f64,
    /// Estimated error of that time where an event stopped the run, s. What changes at a rate is off by as much as it changes in it besides:
    /// errors of outputs are those at a given time.
    pub time_error: Option<f64>,
    /// The chosen outputs there, in the order of the columns.
    pub outputs: Vec<f64>,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// How many things speak against the result.
    pub doubts: usize,
    /// What was found or corrected when the run began.
    pub notes: Vec<String>,
}

/// The runs of a sweep that were done, in the order of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Names of the varied numbers.
    pub varied: Vec<String>,
    /// What is told of each run.
    pub columns: Vec<Column>,
    /// Which of them are reactions of a mechanism in which not all are unique.
    pub shared: Vec<bool>,
    /// What is to be known of these, if there are any.
    pub note: Option<&'static str>,
    /// The runs; those that were cancelled are left out.
    pub runs: Vec<SweepRun>,
}

impl Sweep {
    /// What was found or corrected when runs began: of sentences that differ in numbers alone the first, with the number of the run and of those
    /// that say the like.
    pub fn notes(&self) -> Vec<(&str, usize, usize)> {
        let mut told: Vec<(String, (&str, usize, usize))> = Vec::new();
        for run in &self.runs {
            for note in run.result.iter().flat_map(|reached| &reached.notes) {
                let words: String =
                    note.chars().filter(|c| !c.is_ascii_digit() && !"+-.e".contains(*c)).collect();
                if let Some((_, (.., runs))) = told.iter_mut().find(|(known, _)| *known == words) {
                    *runs += 1;
                } else if told.len() < MOST_NOTES {
                    told.push((words, (note, run.index, 1)));
                }
            }
        }
        told.into_iter().map(|(_, note)| note).collect()
    }
}

/// How a sweep is watched: both are called from many threads.
pub trait Watch: Sync {
    /// A run is done.
    fn done(&self) {}

    /// Whether no further run is to be begun, and those that are under way are to be left.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
pub struct Unwatched;

impl Watch for Unwatched {}

/// Runs a plan on `threads` threads; 0 takes one for each core.
///
/// # Errors
///
/// [`SweepError`]: the scene or the plan cannot be. Errors of single runs stand with them.
///
/// ```
/// use triad_lab::sweep::{SweepPlan, Unwatched, Values, Variation, sweep};
/// use triad_scene::catalogue;
///
/// let mut scene = catalogue::scene("simple-pendulum")?.duration(0.5);
/// scene.simulation.outputs = vec!["joints:pin".parse()?];
/// let gravity = Variation::new(&scene, "/gravity/1", Values::Grid { from: -9.81, to: -1.62, count: 3 })?;
/// let found = sweep(&SweepPlan { varied: vec![gravity], ..SweepPlan::new(scene) }, 2, &Unwatched)?;
/// let angles: Vec<f64> = found.runs.iter().map(|run| run.result.as_ref().unwrap().outputs[0]).collect();
/// assert!(angles[0] > angles[1] && angles[1] > angles[2], "{angles:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(plan: &SweepPlan, threads: usize, watch: &impl Watch) -> Result<Sweep, SweepError> {
    let count = plan.count()?;
    let outputs = Outputs::new(&Simulation::new(&plan.scene)?);
    if threads > MOST_THREADS {
        return Err(SweepError::Threads { threads, reason: format!("there may be {MOST_THREADS}") });
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads.min(count)).build();
    let pool = pool.map_err(|error| SweepError::Threads { threads, reason: error.to_string() })?;
    let shared = SharedParts { plan, outputs: &outputs, watch };
    let runs = pool.install(|| {
        let written = || WrittenScene::new(&plan.scene);
        let runs = (0..count).into_par_iter().map_init(written, |written, index| shared.run(written, index));
        runs.flatten().collect()
    });
    let varied = plan.varied.iter().map(|variation| variation.name.clone()).collect();
    let columns = outputs.columns().to_vec();
    let shared = (0..columns.len()).map(|column| outputs.may_be_shared(column)).collect();
    Ok(Sweep { varied, columns, shared, note: outputs.shared_note(), runs })
}

/// What all runs of a sweep share. The varied numbers change neither names nor what is connected, so that the outputs are the
/// same groups of columns in each of them.
struct SharedParts<'a, W> {
    plan: &'a SweepPlan,
    outputs: &'a Outputs,
    watch: &'a W,
}

impl<W: Watch> SharedParts<'_, W> {
    /// One run; none if it was cancelled. `written` is the scene with the numbers of any other run.
    fn run(&self, written: &mut WrittenScene, index: usize) -> Option<SweepRun> {
        if self.watch.cancelled() {
            return None;
        }
        let values = self.plan.values(index);
        let result = match self.start(written, &values) {
            Ok(run) => self.advance(run)?,
            Err(error) => Err(error),
        };
        self.watch.done();
        Some(SweepRun { index, values, result })
    }

    fn start(&self, written: &mut WrittenScene, values: &[f64]) -> Result<Simulation, EngineError> {
        let varied = self.plan.varied.iter().zip(values);
        written.set_numbers(varied.flat_map(|(variation, value)| variation.changes(*value)))?;
        Simulation::new(&written.read()?)
    }

    /// Runs to the end; none if it was cancelled on the way.
    fn advance(&self, mut run: Simulation) -> Option<Result<Reached, EngineError>> {
        loop {
            match run.advance_towards(run.duration(), PIECE) {
                Err(error) => return Some(Err(error)),
                Ok(true) => break,
                Ok(false) if self.watch.cancelled() => return None,
                Ok(false) => {}
            }
        }
        let mut outputs = Vec::with_capacity(self.outputs.columns().len());
        self.outputs.write(&run, &mut outputs);
        let summary = run.summary();
        let (evaluations, doubts) = (summary.evaluations, summary.doubts.len());
        let notes = run.notes().to_vec();
        let stopped = run.events().last().filter(|event| event.stop && event.time == run.time());
        let time_error = stopped.and_then(|event| event.error);
        Some(Ok(Reached { time: run.time(), time_error, outputs, evaluations, doubts, notes }))
    }
}
