//! One run of one scene, and the judgement on it.

use super::case::{StressOutcome, StressVerdict, TrialMethod};
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_linalg::larger_or_nan;
use triad_scene::Scene;

/// Steps that a run is given unless it asks for more.
const STEPS: u64 = 200_000;
/// Relative violation above which a run with projection counts as degraded.
const LOOSE: f64 = 1e-8;

/// Measures the shown state: its deviation from the reference, relative to the reference's size.
type Measure<'a> = Box<dyn FnMut(&Simulation) -> f64 + 'a>;

/// A scene, what it is compared with, and which error is good, and which still tolerable.
pub struct Trial<'a> {
    scene: Scene,
    reference: String,
    measure: Option<Measure<'a>>,
    good: f64,
    poor: f64,
    samples: u32,
    steps: u64,
    max_steps: u64,
    max_bodies: usize,
    conserves: Option<(f64, f64)>,
}

impl<'a> Trial<'a> {
    /// A scene that is to be run under a method.
    pub fn new(mut scene: Scene, method: &TrialMethod) -> Self {
        method.apply(&mut scene);
        Self {
            scene,
            reference: String::new(),
            measure: None,
            good: 0.0,
            poor: 0.0,
            samples: 40,
            steps: STEPS,
            max_steps: method.max_steps.unwrap_or(u64::MAX),
            max_bodies: method.max_bodies.unwrap_or(usize::MAX),
            conserves: None,
        }
    }

    /// Compares with a reference: an error up to `good` is survived, up to `poor` degraded, above it wrong.
    #[must_use]
    pub fn against(
        mut self,
        reference: &str,
        (good, poor): (f64, f64),
        measure: impl FnMut(&Simulation) -> f64 + 'a,
    ) -> Self {
        reference.clone_into(&mut self.reference);
        self.measure = Some(Box::new(measure));
        (self.good, self.poor) = (good, poor);
        self
    }

    /// Demands that energy is conserved: a drift, relative to the largest kinetic energy, up to the first number is
    /// survived, up to the second degraded, above it wrong.
    #[must_use]
    pub fn conserving(mut self, bounds: (f64, f64)) -> Self {
        self.conserves = Some(bounds);
        if self.reference.is_empty() {
            "energy".clone_into(&mut self.reference);
        }
        self
    }

    /// At how many times the run is compared.
    #[must_use]
    pub fn sampled(mut self, samples: u32) -> Self {
        self.samples = samples;
        self
    }

    /// Steps after which the run is stopped.
    #[must_use]
    pub fn within(mut self, steps: u64) -> Self {
        self.steps = steps;
        self
    }

    /// Runs and judges.
    pub fn run(self) -> StressOutcome {
        let refused = |why: String, reference: String| StressOutcome {
            reference,
            ..StressOutcome::nothing(StressVerdict::Refused, why)
        };
        if self.scene.bodies.len() > self.max_bodies {
            let why = format!(
                "not tried: its matrices are full, and more than {} bodies too many",
                self.max_bodies
            );
            return refused(why, self.reference);
        }
        match Simulation::new(&self.scene) {
            Ok(simulation) => self.watch(simulation),
            Err(error) => refused(error.to_string(), self.reference),
        }
    }

    fn watch(mut self, mut simulation: Simulation) -> StressOutcome {
        simulation.set_step_limit(self.steps.min(self.max_steps));
        let mut outcome = StressOutcome::nothing(StressVerdict::Survived, String::new());
        outcome.reference = std::mem::take(&mut self.reference);
        let (mut drift, mut kinetic) = (0.0f64, f64::MIN_POSITIVE);
        let mut stopped = None;
        for sample in 0..=self.samples {
            let time = simulation.duration() * f64::from(sample) / f64::from(self.samples.max(1));
            if let Err(error) = simulation.advance_to(time) {
                stopped = Some(error);
                break;
            }
            if let Some(measure) = &mut self.measure {
                outcome.error = Some(larger_or_nan(outcome.error.unwrap_or(0.0), measure(&simulation)));
            }
            let summary = simulation.summary();
            drift = larger_or_nan(drift, summary.energy_drift.abs());
            kinetic = kinetic.max(kinetic_energy(&simulation));
            let open = simulation.violation().relative;
            outcome.violation = Some(larger_or_nan(outcome.violation.unwrap_or(0.0), open));
        }
        let summary = simulation.summary();
        outcome.steps = summary.steps;
        outcome.rejected = summary.rejected;
        outcome.evaluations = summary.evaluations;
        outcome.reached = summary.time;
        if self.conserves.is_some() {
            outcome.energy_drift = Some(drift / kinetic);
        }
        self.judge(&mut outcome, stopped.as_ref(), &summary.doubts);
        outcome
    }

