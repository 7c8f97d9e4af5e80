//! Predictions: written so that they can be given, and true of the run.

use std::collections::BTreeSet;

use super::findings::Findings;
use super::texts::short;
use crate::answers::TypedValue;
use crate::exercise::Parameters;
use crate::files::{PredictionFile, PredictionOptionFile};
use crate::lesson::{Course, line_of};
use crate::scenario::measure::{measure, start};
use triad_engine::scene::Scene;

/// Fewest and most options: what does not fit on a few buttons is no prediction.
const OPTIONS: std::ops::RangeInclusive<usize> = 2..=6;

/// A fault of a prediction.
fn fault(found: &mut Findings, id: &str, what: impl std::fmt::Display, remedy: &str) {
    let bytes = found.lesson.files.get("lesson.toml").map(Vec::as_slice).unwrap_or_default();
    let line = line_of(&String::from_utf8_lossy(bytes), id);
    found.add("lesson.toml", line, format!("prediction {id}: {what}"), remedy);
}

/// Names, texts and options of all predictions.
pub(super) fn written(course: &Course, found: &mut Findings) {
    let lesson = found.lesson;
    let mut ids = BTreeSet::new();
    let (some, excused) = (!lesson.about.predictions.is_empty(), !lesson.about.unpredicted.trim().is_empty());
    if some == excused {
        let what = if some { "there are predictions, and unpredicted too" } else { "nothing is predicted" };
        let remedy =
            "ask for a [[prediction]] that the run decides, or say why there is none: unpredicted = \"…\"";
        found.add("lesson.toml", 0, what, remedy);
    }
    for one in &lesson.about.predictions {
        let id = one.id.as_str();
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        if id.is_empty() || !id.chars().all(plain) || !ids.insert(id) {
            fault(
                found,
                id,
                "its id is used twice or not made of small letters, digits and dashes",
                "rename it",
            );
        }
        options(one, found);
        if !(one.points.is_finite() && one.points >= 0.0) {
            fault(found, id, "its points are negative", "give points for predicting, or none");
        }
        if !one.with.is_empty() && one.measured.is_none() {
            let remedy = "say in measured where the run with these numbers shows it";
            fault(found, id, "it sets parameters and measures nothing", remedy);
        }
        let duration = lesson.scene.pointer("/simulation/duration").and_then(serde_json::Value::as_f64);
        if !(0.0..=duration.unwrap_or(f64::INFINITY)).contains(&one.seen_at) {
            fault(found, id, "the run ends before seen_at", "give a time of the run, in seconds");
        }
        let texts = one.options.iter().map(|o| &o.text).chain([&one.text, &one.shows]);
        for text in texts {
            if text.trim().is_empty() {
                fault(found, id, "a text is empty", "write text, shows and the text of each option");
            }
            short(course, text, "lesson.toml", 0, found);
        }
    }
}

/// There are a few options with names of their own, and one of them comes true.
fn options(one: &PredictionFile, found: &mut Findings) {
    let ids: BTreeSet<&str> = one.options.iter().map(|o| o.id.as_str()).collect();
    if !OPTIONS.contains(&one.options.len()) || ids.len() < one.options.len() {
        fault(found, &one.id, "it has not 2 to 6 options with ids of their own", "add, join or rename some");
    }
    if !ids.contains(one.happens.as_str()) {
        fault(
            found,
            &one.id,
            format!("no option is called {}", one.happens),
            "let happens name what comes true",
        );
    }
    let ranges = one.options.iter().filter(|o| o.range.is_some()).count();
    let needed = if one.measured.is_some() { one.options.len() } else { 0 };
    if ranges != needed {
        fault(found, &one.id, "measured and ranges do not go together", "give every option a range, or none");
    }
}

/// What is said to come true does, in the run with the lesson's numbers.
pub(super) fn happen(found: &mut Findings) {
    let lesson = found.lesson;
    for one in &lesson.about.predictions {
        let Some(measured) = &one.measured else { continue };
        let value =
            Scene::from_json(&lesson.scene.to_string()).map_err(|e| e.to_string()).and_then(|scene| {
                let values = one.with.iter().map(|(name, value)| (name.as_str(), *value));
                let scene = scene.changed(values, []).map_err(|e| e.to_string())?;
                let mut run = start(&scene).map_err(|e| e.to_string())?;
                run.advance_to(measured.time).map_err(|e| e.to_string())?;
                measure(&scene, &run, measured).map_err(|e| e.to_string())
            });
        let [value] = match value.as_deref() {
            Ok([value]) => [*value],
            Ok(_) => {
                fault(found, &one.id, "a vector is measured", "say component = \"x\" or \"size\"");
                continue;
            }
            Err(problem) => {
                fault(found, &one.id, problem, "correct measured, or the scene");
                continue;
            }
        };
        let seen: Vec<&str> = one
            .options
            .iter()
            .filter(|o| holds(o, value, &lesson.parameters))
            .map(|o| o.id.as_str())
            .collect();
        if seen != [one.happens.as_str()] {
            let what = format!("the run shows {value}, which is in the range of {seen:?}");
            fault(found, &one.id, what, "correct happens or the ranges: each value belongs to one option");
        }
    }
}

/// Whether a value lies in the range of an option.
fn holds(option: &PredictionOptionFile, value: f64, parameters: &Parameters) -> bool {
    let number = |bound: &TypedValue| match bound {
        TypedValue::Number(number) => Some(*number),
        TypedValue::Text(text) => parameters.eval(text).ok(),
        TypedValue::List(_) => None,
    };
    let [Some(from), Some(to)] =
        option.range.as_ref().map_or([None, None], |r| [number(&r[0]), number(&r[1])])
    else {
        return false;
    };
    (from..to).contains(&value)
}
