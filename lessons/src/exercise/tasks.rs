//! Questions that are answered by work, checked and with their scenes read.

use super::context::{BuildContext, BuildError, build_error};
use super::question::{Implement, ModelTask, QuestionBody, Trajectory, Tuning};
use crate::files::{QuestionFile, ReferenceFile, ScoreBand, WatchFile};

/// Most coordinates of a mechanism whose equations a student's program evaluates.
const MAX_COORDINATES: usize = 120;

fn table<'a, T>(table: Option<&'a T>, name: &str) -> Result<&'a T, BuildError> {
    table.ok_or_else(|| build_error(format!("it has no table {name}"), format!("add [question.{name}]")))
}

pub(super) fn implement(question: &QuestionFile, context: &BuildContext) -> Result<QuestionBody, BuildError> {
    let file = table(question.implement.as_ref(), "implement")?;
    let scene = context.scene_of(file.scene.as_deref())?;
    let mut asks = file.asks.clone();
    asks.sort_unstable();
    asks.dedup();
    if asks.is_empty() || !(1..=20).contains(&file.states) || !(1e-12..=1e-2).contains(&file.tolerance) {
        return Err(build_error(
            "it asks for nothing, for too many states, or with an unusable tolerance",
            "give asks, 1 to 20 states and a tolerance between 1e-12 and 1e-2",
        ));
    }
    let coordinates = 12 * scene.bodies.len();
    if coordinates > MAX_COORDINATES {
        return Err(build_error(
            format!("its mechanism has {coordinates} coordinates"),
            "take at most ten bodies",
        ));
    }
    let (states, consistent, tolerance) = (file.states, file.consistent, file.tolerance);
    Ok(QuestionBody::Implement(Implement { scene, asks, states, consistent, tolerance }))
}

pub(super) fn trajectory(
    question: &QuestionFile,
    context: &BuildContext,
) -> Result<QuestionBody, BuildError> {
    let file = table(question.trajectory.as_ref(), "trajectory")?;
    let scene = context.scene_of(file.scene.as_deref())?;
    let falling = file.bands.windows(2).all(|w| w[0].error < w[1].error && w[0].share > w[1].share);
    let usable = |b: &ScoreBand| b.error > 0.0 && b.error < 1.0 && b.share > 0.0 && b.share <= 1.0;
    if !falling || !file.bands.iter().all(usable) || file.bands.first().is_none_or(|b| b.share != 1.0) {
        let remedy = "write bands = [{ error = 0.001, share = 1 }, { error = 0.01, share = 0.5 }]";
        return Err(build_error("its bands do not go from the best to the worst", remedy));
    }
    if file.columns.is_empty() || file.columns.len() > 12 || !(file.end > 0.0 && file.end <= 100.0) {
        return Err(build_error(
            "it has no columns, too many, or no end",
            "name 1 to 12 columns and an end up to 100 s",
        ));
    }
    if let Some((name, _)) = file.columns.iter().find(|(_, m)| m.component.is_none() || m.count.is_some()) {
        let remedy = "say component = \"x\", \"y\", \"z\" or \"size\"";
        return Err(build_error(format!("the column {name} is not one number"), remedy));
    }
    let (columns, bands) = (file.columns.clone(), file.bands.clone());
    Ok(QuestionBody::Trajectory(Trajectory { scene, end: file.end, columns, bands }))
}

pub(super) fn model(question: &QuestionFile, context: &BuildContext) -> Result<QuestionBody, BuildError> {
    let file = table(question.model.as_ref(), "model")?;
    if !file.reference.starts_with("reference/") {
        return Err(build_error("its reference is not below reference/", "what lies elsewhere may be shown"));
    }
    let reference = context.scene_of(Some(&file.reference))?;
    if !(1..=50).contains(&file.most_bodies) {
        return Err(build_error("most_bodies is not 1 to 50", "correct it"));
    }
    let latest = file.watches.iter().flat_map(|w| &w.times).fold(0.0f64, |a, t| a.max(*t));
    let usable = |w: &WatchFile| {
        !w.times.is_empty()
            && w.times.len() <= 50
            && w.times.iter().all(|t| (0.0..=60.0).contains(t))
            && w.tolerance > 0.0
            && w.tolerance < 0.5
            && w.measured.count.is_none()
    };
    if !file.watches.iter().all(usable) || latest > 60.0 {
        let remedy = "give times from 0 to 60 s and a tolerance between 0 and 0.5";
        return Err(build_error("a watch cannot be used", remedy));
    }
    Ok(QuestionBody::Model(ModelTask { reference, demands: file.clone() }))
}

pub(super) fn tuning(
    question: &QuestionFile,
    reference: &ReferenceFile,
    context: &BuildContext,
) -> Result<QuestionBody, BuildError> {
    let file = table(question.tuning.as_ref(), "tuning")?;
    let scene = context.scene_of(file.scene.as_deref())?;
    let settings = reference.settings.clone().ok_or_else(|| {
        build_error(
            "its reference has no settings",
            "add settings = { integrator = \"dop853\", tolerance = 1e-8 }",
        )
    })?;
    let sound = (1..=1_000_000).contains(&file.budget)
        && (1e-11..1.0).contains(&file.error)
        && file.violation.is_none_or(|violation| (1e-12..1.0).contains(&violation))
        && file.end > 0.0
        && file.end <= 100.0
        && !file.integrators.is_empty()
        && scene.bodies.len() <= 20;
    if !sound {
        let remedy = "budget 1 to 1000000, error 1e-11 to 1, violation 1e-12 to 1, end up to 100 s, at most 20 bodies, some integrators";
        return Err(build_error("its demands cannot be used", remedy));
    }
    let mut watch = file.watch.clone();
    watch.time = file.end;
    Ok(QuestionBody::Tuning(Tuning {
        scene,
        budget: file.budget,
        error: file.error,
        violation: file.violation,
        watch,
        integrators: file.integrators.clone(),
        baumgarte: file.baumgarte,
        reference: settings,
    }))
}
