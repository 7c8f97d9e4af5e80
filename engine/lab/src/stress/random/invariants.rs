//! What holds for every mechanism, however it was drawn.

use crate::stress::trial::kinetic_energy;
use crate::stress::{StressOutcome, StressVerdict, TrialMethod};
use nalgebra::Vector3;
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_linalg::larger_or_nan;
use triad_scene::{ConstraintMethod, Coordinates, IntegratorKind, Load, LoadFrame, Scene};

/// Steps of a random mechanism of half a second.
const STEPS: u64 = 20_000;
/// Deviation, relative to the size of the mechanism, that a tolerance of 1e-10 promises.
const GOOD: f64 = 1e-6;
/// Deviation that is still tolerable in an ill-conditioned mechanism.
const POOR: f64 = 1e-2;
/// The same for the balance of work.
const BALANCED: (f64, f64) = (1e-6, 1e-2);
/// The part of the total energy that counts as kinetic where nothing moves.
const STANDING: f64 = 1e-3;
/// Number of times at which a run is compared.
const COMPARISONS: u32 = 10;

/// Runs a mechanism and compares: balance of energy and work; full, reduced and mixed coordinates; another integrator; the way
/// back in time, where the mechanism is reversible; no NaN; bounded steps.
pub fn judge(scene: &Scene, method: &TrialMethod) -> StressOutcome {
    let mut scene = scene.clone();
    method.apply(&mut scene);
    let mut outcome = StressOutcome::nothing(StressVerdict::Survived, String::new());
    "balance of energy and work; other coordinates; another integrator; back in time"
        .clone_into(&mut outcome.reference);
    let mut findings = Findings { verdict: StressVerdict::Survived, words: Vec::new(), error: 0.0 };
    match watched(&scene, &mut outcome, &mut findings) {
        Ok(run) => {
            compare(&scene, &run, &mut findings);
            if reversible(&scene) && run.system().angles.is_empty() {
                back_in_time(&scene, &run, &mut findings);
            }
        }
        Err(error) => findings.refused(&error),
    }
    outcome.error = Some(findings.error);
    outcome.verdict = findings.verdict;
    outcome.reason = if findings.words.is_empty() {
        format!("all agree within {:.1e}", findings.error)
    } else {
        findings.words.join("; ")
    };
    outcome
}

/// What has been found so far.
struct Findings {
    verdict: StressVerdict,
    words: Vec<String>,
    error: f64,
}

impl Findings {
    fn measure(&mut self, what: &str, value: f64, (good, poor): (f64, f64)) {
        self.error = larger_or_nan(self.error, value);
        if value <= good {
            return;
        }
        self.verdict =
            self.verdict.max(if value <= poor { StressVerdict::Degraded } else { StressVerdict::Wrong });
        self.words.push(format!("{what} differs by {value:.1e}"));
    }

    /// An error is a right answer only if it names the cause; the start of every drawn mechanism satisfies its constraints.
    fn refused(&mut self, error: &EngineError) {
        let is_explained = error.cause().is_some() || error.code() == "motion-impossible";
        self.verdict =
            self.verdict.max(if is_explained { StressVerdict::Refused } else { StressVerdict::Wrong });
        self.words.push(error.to_string());
    }
}

/// Runs to the end; the engine accounts for the work of drivers and loads, so that its energy error is to vanish.
fn watched(
    scene: &Scene,
    outcome: &mut StressOutcome,
    findings: &mut Findings,
) -> Result<Simulation, EngineError> {
    let mut run = Simulation::new(scene)?;
    run.set_step_limit(STEPS);
    let (mut drift, mut kinetic, mut violation) = (0.0, 1e-3, 0.0);
    for look in 0..=COMPARISONS {
        let result = run.advance_to(run.duration() * f64::from(look) / f64::from(COMPARISONS));
        let summary = run.summary();
        (outcome.steps, outcome.rejected) = (summary.steps, summary.rejected);
        (outcome.evaluations, outcome.reached) = (summary.evaluations, run.reached());
        result?;
        drift = larger_or_nan(drift, summary.energy_drift.abs());
        // Structures that cannot move have no kinetic energy, but springs whose force times a tolerance is energy too.
        kinetic =
            larger_or_nan(larger_or_nan(kinetic, kinetic_energy(&run)), STANDING * summary.energy.abs());
        violation = larger_or_nan(violation, run.violation().relative);
    }
    outcome.energy_drift = Some(drift / kinetic);
    outcome.violation = Some(violation);
    findings.measure("the balance of energy and work", drift / kinetic, BALANCED);
    Ok(run)
}

/// Other coordinates and another integrator must give the same positions.
fn compare(scene: &Scene, run: &Simulation, findings: &mut Findings) {
    let all = |coordinates| {
        let mut other = scene.clone();
        other.bodies.iter_mut().for_each(|b| b.coordinates = Some(coordinates));
        other
    };
    let mut others = vec![
        ("full", all(Coordinates::Full)),
        ("reduced", all(Coordinates::Reduced)),
        ("shared", all(Coordinates::Shared)),
    ];
    if scene.simulation.constraint_method == ConstraintMethod::Projection {
        let mut other = scene.clone();
        let by_default = run.summary().integrator == IntegratorKind::Dop853;
        let integrator = if by_default { IntegratorKind::Dopri5 } else { IntegratorKind::Dop853 };
        other.simulation.integrator = integrator;
        others.push(("another integrator", other));
    }
    let here = run.frame();
    for (what, other) in others {
        let there = Simulation::new(&other).and_then(|mut other| {
            other.set_step_limit(10 * STEPS);
            other.advance_to(other.duration())?;
            Ok(other.frame())
        });
        match there {
            Ok(there) => {
                let distance = here.bodies.iter().zip(&there.bodies).map(|(a, b)| {
                    let apart = |x: [f64; 3], y: [f64; 3]| (Vector3::from(x) - Vector3::from(y)).norm();
                    apart(a.position, b.position).max(apart(a.u, b.u)).max(apart(a.v, b.v))
                });
                findings.measure(what, distance.fold(0.0, larger_or_nan), (GOOD, POOR));
            }
            Err(error) => {
                findings.refused(&error);
                findings.words.push(format!("with {what}"));
            }
        }
    }
}

/// Nothing drives, damps, or depends on the direction of time.
fn reversible(scene: &Scene) -> bool {
    scene.drivers.is_empty()
        && scene.simulation.constraint_method == ConstraintMethod::Projection
        && scene.loads.iter().all(|load| match load {
            Load::Force { frame, .. } | Load::Moment { frame, .. } => *frame == LoadFrame::World,
            Load::Spring { damping, .. } | Load::Torsion { damping, .. } | Load::Slider { damping, .. } => {
                *damping == 0.0
            }
        })
}

fn back_in_time(scene: &Scene, run: &Simulation, findings: &mut Findings) {
    let Ok(start) = Simulation::new(scene) else { return };
    let mut back = run.turned_back();
    back.set_step_limit(STEPS);
    match back.advance_to(back.duration()) {
        Ok(()) => {
            let apart = back.q().iter().zip(start.q()).map(|(a, b)| (a - b).abs()).fold(0.0, larger_or_nan);
            findings.measure("the start after the way back", apart, (GOOD, POOR));
        }
        Err(error) => {
            findings.refused(&error);
            findings.words.push("on the way back".to_owned());
        }
    }
}
