//! Settings of a run under a budget: the run is made, its error and its work are measured and drawn.

use triad_engine::scene::{Scene, Stabilization};
use triad_engine::simulation::Simulation;

use super::Outcome;
use super::picture::{Picture, Point};
use crate::exercise::Tuning;
use crate::markdown::{escape, render_short};
use crate::measure::{measure, with_error};
use crate::number;
use crate::submission::{Answer, Entry, Settings};
use crate::tolerance::{norm, plain};
use crate::verdict::Mark;

/// A run is given up after so many times the budget.
const PATIENCE: u64 = 4;
/// Steps between two looks at the work.
const PIECE: u64 = 16;
/// Tolerances of the curves in the picture.
const CURVE: [f64; 8] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// What a run cost and how far it was off; no error if it did not come to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Made {
    evaluations: u64,
    error: Option<f64>,
}

/// Judges settings.
pub(super) fn judge(task: &Tuning, note: &str, answer: &Answer) -> Outcome {
    let Some(settings) = &answer.settings else {
        return Outcome::invalid(
            "This question asks for settings: an integrator, a tolerance, a stabilization.",
        );
    };
    let scene = match chosen(task, settings) {
        Ok(scene) => scene,
        Err(problem) => return Outcome::invalid(&problem),
    };
    let (reference, _) = match with_error(&task.scene, &task.watch) {
        Ok(reference) => reference,
        Err(problem) => return Outcome::invalid(&format!("The reference could not be run: {problem}.")),
    };
    let made = match make(task, &scene, &reference) {
        Ok(made) => made,
        Err(problem) => return failed(&problem),
    };
    let good_error = made.error.is_some_and(|e| e <= task.error);
    let good_work = made.evaluations <= task.budget;
    let told = told(task, made, good_error, good_work);
    let right = good_error && good_work;
    let picture = picture(task, settings, made, &reference, right);
    let share = match (good_error, good_work && made.error.is_some()) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        _ => 0.5,
    };
    if right {
        let html = format!("<p>Right.</p><p>{told}</p>{}", render_short(note));
        return Outcome { mark: Mark::Right, share, html, figure: Some(picture), ..Outcome::default() };
    }
    let slip = if good_error { "too-dear" } else { "too-coarse" };
    let advice = match (good_error, good_work) {
        (true, false) => "You bought more digits than were asked for, or bought them at the wrong place.",
        (false, true) => "There is money left: a tighter tolerance costs little for a method of high order.",
        _ => "Both are missed: with this method every further digit is too dear. Try another one.",
    };
    let html = format!("<p>Not yet.</p><p>{told}</p><p>{advice}</p>");
    Outcome { mark: Mark::Wrong, share, html, slip: Some(slip.to_owned()), figure: Some(picture) }
}

fn failed(problem: &str) -> Outcome {
    let html = format!("<p>Not yet.</p><p>With these settings the run stops: {}.</p>", escape(problem));
    Outcome::wrong(Some("stopped"), html)
}

fn told(task: &Tuning, made: Made, good_error: bool, good_work: bool) -> String {
    let than = |good: bool| if good { "not more than" } else { "more than" };
    let Some(error) = made.error else {
        let (most, budget) = (PATIENCE * task.budget, task.budget);
        return format!(
            "The run was stopped after {most} evaluations, {PATIENCE} times the budget of {budget}."
        );
    };
    format!(
        "Error {}, {} the {} that is allowed. {} evaluations, {} the budget of {}.",
        short(error),
        than(good_error),
        plain(task.error),
        made.evaluations,
        than(good_work),
        task.budget
    )
}

fn short(x: f64) -> String {
    format!("{x:.1e}")
}

/// The scene with the settings that were chosen, or what cannot be chosen.
fn chosen(task: &Tuning, settings: &Settings) -> Result<Scene, String> {
    if !task.integrators.contains(&settings.integrator) {
        let known = task.integrators.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        return Err(format!("There is no choice {}; choose one of {known}.", settings.integrator));
    }
    let tolerance = positive(&settings.tolerance, "The tolerance")?;
    if !(1e-13..=1e-1).contains(&tolerance) {
        return Err("The tolerance goes from 1e-13 to 0.1.".to_owned());
    }
    let stabilization = match &settings.baumgarte {
        None => Stabilization::Projection,
        Some(_) if !task.baumgarte => return Err("Baumgarte's stabilization is no choice here.".to_owned()),
        Some([alpha, beta]) => {
            let (alpha, beta) = (positive(alpha, "Alpha")?, positive(beta, "Beta")?);
            if alpha > 1e4 || beta > 1e4 {
                return Err("Alpha and beta go up to 10000 1/s.".to_owned());
            }
            Stabilization::Baumgarte { alpha, beta }
        }
    };
    let mut scene = task.scene.clone();
    // What a reader may change belongs to the settings as they were.
    scene.parameters.clear();
    scene.simulation.integrator = settings.integrator;
    scene.simulation.tolerance = tolerance;
    scene.simulation.stabilization = stabilization;
    scene.simulation.duration = task.watch.time;
    Ok(scene)
}

fn positive(entry: &Entry, what: &str) -> Result<f64, String> {
    let value = match entry {
        Entry::Number(x) => *x,
        Entry::Text(text) => number::read(text).map_err(|e| format!("{what}: {e}."))?.0.value,
        Entry::List(_) => return Err(format!("{what} is one number.")),
    };
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(format!("{what} is not negative.")) }
}

/// Makes the run, in pieces, and measures.
fn make(task: &Tuning, scene: &Scene, reference: &[f64]) -> Result<Made, String> {
    let mut simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    while !simulation.advance_towards(task.watch.time, PIECE).map_err(|e| e.to_string())? {
        let evaluations = simulation.summary().evaluations;
        if evaluations > PATIENCE * task.budget {
            return Ok(Made { evaluations, error: None });
        }
    }
    let evaluations = simulation.summary().evaluations;
    let value = measure(scene, &mut simulation, &task.watch)?;
    let difference: Vec<f64> = value.iter().zip(reference).map(|(a, b)| a - b).collect();
    Ok(Made { evaluations, error: Some(norm(&difference)) })
}

/// The run in the picture of work and precision; when the demand is met, with the curves of all choices.
fn picture(task: &Tuning, settings: &Settings, own: Made, reference: &[f64], curves: bool) -> String {
    let mut picture = Picture::new(task.budget, task.error);
    if curves {
        for kind in &task.integrators {
            let points = CURVE.iter().filter_map(|tolerance| {
                let settings =
                    Settings { integrator: *kind, tolerance: Entry::Number(*tolerance), baumgarte: None };
                let made = make(task, &chosen(task, &settings).ok()?, reference).ok()?;
                Some(Point { work: made.evaluations, error: made.error? })
            });
            picture.curve(&kind.to_string(), points.collect());
        }
    }
    if let Some(error) = own.error {
        picture.own(&settings.integrator.to_string(), Point { work: own.evaluations, error });
    }
    picture.svg()
}
