//! How good the error estimates of runs are: each compared with the error that a much tighter run finds.

use crate::stress::random;
use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::state::BodyFrame;
use triad_scene::{IntegratorKind, Scene};

/// Tolerance of the run that errors are measured with.
const TIGHTEST: f64 = 1e-13;
/// Tolerance of the run that tells how far that can be trusted, where it need not be told closely.
const NEXT_TIGHTEST: f64 = 1e-12;
/// Part of the size of a quantity below which an error cannot be measured that way: both runs round.
const MEASURABLE: f64 = 3e-12;
/// How many times as far as two tight runs are apart an error must be to be measured by one of them, and the tolerance below which they
/// are by different methods: looser runs are much farther off.
const KNOWN: f64 = 3.0;
const NEAR_TIGHTEST: f64 = 3e-8;
/// Part of that size above which a run promises nothing: of the length of a mechanism, it says that it doubts the result.
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

/// What a run estimates the error of, the largest over all bodies or joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Centres of mass, m.
    Position,
    /// Directors, rad.
    Turn,
    /// Their velocities, m/s.
    Velocity,
    /// Angular velocities, rad/s.
    AngularVelocity,
    /// The kinetic plus potential energy, J.
    Energy,
    /// Forces of joints and drivers, N.
    Force,
    /// Their moments, N m.
    Moment,
}

/// All of them.
pub const QUANTITIES: [Quantity; 7] = [
    Quantity::Position,
    Quantity::Turn,
    Quantity::Velocity,
    Quantity::AngularVelocity,
    Quantity::Energy,
    Quantity::Force,
    Quantity::Moment,
];

/// An estimate, and the error that it estimates.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The scene.
    pub scene: String,
    /// Its tolerance.
    pub tolerance: f64,
    /// Time, s.
    pub time: f64,
    /// What was estimated; the following are in its unit.
    pub quantity: Quantity,
    /// Its size: the length of the mechanism, one radian, and of the others the largest that there was so far; of velocities and angular
    /// velocities, and of forces and moments, also what they make of each other over that length.
    pub size: f64,
    /// The estimate of its error.
    pub estimate: f64,
    /// That error.
    pub error: f64,
    /// How well that is known: how far two tight runs are apart, and of forces and moments also what rounding makes of them.
    pub unsure: f64,
}

impl Judged {
    /// Whether the estimate is within a factor of three of the error.
    pub fn is_good(&self) -> bool {
        (1.0 / GOOD..=GOOD).contains(&(self.estimate / self.error))
    }

