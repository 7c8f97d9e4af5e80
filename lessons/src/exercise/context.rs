//! What questions are built from, and what can be wrong with them.

use serde_json::Value;
use thiserror::Error;
use triad_engine::scene::Scene;

use super::parameters::Parameters;
use crate::files::{Files, PatchFile};

/// What is wrong with a question, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("question {question}: {problem}; {remedy}")]
pub struct QuestionError {
    /// The question's id.
    pub question: String,
    /// Whether it is wrong in `reference/answers.toml` rather than in `exercise.toml`.
    pub in_reference: bool,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

/// What questions are built from: the numbers of the variant, its scenario, the files of the lesson, and where the numbers
/// enter them.
pub(crate) struct BuildContext<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) scene: &'a Value,
    pub(crate) files: &'a Files,
    pub(crate) patches: &'a [PatchFile],
}

/// The name of the scenario's file.
const SCENARIO: &str = "scene.json";

/// Puts drawn numbers into a scene, the scenario or the one in another file.
///
/// Errors, with a remedy, if a place is not there or a value has no number.
pub(crate) fn put_numbers(
    scene: &mut Value,
    file: Option<&str>,
    patches: &[PatchFile],
    parameters: &Parameters,
) -> Result<(), String> {
    for patch in patches.iter().filter(|patch| patch.file.as_deref() == file) {
        let value = parameters.eval(&patch.value).map_err(|e| format!("scene {}: {e}", patch.pointer))?;
        let place = scene.pointer_mut(&patch.pointer).filter(|v| v.is_number());
        let (Some(place), Some(number)) = (place, serde_json::Number::from_f64(value)) else {
            let name = file.unwrap_or(SCENARIO);
            return Err(format!("{name} has no number at {}; correct the pointer", patch.pointer));
        };
        *place = Value::Number(number);
    }
    Ok(())
}

impl BuildContext<'_> {
    /// The scenario, or the scene in another file of the lesson with the numbers of the variant.
    pub(super) fn scene_of(&self, file: Option<&str>) -> Result<Scene, BuildError> {
        let text = match file {
            None => self.scene.to_string(),
            Some(name) => self.with_numbers(name)?,
        };
        let name = file.unwrap_or(SCENARIO);
        Scene::from_json(&text).map_err(|e| build_error(format!("{name}: {e}"), "correct the key it names"))
    }

    /// The text of a scene with the drawn numbers, as it is written where none enters it.
    fn with_numbers(&self, name: &str) -> Result<String, BuildError> {
        let bytes = self.files.get(name);
        let bytes = bytes.ok_or_else(|| build_error(format!("there is no file {name}"), "add it"))?;
        let text = String::from_utf8_lossy(bytes).into_owned();
        if !self.patches.iter().any(|patch| patch.file.as_deref() == Some(name)) {
            return Ok(text);
        }
        // What is no JSON is reported by whoever reads the scene.
        let Ok(mut scene) = serde_json::from_str(&text) else { return Ok(text) };
        put_numbers(&mut scene, Some(name), self.patches, self.parameters)
            .map_err(|problem| build_error(problem, "it is named under [[scene]]"))?;
        Ok(scene.to_string())
    }
}

/// What is wrong and what to do, before it is known with which question.
pub(crate) struct BuildError {
    pub(super) problem: String,
    pub(super) remedy: String,
    pub(super) in_reference: bool,
}

impl BuildError {
    /// The same error, found in the file of the references.
    pub(super) fn in_reference(self) -> Self {
        Self { in_reference: true, ..self }
    }
}

/// An error in `exercise.toml`.
pub(super) fn build_error(problem: impl Into<String>, remedy: impl Into<String>) -> BuildError {
    BuildError { problem: problem.into(), remedy: remedy.into(), in_reference: false }
}

/// An error if a key is present that this kind of question does not use.
pub(super) fn refuse(present: bool, key: &str, kind: &str) -> Result<(), BuildError> {
    if present { Err(build_error(format!("{key} does not belong to a {kind}"), "remove it")) } else { Ok(()) }
}
