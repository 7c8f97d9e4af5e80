//! Trying out the questions that are answered by work: right, with every misconception, and with nothing done.

use std::fmt::Write as _;

use super::diagram;
use super::findings::Findings;
use super::programs::{self, TaskError};
use super::references::{file, judged};
use crate::answers::{Answer, RunSettings, TypedValue};
use crate::exercise::{ModelTask, Question, QuestionBody, Trajectory, Tuning};
use crate::scenario::measure::with_error;
use crate::tasks::trajectory::{ReferenceMotion, reference_csv};
use crate::verdict::Mark;

/// One question of these kinds.
pub(super) fn task(question: &Question, found: &mut Findings) {
    let id = question.id.as_str();
    let done = match &question.body {
        QuestionBody::Implement(task) => programs::program(found, id, task),
        QuestionBody::Trajectory(task) => trajectory(found, id, task),
        QuestionBody::Tuning(task) => tuning(found, id, task),
        QuestionBody::Diagram(task) => {
            diagram::mistakes(found, id, task);
            Ok(())
        }
        QuestionBody::Model(task) => {
            model(found, id, task);
            Ok(())
        }
        QuestionBody::Quantity(_)
        | QuestionBody::Choice { .. }
        | QuestionBody::Formula(_)
        | QuestionBody::Explanation(_) => Ok(()),
    };
    if let Err(problem) = done {
        found.question(id, problem, "correct the question or its scene");
    }
}

/// The reference must be far more precise than what is asked for.
fn tuning(found: &mut Findings, id: &str, task: &Tuning) -> Result<(), TaskError> {
    let (_, error) = with_error(&task.scene, &task.watch)?;
    if 10.0 * error > task.error {
        let what = format!("it asks for {:e}, its reference is off by up to {error:e}", task.error);
        found.question(id, what, "ask for at least ten times the error of the reference");
    }
    for (settings, what) in without_work(task) {
        let answer = Answer { settings: Some(settings), ..Answer::default() };
        if judged(found.lesson, id, answer).is_some_and(|given| given.share > 0.0) {
            let what = format!("{what} earns points");
            found.question(id, what, "tighten the error or the budget, or let the run be longer");
        }
    }
    Ok(())
}

/// Settings that nobody has thought about: the coarsest and the finest tolerance of each method, and the reference without
/// any stabilization.
fn without_work(task: &Tuning) -> Vec<(RunSettings, String)> {
    let plain = |integrator, tolerance: f64| RunSettings {
        integrator,
        tolerance: TypedValue::Number(tolerance),
        baumgarte: None,
    };
    let mut tried: Vec<(RunSettings, String)> = Vec::new();
    for integrator in &task.integrators {
        for tolerance in [1e-1, 1e-13] {
            tried.push((plain(*integrator, tolerance), format!("{integrator} at {tolerance:e}")));
        }
    }
    if task.baumgarte {
        let none = [TypedValue::Number(0.0), TypedValue::Number(0.0)];
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            for integrator in &task.integrators {
                let settings = RunSettings { baumgarte: Some(none.clone()), ..plain(*integrator, tolerance) };
                tried.push((settings, format!("no stabilization, {integrator} at {tolerance:e},")));
            }
        }
    }
    tried
}

/// Every demand has feedback, the joints that are demanded exist, and the scene that everybody has earns nothing.
fn model(found: &mut Findings, id: &str, task: &ModelTask) {
    if judged(found.lesson, id, file(found.lesson.scene.to_string())).is_some_and(|given| given.share > 0.0) {
        found.question(id, "the lesson's own scene earns points", "ask for another mechanism");
    }
    for watch in task.watches().iter().filter(|w| w.feedback.trim().is_empty()) {
        let what = format!("the watch \u{201c}{}\u{201d} has no feedback", watch.what);
        found.question(id, what, "write it");
    }
    let known = |kind: &str| {
        let written = serde_json::Value::String(kind.to_owned());
        serde_json::from_value::<triad_engine::scene::JointKind>(written).is_ok()
    };
    for kind in task.demands.joints.keys().filter(|kind| !known(kind)) {
        found.question(id, format!("there is no joint {kind}"), "name a type such as revolute");
    }
}

/// The error of the reference, and delays and factors that must be recognised as such.
fn trajectory(found: &mut Findings, id: &str, task: &Trajectory) -> Result<(), TaskError> {
    let motion = ReferenceMotion::new(task)?;
    let (best, worst) =
        (task.bands.first().map_or(0.0, |b| b.error), task.bands.last().map_or(0.0, |b| b.error));
    let error = motion.error(task)?;
    if 10.0 * error > best {
        let what = format!("its best band is {best:e}, its reference is off by up to {error:e}");
        found.question(id, what, "a band is at least ten times the error of the reference");
    }
    let thin = reference_csv(task, 400)?;
    let cases = [
        (thin, None, "the reference with 400 rows"),
        (shifted(task, &motion, 0.02 * task.end, 1.0), Some("phase"), "a delay"),
        (shifted(task, &motion, 0.0, 1.0 + 3.0 * worst + 0.05), Some("amplitude"), "a factor"),
        (shifted(task, &motion, 0.0, -1.0), Some("opposite-sign"), "the opposite sign"),
    ];
    for (text, misconception, what) in cases {
        let Some(given) = judged(found.lesson, id, file(text)) else { continue };
        // The opposite of a motion may be the motion half a period later: then it is called so.
        let fits = match misconception {
            None => given.mark == Mark::Right,
            Some("opposite-sign") => given.mark == Mark::Wrong,
            Some(_) => given.misconception.as_deref() == misconception,
        };
        if !fits {
            let got = given.misconception.unwrap_or_else(|| format!("{:?}", given.mark));
            found.question(id, format!("{what} is judged {got}"), "take another motion or other bands");
        }
    }
    Ok(())
}

/// Rows of a table that is sent.
const ROWS: i32 = 777;
/// Points from which the mean of a column is taken.
const MEAN_POINTS: i32 = 400;

/// The reference as a table, delayed and with other swings.
fn shifted(task: &Trajectory, motion: &ReferenceMotion, late: f64, factor: f64) -> String {
    let mut text = format!("t,{}\n", task.columns.keys().cloned().collect::<Vec<_>>().join(","));
    let mean = |column: usize| {
        let time = |k| task.end * f64::from(k) / f64::from(MEAN_POINTS);
        (0..=MEAN_POINTS).map(|k| motion.at(column, time(k))).sum::<f64>() / f64::from(MEAN_POINTS + 1)
    };
    let means: Vec<f64> = (0..task.columns.len()).map(mean).collect();
    for k in 0..=ROWS {
        let t = task.end * f64::from(k) / f64::from(ROWS);
        let _ = write!(text, "{t}");
        for (column, mean) in means.iter().enumerate() {
            let _ = write!(text, ",{}", mean + factor * (motion.at(column, t - late) - mean));
        }
        text.push('\n');
    }
    text
}
