//! Which scene is meant, and with which options.

use crate::refusal::Refusal;
use serde::Deserialize;
use std::path::Path;
use triad_engine::catalogue::{self, ENTRIES};
use triad_engine::run::Simulation;
use triad_engine::scene::{self, Coordinates, IntegratorKind, Output, Scene, Skip};

/// How a scene is named: `name` (built in, or a file), `path` (a file) or `json` (its text).
pub fn read(kind: &str, text: &str) -> Result<Scene, Refusal> {
    let path = Path::new(text);
    match kind {
        "json" => Ok(Scene::from_json(text)?),
        "path" => in_file(path),
        _ if path.is_file() => in_file(path),
        _ => match catalogue::scene(text) {
            Ok(scene) => Ok(scene),
            Err(_) if text.contains(['/', '\\']) || path.extension().is_some() => {
                let names: Vec<&str> = ENTRIES.iter().map(|entry| entry.name).collect();
                let hint = format!("check the path, or take a built-in scene: {}", names.join(", "));
                Err(Refusal::new("no-such-file", format!("there is no file {text}"), hint))
            }
            Err(error) => Err(Refusal::new(error.code(), error.to_string(), error.hint())),
        },
    }
}

fn in_file(path: &Path) -> Result<Scene, Refusal> {
    let refused = |cause: String, hint: &str| {
        Refusal::new("unreadable-file", format!("{} cannot be read: {cause}", path.display()), hint)
    };
    let size = std::fs::metadata(path).map_err(|error| refused(error.to_string(), "check the path"))?.len();
    if size > scene::MAX_TEXT as u64 {
        let most = scene::MAX_TEXT;
        return Err(refused(format!("it has {size} bytes, more than {most}"), "use a smaller file"));
    }
    let text = std::fs::read_to_string(path)
        .map_err(|error| refused(error.to_string(), "it must be a text file in UTF-8"))?;
    Ok(Scene::from_json(&text)?)
}

/// The options of a run, each in place of what the scene says.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Options {
    /// End of the run, s.
    pub until: Option<f64>,
    /// Time between outputs, s.
    pub every: Option<f64>,
    /// Tolerance of the integrator.
    pub tolerance: Option<f64>,
    /// Integrator by its word.
    pub integrator: Option<String>,
    /// What keeps the constraints, by its word.
    pub treatment: Option<String>,
    /// Size of fixed steps, s.
    pub step: Option<f64>,
    /// Coordinates of the bodies, by their word.
    pub coordinates: Option<String>,
    /// Columns of the table.
    pub outputs: Option<Vec<String>>,
    /// What is computed although nothing depends on it.
    pub no_skip: Vec<String>,
    /// Whether an estimate of the error is carried along.
    pub estimate: Option<bool>,
    /// Steps after which the run stops.
    pub most_steps: Option<u64>,
    /// Seconds of computing after which it stops.
    pub most_seconds: Option<f64>,
}

impl Options {
    /// Reads them.
    pub fn from_json(text: &str) -> Result<Self, Refusal> {
        Ok(serde_json::from_str(text)?)
    }

    /// Puts them into a scene.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), Refusal> {
        if let Some(word) = &self.coordinates {
            scene.coordinates =
                word.parse::<Coordinates>().map_err(|error| Refusal::word("coordinates", word, error))?;
        }
        let settings = &mut scene.simulation;
        settings.duration = self.until.unwrap_or(settings.duration);
        settings.every = self.every.unwrap_or(settings.every);
        settings.tolerance = self.tolerance.unwrap_or(settings.tolerance);
        settings.step = self.step.or(settings.step);
        settings.error_estimate = self.estimate.unwrap_or(settings.error_estimate);
        if let Some(word) = &self.integrator {
            settings.integrator = word.parse().map_err(|error| Refusal::word("integrator", word, error))?;
        }
        if let Some(word) = &self.treatment {
            settings.constraint_method =
                word.parse().map_err(|error| Refusal::word("treatment", word, error))?;
        }
        for word in &self.no_skip {
            if word == "all" {
                settings.skip = Skip::nothing();
            } else if let Some(on) = settings.skip.word_mut(word) {
                *on = false;
            } else {
                let words = || Skip::WORDS.into_iter().chain(["all"]);
                return Err(Refusal::unknown("word of no_skip", word, words()));
            }
        }
        if let Some(outputs) = &self.outputs {
            let read =
                |word: &String| word.parse::<Output>().map_err(|error| Refusal::word("outputs", word, error));
            settings.outputs = outputs.iter().map(read).collect::<Result<_, _>>()?;
        }
        let lost = self.outputs.is_some() && !settings.error_estimate && settings.tells_errors();
        if lost || settings.misses_errors() {
            return Err(Refusal::new(
                "no-errors",
                "the outputs hold errors, but the run carries no estimate of them along",
                "leave estimate=False out (and \"error_estimate\": false in the scene), or errors out of outputs",
            ));
        }
        Ok(())
    }

    /// Refuses to run by another integrator than the one that was asked for together with these options.
    pub fn check_choice(&self, run: &Simulation) -> Result<(), Refusal> {
        let asked = run.model().settings.integrator;
        let summary = run.summary();
        let chosen = self.integrator.is_some() || self.treatment.is_some() || self.step.is_some();
        if !chosen || asked == IntegratorKind::Auto || asked == summary.integrator {
            return Ok(());
        }
        let taken = summary.integrator;
        Err(Refusal::new(
            "choices-conflict",
            format!("{} would run by {taken}: {}", run.model().name, summary.reason),
            format!(
                "leave one of the choices out, or give integrator=\"auto\" or integrator=\"{taken}\" to agree"
            ),
        ))
    }
}
