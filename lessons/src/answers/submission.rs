//! What a student hands in, as JSON.

use std::collections::BTreeMap;

use serde::de::IntoDeserializer;
use serde::{Deserialize, Deserializer, Serialize};
use thiserror::Error;
use triad_engine::scene::IntegratorKind;

use super::diagram::Arrow;

/// Largest submission that is read, in bytes.
const MAX_BYTES: usize = 4 << 20;
/// Largest file in an answer, in bytes.
pub(crate) const MAX_FILE: usize = 1 << 20;
/// Most answers in one submission.
const MAX_ANSWERS: usize = 200;

/// A student's answers to the questions of one lesson.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Submission {
    /// Who answers; any name the class agrees on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub student: Option<String>,
    /// The numbers that were asked about, if not the student's own: the seed of the lesson as it was shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<String>,
    /// The answers by the question's id. A question that is left out is blank.
    pub answers: BTreeMap<String, Answer>,
}

/// The answer to one question.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// A number, a list of numbers, or a formula, as typed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<TypedValue>,
    /// The unit of the value, as typed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// The id of the option that was chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<String>,
    /// The text of a file: JSON or CSV of a program, a table, a scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Settings of a run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<RunSettings>,
    /// Forces and moments on bodies that are cut free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diagram: Option<Vec<Arrow>>,
}

/// Settings of a run, as chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunSettings {
    /// The integrator.
    #[serde(deserialize_with = "integrator")]
    pub integrator: IntegratorKind,
    /// Its tolerance, as typed.
    pub tolerance: TypedValue,
    /// Baumgarte's α and β in 1/s, as typed; without them the state is projected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baumgarte: Option<[TypedValue; 2]>,
}

/// A value as typed: text keeps the digits that were written, a JSON number is taken as its shortest text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "expected text such as \"12.3\", a number, or a list of these")]
pub enum TypedValue {
    /// Text as typed.
    Text(String),
    /// A JSON number.
    Number(f64),
    /// The components of a vector, or the rows of a matrix.
    List(Vec<TypedValue>),
}

/// Why a submission could not be read at all.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SubmissionError {
    /// Not JSON, an unknown key, or a wrong type.
    #[error("{place}: {problem}")]
    Unreadable {
        /// Where, as a path such as `answers.period.value`.
        place: String,
        /// What is wrong there.
        problem: String,
    },
    /// More than a submission can sensibly hold.
    #[error("the submission is too large; send at most {limit}")]
    TooLarge {
        /// The bound that was hit.
        limit: String,
    },
}

impl SubmissionError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "submission-unreadable",
            Self::TooLarge { .. } => "submission-too-large",
        }
    }

    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        r#"A submission looks like {"student": "ada", "answers": {"period": {"value": "2.37", "unit": "s"}, "sign": {"choice": "a"}}}."#
    }
}

/// An integrator as people and other programs write it: `DOP853`, `Dopri5`.
fn integrator<'de, D: Deserializer<'de>>(from: D) -> Result<IntegratorKind, D::Error> {
    let written = String::deserialize(from)?;
    IntegratorKind::deserialize(written.trim().to_lowercase().into_deserializer())
}

impl Submission {
    /// Whose numbers it is about, where nobody else decides it: those of its seed, else its student's; empty for everybody's.
    pub fn numbers_of(&self) -> &str {
        self.seed.as_deref().or(self.student.as_deref()).unwrap_or_default()
    }

