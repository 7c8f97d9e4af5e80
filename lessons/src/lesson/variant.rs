//! The same lesson with other numbers: parameters drawn from a seed, tried out before they are used.

use thiserror::Error;
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_engine::scene::{Scene, SceneError};

use super::content::Lesson;
use super::personal::{describe, shuffle_options};
use crate::answers::tolerance::{distance, norm};
use crate::exercise::{self, BuildContext, Exercise, Parameters, QuestionBody, put_numbers};
use crate::files::ParameterFile;
use crate::random::SeededRandom;
use crate::seed::seed;

/// Draws after which the search for numbers ends with an error.
const MAX_DRAWS: usize = 64;

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
    /// No draw gave questions whose answers can be distinguished.
    #[error("no numbers were found for which the answers can be distinguished ({reason}); change the ranges")]
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

impl Lesson {
    /// The lesson with the numbers of this seed (a student's name, say). The same seed always gives the same lesson,
    /// as long as its files do not change. A lesson without parameters is returned as it is.
    ///
    /// Errors if no draw gives a lesson that can be judged.
    pub fn variant(&self, seed: &str) -> Result<Self, VariantError> {
        self.variant_in(seed, "")
    }

    /// The lesson with the numbers of a student in a class with this secret; an empty one is none.
    ///
    /// Errors if no draw gives a lesson that can be judged.
    pub fn variant_in(&self, student: &str, secret: &str) -> Result<Self, VariantError> {
        let drawn_from = seed(student, &self.slug, secret);
        let mut lesson = match self.dealt(&drawn_from) {
            Some(lesson) => lesson,
            None => self.drawn(&drawn_from)?,
        };
        lesson.exercise.draw_own(
            &self.slug,
            &drawn_from,
            self.dealer.as_ref().map(|dealer| &dealer.exercise),
        );
        shuffle_options(&mut lesson.exercise, &self.slug, &drawn_from);
        Ok(Self { seed: student.to_owned(), drawn_from, ..lesson })
    }

    /// The lesson with the numbers of a seed, or for nobody where it is empty.
    ///
    /// Errors if no draw gives a lesson that can be judged.
    pub fn of_seed(&self, seed: &str) -> Result<Self, VariantError> {
        if seed.is_empty() { Ok(self.for_nobody()) } else { self.variant(seed) }
    }

    /// The lesson for whoever has no name: the numbers of the text, and of each pool the questions that an empty name draws.
    #[must_use]
    pub fn for_nobody(&self) -> Self {
        let mut lesson = self.clone();
        lesson.exercise.draw_own(&self.slug, "", self.dealer.as_ref().map(|dealer| &dealer.exercise));
        lesson
    }

    /// The lesson with numbers drawn from a text.
    pub(super) fn drawn(&self, seed: &str) -> Result<Self, VariantError> {
        let files = &self.sources.exercise.parameters;
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
            // Instances are the student's own even where the numbers are everybody's.
            return Ok(self.clone());
        }
        let mut random = SeededRandom::new(&format!("{}/{seed}", self.slug));
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
                Ok(()) => return Ok(lesson),
                Err(refused) => reason = refused.to_string(),
            }
        }
        Err(VariantError::NoneFits { reason })
    }

    /// Whether each student gets numbers, states or questions of their own.
    pub fn has_variants(&self) -> bool {
        !self.parameters.is_empty()
            || !self.exercise.draw.is_empty()
            || self.exercise.questions.iter().any(|q| matches!(q.body, QuestionBody::Implement(_)))
    }

    /// The lesson with these numbers.
    pub(super) fn with(&self, parameters: Parameters) -> Result<Self, VariantError> {
        let unusable = |what: String| VariantError::Unusable { what };
        let (file, references) = (self.sources.exercise.clone(), self.sources.references.clone());
        let mut lesson = self.clone();
        let patches = &self.sources.exercise.scene;
        put_numbers(&mut lesson.scene, None, patches, &parameters).map_err(unusable)?;
        describe(&mut lesson.scene, &self.sources.description, &parameters);
        let context =
            BuildContext { parameters: &parameters, scene: &lesson.scene, files: &lesson.files, patches };
        lesson.exercise =
            exercise::build(file, references, &context).map_err(|error| unusable(error.to_string()))?;
        lesson.parameters = parameters;
        Ok(lesson)
    }
}

/// Why drawn numbers are not given to a student.
#[derive(Debug, Error)]
pub(super) enum DrawRefused {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error("the scenario starts in a singular position")]
    Singular,
    #[error("the answer to {question} is nearly zero")]
    NearlyZero { question: String },
    #[error("the misconception {misconception} of {question} cannot be distinguished")]
    Ambiguous { question: String, misconception: String },
}

/// Whether the scenario can be started, and not in a singular position.
pub(super) fn starts(scene: &serde_json::Value) -> Result<(), DrawRefused> {
    let scene = Scene::from_json(&scene.to_string())?;
    let simulation = Simulation::new(&scene)?;
    let rank = simulation.rank();
    if rank.lost_at_start() > 0 { Err(DrawRefused::Singular) } else { Ok(()) }
}

/// Whether every answer is worth asking for, and differs from every misconception by more than the tolerance.
fn fits(exercise: &Exercise) -> Result<(), DrawRefused> {
    for question in &exercise.questions {
        let QuestionBody::Quantity(q) = &question.body else { continue };
        if !q.tolerance.is_exact() && norm(&q.reference) <= 10.0 * q.tolerance.absolute {
            return Err(DrawRefused::NearlyZero { question: question.id.clone() });
        }
        let far = |a: &[f64], b: &[f64]| {
            distance(a, b) > q.tolerance.allowed(norm(a)) + q.tolerance.allowed(norm(b))
        };
        for (k, m) in q.misconceptions.iter().enumerate() {
            if !far(&m.value, &q.reference)
                || q.misconceptions[..k].iter().any(|other| !far(&m.value, &other.value))
            {
                let (question, misconception) = (question.id.clone(), m.id.clone());
                return Err(DrawRefused::Ambiguous { question, misconception });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    use crate::answers::{Answer, Submission, TypedValue};
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
            // At 45 degrees sine and cosine are equal, so nobody is given 45 degrees.
            assert!(phi != 45.0);
            assert_eq!(variant.scene.pointer("/bodies/0/mass").unwrap().as_f64(), Some(m));
            let view = serde_json::to_string(&variant.public_view()).unwrap();
            assert!(view.contains(&format!("={phi}°")) && view.contains(&format!("The ball has {m} kg")));
            assert!(!view.contains("{{"));
            let pull = format!("{:.5}", m * 9.81 / libm::cos(phi.to_radians()));
            let answer = Answer { value: Some(TypedValue::Text(pull)), ..Answer::default() };
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
        let range = lesson.sources.exercise.parameters.get_mut("phi").unwrap();
        range.step = 0.0;
        assert_eq!(lesson.variant("ada").unwrap_err(), VariantError::Range { name: "phi".to_owned() });
        let range = lesson.sources.exercise.parameters.get_mut("phi").unwrap();
        (range.step, range.from, range.to, range.default) = (1.0, 44.9999, 45.0001, 45.0);
        assert_eq!(lesson.variant("ada").unwrap_err().code(), "variant-none-fits");
        lesson.sources.exercise.scene[0].pointer = "/bodies/9/mass".to_owned();
        let error = lesson.variant("ada").unwrap_err().to_string();
        assert!(error.contains("/bodies/9/mass"), "{error}");
    }
}
