//! A scene of the student's own, judged by what it does.

use triad_engine::check::{CheckReport, check};
use triad_engine::scene::{IntegratorKind, Scene, Settings, Stabilization};
use triad_engine::simulation::Simulation;

use super::Outcome;
use crate::exercise::ModelTask;
use crate::files::WatchFile;
use crate::markdown::{escape, render_short};
use crate::measure::{measure, reference_scenes, start};
use crate::submission::Answer;
use crate::tolerance::norm;
use crate::verdict::Mark;

/// Integrator steps that a student's scene may take.
const MOST_STEPS: u64 = 20_000;
/// Joints, drivers and loads that it may have, for each body.
const CONNECTIONS_PER_BODY: usize = 6;
/// Tolerance at which it is run.
const TOLERANCE: f64 = 1e-9;

/// One thing that was looked at.
struct Looked {
    /// In words.
    what: String,
    good: bool,
    /// What to say if it is not good, as HTML.
    html: String,
    slip: String,
}

/// Judges a scene.
pub(super) fn judge(task: &ModelTask, note: &str, answer: &Answer) -> Outcome {
    let Some(text) = &answer.file else {
        return Outcome::invalid("This question asks for a scene, as the text of its JSON file.");
    };
    let (scene, report) = match accepted(task, text) {
        Ok(accepted) => accepted,
        Err(problem) => return Outcome::invalid(&problem),
    };
    let looked = match look(task, &scene, &report) {
        Ok(looked) => looked,
        Err(problem) => return Outcome::invalid(&format!("The author's scene does not run: {problem}.")),
    };
    let good = looked.iter().filter(|l| l.good).count();
    let list: Vec<String> = looked
        .iter()
        .map(|l| {
            let (sign, after) = if l.good { ("✓", String::new()) } else { ("✗", l.html.clone()) };
            format!("<li>{sign} {}{after}</li>", escape(&l.what))
        })
        .collect();
    let list = format!("<ul class=\"checks\">{}</ul>", list.concat());
    if good == looked.len() {
        let html = format!("<p>Right.</p>{list}{}", render_short(note));
        return Outcome { mark: Mark::Right, share: 1.0, html, ..Outcome::default() };
    }
    Outcome {
        mark: Mark::Wrong,
        share: good as f64 / looked.len() as f64,
        html: format!("<p>{good} of {} demands are met.</p>{list}", looked.len()),
        slip: looked.iter().find(|l| !l.good).map(|l| l.slip.clone()),
        ..Outcome::default()
    }
}

/// The scene, if it can be read, is within bounds and can be started.
fn accepted(task: &ModelTask, text: &str) -> Result<(Scene, CheckReport), String> {
    let mut scene = Scene::from_json(text).map_err(|e| format!("The scene cannot be read: {e}."))?;
    let (bodies, most) = (scene.bodies.len(), task.demands.most_bodies);
    if bodies > most {
        return Err(format!("The scene has {bodies} bodies; at most {most} are run here."));
    }
    let connections = scene.joints.len() + scene.drivers.len() + scene.loads.len();
    if connections > CONNECTIONS_PER_BODY * most {
        return Err(format!(
            "The scene has {connections} joints, drivers and loads; that is more than is run here."
        ));
    }
    let end = task.watches().iter().flat_map(|w| &w.times).fold(0.01, |a: f64, t| a.max(*t));
    scene.simulation = Settings {
        duration: end,
        integrator: IntegratorKind::Auto,
        tolerance: TOLERANCE,
        stabilization: Stabilization::Projection,
        ..scene.simulation
    };
    let report = check(&scene).map_err(|e| format!("The scene is refused: {e}."))?;
    Ok((scene, report))
}

fn look(task: &ModelTask, scene: &Scene, report: &CheckReport) -> Result<Vec<Looked>, String> {
    let demands = &task.demands;
    let mut looked = Vec::new();
    if demands.degrees_of_freedom {
        let wanted = check(&task.reference).map_err(|e| e.to_string())?.degrees_of_freedom;
        let has = report.degrees_of_freedom;
        looked.push(Looked {
            what: "the number of degrees of freedom".to_owned(),
            good: has == wanted,
            html: format!("<p>Your scene has {has}. Count bodies and rows of the joints again.</p>"),
            slip: "degrees-of-freedom".to_owned(),
        });
    }
    if demands.no_redundancy {
        let joints = report.redundant.iter().map(|r| r.joint.as_str()).collect::<Vec<_>>().join(", ");
        looked.push(Looked {
            what: "no redundant rows".to_owned(),
            good: joints.is_empty(),
            html: format!("<p>Rows of these joints say what others say already: {}.</p>", escape(&joints)),
            slip: "redundant".to_owned(),
        });
    }
    for (kind, least) in &demands.joints {
        let of_kind = |j: &&triad_engine::scene::Joint| {
            serde_json::to_value(j.kind).is_ok_and(|word| word.as_str() == Some(kind.as_str()))
        };
        let has = scene.joints.iter().filter(of_kind).count();
        looked.push(Looked {
            what: format!("a {kind} joint is used"),
            good: has >= *least,
            html: format!("<p>Your scene has {has} of this type.</p>"),
            slip: format!("joint-{kind}"),
        });
    }
    looked.extend(watched(task, scene)?);
    Ok(looked)
}

/// The motion and the reactions that are watched, side by side with the author's scene.
fn watched(task: &ModelTask, scene: &Scene) -> Result<Vec<Looked>, String> {
    let mut times: Vec<f64> = task.watches().iter().flat_map(|w| w.times.clone()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let end = times.last().copied().unwrap_or(0.0);
    let [reference, _] = reference_scenes(&task.reference, end);
    let own = run(&reference, &times, task.watches(), &mut start(&reference)?)?;
    let mut simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    simulation.set_step_limit(MOST_STEPS);
    let given = run(scene, &times, task.watches(), &mut simulation);
    let mut looked = Vec::new();
    for (k, watch) in task.watches().iter().enumerate() {
        let (good, html) = match &given {
            Err(problem) => (false, format!("<p>{}.</p>", escape(problem))),
            Ok(given) => (close(&given[k], &own[k], watch.tolerance), render_short(&watch.feedback)),
        };
        looked.push(Looked { what: watch.what.clone(), good, html, slip: format!("watch-{}", k + 1) });
    }
    Ok(looked)
}

/// What each watch sees, at its own times.
fn run(
    scene: &Scene,
    times: &[f64],
    watches: &[WatchFile],
    simulation: &mut Simulation,
) -> Result<Vec<Vec<Vec<f64>>>, String> {
    let mut seen = vec![Vec::new(); watches.len()];
    for t in times {
        simulation.advance_to(*t).map_err(|e| e.to_string())?;
        for (seen, watch) in seen.iter_mut().zip(watches).filter(|(_, w)| w.times.contains(t)) {
            seen.push(measure(scene, simulation, &watch.measured)?);
        }
    }
    Ok(seen)
}

/// Whether all differences are small beside the largest value.
fn close(given: &[Vec<f64>], own: &[Vec<f64>], tolerance: f64) -> bool {
    let size = own.iter().map(|v| norm(v)).fold(0.0, f64::max).max(1e-9);
    given.len() == own.len()
        && given.iter().zip(own).all(|(a, b)| {
            let difference: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
            a.len() == b.len() && norm(&difference) <= tolerance * size
        })
}
