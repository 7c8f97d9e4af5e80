//! The same lesson with other numbers: parameters drawn from a seed, tried out before they are used.

use std::collections::BTreeMap;

use thiserror::Error;
use triad_engine::scene::Scene;
use triad_engine::simulation::Simulation;

use crate::exercise::{self, Body, Exercise, Ground};
use crate::expression::{Expression, ExpressionError};
use crate::files::ParameterFile;
use crate::lesson::Lesson;
use crate::random::Random;
use crate::tolerance::{norm, plain};

/// Draws after which a lesson is given up.
const MAX_DRAWS: usize = 64;

/// Named numbers of a lesson.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters {
    names: Vec<String>,
    values: Vec<f64>,
}

/// Why a lesson has no variant for a seed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum VariantError {
    /// A range that cannot be drawn from.
    #[error("the parameter {name} has no usable range; give from < to, step > 0 and a default between them")]
    Range {
        /// The parameter.
        name: String,
    },
    /// A value or a place of the scenario that does not work.
    #[error("{what}")]
    Unusable {
        /// What, with a remedy.
        what: String,
    },
    /// No draw gave questions whose answers can be told apart.
    #[error("no numbers were found for which the answers can be told apart ({reason}); change the ranges")]
    NoneFits {
        /// Why the last draw was refused.
        reason: String,
    },
}

impl VariantError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Range { .. } => "variant-range",
            Self::Unusable { .. } => "variant-unusable",
            Self::NoneFits { .. } => "variant-none-fits",
        }
    }
}

impl Parameters {
    /// The default values.
    pub fn defaults(files: &BTreeMap<String, ParameterFile>) -> Self {
        Self { names: files.keys().cloned().collect(), values: files.values().map(|p| p.default).collect() }
    }

    /// True if the lesson has none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.names.iter().map(String::as_str).zip(self.values.iter().copied())
    }

    /// The value of an expression in the parameters.
    pub fn eval(&self, text: &str) -> Result<f64, ExpressionError> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        Ok(Expression::parse(text, &names)?.eval(&self.values))
    }

    /// A text with `{{name}}` replaced by the value.
    pub fn fill(&self, text: &str) -> String {
        self.iter().fold(text.to_owned(), |text, (name, value)| {
            text.replace(&format!("{{{{{name}}}}}"), &plain(value))
        })
    }

    /// One more named number.
    pub(crate) fn add(&mut self, name: &str, value: f64) {
        self.names.push(name.to_owned());
        self.values.push(value);
    }

    fn draw(files: &BTreeMap<String, ParameterFile>, random: &mut Random) -> Self {
        let values = files.values().map(|p| {
            let steps = ((p.to - p.from) / p.step + 1e-9).floor() + 1.0;
            let value = p.from + p.step * (random.unit() * steps).floor();
            // Without the noise of binary fractions: the student sees and uses the same number.
            plain(value).parse().unwrap_or(value)
        });
        Self { values: values.collect(), names: files.keys().cloned().collect() }
    }
}

impl Lesson {
    /// The lesson with the numbers of this seed (a student's name, say). The same seed always gives the same lesson,
    /// as long as its files do not change. A lesson without parameters is returned as it is.
    pub fn variant(&self, seed: &str) -> Result<Self, VariantError> {
        let files = &self.source.exercise.parameters;
        let usable = |p: &ParameterFile| {
            p.from < p.to
                && p.step > 0.0
                && (p.from..=p.to).contains(&p.default)
                && (p.to - p.from) / p.step < 1e6
        };
        if let Some((name, _)) = files.iter().find(|(_, p)| !usable(p)) {
            return Err(VariantError::Range { name: name.clone() });
        }
        if files.is_empty() {
            // States that are dealt are the student's own even where the numbers are everybody's.
            return Ok(Self { seed: seed.to_owned(), ..self.clone() });
        }
        let mut random = Random::new(&format!("{}/{seed}", self.slug));
        let mut reason = String::new();
        for _ in 0..MAX_DRAWS {
            // A draw for which the scene does not start or a wrong model has no answer is a bad draw, not a bad lesson.
            let lesson = match self.with(Parameters::draw(files, &mut random)) {
                Ok(lesson) => lesson,
                Err(VariantError::Unusable { what }) => {
                    reason = what;
                    continue;
                }
                Err(error) => return Err(error),
            };
            match fits(&lesson.exercise).and_then(|()| starts(&lesson.scene)) {
                Ok(()) => return Ok(Self { seed: seed.to_owned(), ..lesson }),
                Err(why) => reason = why,
            }
        }
        Err(VariantError::NoneFits { reason })
    }

    /// Whether each student gets numbers, or states, of their own.
    pub fn has_variants(&self) -> bool {
        !self.parameters.is_empty()
            || self.exercise.questions.iter().any(|q| matches!(q.body, Body::Implement(_)))
    }

