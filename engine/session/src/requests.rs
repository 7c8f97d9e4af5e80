//! What may be asked of a run: the bodies and queries of its requests.

use http::StatusCode;
use schemars::JsonSchema;
use serde::Deserialize;
use triad_engine::scene::{ConstraintMethod, Scene};

use crate::change::SceneChange;
use crate::drawing::{Arrows, Camera};
use crate::refusal::Refusal;

/// Integrator steps that one request may take.
const MAX_STEPS: u32 = 100_000;
/// Simulated seconds a second that a session may play.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// The time that something is wanted for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtTime {
    /// One that the run has passed, s; the present if it is not given.
    #[serde(default)]
    pub at: Option<f64>,
}

/// What to simulate: exactly one of `lesson`, `builtin` and `scene`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewSession {
    /// The scenario of a lesson, by the lesson's slug.
    pub lesson: Option<String>,
    /// With `lesson`: whose numbers, a student's name or another seed; without it, those that everybody sees.
    pub seed: Option<String>,
    /// A built-in scene, by name.
    #[schemars(example = "n-four-bar:2")]
    pub builtin: Option<String>,
    /// A scene; its schema is at /api/v1/schema/scene.
    #[schemars(with = "Option<Scene>")]
    pub scene: Option<serde_json::Value>,
    /// Settings that replace those of the scene.
    #[serde(default)]
    pub overrides: Overrides,
    /// Changes that are made before the start; undoing them leads back to the scene as it is written.
    #[serde(default)]
    pub change: SceneChange,
}

/// Settings that replace those of the scene.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Overrides {
    /// End of the simulation, s.
    pub duration: Option<f64>,
    /// Time between frames, s.
    pub every: Option<f64>,
    /// Tolerance of the integrator.
    pub tolerance: Option<f64>,
    /// How the constraints are kept.
    pub stabilization: Option<ConstraintMethod>,
}

impl Overrides {
    /// Replaces them.
    pub fn apply(self, scene: &mut Scene) {
        let simulation = &mut scene.simulation;
        simulation.duration = self.duration.unwrap_or(simulation.duration);
        simulation.every = self.every.unwrap_or(simulation.every);
        simulation.tolerance = self.tolerance.unwrap_or(simulation.tolerance);
        simulation.constraint_method = self.stabilization.unwrap_or(simulation.constraint_method);
    }
}

/// How far to step: `steps` of the integrator or simulated `seconds`; one step if neither is given.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepRequest {
    /// Integrator steps, 1 to 100000.
    pub steps: Option<u32>,
    /// Simulated seconds, above 0.
    pub seconds: Option<f64>,
}

/// How far a run is to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stretch {
    /// Integrator steps.
    Steps(u32),
    /// Simulated seconds.
    Seconds(f64),
}

impl StepRequest {
    /// What is asked for. Errors if it is out of range, or both are given.
    pub fn asked(&self) -> Result<Stretch, Refusal> {
        match (self.steps, self.seconds) {
            (_, None) => {
                let steps = self.steps.unwrap_or(1);
                if !(1..=MAX_STEPS).contains(&steps) {
                    return Err(out_of_range(
                        "/steps",
                        format!("steps must be from 1 to {MAX_STEPS}, not {steps}"),
                    ));
                }
                Ok(Stretch::Steps(steps))
            }
            (None, Some(seconds)) => {
                if seconds.is_nan() || seconds <= 0.0 || seconds > 1e6 {
                    return Err(out_of_range(
                        "/seconds",
                        format!("seconds must be above 0, at most 1e6, not {seconds}"),
                    ));
                }
                Ok(Stretch::Seconds(seconds))
            }
            (Some(_), Some(_)) => {
                Err(out_of_range("/seconds", "give either steps or seconds, not both".into()))
            }
        }
    }
}

/// How fast to play.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlayRequest {
    /// Simulated seconds a second, 0.001 to 1000; 1 if it is not given.
    pub speed: Option<f64>,
}

impl PlayRequest {
    /// Simulated seconds a second. Errors if it is out of range.
    pub fn asked(&self) -> Result<f64, Refusal> {
        let speed = self.speed.unwrap_or(1.0);
        if !SPEEDS.contains(&speed) {
            return Err(out_of_range("/speed", format!("speed must be from 0.001 to 1000, not {speed}")));
        }
        Ok(speed)
    }
}

/// How forces are to be drawn; what is not given stays.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewDrawing {
    /// Which, on which body, about which point.
    pub arrows: Option<Arrows>,
    /// Take the scale of forces from the recording so far.
    #[serde(default)]
    pub fit: bool,
}

/// Where the camera is to stand.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewCamera {
    /// From where the mechanism is looked at.
    pub from: Camera,
}

fn out_of_range(pointer: &str, detail: String) -> Refusal {
    Refusal::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "out-of-range",
        detail.clone(),
        "send a value within the stated range",
    )
    .at(pointer, detail)
}
