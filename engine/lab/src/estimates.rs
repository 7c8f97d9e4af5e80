//! How good the error estimates of runs are: each compared with the error that a much tighter run finds.

use crate::stress::random;
use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::run::{Frame, Simulation};
use triad_scene::{ConstraintMethod, IntegratorKind, Scene};

/// Tolerance of the run that errors are measured with.
const TIGHTEST: f64 = 1e-13;
/// Part of the length of a mechanism below which an error cannot be measured that way: both runs round.
const MEASURABLE: f64 = 3e-12;
/// How many times as far as two tight runs by different methods are apart an error must be to be measured by one of them, and the
/// tolerance below which that is looked at: looser runs are much farther off.
const KNOWN: f64 = 3.0;
const NEAR_TIGHTEST: f64 = 3e-8;
/// Part of that length above which a run promises nothing: it says that it doubts the result.
const PROMISED: f64 = 0.01;
/// An estimate within this factor of the error is good.
const GOOD: f64 = 3.0;
/// One below this part of it is bad.
const BAD: f64 = 0.1;
/// Moments at which a run is judged.
const MOMENTS: u32 = 20;

/// Steps after which a run is judged no further: a method that does not suit its scene would take hours.
const MOST_STEPS: u64 = 100_000;
/// The same of the run that only tells how far a tight one can be trusted.
const MOST_STEPS_OF_OTHER: u64 = 20_000;

/// An estimate, and the error that it estimates.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The scene.
    pub scene: String,
    /// Its tolerance.
    pub tolerance: f64,
    /// Time, s.
    pub time: f64,
    /// Length of the mechanism, m.
    pub length: f64,
    /// The estimate of the largest error of a centre of mass, m.
    pub estimate: f64,
    /// That error, m.
    pub error: f64,
}

impl Judged {
    /// Whether the estimate is within a factor of three of the error.
    pub fn is_good(&self) -> bool {
        (1.0 / GOOD..=GOOD).contains(&(self.estimate / self.error))
    }

    /// Whether it is below a tenth of the error while it promises less than a hundredth of the length.
    pub fn is_bad(&self) -> bool {
        self.estimate < BAD * self.error && self.estimate < PROMISED * self.length
    }
}

/// The ways to run a scene whose estimates are judged: integrator, treatment and, of the methods that have them, the number of steps
/// of one size in a run.
pub const WAYS: [&str; 11] = [
    "taylor",
    "dop853",
    "dopri5",
    "ode45",
    "radau",
    "rattle",
    "dop853 baumgarte",
    "dopri5 partitioning",
    "dop853 penalty",
    "trapezoidal augmented-lagrangian",
    "dop853 projection 120",
];

/// A scene that runs in one of the [`WAYS`]; `None` for a word that is not known.
pub fn in_the_way(scene: &Scene, way: &str) -> Option<Scene> {
    let mut words = way.split(' ');
    let mut scene = scene.clone();
    let settings = &mut scene.simulation;
    settings.integrator = words.next()?.parse().ok()?;
    settings.constraint_method = words.next().unwrap_or("projection").parse().ok()?;
    settings.step = match words.next() {
        Some(steps) => Some(settings.duration / steps.parse::<f64>().ok()?),
        None => None,
    };
    Some(scene)
}

/// The much tighter run that errors of a scene's run are measured with.
fn truth(scene: &Scene, integrator: IntegratorKind) -> Scene {
    let mut tight = scene.clone();
    let settings = &mut tight.simulation;
    settings.tolerance = TIGHTEST;
    settings.integrator = integrator;
    settings.constraint_method = ConstraintMethod::Projection;
    settings.step = None;
    settings.error_estimate = false;
    tight
}

/// Judges the estimates of a scene's run, where it makes them and its errors can be measured.
///
/// # Errors
///
/// [`EngineError`]: the scene cannot start. A run that cannot go on is judged up to there.
pub fn judge(scene: &Scene) -> Result<Vec<Judged>, EngineError> {
    let by = |integrator| Simulation::new(&truth(scene, integrator));
    let (mut run, mut truth) = (Simulation::new(scene)?, by(IntegratorKind::Auto)?);
    // Another method, so that the two do not err alike.
    let near = scene.simulation.tolerance < NEAR_TIGHTEST;
    let mut other = if near { Some(by(IntegratorKind::Dop853)?) } else { None };
    run.set_step_limit(MOST_STEPS);
    truth.set_step_limit(MOST_STEPS);
    if let Some(other) = &mut other {
        other.set_step_limit(MOST_STEPS_OF_OTHER);
    }
    let length = run.system().length;
    let mut judged = Vec::new();
    for k in 1..=MOMENTS {
        let time = run.duration() * f64::from(k) / f64::from(MOMENTS);
        if run.advance_to(time).is_err() || truth.advance_to(time).is_err() {
            break;
        }
        let Some(estimate) = run.error_estimate() else { break };
        let mut unsure = 0.0;
        if let Some(other) = &mut other {
            if other.advance_to(time).is_err() {
                break;
            }
            unsure = apart(&other.frame(), &truth.frame());
        }
        let error = apart(&run.frame(), &truth.frame());
        let least = (MEASURABLE * length).max(KNOWN * unsure);
        if error > least && estimate.position < PROMISED * length {
            let (scene, tolerance) = (scene.name.clone(), scene.simulation.tolerance);
            judged.push(Judged { scene, tolerance, time, length, estimate: estimate.position, error });
        }
    }
    Ok(judged)
}

/// Largest distance of a centre of mass.
fn apart(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.bodies.iter().zip(&b.bodies);
    let squares = pairs.map(|(a, b)| {
        (0..3).map(|k| (a.position[k] - b.position[k]) * (a.position[k] - b.position[k])).sum::<f64>()
    });
    squares.fold(0.0, f64::max).sqrt()
}

/// The scenes that estimates are judged on: the catalogue, and the random mechanisms of the first seeds.
pub fn scenes(seeds: u64) -> Vec<Scene> {
    let names = [
        "simple-pendulum",
        "free-body",
        "heavy-top",
        "spatial-double-pendulum",
        "n-four-bar:2",
        "bricard",
        "spatial-slider-crank",
        "spatial-chain:5",
    ];
    let built_in = names.iter().filter_map(|name| catalogue::scene(name).ok());
    built_in.chain((0..seeds).map(random::scene)).collect()
}
