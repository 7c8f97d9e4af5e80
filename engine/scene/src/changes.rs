//! Scenes with changed numbers.

use crate::error::SceneError;
use crate::parameter::Parameter;
use crate::scene::Scene;
use crate::settings::Settings;
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// Largest number of places that one change may touch.
pub const MAX_CHANGES: usize = 1_000;
/// What a change may choose besides numbers: words, and the way of stabilization.
const CHOICES: [&str; 3] = ["/coordinates", "/simulation/integrator", "/simulation/stabilization"];
/// Triples of a body that may be left out of a scene, where they are zero.
const ZERO_TRIPLES: [&str; 4] = ["center_of_mass", "position", "velocity", "angular_velocity"];

/// A scene as JSON in which everything that may be changed is written out.
#[derive(Clone, Debug)]
pub struct WrittenScene(Value);

impl WrittenScene {
    /// Writes a scene out.
    pub fn new(scene: &Scene) -> Self {
        let mut value = serde_json::to_value(scene).unwrap_or_default();
        let settings = serde_json::to_value::<&Settings>(&scene.simulation).unwrap_or_default();
        if let Some(root) = value.as_object_mut() {
            root.insert("simulation".into(), settings);
            root.entry("coordinates").or_insert_with(|| json!(scene.coordinates));
        }
        let bodies = value.pointer_mut("/bodies").and_then(Value::as_array_mut).into_iter().flatten();
        for body in bodies.filter_map(Value::as_object_mut) {
            for key in ZERO_TRIPLES {
                body.entry(key).or_insert_with(|| json!([0.0, 0.0, 0.0]));
            }
        }
        Self(value)
    }

    /// The number at a place.
    ///
    /// # Errors
    ///
    /// [`SceneError::NoNumber`]: what stands at the place instead.
    pub fn number(&self, pointer: &str) -> Result<f64, SceneError> {
        let fail = |found: String| SceneError::NoNumber { pointer: pointer.to_owned(), found };
        match self.0.pointer(&self.place(pointer)) {
            None => Err(fail(format!("there is nothing; {}", self.deepest(pointer)))),
            Some(Value::Number(number)) => Ok(number.as_f64().unwrap_or(f64::NAN)),
            Some(Value::String(word)) => Err(fail(format!("the word \"{word}\" stands there"))),
            Some(Value::Array(_)) => {
                Err(fail(format!("a list stands there: name one of its entries, like {pointer}/0")))
            }
            Some(Value::Object(inner)) => Err(fail(format!("there stand the keys {}", keys(inner)))),
            Some(_) => Err(fail("no number stands there".to_owned())),
        }
    }

    /// The value of a parameter.
    ///
    /// # Errors
    ///
    /// [`SceneError::NoNumber`]: the parameter names no place, or one without a number.
    pub fn value_of(&self, parameter: &Parameter) -> Result<f64, SceneError> {
        let Some(first) = parameter.places().first() else {
            return Err(SceneError::NoNumber {
                pointer: String::new(),
                found: format!("parameter \"{}\" names no place", parameter.name),
            });
        };
        Ok(self.number(first.pointer())? / first.factor())
    }

    /// The whole scene, written out.
    pub fn into_value(self) -> Value {
        self.0
    }

    /// Writes other numbers at some places, each named by a JSON pointer. What stood there is lost: who changes the same places
    /// again and again needs no copy.
    ///
    /// # Errors
    ///
    /// [`SceneError::NoNumber`]: a place without a number, or a number that is not finite.
    pub fn set_numbers<'a>(
        &mut self,
        numbers: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<(), SceneError> {
        numbers.into_iter().try_for_each(|(pointer, number)| self.set(pointer, &json!(number)))
    }

    /// The scene that is written here: as [`Scene::changed`], without writing and reading a text.
    ///
    /// # Errors
    ///
    /// [`SceneError`]: it cannot be read any more.
    pub fn read(&self) -> Result<Scene, SceneError> {
        // The text is only needed to say where a scene cannot be read.
        Scene::deserialize(&self.0).or_else(|_| Scene::from_json(&self.0.to_string()))
    }

