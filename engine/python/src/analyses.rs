//! Scenes, and analyses other than running: answers as JSON, the same that the command line gives.

use crate::refusal::Refusal;
use crate::scene;
use pyo3::prelude::*;
use serde::Serialize;
use triad_engine::analysis::{self, ModesAbout};
use triad_engine::catalogue::ENTRIES;
use triad_engine::reactions::report::Convention;

fn answer(value: &impl Serialize) -> Result<String, Refusal> {
    Ok(serde_json::to_string(value)?)
}

/// The built-in scenes: name and what each is.
#[pyfunction]
pub fn scenes() -> Vec<(&'static str, &'static str)> {
    ENTRIES.iter().map(|entry| (entry.name, entry.summary)).collect()
}

/// A scene as JSON, as its author would write it.
#[pyfunction]
pub fn scene_json(kind: &str, text: &str) -> PyResult<String> {
    Ok(scene::read(kind, text)?.to_json())
}

/// The JSON Schema of scenes.
#[pyfunction]
pub fn scene_schema() -> String {
    triad_engine::scene::schema().to_string()
}

/// What a scene amounts to.
#[pyfunction]
pub fn check(py: Python<'_>, kind: &str, text: &str) -> PyResult<String> {
    let scene = scene::read(kind, text)?;
    let found = py.detach(|| analysis::check::check(&scene)).map_err(Refusal::from)?;
    Ok(answer(&found)?)
}

/// An analysis by its word: equilibrium, modes (about `at`: equilibrium, start or steady), kinematics (reactions as the
/// convention `at` says), assemble (`keep` stay where they are).
#[pyfunction]
pub fn analyse(
    py: Python<'_>,
    word: &str,
    kind: &str,
    text: &str,
    at: &str,
    keep: Vec<String>,
) -> PyResult<String> {
    let scene = scene::read(kind, text)?;
    let found = py.detach(|| match word {
        "equilibrium" => answer(&analysis::equilibrium(&scene)?),
        "modes" => {
            let about = match at {
                "equilibrium" => ModesAbout::Equilibrium,
                "start" => ModesAbout::Start,
                "steady" => ModesAbout::Steady,
                other => {
                    let words = || ["equilibrium", "start", "steady"].into_iter();
                    return Err(Refusal::unknown("place for modes", other, words()));
                }
            };
            answer(&analysis::modes(&scene, about)?)
        }
        "assemble" => answer(&analysis::assemble(&scene, &keep)?),
        _ => {
            let convention: Convention = serde_json::from_str(at)?;
            answer(&analysis::kinematics(&scene, convention)?)
        }
    })?;
    Ok(found)
}
