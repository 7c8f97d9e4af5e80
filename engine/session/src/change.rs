//! What may be done to a live session's scene: its numbers changed, a body dragged.

use std::collections::BTreeMap;

use http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use triad_engine::EngineError;
use triad_engine::model::Model;
use triad_engine::run::Simulation;
use triad_engine::scene::{Load, OnChange, Scene, WrittenScene};

use crate::refusal::{Refusal, suggest};

/// Other values for numbers of the scene.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SceneChange {
    /// Values of the parameters that the scene's author offers, by name.
    #[schemars(example = json!({"mass": 2.5}))]
    pub values: BTreeMap<String, f64>,
    /// Values of any other numbers, by JSON pointers into the scene; also `/coordinates`, `/simulation/integrator`
    /// and `/simulation/stabilization`.
    #[schemars(example = json!({"/simulation/tolerance": 1e-6}))]
    #[schemars(with = "BTreeMap<String, NumberOrWord>")]
    pub places: BTreeMap<String, Value>,
    /// What happens to the run: as the parameters say if it is not given, and a restart for other numbers.
    pub then: Option<AfterChange>,
}

/// What stands at a place of a scene that may be changed.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code)] // described, never made: the scene itself says what fits
enum NumberOrWord {
    Number(f64),
    Word(String),
}

/// What happens to a run whose scene is changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AfterChange {
    /// It starts over.
    Restart,
    /// It goes on from where it stands.
    Continue,
}

impl From<OnChange> for AfterChange {
    fn from(on_change: OnChange) -> Self {
        match on_change {
            OnChange::Restart => Self::Restart,
            OnChange::Continue => Self::Continue,
        }
    }
}

impl SceneChange {
    /// Whether it changes nothing.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty() && self.places.is_empty()
    }

    /// The changed scene, and what happens to its run.
    ///
    /// Errors if a name, a place or a value is refused.
    pub fn of(&self, scene: &Scene) -> Result<(Scene, AfterChange), Refusal> {
        let values = self.values.iter().map(|(name, value)| (name.as_str(), *value));
        let places = self.places.iter().map(|(pointer, value)| (pointer.as_str(), value));
        let changed = scene.changed(values, places)?;
        let offered = |name: &String| scene.parameter(name).map(|p| AfterChange::from(p.on_change));
        let goes_on = self.places.is_empty()
            && self.values.keys().all(|name| offered(name).is_ok_and(|then| then == AfterChange::Continue));
        Ok((changed, self.then.unwrap_or(if goes_on { AfterChange::Continue } else { AfterChange::Restart })))
    }
}

/// A number that may be changed, as it is now.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SessionParameter {
    /// Name in requests.
    pub name: String,
    /// Name for people.
    pub label: String,
    /// Where its number stands in the scene.
    pub pointers: Vec<String>,
    /// Its value.
    pub value: f64,
    /// Its value in the scene as the author wrote it.
    pub initial: f64,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Between two values of a slider.
    pub step: Option<f64>,
    /// Unit, for people.
    pub unit: Option<String>,
    /// What happens to the run when it changes.
    pub on_change: AfterChange,
}

/// A session's scene as it is now.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SessionScene {
    /// The parameters that its author offers.
    pub parameters: Vec<SessionParameter>,
    /// The scene with everything written out that may be changed.
    #[schemars(with = "Scene")]
    pub scene: Value,
    /// The same, before any change.
    #[schemars(with = "Scene")]
    pub original: Value,
}

impl SessionScene {
    /// The view of a scene that was `original`.
    pub fn new(scene: &Scene, original: &Scene) -> Self {
        let (now, before) = (WrittenScene::new(scene), WrittenScene::new(original));
        let parameters = scene.parameters.iter().filter_map(|p| {
            Some(SessionParameter {
                name: p.name.clone(),
                label: p.label.clone(),
                pointers: p.places().iter().map(|place| place.pointer().to_owned()).collect(),
                value: now.value_of(p).ok()?,
                initial: before.value_of(p).ok()?,
                low: p.low,
                high: p.high,
                step: p.step,
                unit: p.unit.clone(),
                on_change: p.on_change.into(),
            })
        });
        Self { parameters: parameters.collect(), scene: now.into_value(), original: before.into_value() }
    }
}