    /// Reads a submission from JSON text.
    ///
    /// Errors if it is no JSON, is too large, or has unknown keys.
    pub fn from_json(text: &str) -> Result<Self, SubmissionError> {
        if text.len() > MAX_BYTES {
            return Err(SubmissionError::TooLarge { limit: format!("{} KiB", MAX_BYTES / 1024) });
        }
        let mut reader = serde_json::Deserializer::from_str(text);
        let submission: Self = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
            let place = match error.path().to_string() {
                path if path == "." || path == "?" => "submission".to_owned(),
                path => path,
            };
            SubmissionError::Unreadable { place, problem: error.inner().to_string() }
        })?;
        reader.end().map_err(|error| SubmissionError::Unreadable {
            place: "submission".to_owned(),
            problem: error.to_string(),
        })?;
        if submission.answers.len() > MAX_ANSWERS {
            return Err(SubmissionError::TooLarge { limit: format!("{MAX_ANSWERS} answers") });
        }
        if let Some((id, _)) = submission
            .answers
            .iter()
            .find(|(_, answer)| answer.file.as_ref().is_some_and(|file| file.len() > MAX_FILE))
        {
            let limit = format!("{} KiB in the file of {}", MAX_FILE / 1024, crate::text::shorten(id));
            return Err(SubmissionError::TooLarge { limit });
        }
        Ok(submission)
    }
}

impl Answer {
    /// True if nothing was filled in.
    pub fn is_blank(&self) -> bool {
        let no_text = |t: &Option<String>| t.as_ref().is_none_or(|t| t.trim().is_empty());
        self.value.as_ref().is_none_or(TypedValue::is_blank)
            && no_text(&self.choice)
            && no_text(&self.file)
            && self.diagram.as_ref().is_none_or(Vec::is_empty)
            && self.settings.as_ref().is_none_or(|s| s.tolerance.is_blank())
    }
}

impl TypedValue {
    /// True if every text is empty.
    pub fn is_blank(&self) -> bool {
        match self {
            Self::Text(text) => text.trim().is_empty(),
            Self::Number(_) => false,
            Self::List(list) => list.iter().all(Self::is_blank),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documented_shapes_are_read() {
        let text = r#"{"student":"ada","answers":{"a":{"value":"12.30","unit":"N"},"b":{"choice":"x"},
                       "c":{"value":["1",2,"3"]},"d":{"value":[["1","0"],["0","1"]]}}}"#;
        let submission = Submission::from_json(text).unwrap();
        assert_eq!(submission.answers["a"].value, Some(TypedValue::Text("12.30".to_owned())));
        assert_eq!(submission.answers.len(), 4);
        assert!(!submission.answers["c"].is_blank());
    }

    #[test]
    fn an_integrator_is_known_in_any_letters() {
        let read = |name: &str| {
            let text = format!(
                r#"{{"answers":{{"a":{{"settings":{{"integrator":"{name}","tolerance":"1e-8"}}}}}}}}"#
            );
            Submission::from_json(&text).map(|s| s.answers["a"].settings.as_ref().map(|s| s.integrator))
        };
        for name in ["dop853", "DOP853", " Dop853 "] {
            assert_eq!(read(name).unwrap(), Some(IntegratorKind::Dop853), "{name}");
        }
        assert!(read("euler").unwrap_err().to_string().contains("euler"));
    }

    #[test]
    fn errors_name_the_place() {
        let fails = |t: &str| Submission::from_json(t).unwrap_err().to_string();
        assert!(fails(r#"{"answers":{"a":{"vlaue":"1"}}}"#).contains("answers.a"), "{}", fails("{}"));
        assert!(fails(r#"{"answers":{"a":{"vlaue":"1"}}}"#).contains("vlaue"));
        assert!(fails(r#"{"answers":{"a":{"value":true}}}"#).contains("answers.a.value"));
        assert!(fails(r#"{"answers":{},"grade":10}"#).contains("grade"));
        assert!(fails("{}").contains("answers"));
        assert!(fails(r#"{"answers":{}} x"#).contains("trailing"));
        assert!(fails("").contains("line 1"));
    }

    #[test]
    fn bounds_hold() {
        let huge = format!(r#"{{"answers":{{"a":{{"value":"{}"}}}}}}"#, "9".repeat(5 << 20));
        assert_eq!(Submission::from_json(&huge).unwrap_err().code(), "submission-too-large");
        let nested =
            format!("{{\"answers\":{{\"a\":{{\"value\":{}1{}}}}}}}", "[".repeat(500), "]".repeat(500));
        assert!(Submission::from_json(&nested).is_err());
    }
}
