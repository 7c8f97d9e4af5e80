//! What questions are built from, and what can be wrong with them.

use serde_json::Value;
use thiserror::Error;
use triad_engine::scene::Scene;

use super::parameters::Parameters;
use crate::files::Files;

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

/// What questions are built from: the numbers of the variant, its scenario, and the files of the lesson.
pub(crate) struct BuildContext<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) scene: &'a Value,
    pub(crate) files: &'a Files,
}

impl BuildContext<'_> {
    /// The scenario, or the scene in another file of the lesson.
    pub(super) fn scene_of(&self, file: Option<&str>) -> Result<Scene, BuildError> {
        let text = match file {
            None => self.scene.to_string(),
            Some(name) => {
                let bytes = self.files.get(name);
                let bytes = bytes.ok_or_else(|| build_error(format!("there is no file {name}"), "add it"))?;
                String::from_utf8_lossy(bytes).into_owned()
            }
        };
        let name = file.unwrap_or("scene.json");
        Scene::from_json(&text).map_err(|e| build_error(format!("{name}: {e}"), "correct the key it names"))
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
