//! Settings of a run under a budget: the run is made, its error and its work are measured and drawn.

use triad_engine::analysis::Wanted;
use triad_engine::run::Simulation;
use triad_engine::scene::{ConstraintMethod, IntegratorKind, Scene};

use super::known::{Known, Made, Run};
use super::picture::{Picture, Point};
use crate::answers::number::{self, NumberError};
use crate::answers::tolerance::distance;
use crate::answers::{Answer, RunSettings, TypedValue};
use crate::exercise::Tuning;
use crate::files::MeasuredFile;
use crate::scenario::measure::{MeasureError, measure, tight};
use crate::text::shorten;
use crate::verdict::feedback::{Feedback, Judgement, TuningFeedback};
use crate::verdict::invalid::InvalidSettings;

/// A run ends after this many times the budget of evaluations.
const BUDGETS: u64 = 4;
/// A run that is precise earns half its points up to this many times the budget.
const NEARLY: u64 = 2;
/// Steps between two checks of the budget.
const STEPS_PER_CHECK: u64 = 16;
/// Units that alpha and beta may be given in.
const PER_SECOND: [&str; 4] = ["1/s", "s^-1", "s^(-1)", "rad/s"];
/// Tolerances of the curves in the picture.
const CURVE: [f64; 8] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// What a run cost and how far it was off; no error if it did not come to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RunCost {
    evaluations: u64,
    error: Option<f64>,
    /// How far the constraints are violated at the end.
    violation: f64,
}

/// Judges settings, as long as that is wanted.
pub(super) fn judge(
    task: &Tuning,
    answer: &Answer,
    known: &Known,
    wanted: &Wanted,
) -> Result<Judgement, InvalidSettings> {
    let settings = answer.settings.as_ref().ok_or(InvalidSettings::NoSettings)?;
    let scene = chosen(task, settings)?;
    let run = |(scene, watch): &(Scene, MeasuredFile)| tight(scene, watch);
    let reference = known.references.of((task.scene.clone(), task.watch.clone()), wanted, run);
    let reference = reference.map_err(InvalidSettings::Reference)?;
    let cost = match cost(task, scene, &reference, known, wanted) {
        Ok(cost) => cost,
        Err(problem) => {
            return Ok(Judgement::wrong(0.0, Some("stopped"), Feedback::TuningStopped { problem }));
        }
    };
    let feedback = TuningFeedback {
        evaluations: cost.evaluations,
        budget: task.budget,
        most: BUDGETS * task.budget,
        error: cost.error,
        allowed: task.error,
        violation: task.violation.map(|allowed| [cost.violation, allowed]),
        stabilized: settings.baumgarte.is_some(),
        note: String::new(),
    };
    let (precise, cheap) = (feedback.is_precise(), feedback.is_cheap() && cost.error.is_some());
    let drifted = feedback.has_drifted();
    let curves = if precise && cheap { curves(task, &reference, known, wanted) } else { Vec::new() };
    let figure = Some(picture(task, settings, cost, curves));
    let feedback = Feedback::Tuning(feedback);
    let judgement = match (precise, cheap) {
        (true, true) => Judgement::right(feedback),
        // The finest tolerance is precise without a thought, the coarsest cheap: only what comes near to both earns a share.
        (true, false) if cost.evaluations <= NEARLY * task.budget => {
            Judgement::wrong(0.5, Some("too-dear"), feedback)
        }
        (true, false) => Judgement::wrong(0.0, Some("too-dear"), feedback),
        (false, _) if drifted => Judgement::wrong(0.0, Some("drifted"), feedback),
        (false, _) => Judgement::wrong(0.0, Some("too-coarse"), feedback),
    };
    Ok(Judgement { figure, ..judgement })
}

