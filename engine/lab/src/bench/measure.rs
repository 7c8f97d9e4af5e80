//! Running a plan.

use std::time::{Duration, Instant};

use triad_engine::EngineError;
use triad_engine::run::{Simulation, Summary};
use triad_scene::catalogue;
use triad_scene::{IntegratorKind, Scene};

use super::plan::{BenchCase, BenchPlan, Method, Truth};
use super::reference::{self, Positions, Reference, distance};

/// One run with its error, its times and its work.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name of the scene.
    pub scene: String,
    /// How it was run.
    pub method: Method,
    /// The tolerance.
    pub tolerance: f64,
    /// Largest distance from the reference, m, and not less than what that may be off itself; `None` if the run stopped early.
    pub error: Option<f64>,
    /// Times of all repeats in rising order, s.
    pub times: Vec<f64>,
    /// Work of one run.
    pub work: Summary,
}

impl Measured {
    /// Median of the times, s.
    pub fn median(&self) -> f64 {
        self.times.get(self.times.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Half the range between the quartiles, relative to the median.
    pub fn spread(&self) -> f64 {
        let at = |part: usize| self.times.get(self.times.len() * part / 4).copied().unwrap_or(f64::NAN);
        0.5 * (at(3) - at(1)) / self.median()
    }
}

/// A method that a scene is not run by, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Name of the scene.
    pub scene: String,
    /// The method, in words.
    pub method: String,
    /// What stands against it.
    pub why: String,
}

/// A run that is ready to be repeated.
struct Ready {
    simulation: Simulation,
    measured: Measured,
}

/// Runs a plan, and tells what was left out of it; `progress(done, of all, what)` hears how far it is, in parts of one.
///
/// # Errors
///
/// The error of the first run that cannot start or go on.
pub fn measure(
    plan: &BenchPlan,
    mut progress: impl FnMut(f64, &str),
) -> Result<(Vec<Measured>, Vec<LeftOut>), EngineError> {
    let (mut ready, mut left_out) = (Vec::new(), Vec::new());
    for (index, case) in plan.cases.iter().enumerate() {
        prepare(plan, case, (&mut ready, &mut left_out), |part| {
            progress(0.4 * (index as f64 + part) / plan.cases.len() as f64, &case.scene);
        })?;
    }
    let deadline = Instant::now() + Duration::from_secs_f64(plan.seconds);
    for round in 0..plan.repeats {
        for run in &mut ready {
            if Instant::now() >= deadline && round > 0 {
                break;
            }
            run.simulation.reset();
            let start = Instant::now();
            // A run that stops early was found out when its error was taken.
            let _ = run.simulation.advance_to(run.simulation.duration());
            run.measured.times.push(start.elapsed().as_secs_f64());
        }
        progress(0.4 + 0.6 * (round + 1) as f64 / plan.repeats as f64, "repeats");
    }
    let measured = ready.into_iter().map(|Ready { simulation, mut measured }| {
        measured.times.sort_by(f64::total_cmp);
        measured.work = simulation.summary();
        measured
    });
    Ok((measured.collect(), left_out))
}

/// What the runs of a case are compared with, and how far it may be off itself, m; `None` if nobody knows. The scene gives up what
/// stands against a comparison of tolerances.
fn truth(
    case: &BenchCase,
    scene: &mut Scene,
    left_out: &mut Vec<LeftOut>,
) -> Result<Option<(Positions, f64)>, EngineError> {
    let mut leave = |method: &str, why: &str| {
        left_out.push(LeftOut { scene: case.scene.clone(), method: method.to_owned(), why: why.to_owned() });
    };
    if scene.simulation.step.take().is_some() {
        leave("steps of one size", "tolerances are compared, and such steps have none");
    }
    let Reference { positions, error } = reference::reference(case, scene)?;
    if error.is_none() && case.given.is_some() {
        leave(
            "every method",
            "what runs are compared with does not know its own error until the end: ask for a shorter duration",
        );
        return Ok(None);
    }
    Ok(Some((positions, error.unwrap_or(0.0))))
}

fn prepare(
    plan: &BenchPlan,
    case: &BenchCase,
    (ready, left_out): (&mut Vec<Ready>, &mut Vec<LeftOut>),
    mut progress: impl FnMut(f64),
) -> Result<(), EngineError> {
    let mut scene: Scene = match &case.given {
        Some(scene) => scene.clone(),
        None => catalogue::scene(&case.scene)?,
    };
    scene.simulation.duration = case.duration;
    let Some((truth, own)) = truth(case, &mut scene, left_out)? else { return Ok(()) };
    let compared = if case.truth == Truth::Converged { scene.bodies.len() } else { 1 };
    for (index, &method) in plan.methods.iter().enumerate() {
        progress(index as f64 / plan.methods.len() as f64);
        let leave = |why: String| LeftOut { scene: case.scene.clone(), method: method.to_string(), why };
        let (worth, not): (Vec<f64>, Vec<f64>) =
            plan.tolerances.iter().partition(|&&tolerance| BenchPlan::worth(case, method, tolerance));
        if worth.is_empty() {
            left_out.push(leave("no tolerance of these is worth its time".to_owned()));
        } else if !not.is_empty() && case.given.is_some() {
            let not: Vec<String> = not.iter().map(|tolerance| format!("{tolerance:e}")).collect();
            left_out.push(leave(format!("tolerances not worth its time: {}", not.join(", "))));
        }
        for tolerance in worth {
            scene.coordinates = method.coordinates;
            scene.simulation.integrator = method.integrator;
            scene.simulation.constraint_method = method.constraint_method;
            scene.simulation.tolerance = tolerance;
            let mut simulation = match Simulation::new(&scene) {
                Ok(simulation) => simulation,
                // A method that a given scene cannot be run by is left out; the built-in ones are run by all.
                Err(error) if case.given.is_some() => {
                    left_out.push(leave(error.to_string()));
                    break;
                }
                Err(error) => return Err(error),
            };
            // Times of another method than the one that is named would say nothing of this one.
            let by = simulation.summary();
            if method.integrator != IntegratorKind::Auto && by.integrator != method.integrator {
                left_out.push(leave(format!("it would run by {}: {}", by.integrator, by.reason)));
                break;
            }
            let run = reference::positions(&scene, compared);
            if let Err(error @ EngineError::Integrator { .. }) = &run {
                left_out.push(leave(error.to_string()));
                break;
            }
            let error = run.ok().map(|run| distance(&run, &truth).max(own));
            simulation.set_step_limit(reference::MAX_STEPS);
            let work = simulation.summary();
            let times = Vec::with_capacity(plan.repeats);
            let measured = Measured { scene: case.scene.clone(), method, tolerance, error, times, work };
            ready.push(Ready { simulation, measured });
        }
    }
    Ok(())
}
