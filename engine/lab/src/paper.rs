//! The demonstrative examples of the paper, with the paper's own settings.
//!
//! Gonçalves, Roupa, Flores and Tavares da Silva, Mechanism and Machine Theory (2025) 105955, section 5: ode45 with its
//! default options, Baumgarte's stabilization with 2α and β², the augmented system with the redundant rows
//! dropped once, at the start. Nothing here measures time: the caller does.
//!
//! The counts of the N-four-bar mechanisms hang on rounding at their singular positions: another order of elimination,
//! or another choice between equally long rows, moves them by up to three steps. The plain order and the choice made
//! here are among those that give the published counts where these are compared; they are not derived from anything.

mod cases;
mod correlation;
mod descriptor;

pub use cases::{CASES, PaperCase, Published};
pub use correlation::{Correlation, correlation};
pub use descriptor::{LinearAlgebra, PaperSystem};

use serde::Serialize;
use triad_engine::EngineError;
use triad_engine::integrate::{Explicit, ODE45_TOLERANCE, OdeMethod};
use triad_engine::run::Simulation;
use triad_scene::{ConstraintMethod, Coordinates, IntegratorKind, Scene, Settings};

/// Interval at which two runs are compared, s.
const EVERY: f64 = 0.01;
/// Tolerance of the reference runs.
const REFERENCE_TOLERANCE: f64 = 1e-11;

/// Why an example of the paper did not come to its end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PaperError {
    /// The scene or the reference run.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The matrix of the equations of motion became singular, or the step too small.
    #[error("{case} ({coordinates}): the run ended at t = {time:.4} s, its equations of motion singular")]
    Singular {
        /// Name of the example.
        case: &'static str,
        /// The coordinates of all its bodies.
        coordinates: Coordinates,
        /// Time reached, s.
        time: f64,
    },
}

impl PaperError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Engine(error) => error.code(),
            Self::Singular { .. } => "paper-run-singular",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::Engine(error) => error.hint(),
            Self::Singular { .. } => {
                "The paper's settings break up at singular passages when α and β are small; keep those of the table."
                    .to_owned()
            }
        }
    }
}

/// What a run cost, in the words of the published table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Failed attempts.
    pub failed: u64,
    /// Evaluations of ẏ: one, and six for each attempt.
    pub evaluations: u64,
}

/// A run with the paper's settings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Steps, failed attempts and evaluations.
    pub counts: Counts,
    /// Integration variables: coordinates and velocities.
    pub variables: usize,
    /// Rows that were dropped at the start.
    pub dropped: usize,
    /// Largest change of energy, J.
    pub energy_drift: f64,
    /// Largest |Φ| along the run.
    pub violation: f64,
    /// The example's tracked coordinate, every 0.01 s.
    #[serde(skip)]
    pub tracked: Vec<f64>,
}

/// Runs an example with the given coordinates in every body.
///
/// # Errors
///
/// [`PaperError`]: the scene cannot be made or assembled, or the run stops.
pub fn run(case: &PaperCase, coordinates: Coordinates, algebra: LinearAlgebra) -> Result<Run, PaperError> {
    let mut plant = PaperSystem::new(case, coordinates, algebra)?;
    let start = plant.start().to_vec();
    let end = case.duration;
    let place = plant.coordinate(case.tracked_body, case.tracked_axis);
    let n = start.len() / 2;
    let mut observer = plant.clone();
    let (first_energy, mut violation) = observer.observe(&start);
    let mut drift = 0.0f64;
    let mut tracked = Vec::new();
    let mut last = (0.0, start[place], start[n + place]);
    sample(last, last, &mut tracked);
    let mut ode45 = Explicit::ode45(&mut plant, 0.0, &start, ODE45_TOLERANCE, end);
    while ode45.last().t < end {
        if ode45.step(&mut plant, end).is_err() {
            let case = case.name;
            return Err(PaperError::Singular { case, coordinates, time: ode45.last().t });
        }
        let y = &ode45.last().y;
        let (energy, open) = observer.observe(y);
        violation = violation.max(open);
        drift = drift.max((energy - first_energy).abs());
        let now = (ode45.last().t, y[place], y[n + place]);
        sample(last, now, &mut tracked);
        last = now;
    }
    let steps = ode45.last().steps;
    let counts = Counts {
        steps: steps.accepted,
        failed: steps.rejected,
        evaluations: 1 + 6 * (steps.accepted + steps.rejected),
    };
    let dropped = plant.dropped();
    Ok(Run { counts, variables: 2 * n, dropped, energy_drift: drift, violation, tracked })
}

/// Adds the samples between two steps, by cubic Hermite interpolation of positions and velocities.
fn sample(old: (f64, f64, f64), now: (f64, f64, f64), out: &mut Vec<f64>) {
    let h = now.0 - old.0;
    loop {
        let t = out.len() as f64 * EVERY;
        if t > now.0 * (1.0 + 1e-12) {
            return;
        }
        if h <= 0.0 {
            out.push(now.1);
            continue;
        }
        let s = ((t - old.0) / h).min(1.0);
        let difference = now.1 - old.1;
        let bend = (1.0 - s) * (h * old.2 - difference) - s * (h * now.2 - difference);
        out.push(old.1 + s * difference + s * (1.0 - s) * bend);
    }
}

/// The same coordinate from the engine's own solver, as the reference of an example.
///
/// # Errors
///
/// [`PaperError`]: the scene cannot be made, or its run stops.
pub fn reference(case: &PaperCase) -> Result<Vec<f64>, PaperError> {
    let mut scene = scene(case, Coordinates::Full)?;
    scene.simulation = Settings {
        duration: case.duration,
        every: EVERY,
        integrator: IntegratorKind::Dop853,
        tolerance: REFERENCE_TOLERANCE,
        constraint_method: ConstraintMethod::Projection,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(&scene)?;
    let mut tracked = Vec::new();
    loop {
        let t = tracked.len() as f64 * EVERY;
        if t > case.duration * (1.0 + 1e-12) {
            return Ok(tracked);
        }
        simulation.advance_to(t.min(case.duration))?;
        tracked.push(simulation.frame().bodies[case.tracked_body].position[case.tracked_axis]);
    }
}

/// The scene of an example, all bodies with the given coordinates.
///
/// # Errors
///
/// [`PaperError`]: no built-in scene of that name.
pub fn scene(case: &PaperCase, coordinates: Coordinates) -> Result<Scene, PaperError> {
    let mut scene = (case.scene)().map_err(EngineError::from)?;
    scene.coordinates = coordinates;
    for body in &mut scene.bodies {
        body.coordinates = None;
    }
    Ok(scene)
}