/// The scene with the settings that were chosen, or what cannot be chosen.
fn chosen(task: &Tuning, settings: &RunSettings) -> Result<Scene, InvalidSettings> {
    if !task.integrators.contains(&settings.integrator) {
        let known = task.integrators.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        return Err(InvalidSettings::Integrator { integrator: settings.integrator.to_string(), known });
    }
    let tolerance = positive(&settings.tolerance, "The tolerance", &[])?;
    if !(1e-13..=1e-1).contains(&tolerance) {
        return Err(InvalidSettings::ToleranceRange);
    }
    let constraint_method = match &settings.baumgarte {
        None => ConstraintMethod::Projection,
        Some(_) if !task.baumgarte => return Err(InvalidSettings::NoBaumgarte),
        Some([alpha, beta]) => {
            let (alpha, beta) =
                (positive(alpha, "Alpha", &PER_SECOND)?, positive(beta, "Beta", &PER_SECOND)?);
            if alpha > 1e4 || beta > 1e4 {
                return Err(InvalidSettings::BaumgarteRange);
            }
            ConstraintMethod::Baumgarte { alpha, beta }
        }
    };
    let mut scene = task.scene.clone();
    // What a reader may change belongs to the settings as they were.
    scene.parameters.clear();
    scene.simulation.integrator = settings.integrator;
    scene.simulation.tolerance = tolerance;
    scene.simulation.constraint_method = constraint_method;
    scene.simulation.duration = task.watch.time;
    Ok(scene)
}

/// A number that is not negative, without a unit or with one that says nothing new.
fn positive(entry: &TypedValue, what: &'static str, units: &[&str]) -> Result<f64, InvalidSettings> {
    let value = match entry {
        TypedValue::Number(x) => *x,
        TypedValue::Text(text) => {
            let refused = |error| InvalidSettings::Number { what, error };
            let (number, unit) = number::read(text).map_err(refused)?;
            if !unit.is_empty() && !units.contains(&unit.as_str()) {
                return Err(refused(NumberError::NotANumber { text: shorten(text) }));
            }
            number.value
        }
        TypedValue::List(_) => return Err(InvalidSettings::List { what }),
    };
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(InvalidSettings::Negative { what }) }
}

/// What the run costs and how far it is off.
fn cost(
    task: &Tuning,
    scene: Scene,
    reference: &[f64],
    known: &Known,
    wanted: &Wanted,
) -> Result<RunCost, MeasureError> {
    let run = Run { scene, watch: task.watch.clone(), most: BUDGETS * task.budget };
    let made = known.runs.of(run, wanted, |run| make(run, wanted))?;
    let error = made.value.map(|value| distance(&value, reference));
    Ok(RunCost { evaluations: made.evaluations, error, violation: made.violation })
}

/// Makes the run, in pieces, as long as it is wanted, and measures.
fn make(run: &Run, wanted: &Wanted) -> Result<Made, MeasureError> {
    let mut simulation = Simulation::new(&run.scene)?;
    while !simulation.advance_towards(run.watch.time, STEPS_PER_CHECK)? {
        let evaluations = simulation.summary().evaluations;
        if evaluations > run.most || !wanted.is_still() {
            return Ok(Made { evaluations, value: None, violation: f64::INFINITY });
        }
    }
    let summary = simulation.summary();
    Ok(Made {
        evaluations: summary.evaluations,
        value: Some(measure(&run.scene, &simulation, &run.watch)?),
        violation: summary.position_violation,
    })
}

/// The curves of all choices, by the names of the integrators.
fn curves(task: &Tuning, reference: &[f64], known: &Known, wanted: &Wanted) -> Vec<(String, Vec<Point>)> {
    let point = |integrator: IntegratorKind, tolerance: f64| {
        let tolerance = TypedValue::Number(tolerance);
        let settings = RunSettings { integrator, tolerance, baumgarte: None };
        let made = cost(task, chosen(task, &settings).ok()?, reference, known, wanted).ok()?;
        Some(Point { work: made.evaluations, error: made.error? })
    };
    let curve = |kind: &IntegratorKind| {
        (kind.to_string(), CURVE.iter().filter_map(|tolerance| point(*kind, *tolerance)).collect())
    };
    task.integrators.iter().map(curve).collect()
}

/// The run in the picture of work and precision, with the curves of all choices.
fn picture(task: &Tuning, settings: &RunSettings, own: RunCost, curves: Vec<(String, Vec<Point>)>) -> String {
    let mut picture = Picture::new(task.budget, task.error);
    for (name, points) in curves {
        picture.curve(&name, points);
    }
    if let Some(error) = own.error {
        picture.own(&settings.integrator.to_string(), Point { work: own.evaluations, error });
    }
    picture.svg()
}
