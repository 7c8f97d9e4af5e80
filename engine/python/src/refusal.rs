//! What went wrong, where, and what to try: one exception for all of it.

use pyo3::prelude::*;
use pyo3::{create_exception, exceptions::PyException};
use triad_engine::EngineError;
use triad_engine::analysis::AnalysisError;
use triad_engine::scene::text::nearest_name;
use triad_engine::scene::{SceneError, UnknownWord};
use triad_lab::sweep::SweepError;
use triad_lessons::{CourseError, GradeError, SubmissionError, VariantError};

create_exception!(
    triad,
    TriadError,
    PyException,
    "What went wrong (str), where in the input (pointer), and what to try (hint)."
);

/// An error on its way to Python.
#[derive(Debug)]
pub struct Refusal {
    code: String,
    what: String,
    pointer: Option<String>,
    hint: String,
}

impl Refusal {
    /// With its stable code, a sentence and a remedy.
    pub fn new(code: &str, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { code: code.to_owned(), what: what.into(), pointer: None, hint: hint.into() }
    }

    /// A name that does not exist, with the one that was probably meant.
    pub fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Self {
        let all = known.clone().collect::<Vec<_>>().join(", ");
        let hint = match nearest_name(name, known) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None if all.is_empty() => "there is none".to_owned(),
            None => format!("there are {all}"),
        };
        let code = format!("unknown-{}", what.replace(' ', "-"));
        Self::new(&code, format!("there is no {what} \"{name}\""), hint)
    }

    /// A word that an option does not know.
    pub fn word(option: &str, word: &str, UnknownWord(words): UnknownWord) -> Self {
        let what = format!("{option} cannot be \"{word}\"");
        Self {
            pointer: Some(option.to_owned()),
            ..Self::new("unknown-word", what, format!("there are {words}"))
        }
    }

    /// The same, about a place in the input.
    pub fn at(self, pointer: Option<String>) -> Self {
        Self { pointer, ..self }
    }
}

impl From<EngineError> for Refusal {
    fn from(error: EngineError) -> Self {
        Self::new(error.code(), error.to_string(), error.hint()).at(error.pointer())
    }
}

impl From<SceneError> for Refusal {
    fn from(error: SceneError) -> Self {
        EngineError::from(error).into()
    }
}

impl From<AnalysisError> for Refusal {
    fn from(error: AnalysisError) -> Self {
        match error {
            AnalysisError::Engine(error) => error.into(),
            other => Self::new(other.code(), other.to_string(), other.hint()),
        }
    }
}

impl From<SweepError> for Refusal {
    fn from(error: SweepError) -> Self {
        let (code, hint) = match error {
            SweepError::Engine(error) => return error.into(),
            SweepError::Count { .. } => ("sweep-size", "give grids fewer points, and samples at least 1"),
            SweepError::Twice { .. } => ("varied-twice", "vary it once"),
            SweepError::Undrawn { .. } => ("nothing-drawn", "leave samples out, or draw a number at random"),
            SweepError::Threads { .. } => ("threads", "give fewer threads, or leave the option out"),
        };
        Self::new(code, error.to_string(), hint)
    }
}

impl From<CourseError> for Refusal {
    fn from(error: CourseError) -> Self {
        Self::new(error.code(), error.to_string(), "triad lesson check tells all that is wrong with a course")
    }
}

impl From<VariantError> for Refusal {
    fn from(error: VariantError) -> Self {
        Self::new(error.code(), error.to_string(), "this is the author's mistake, not yours")
    }
}

impl From<SubmissionError> for Refusal {
    fn from(error: SubmissionError) -> Self {
        Self::new(error.code(), error.to_string(), error.hint())
    }
}

impl From<GradeError> for Refusal {
    fn from(error: GradeError) -> Self {
        let hint = match error {
            GradeError::UnknownQuestion { .. } => "answer only the questions of this lesson, by their ids",
            GradeError::NoLongerWanted => "ask again, and wait",
        };
        Self::new(error.code(), error.to_string(), hint)
    }
}

impl From<serde_json::Error> for Refusal {
    fn from(error: serde_json::Error) -> Self {
        Self::new(
            "not-understood",
            error.to_string(),
            "triad's documentation names the options and their types",
        )
    }
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> Self {
        let Refusal { code, what, pointer, hint } = refusal;
        let mut text = format!("{what} [{code}]");
        if let Some(pointer) = &pointer {
            text = format!("{text}\n  at {pointer}");
        }
        if !hint.is_empty() {
            text = format!("{text}\n  try: {hint}");
        }
        Python::attach(|py| {
            let error = TriadError::new_err(text);
            let value = error.value(py);
            let parts = [
                ("code", Some(code)),
                ("what", Some(what)),
                ("pointer", pointer),
                ("hint", Some(hint)),
                ("partial", None),
            ];
            for (name, part) in parts {
                if let Err(failure) = value.setattr(name, part) {
                    return failure;
                }
            }
            error
        })
    }
}
