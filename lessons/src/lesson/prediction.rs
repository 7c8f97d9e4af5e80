//! Predictions as students see them: the question before the run, what came of it afterwards.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::content::Lesson;
use crate::exercise::Parameters;
use crate::files::PredictionFile;
use crate::rendering::markdown;

/// An option as a student sees it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "ChoiceOption")]
pub struct OptionView {
    /// Id to send.
    pub id: String,
    /// The option as safe HTML.
    pub html: String,
}

/// Something to predict before the run.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Prediction")]
pub struct PredictionView {
    /// Id under which the prediction is sent.
    pub id: String,
    /// What is asked, as safe HTML.
    pub html: String,
    /// What may happen.
    pub options: Vec<OptionView>,
    /// Whether a sentence why is asked for, too.
    pub asks_why: bool,
    /// Points for having predicted, right or wrong.
    pub points: f64,
    /// Parameters of the scene to set before the run, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub with: BTreeMap<String, f64>,
    /// When the run has shown what happens, s.
    pub seen_at: f64,
}

/// What came of a prediction.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "Outcome")]
pub struct OutcomeView {
    /// Id of the option that comes true.
    pub happens: String,
    /// What the run shows, and why, as safe HTML.
    pub html: String,
}

impl Lesson {
    /// What is to be predicted, without what comes true.
    pub fn predictions(&self) -> Vec<PredictionView> {
        self.about.predictions.iter().map(|one| PredictionView::new(one, &self.parameters)).collect()
    }

    /// What came of a prediction: only for who has made it, or said that they make none.
    pub fn outcome(&self, prediction: &str) -> Option<OutcomeView> {
        let found = self.prediction(prediction)?;
        let html = markdown::render_short(&self.parameters.fill(&found.shows));
        Some(OutcomeView { happens: found.happens.clone(), html })
    }

    /// A prediction by its id.
    pub fn prediction(&self, id: &str) -> Option<&PredictionFile> {
        self.about.predictions.iter().find(|one| one.id == id)
    }

    /// Points that can be earned: by answers, whoever judges them, and by having predicted.
    pub fn points(&self) -> f64 {
        let predicted: f64 = self.about.predictions.iter().map(|one| one.points).sum();
        predicted + self.exercise.possible() + self.exercise.by_people()
    }
}

impl PredictionView {
    fn new(file: &PredictionFile, parameters: &Parameters) -> Self {
        let html = |text: &str| markdown::render_short(&parameters.fill(text));
        Self {
            id: file.id.clone(),
            html: html(&file.text),
            options: file
                .options
                .iter()
                .map(|o| OptionView { id: o.id.clone(), html: html(&o.text) })
                .collect(),
            asks_why: file.asks_why,
            points: file.points,
            with: file.with.clone(),
            seen_at: file.seen_at,
        }
    }
}
