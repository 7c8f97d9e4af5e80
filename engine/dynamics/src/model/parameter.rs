//! The parameters that an author offers, checked against the scene that they belong to.

use super::error::ModelError;
use super::unique_name;
use crate::scene::{Parameter, Scene, WrittenScene};
use std::collections::HashMap;

/// Relative difference up to which two numbers that an author has written agree.
const AGREES: f64 = 1e-9;

/// Refuses parameters that name no number, or numbers outside their own range.
pub(super) fn check(scene: &Scene) -> Result<(), ModelError> {
    if scene.parameters.is_empty() {
        return Ok(());
    }
    let written = WrittenScene::new(scene);
    let mut names = HashMap::new();
    for (index, parameter) in scene.parameters.iter().enumerate() {
        unique_name(&mut names, ("parameters", index), &parameter.name, index, |k| {
            format!("parameters[{k}]")
        })?;
        check_one(parameter, index, &written)?;
    }
    Ok(())
}

fn check_one(parameter: &Parameter, index: usize, written: &WrittenScene) -> Result<(), ModelError> {
    let wrong = |key: &str, reason: String| ModelError::Parameter {
        name: parameter.name.clone(),
        pointer: format!("/parameters/{index}/{key}"),
        reason,
    };
    let Parameter { low, high, step, .. } = *parameter;
    if !(low.is_finite() && high.is_finite() && low < high) {
        return Err(wrong("low", format!("its range from {low} to {high} is empty")));
    }
    if step.is_some_and(|step| !(step > 0.0 && step <= high - low)) {
        return Err(wrong("step", format!("its step must be above 0 and at most {}", high - low)));
    }
    let mut first = None;
    for place in parameter.places() {
        let factor = place.factor();
        if !(factor.is_finite() && factor != 0.0) {
            return Err(wrong("pointer", format!("the factor {factor} at {} is of no use", place.pointer())));
        }
        let number = written.number(place.pointer()).map_err(|e| wrong("pointer", e.to_string()))?;
        let value = number / factor;
        let slack = AGREES * value.abs().max(high - low);
        if value < low - slack || value > high + slack {
            let reason =
                format!("{}: its value {value} is outside its range from {low} to {high}", place.pointer());
            return Err(wrong("pointer", reason));
        }
        let expected = *first.get_or_insert(value);
        if (value - expected).abs() > slack {
            let reason = format!(
                "{}: its value there is {value}, but {expected} at the first of its places",
                place.pointer()
            );
            return Err(wrong("pointer", reason));
        }
    }
    first.map(drop).ok_or_else(|| wrong("pointer", "it names no place".to_owned()))
}
