//! A scene of the student's own, judged by what it does.

use std::sync::Arc;

use triad_engine::analysis::Wanted;
use triad_engine::analysis::check::{CheckReport, check};
use triad_engine::run::Simulation;
use triad_engine::scene::{ConstraintMethod, IntegratorKind, Scene, Settings};

use super::known::Known;
use crate::answers::Answer;
use crate::answers::tolerance::{distance, norm};
use crate::exercise::ModelTask;
use crate::files::WatchFile;
use crate::scenario::measure::MeasureError;
use crate::tasks::authors_model::{AuthorsModel, seen};
use crate::verdict::feedback::{Demand, DemandResult, Feedback, Judgement};
use crate::verdict::invalid::InvalidModel;

/// Integrator steps that a student's scene may take.
const MAX_STEPS: u64 = 20_000;
/// Joints, drivers and loads that it may have, for each body.
const CONNECTIONS_PER_BODY: usize = 6;
/// Tolerance at which it is run.
const TOLERANCE: f64 = 1e-9;
/// Smallest value that differences are compared with, SI.
const SMALLEST_SIZE: f64 = 1e-9;

/// Judges a scene.
pub(super) fn judge(
    task: &ModelTask,
    answer: &Answer,
    known: &Known,
    wanted: &Wanted,
) -> Result<Judgement, InvalidModel> {
    let text = answer.file.as_ref().ok_or(InvalidModel::NoFile)?;
    let (scene, report) = accepted(task, text)?;
    let author = known.models.of(task.clone(), wanted, |task| AuthorsModel::new(task).map(Arc::new));
    let demands = author.and_then(|author| compare(task, &author, &scene, &report));
    let demands = demands.map_err(InvalidModel::Reference)?;
    let met = demands.iter().filter(|d| d.met).count();
    if met == demands.len() {
        return Ok(Judgement::right(Feedback::Model { demands, note: Some(String::new()) }));
    }
    // A scene of another structure is another mechanism, whatever it shares with the one that is asked for.
    let (shown, structure): (Vec<&DemandResult>, Vec<&DemandResult>) =
        demands.iter().partition(|d| matches!(d.demand, Demand::Watch { .. }));
    let share = if structure.iter().all(|d| d.met) {
        shown.iter().filter(|d| d.met).count() as f64 / shown.len().max(1) as f64
    } else {
        0.0
    };
    let misconception = demands.iter().find(|d| !d.met).map(|d| d.demand.misconception());
    Ok(Judgement::wrong(share, misconception.as_deref(), Feedback::Model { demands, note: None }))
}

/// The scene, if it can be read, is within bounds and can be started.
fn accepted(task: &ModelTask, text: &str) -> Result<(Scene, CheckReport), InvalidModel> {
    let mut scene = Scene::from_json(text.trim_start_matches('\u{feff}')).map_err(Box::new)?;
    let (bodies, most) = (scene.bodies.len(), task.demands.most_bodies);
    if bodies > most {
        return Err(InvalidModel::Bodies { bodies, most });
    }
    let connections = scene.joints.len() + scene.drivers.len() + scene.loads.len();
    if connections > CONNECTIONS_PER_BODY * most {
        return Err(InvalidModel::Connections { connections });
    }
    let end = task.watches().iter().flat_map(|w| &w.times).fold(0.01, |a: f64, t| a.max(*t));
    // How it is run, and where it would be stopped, is no part of the mechanism.
    scene.events.clear();
    scene.simulation = Settings {
        duration: end,
        integrator: IntegratorKind::Auto,
        tolerance: TOLERANCE,
        constraint_method: ConstraintMethod::Projection,
        ..Settings::default()
    };
    let report = check(&scene).map_err(Box::new)?;
    Ok((scene, report))
}

/// What is demanded, side by side with the author's scene.
fn compare(
    task: &ModelTask,
    author: &AuthorsModel,
    scene: &Scene,
    report: &CheckReport,
) -> Result<Vec<DemandResult>, MeasureError> {
    let demands = &task.demands;
    let mut results = Vec::new();
    let mut add = |demand: Demand, met: bool| results.push(DemandResult { demand, met });
    if let Some(wanted) = author.degrees_of_freedom {
        let found = report.degrees_of_freedom;
        add(Demand::DegreesOfFreedom { found }, found == wanted);
    }
    if demands.no_redundancy {
        let joints: Vec<String> = report.redundant.iter().map(|r| r.joint.clone()).collect();
        let met = joints.is_empty();
        add(Demand::NoRedundancy { joints }, met);
    }
    for (kind, least) in &demands.joints {
        let found = scene.joints.iter().filter(|joint| joint.kind.to_string() == *kind).count();
        add(Demand::Joint { kind: kind.clone(), found }, found >= *least);
    }
    results.extend(watched(task, author, scene)?);
    Ok(results)
}

/// The motion and the reactions that are watched, side by side with the author's scene.
fn watched(
    task: &ModelTask,
    author: &AuthorsModel,
    scene: &Scene,
) -> Result<Vec<DemandResult>, MeasureError> {
    let mut simulation = Simulation::new(scene)?;
    simulation.set_step_limit(MAX_STEPS);
    let given = seen(task, scene, &mut simulation);
    let result = |(k, watch): (usize, &WatchFile)| {
        let (met, stopped) = match given.as_ref().map(|given| &given[k]) {
            Err(problem) | Ok(Err(problem)) => (false, Some(problem.clone())),
            Ok(Ok(given)) => (close(given, &author.seen[k], watch.tolerance), None),
        };
        let (what, feedback) = (watch.what.clone(), watch.feedback.clone());
        DemandResult { demand: Demand::Watch { number: k + 1, what, feedback, stopped }, met }
    };
    Ok(task.watches().iter().enumerate().map(result).collect())
}

/// Whether all differences are small beside the largest value.
fn close(given: &[Vec<f64>], own: &[Vec<f64>], tolerance: f64) -> bool {
    let size = own.iter().map(|v| norm(v)).fold(0.0, f64::max).max(SMALLEST_SIZE);
    given.len() == own.len()
        && given.iter().zip(own).all(|(a, b)| a.len() == b.len() && distance(a, b) <= tolerance * size)
}