    /// Whether it is below a tenth of the error.
    pub fn is_bad(&self) -> bool {
        self.estimate < BAD * self.error
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
    settings.compare_by(integrator, TIGHTEST);
    settings.error_estimate = false;
    tight
}

/// Judges the estimates of positions of a scene's run, where it makes them and its errors can be measured.
///
/// # Errors
///
/// [`EngineError`]: the scene cannot start. A run that cannot go on is judged up to there.
pub fn judge(scene: &Scene) -> Result<Vec<Judged>, EngineError> {
    let mut all = judge_all(scene)?;
    all.retain(|one| one.quantity == Quantity::Position);
    Ok(all)
}

/// The same of all quantities.
///
/// # Errors
///
/// Those of [`judge`].
pub fn judge_all(scene: &Scene) -> Result<Vec<Judged>, EngineError> {
    let by = |integrator| Simulation::new(&truth(scene, integrator));
    let (mut run, mut right) = (Simulation::new(scene)?, by(IntegratorKind::Auto)?);
    // Near it another method, so that the two do not err alike; where rows are redundant, series know no tolerance that tight, and two of
    // them would be the same run.
    let near = scene.simulation.tolerance < NEAR_TIGHTEST || !right.rank().dependent.is_empty();
    let mut other = if near {
        by(IntegratorKind::Dop853)?
    } else {
        Simulation::new(&truth(scene, IntegratorKind::Auto).tolerance(NEXT_TIGHTEST))?
    };
    run.set_step_limit(MOST_STEPS);
    right.set_step_limit(MOST_STEPS);
    other.set_step_limit(if near { MOST_STEPS_OF_OTHER } else { MOST_STEPS });
    let mut sizes = [run.system().length, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut judged = Vec::new();
    for k in 1..=MOMENTS {
        let time = run.duration() * f64::from(k) / f64::from(MOMENTS);
        if [&mut run, &mut right, &mut other].into_iter().any(|one| one.advance_to(time).is_err()) {
            break;
        }
        let Some(estimates) = estimates(&run) else { break };
        let true_numbers = Numbers::of(&right);
        let mut unsure = true_numbers.apart(&Numbers::of(&other));
        for (unsure, rounding) in unsure[5..].iter_mut().zip(rounded_reactions(&right, &true_numbers)) {
            *unsure = f64::max(*unsure, rounding);
        }
        let errors = true_numbers.apart(&Numbers::of(&run));
        true_numbers.raise(&mut sizes);
        if estimates[0] >= PROMISED * sizes[0] {
            continue;
        }
        for (k, quantity) in QUANTITIES.into_iter().enumerate() {
            let (size, estimate, error, unsure) = (sizes[k], estimates[k], errors[k], unsure[k]);
            if error > (MEASURABLE * size).max(KNOWN * unsure) && estimate < PROMISED * size {
                let (scene, tolerance) = (scene.name.clone(), scene.simulation.tolerance);
                judged.push(Judged { scene, tolerance, time, quantity, size, estimate, error, unsure });
            }
        }
    }
    Ok(judged)
}

/// What a rounding of each number of a run's state makes of its forces and moments: near singular positions, and where rows depend on
/// others, no run knows them better, and those that agree in all bits of their states only seem to.
fn rounded_reactions(run: &Simulation, numbers: &Numbers) -> [f64; 2] {
    let mut rounded = serde_json::to_value(run.snapshot()).unwrap_or_default();
    for (k, x) in rounded["state"].as_array_mut().into_iter().flatten().enumerate() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        *x = (x.as_f64().unwrap_or_default() * (1.0 + sign * f64::EPSILON)).into();
    }
    let view = serde_json::from_value(rounded).ok().and_then(|snapshot| run.at_snapshot(&snapshot));
    let reactions = view.map_or_else(Vec::new, |view| view.multipliers());
    let mut all = [0.0; 2];
    for (a, b) in numbers.reactions.iter().zip(&reactions) {
        for (all, apart) in all.iter_mut().zip([distance(a[0], b.force), distance(a[1], b.moment)]) {
            *all = f64::max(*all, apart);
        }
    }
    all
}

/// What a run estimates, by quantity.
fn estimates(run: &Simulation) -> Option<[f64; QUANTITIES.len()]> {
    let (state, reactions) = (run.error_estimate()?, run.reaction_errors()?);
    Some([
        state.position,
        state.turn,
        state.velocity,
        state.angular_velocity,
        state.energy,
        reactions.force,
        reactions.moment,
    ])
}

/// The numbers of a state.
struct Numbers {
    bodies: Vec<BodyFrame>,
    kinetic: f64,
    energy: f64,
    /// Force and moment of each joint.
    reactions: Vec<[[f64; 3]; 2]>,
}

impl Numbers {
    fn of(run: &Simulation) -> Self {
        let bodies = run.frame().bodies;
        let kinetic = bodies.iter().zip(&run.system().model.bodies);
        let kinetic = kinetic.map(|(body, of)| 0.5 * of.mass * square(body.velocity)).sum();
        let reactions = run.multipliers().iter().map(|joint| [joint.force, joint.moment]).collect();
        Self { bodies, kinetic, energy: run.summary().energy, reactions }
    }

    /// How far two states are apart, by quantity.
    fn apart(&self, other: &Self) -> [f64; QUANTITIES.len()] {
        let mut all = [0.0; QUANTITIES.len()];
        let mut raise = |k: usize, distance: f64| all[k] = f64::max(all[k], distance);
        for (a, b) in self.bodies.iter().zip(&other.bodies) {
            raise(0, distance(a.position, b.position));
            for (a, b) in [(a.u, b.u), (a.v, b.v), (a.w, b.w)] {
                raise(1, distance(a, b));
            }
            raise(2, distance(a.velocity, b.velocity));
            raise(3, distance(a.angular_velocity, b.angular_velocity));
        }
        raise(4, (self.energy - other.energy).abs());
        for (a, b) in self.reactions.iter().zip(&other.reactions) {
            raise(5, distance(a[0], b[0]));
            raise(6, distance(a[1], b[1]));
        }
        all
    }

    /// Raises the sizes of quantities that have none of their own.
    fn raise(&self, sizes: &mut [f64; QUANTITIES.len()]) {
        let mut raise = |k: usize, size: f64| sizes[k] = f64::max(sizes[k], size);
        for body in &self.bodies {
            raise(2, length(body.velocity));
            raise(3, length(body.angular_velocity));
        }
        raise(4, self.kinetic + self.energy.abs());
        for [force, moment] in &self.reactions {
            raise(5, length(*force));
            raise(6, length(*moment));
        }
        let [long, _, velocity, spin, _, force, moment] = *sizes;
        (sizes[2], sizes[3]) = (velocity.max(long * spin), spin.max(velocity / long));
        (sizes[5], sizes[6]) = (force.max(moment / long), moment.max(long * force));
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length([0, 1, 2].map(|k| a[k] - b[k]))
}

fn length(a: [f64; 3]) -> f64 {
    square(a).sqrt()
}

fn square(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum()
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
