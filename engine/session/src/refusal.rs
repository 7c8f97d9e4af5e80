//! The refusal of a request: what is wrong, where, and what to try, as `application/problem+json` (RFC 9457) has it.

use std::fmt;

use http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::EngineError;
use triad_engine::analysis::AnalysisError;
use triad_engine::scene::SceneError;

/// One place in the input that is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "Fault")]
pub struct InputFault {
    /// Where: a JSON pointer into the request body, as a URI fragment.
    #[schemars(example = "#/scene/joints/0/axis")]
    pub pointer: String,
    /// What is wrong there.
    pub detail: String,
}

/// What went wrong, where, and what to do about it (RFC 9457).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    status: StatusCode,
    code: &'static str,
    detail: String,
    hint: String,
    errors: Vec<InputFault>,
}

/// The members of a problem document as they go over the wire.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "Problem")]
pub struct ProblemDocument {
    /// A stable name for this kind of problem, as a URI.
    #[serde(rename = "type")]
    #[schemars(example = "urn:triad:problem:unknown-lesson")]
    pub kind: String,
    /// A short summary, the same for every problem of this kind.
    pub title: String,
    /// The HTTP status, repeated.
    pub status: u16,
    /// What happened this time.
    pub detail: String,
    /// The stable name of this kind of problem.
    #[schemars(example = "unknown-lesson")]
    pub code: String,
    /// What to try.
    pub hint: String,
    /// The places in the input that are wrong; empty if the problem is not about the input.
    pub errors: Vec<InputFault>,
    /// Names the request, to be quoted in a report; the header `x-request-id` and the server's log have the same.
    pub trace_id: String,
}

impl Refusal {
    /// A refusal with its HTTP `status`, stable kebab-case `code`, this occurrence's `detail` and the remedy.
    pub fn new(
        status: StatusCode,
        code: &'static str,
        detail: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self { status, code, detail: detail.into(), hint: hint.into(), errors: Vec::new() }
    }

    /// The same refusal, with another status.
    #[must_use]
    pub fn with_status(self, status: StatusCode) -> Self {
        Self { status, ..self }
    }

    /// The same refusal, pointing at a place in the input (`pointer` like `/joints/0/axis`).
    #[must_use]
    pub fn at(mut self, pointer: impl AsRef<str>, detail: impl Into<String>) -> Self {
        let pointer = format!("#{}", pointer.as_ref());
        self.errors.push(InputFault { pointer, detail: detail.into() });
        self
    }

    /// The same refusal, seen from a document that holds the input under `prefix` (like `/scene`).
    #[must_use]
    pub fn within(mut self, prefix: &str) -> Self {
        for fault in &mut self.errors {
            fault.pointer = format!("#{prefix}{}", fault.pointer.trim_start_matches('#'));
        }
        self
    }

    /// The HTTP status.
    pub fn status(&self) -> StatusCode {
        self.status
    }

    /// The stable kebab-case code.
    pub fn code(&self) -> &'static str {
        self.code
    }

    /// The document as it goes over the wire; `trace_id` names this occurrence.
    pub fn document(&self, trace_id: String) -> ProblemDocument {
        ProblemDocument {
            kind: format!("urn:triad:problem:{}", self.code),
            title: title(self.code),
            status: self.status.as_u16(),
            detail: self.detail.clone(),
            code: self.code.to_owned(),
            hint: self.hint.clone(),
            errors: self.errors.clone(),
            trace_id,
        }
    }
}

/// The title of a kind of problem is its code, read as words.
fn title(code: &str) -> String {
    let words = code.replace('-', " ");
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

impl fmt::Display for Refusal {
    /// The form for a terminal: the sentence, then each place, then the remedy.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.detail, self.code)?;
        for fault in &self.errors {
            write!(f, "\n  at {}", fault.pointer.trim_start_matches('#'))?;
            // Where there is nothing more to say about the place, the sentence has said it.
            if fault.detail != self.detail {
                write!(f, ": {}", fault.detail)?;
            }
        }
        if !self.hint.is_empty() {
            write!(f, "\n  try: {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for Refusal {}

impl From<EngineError> for Refusal {
    fn from(error: EngineError) -> Self {
        let status = match &error {
            EngineError::Catalogue(_) => StatusCode::NOT_FOUND,
            EngineError::Scene(SceneError::TooLong { .. }) => StatusCode::PAYLOAD_TOO_LARGE,
            _ => StatusCode::UNPROCESSABLE_ENTITY,
        };
        let detail = error.to_string();
        let refusal = Self::new(status, error.code(), detail.clone(), error.hint());
        match error.pointer() {
            Some(pointer) => refusal.at(pointer, detail),
            None => refusal,
        }
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
            other => {
                Self::new(StatusCode::UNPROCESSABLE_ENTITY, other.code(), other.to_string(), other.hint())
            }
        }
    }
}

/// The names in `known` that `wanted` may have been meant to be, best first, at most three.
pub fn near_matches<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let mut scored: Vec<(f64, &str)> = known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&start(wanted), &start(name)), name))
        .filter(|(score, _)| *score > 0.72)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    scored.into_iter().take(3).map(|(_, name)| name).collect()
}

/// What of a name is compared with others: comparing takes the product of both lengths.
fn start(name: &str) -> String {
    name.chars().take(64).flat_map(char::to_lowercase).collect()
}

/// “did you mean …?” if anything is near, else a list of everything that is known.
pub fn suggest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let near = near_matches(wanted, known.clone());
    if near.is_empty() {
        let all: Vec<&str> = known.into_iter().collect();
        format!("known names: {}", all.join(", "))
    } else {
        format!("did you mean {}?", near.join(" or "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_finds_its_neighbour_first() {
        let known = ["simple-pendulum", "spatial-double-pendulum", "free-body"];
        assert_eq!(near_matches("simple-pendulm", known).first(), Some(&"simple-pendulum"));
        assert!(near_matches("qqq", known).is_empty());
        assert_eq!(suggest("qqq", ["a", "b"]), "known names: a, b");
    }

    #[test]
    fn names_of_any_length_are_compared_by_their_first_letters() {
        let (known, long) = ("a".repeat(64) + "b", "a".repeat(64) + &"c".repeat(1000));
        assert_eq!(near_matches(&long, [known.as_str(), "aaaa"]), [known.as_str()]);
        assert_eq!(start(&long), start(&known));
    }

    #[test]
    fn pointers_move_with_their_document() {
        let refusal =
            Refusal::new(StatusCode::BAD_REQUEST, "x-y", "d", "h").at("/joints/0", "bad").within("/scene");
        let document = refusal.document(String::new());
        assert_eq!(
            (document.errors[0].pointer.as_str(), document.title.as_str()),
            ("#/scene/joints/0", "X y")
        );
        assert!(refusal.to_string().contains("at /scene/joints/0: bad"));
    }
}