    /// The place that a pointer means. A constant that a scene states shortly, `"force": [1, 2, 3]`, has its kind written out here, and
    /// is found as it is stated: `/loads/0/force/2`.
    fn place(&self, pointer: &str) -> String {
        let (mut at, mut place) = (&self.0, String::new());
        for token in pointer.split('/').skip(1).map(Some).chain([None]) {
            if let Value::Object(inner) = at
                && token.is_none_or(|token| !inner.contains_key(token))
                && let Some(key) = stated_shortly(inner)
            {
                place = format!("{place}/{key}");
            }
            let Some(token) = token else { return place };
            place = format!("{place}/{token}");
            match self.0.pointer(&place) {
                Some(inner) => at = inner,
                None => return pointer.to_owned(),
            }
        }
        place
    }

    /// What can be said about a place that is not there.
    fn deepest(&self, pointer: &str) -> String {
        let mut known = "";
        for (at, _) in pointer.match_indices('/').skip(1).chain([(pointer.len(), "")]) {
            let Some(prefix) = pointer.get(..at) else { break };
            if self.0.pointer(prefix).is_none() {
                break;
            }
            known = prefix;
        }
        let place = if known.is_empty() { "the scene" } else { known };
        match self.0.pointer(known) {
            Some(Value::Object(inner)) => format!("{place} has the keys {}", keys(inner)),
            Some(Value::Array(list)) => format!("{place} is a list of {}", list.len()),
            _ => format!("{place} goes no deeper"),
        }
    }

    fn set(&mut self, pointer: &str, to: &Value) -> Result<(), SceneError> {
        let wrong = |found: String| SceneError::NoNumber { pointer: pointer.to_owned(), found };
        if !CHOICES.contains(&pointer) {
            self.number(pointer)?;
            if !to.as_f64().is_some_and(f64::is_finite) {
                return Err(wrong(format!("a number stands there, and {to} is none")));
            }
        }
        let place = self.place(pointer);
        match self.0.pointer_mut(&place) {
            Some(place) => *place = to.clone(),
            None => return Err(wrong("there is nothing".to_owned())),
        }
        Ok(())
    }
}

/// The key of the constant in a value that may vary, if it is one.
fn stated_shortly(inner: &Map<String, Value>) -> Option<&'static str> {
    let mut keys = ["value", "vector"].into_iter().filter(|_| inner.len() == 2 && inner.contains_key("kind"));
    keys.find(|key| inner.get(*key).is_some_and(|constant| constant.is_number() || constant.is_array()))
}

fn keys(map: &Map<String, Value>) -> String {
    map.keys().map(String::as_str).collect::<Vec<_>>().join(", ")
}

impl Scene {
    /// The parameter of that name.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownParameter`], with the names that there are.
    pub fn parameter(&self, name: &str) -> Result<&Parameter, SceneError> {
        self.parameters.iter().find(|p| p.name == name).ok_or_else(|| SceneError::UnknownParameter {
            name: name.to_owned(),
            known: self.parameters.iter().map(|p| p.name.clone()).collect(),
        })
    }

    /// The same scene with other values of its parameters, and other values at places that are named by JSON
    /// pointers. The latter may be any number, and the choices of coordinates, integrator and stabilization.
    ///
    /// # Errors
    ///
    /// [`SceneError`]: an unknown parameter, a value outside its range, a place without a number, too many changes, or a scene that
    /// cannot be read any more.
    pub fn changed<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a str, f64)>,
        places: impl IntoIterator<Item = (&'a str, &'a Value)>,
    ) -> Result<Self, SceneError> {
        let mut written = WrittenScene::new(self);
        let mut count = 0;
        for (pointer, value) in places {
            count += 1;
            if count > MAX_CHANGES {
                return Err(SceneError::TooMany { what: "changes", count, limit: MAX_CHANGES });
            }
            written.set(pointer, value)?;
        }
        for (name, value) in values {
            let parameter = self.parameter(name)?;
            let Parameter { low, high, .. } = *parameter;
            if !(low..=high).contains(&value) {
                return Err(SceneError::OutsideParameter { name: name.to_owned(), value, low, high });
            }
            for place in parameter.places() {
                written.set(place.pointer(), &json!(value * place.factor()))?;
            }
        }
        Self::from_json(&written.into_value().to_string())
    }
}