    /// The lesson with these numbers.
    fn with(&self, parameters: Parameters) -> Result<Self, VariantError> {
        let unusable = |what: String| VariantError::Unusable { what };
        let (file, references) = (self.source.exercise.clone(), self.source.references.clone());
        let mut lesson = self.clone();
        for patch in &file.scene {
            let value = parameters
                .eval(&patch.value)
                .map_err(|e| unusable(format!("scene {}: {e}", patch.pointer)))?;
            let place = lesson.scene.pointer_mut(&patch.pointer).filter(|v| v.is_number());
            let (Some(place), Some(number)) = (place, serde_json::Number::from_f64(value)) else {
                let what = format!("scene.json has no number at {}; correct the pointer", patch.pointer);
                return Err(unusable(what));
            };
            *place = serde_json::Value::Number(number);
        }
        let ground = Ground { parameters: &parameters, scene: &lesson.scene, files: &lesson.files };
        lesson.exercise =
            exercise::build(file, references, &ground).map_err(|error| unusable(error.to_string()))?;
        lesson.parameters = parameters;
        Ok(lesson)
    }
}

/// Whether the scenario can be started, and not in a singular position.
fn starts(scene: &serde_json::Value) -> Result<(), String> {
    let scene = Scene::from_json(&scene.to_string()).map_err(|e| e.to_string())?;
    let simulation = Simulation::new(&scene).map_err(|e| e.to_string())?;
    let rank = simulation.rank();
    if rank.at_start < rank.rank {
        Err("the scenario starts in a singular position".to_owned())
    } else {
        Ok(())
    }
}

/// Whether every answer is worth asking for, and differs from every misconception by more than the tolerance.
fn fits(exercise: &Exercise) -> Result<(), String> {
    for question in &exercise.questions {
        let Body::Quantity(q) = &question.body else { continue };
        if !q.rule.is_exact() && norm(&q.reference) <= 10.0 * q.rule.absolute {
            return Err(format!("the answer to {} is nearly zero", question.id));
        }
        let far = |a: &[f64], b: &[f64]| {
            let difference: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
            norm(&difference) > q.rule.allowed(norm(a)) + q.rule.allowed(norm(b))
        };
        for (k, m) in q.misconceptions.iter().enumerate() {
            if !far(&m.value, &q.reference)
                || q.misconceptions[..k].iter().any(|other| !far(&m.value, &other.value))
            {
                return Err(format!("the misconception {} of {} cannot be told apart", m.id, question.id));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::submission::{Answer, Entry, Submission};
    use crate::{Course, Mark, grade};

    fn lesson() -> Lesson {
        Course::embedded().unwrap().lesson("spherical-joint").unwrap().clone()
    }

    #[test]
    fn a_seed_gives_the_same_numbers_for_ever_and_seeds_differ() {
        let lesson = lesson();
        let numbers = |seed: &str| lesson.variant(seed).unwrap().parameters;
        assert_eq!(numbers("ada"), numbers("ada"));
        let different: std::collections::BTreeSet<String> =
            (0..40).map(|k| format!("{:?}", numbers(&format!("student-{k}")))).collect();
        assert!(different.len() > 20, "{}", different.len());
    }

    #[test]
    fn text_scene_and_answer_belong_together() {
        let lesson = lesson();
        for seed in 0..20 {
            let variant = lesson.variant(&format!("student-{seed}")).unwrap();
            let value = |name: &str| variant.parameters.iter().find(|(n, _)| *n == name).unwrap().1;
            let (phi, m) = (value("phi"), value("m"));
            // At 45 degrees sine and cosine cannot be told apart, so nobody is given 45 degrees.
            assert!(phi != 45.0);
            assert_eq!(variant.scene.pointer("/bodies/0/mass").unwrap().as_f64(), Some(m));
            let view = serde_json::to_string(&variant.public_view()).unwrap();
            assert!(view.contains(&format!("={phi}°")) && view.contains(&format!("The ball has {m} kg")));
            assert!(!view.contains("{{"));
            let pull = format!("{:.5}", m * 9.81 / phi.to_radians().cos());
            let answer = Answer { value: Some(Entry::Text(pull)), ..Answer::default() };
            let answers = BTreeMap::from([("pull".to_owned(), answer)]);
            let verdict = grade(&variant, &Submission { answers, ..Submission::default() }).unwrap();
            assert_eq!(verdict.questions.iter().find(|q| q.id == "pull").unwrap().verdict, Mark::Right);
        }
    }

    #[test]
    fn without_a_seed_the_defaults_hold() {
        let view = serde_json::to_string(&lesson().public_view()).unwrap();
        assert!(view.contains("=60°") && !view.contains("{{"));
    }

    #[test]
    fn ranges_that_cannot_be_drawn_from_are_named() {
        let mut lesson = lesson();
        let range = lesson.source.exercise.parameters.get_mut("phi").unwrap();
        range.step = 0.0;
        assert_eq!(lesson.variant("ada").unwrap_err(), VariantError::Range { name: "phi".to_owned() });
        let range = lesson.source.exercise.parameters.get_mut("phi").unwrap();
        (range.step, range.from, range.to, range.default) = (1.0, 44.9999, 45.0001, 45.0);
        assert_eq!(lesson.variant("ada").unwrap_err().code(), "variant-none-fits");
        lesson.source.exercise.scene[0].pointer = "/bodies/9/mass".to_owned();
        let error = lesson.variant("ada").unwrap_err().to_string();
        assert!(error.contains("/bodies/9/mass"), "{error}");
    }
}
