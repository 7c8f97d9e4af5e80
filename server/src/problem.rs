//! The error of all requests and commands: `application/problem+json` over HTTP, the same words on a terminal.
//!
//! Every error enum of the workspace is turned into a [`Problem`] in exactly one place (its `From`
//! implementation), so that a mistake is reported with the same code, sentence and remedy in the page, over HTTP
//! and on the command line.

use std::fmt;

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::Serialize;

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
pub struct Problem {
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
    /// Names this one occurrence, to be quoted in a report; the server's log has the same.
    pub trace_id: String,
}

impl Problem {
    /// The same problem, told as one that may pass (503).
    #[must_use]
    pub fn unavailable(self) -> Self {
        Self { status: StatusCode::SERVICE_UNAVAILABLE, ..self }
    }

    /// A problem with its HTTP `status`, stable kebab-case `code`, this occurrence's `detail` and the remedy.
    pub fn new(
        status: StatusCode,
        code: &'static str,
        detail: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self { status, code, detail: detail.into(), hint: hint.into(), errors: Vec::new() }
    }

    /// The same problem, pointing at a place in the input (`pointer` like `/joints/0/axis`).
    #[must_use]
    pub fn at(mut self, pointer: impl AsRef<str>, detail: impl Into<String>) -> Self {
        let pointer = format!("#{}", pointer.as_ref());
        self.errors.push(InputFault { pointer, detail: detail.into() });
        self
    }

    /// The same problem, seen from a document that holds the input under `prefix` (like `/scene`).
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

    /// The document as it goes over the wire, with a fresh trace id.
    pub fn document(&self) -> ProblemDocument {
        ProblemDocument {
            kind: format!("urn:triad:problem:{}", self.code),
            title: title(self.code),
            status: self.status.as_u16(),
            detail: self.detail.clone(),
            code: self.code.to_owned(),
            hint: self.hint.clone(),
            errors: self.errors.clone(),
            trace_id: uuid::Uuid::new_v4().simple().to_string(),
        }
    }

    /// The server's own fault: `cause` goes to the log, the caller learns only that it is not their mistake.
    pub fn internal(cause: impl fmt::Display) -> Self {
        Self::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "internal",
            format!("the server could not finish the request: {cause}"),
            "this is not your mistake; try again, and report the trace_id if it comes back",
        )
    }
}

/// The title of a kind of problem is its code, read as words.
fn title(code: &str) -> String {
    let words = code.replace('-', " ");
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

impl fmt::Display for Problem {
    /// The form for a terminal: the sentence, then each place, then the remedy.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.detail, self.code)?;
        for fault in &self.errors {
            write!(f, "\n  at {}: {}", fault.pointer.trim_start_matches('#'), fault.detail)?;
        }
        if !self.hint.is_empty() {
            write!(f, "\n  try: {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problem {}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let document = self.document();
        if self.status.is_server_error() {
            eprintln!("triad: {} (trace {})", self, document.trace_id);
        }
        let mut response = (self.status, axum::Json(document)).into_response();
        response
            .headers_mut()
            .insert(header::CONTENT_TYPE, HeaderValue::from_static("application/problem+json"));
        response
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
    fn pointers_move_with_their_document() {
        let problem =
            Problem::new(StatusCode::BAD_REQUEST, "x-y", "d", "h").at("/joints/0", "bad").within("/scene");
        assert_eq!(problem.document().errors[0].pointer, "#/scene/joints/0");
        assert_eq!(problem.document().title, "X y");
        assert!(problem.to_string().contains("at /scene/joints/0: bad"));
    }
}
