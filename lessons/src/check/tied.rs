//! Holding references to the scene: its numbers are read from it, so that nobody edits one without the other.

use serde_json::Value;

use super::findings::Findings;
use crate::answers::TypedValue;
use crate::exercise::QuestionBody;
use crate::files::{ProvenanceKind, ReferenceFile};

/// Where in a scene nothing is that a reference rests on: pictures, the run, and what is only shown.
const BESIDE: [&str; 6] = ["shape", "view", "simulation", "outputs", "parameters", "plots"];

/// Each number of the scene that stands in a reference which nothing measures is read from the scene.
pub(super) fn all(found: &mut Findings) {
    let lesson = found.lesson;
    let mut shown = Vec::new();
    collect(&lesson.scene, &mut String::new(), &mut shown);
    for question in &lesson.exercise.questions {
        let Some(reference) = lesson.sources.references.get(&question.id) else { continue };
        idle(&question.id, reference, found);
        let QuestionBody::Quantity(q) = &question.body else { continue };
        let is_shown = question.measured.is_some() || question.provenance == ProvenanceKind::Engine;
        if is_shown || q.tolerance.is_exact() || reference.apart {
            continue;
        }
        for number in written(reference).into_iter().filter(|x| is_telling(*x)) {
            let same = |(_, value): &&(String, f64)| value.abs().to_bits() == number.to_bits();
            let Some((place, value)) = shown.iter().find(same) else { continue };
            let sign = if *value < 0.0 { "-" } else { "" };
            found.question(
                &question.id,
                format!("{number} stands in its reference and at {place} in scene.json"),
                format!(
                    "name it, scene = {{ name = \"{sign}{place}\" }}, or say apart = true where they only happen to be the same"
                ),
            );
        }
    }
}

/// A number that is named is used.
fn idle(id: &str, reference: &ReferenceFile, found: &mut Findings) {
    // What the symbols of a formula stand for is used by their comparison.
    let Some(question) = found.lesson.question(id) else { return };
    if matches!(question.body, QuestionBody::Formula(_)) {
        return;
    }
    let mut texts = Vec::new();
    expressions(reference.value.as_ref(), &mut texts);
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let used: Vec<&str> = texts.iter().flat_map(|text| text.split(|c| !is_of_word(c))).collect();
    for name in reference.scene.keys().filter(|name| !used.contains(&name.as_str())) {
        found.question(id, format!("its reference names {name} and does not use it"), "use it or remove it");
    }
}

fn expressions<'a>(value: Option<&'a TypedValue>, texts: &mut Vec<&'a str>) {
    match value {
        Some(TypedValue::Text(text)) => texts.push(text),
        Some(TypedValue::List(list)) => list.iter().for_each(|one| expressions(Some(one), texts)),
        Some(TypedValue::Number(_)) | None => {}
    }
}

/// The numbers that are written in a reference.
fn written(reference: &ReferenceFile) -> Vec<f64> {
    let mut texts = Vec::new();
    expressions(reference.value.as_ref(), &mut texts);
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    texts
        .iter()
        .flat_map(|text| text.split(|c| !is_of_word(c)))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_digit()))
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// Whether it says something that two things have a number in common: quarters and powers of ten stand everywhere.
fn is_telling(number: f64) -> bool {
    let is_power_of_ten = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6].contains(&number);
    (number * 4.0).fract() != 0.0 && !is_power_of_ten
}

/// The numbers of a scene with their places.
fn collect(value: &Value, place: &mut String, shown: &mut Vec<(String, f64)>) {
    let length = place.len();
    match value {
        Value::Number(number) => shown.extend(number.as_f64().map(|number| (place.clone(), number))),
        Value::Object(keys) => {
            for (key, inner) in keys.iter().filter(|(key, _)| !BESIDE.contains(&key.as_str())) {
                place.push('/');
                place.push_str(key);
                collect(inner, place, shown);
                place.truncate(length);
            }
        }
        Value::Array(list) => {
            for (at, inner) in list.iter().enumerate() {
                place.extend(["/", &at.to_string()]);
                collect(inner, place, shown);
                place.truncate(length);
            }
        }
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}
