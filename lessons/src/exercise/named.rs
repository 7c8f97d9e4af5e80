//! Numbers of a reference that are read from the scene: whoever edits the scene edits the reference with it.

use std::collections::BTreeMap;

use serde_json::Value;

use super::context::{BuildError, build_error};
use super::parameters::Parameters;
use crate::answers::TypedValue;
use crate::files::{QuestionFile, QuestionKind, ReferenceFile};

/// Puts the numbers of the scene into the expressions of a reference and of its misconceptions, where they are named.
pub(super) fn put(
    question: &mut QuestionFile,
    reference: &mut ReferenceFile,
    scene: &Value,
    parameters: &Parameters,
) -> Result<(), BuildError> {
    // The symbols of a formula are the student's: there the check puts the numbers in.
    if reference.scene.is_empty() || question.kind == QuestionKind::Formula {
        return Ok(());
    }
    let numbers = numbers(&reference.scene, scene, parameters)?;
    if let Some((name, _)) = parameters.iter().find(|(name, _)| numbers.contains_key(*name)) {
        let problem = format!("scene names {name}, which is a parameter already");
        return Err(build_error(problem, "take another name").in_reference());
    }
    let wrong = question.misconceptions.iter_mut().filter_map(|m| m.value.as_mut());
    for value in reference.value.iter_mut().chain(wrong) {
        fill(value, &numbers);
    }
    Ok(())
}

/// What `scene = { name = "/bodies/0/mass" }` names, in SI units.
pub(crate) fn numbers(
    places: &BTreeMap<String, String>,
    scene: &Value,
    parameters: &Parameters,
) -> Result<BTreeMap<String, f64>, BuildError> {
    let number = |(name, place): (&String, &String)| {
        look(place, scene, parameters).map(|value| (name.clone(), value)).ok_or_else(|| {
            let problem = format!("scene.json has no number for {name} at {place}");
            build_error(problem, "correct the pointer, as /bodies/0/mass or -/gravity/1").in_reference()
        })
    };
    places.iter().map(number).collect()
}

/// A number of the scene, with a minus before its pointer the negative of it, or an expression in the parameters.
fn look(place: &str, scene: &Value, parameters: &Parameters) -> Option<f64> {
    let (sign, pointer) = place.strip_prefix('-').map_or((1.0, place), |rest| (-1.0, rest));
    if pointer.starts_with('/') {
        scene.pointer(pointer)?.as_f64().map(|value| sign * value)
    } else {
        parameters.eval(place).ok().filter(|value| value.is_finite())
    }
}

/// Puts numbers in the place of names, as if the author had written them.
fn fill(value: &mut TypedValue, numbers: &BTreeMap<String, f64>) {
    match value {
        TypedValue::Number(_) => {}
        TypedValue::List(list) => list.iter_mut().for_each(|one| fill(one, numbers)),
        TypedValue::Text(text) => *text = written(text, numbers),
    }
}

fn written(text: &str, numbers: &BTreeMap<String, f64>) -> String {
    let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut out = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if is_of_name(first) {
            rest.find(|c| !is_of_name(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (word, after) = rest.split_at(end);
        match numbers.get(word) {
            Some(value) if *value < 0.0 => out.extend(["(", &value.to_string(), ")"]),
            Some(value) => out.push_str(&value.to_string()),
            None => out.push_str(word),
        }
        rest = after;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_replaced_and_nothing_else() {
        let numbers = BTreeMap::from([("g".to_owned(), 9.81), ("L".to_owned(), -1.2)]);
        assert_eq!(written("m*g/L+sqrt(gL)-2*g^2", &numbers), "m*9.81/(-1.2)+sqrt(gL)-2*9.81^2");
        assert_eq!(written("1e-9*g", &numbers), "1e-9*9.81");
    }

    #[test]
    fn places_are_pointers_negatives_of_them_and_expressions() {
        let scene = serde_json::json!({"gravity": [0, -9.81, 0], "name": "x"});
        let parameters = Parameters::default();
        assert_eq!(look("-/gravity/1", &scene, &parameters), Some(9.81));
        assert_eq!(look("/gravity/1", &scene, &parameters), Some(-9.81));
        assert_eq!(look("2*3", &scene, &parameters), Some(6.0));
        for wrong in ["/gravity/3", "/name", "k"] {
            assert_eq!(look(wrong, &scene, &parameters), None, "{wrong}");
        }
    }
}