    fn judge(&self, outcome: &mut StressOutcome, stopped: Option<&EngineError>, doubts: &[String]) {
        let mut verdict = StressVerdict::Survived;
        let mut reasons = Vec::new();
        let mut blame = |what: &str, value: Option<f64>, good: f64, poor: f64| {
            let Some(value) = value else { return };
            // Not a number is above any bound.
            let found = if value <= good {
                return;
            } else if value <= poor {
                StressVerdict::Degraded
            } else {
                StressVerdict::Wrong
            };
            verdict = verdict.max(found);
            reasons.push(format!("{what} {value:.1e} is above {good:.0e}"));
        };
        blame("the error", outcome.error, self.good, self.poor);
        if let Some((good, poor)) = self.conserves {
            blame("the energy drift", outcome.energy_drift, good, poor);
        }
        blame("the violation", outcome.violation, LOOSE, f64::MAX);
        match stopped {
            Some(error) if verdict < StressVerdict::Wrong => {
                verdict = StressVerdict::Refused;
                reasons.insert(0, error.to_string());
            }
            Some(error) => reasons.push(format!("then it stopped: {error}")),
            None => {}
        }
        if verdict == StressVerdict::Wrong && !doubts.is_empty() {
            verdict = StressVerdict::Warned;
            reasons.push(format!("it says: {}", doubts.join("; ")));
        }
        if reasons.is_empty() {
            let error = outcome.error.or(outcome.energy_drift).unwrap_or(0.0);
            reasons.push(format!("agrees within {error:.1e}"));
        }
        outcome.verdict = verdict;
        outcome.reason = reasons.join("; ");
    }
}

/// A scene that must be refused with an error of one of the given codes (`a|b`) that names all of `names`.
pub fn must_be_refused(scene: &Scene, method: &TrialMethod, code: &str, names: &[&str]) -> StressOutcome {
    let mut scene = scene.clone();
    method.apply(&mut scene);
    let reference = format!("must be refused as {code}, naming {}", names.join(" and "));
    let mut outcome = StressOutcome::nothing(StressVerdict::Wrong, "it ran to its end".to_owned());
    let error = match Simulation::new(&scene) {
        Err(error) => Some(error),
        Ok(mut simulation) => {
            simulation.set_step_limit(STEPS);
            let end = simulation.duration();
            let error = simulation.advance_to(end).err();
            outcome.reached = simulation.reached();
            outcome.steps = simulation.summary().steps;
            error
        }
    };
    if let Some(error) = error {
        let text = error.to_string();
        let names_all = names.iter().all(|name| text.contains(name));
        let true_reason = code.split('|').any(|code| code == error.code()) && names_all;
        outcome.verdict = if true_reason { StressVerdict::Refused } else { StressVerdict::Wrong };
        outcome.reason = if true_reason { text } else { format!("{}: {text}", error.code()) };
    }
    outcome.reference = reference;
    outcome
}

/// Kinetic energy from the bodies as they are shown, J.
pub fn kinetic_energy(simulation: &Simulation) -> f64 {
    let frame = simulation.frame();
    let mut sum = 0.0;
    for (shown, body) in frame.bodies.iter().zip(&simulation.model().bodies) {
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let omega = shown.angular_velocity;
        let turning: f64 = [shown.u, shown.v, shown.w]
            .iter()
            .zip(body.principal.iter())
            .map(|(axis, moment)| (moment, dot(axis, &omega)))
            .map(|(moment, rate)| moment * rate * rate)
            .sum();
        sum += 0.5 * (body.mass * dot(&shown.velocity, &shown.velocity) + turning);
    }
    sum
}