/// A spring from a point of a body to a place in the world.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// The body.
    pub body: String,
    /// The point, from the centre of mass along the body's principal axes, m.
    #[serde(default)]
    pub point: [f64; 3],
    /// Where it is dragged to, in the world, m.
    pub to: [f64; 3],
    /// Stiffness, N/m; one that suits the body's mass if it is not given.
    #[serde(default)]
    pub stiffness: Option<f64>,
}

/// Natural period of a body alone on the spring of a drag, s.
const DRAG_PERIOD: f64 = 0.6;

impl Drag {
    /// The same point of a body whose centre of mass or principal axes are others now.
    pub(crate) fn carried_on(&self, before: &Model, scene: &Scene) -> Result<Self, Refusal> {
        let after = Model::new(scene).map_err(EngineError::from)?;
        let of = |model: &Model| model.bodies.iter().find(|body| body.name == self.body).cloned();
        let (Some(before), Some(after)) = (of(before), of(&after)) else { return Ok(self.clone()) };
        let point = after.point_to_principal(&before.point_from_principal(self.point).into());
        Ok(Self { point: point.into(), ..self.clone() })
    }

    /// The scene with the spring in it.
    ///
    /// Errors if there is no such body, or the stiffness is not positive.
    fn added_to(&self, scene: &Scene, model: &Model) -> Result<Scene, Refusal> {
        let wrong = |pointer: &str, detail: String, hint: String| {
            Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, "cannot-pull", detail.clone(), hint)
                .at(pointer, detail)
        };
        let Some(body) = model.bodies.iter().find(|body| body.name == self.body) else {
            let names = model.bodies.iter().map(|body| body.name.as_str());
            let detail = format!("there is no body \"{}\"", self.body);
            return Err(wrong("/body", detail, suggest(&self.body, names)));
        };
        let total = model.mass();
        let rate = std::f64::consts::TAU / DRAG_PERIOD;
        let stiffness = self.stiffness.unwrap_or(total * rate * rate);
        let plain =
            self.point.iter().chain(&self.to).chain([&stiffness]).all(|x| x.is_finite() && x.abs() < 1e9);
        if !plain || stiffness < 0.0 {
            let detail =
                "point, to and stiffness must be ordinary numbers, the stiffness not negative".to_owned();
            return Err(wrong("/stiffness", detail, "leave the stiffness out for one that suits".into()));
        }
        let point = body.point_from_principal(self.point);
        let mut name = "hand".to_owned();
        while scene.loads.iter().any(|load| load.name() == name) {
            name.push('\'');
        }
        let mut dragged = scene.clone();
        dragged.loads.push(Load::Spring {
            name,
            body_i: triad_engine::scene::GROUND.to_owned(),
            point_i: self.to,
            body_j: self.body.clone(),
            point_j: point,
            stiffness,
            free_length: Some(0.0),
            damping: 0.6 * (stiffness * total).sqrt(),
            force: None,
        });
        Ok(dragged)
    }
}

/// A changed scene as the engine is given it, with the spring of a drag: the ranges of its parameters are the author's promise about
/// the scene as written, and an expert may leave them.
///
/// Errors if the scene is refused, or there is no such body.
pub(crate) fn assembled(scene: &Scene, drag: Option<&Drag>) -> Result<Simulation, Refusal> {
    let mut scene = Scene { parameters: Vec::new(), ..scene.clone() };
    if let Some(drag) = drag {
        let model = Model::new(&scene).map_err(EngineError::from)?;
        scene = drag.added_to(&scene, &model)?;
    }
    Ok(Simulation::new(&scene)?)
}
