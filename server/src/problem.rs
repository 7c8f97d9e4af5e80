//! The error of all requests and commands: `application/problem+json` over HTTP, the same words on a terminal.
//!
//! Every error enum of the workspace is turned into a [`Problem`] in exactly one place (its `From`
//! implementation), so that a mistake is reported with the same code, sentence and remedy in the page, over HTTP
//! and on the command line.

use std::fmt;

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use triad_engine::EngineError;
use triad_engine::analysis::AnalysisError;
use triad_engine::scene::SceneError;
use triad_session::refusal::Refusal;

use crate::request;

pub use triad_session::refusal::{ProblemDocument, near_matches, suggest};

/// What went wrong, where, and what to do about it (RFC 9457): a refusal that is an answer over HTTP.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem(Refusal);

/// The code of the problem that an answer is about, for those who count answers.
#[derive(Debug, Clone, Copy)]
pub struct ProblemCode(pub &'static str);

impl Problem {
    /// A problem with its HTTP `status`, stable kebab-case `code`, this occurrence's `detail` and the remedy.
    pub fn new(
        status: StatusCode,
        code: &'static str,
        detail: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self(Refusal::new(status, code, detail, hint))
    }

    /// The same problem, told as one that may pass (503).
    #[must_use]
    pub fn unavailable(self) -> Self {
        Self(self.0.with_status(StatusCode::SERVICE_UNAVAILABLE))
    }

    /// The same problem, pointing at a place in the input (`pointer` like `/joints/0/axis`).
    #[must_use]
    pub fn at(self, pointer: impl AsRef<str>, detail: impl Into<String>) -> Self {
        Self(self.0.at(pointer, detail))
    }

    /// The same problem, seen from a document that holds the input under `prefix` (like `/scene`).
    #[must_use]
    pub fn within(self, prefix: &str) -> Self {
        Self(self.0.within(prefix))
    }

    /// The HTTP status.
    pub fn status(&self) -> StatusCode {
        self.0.status()
    }

    /// The stable kebab-case code.
    pub fn code(&self) -> &'static str {
        self.0.code()
    }

    /// The document as it goes over the wire, with a fresh trace id.
    pub fn document(&self) -> ProblemDocument {
        self.0.document(trace_id())
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

/// A name for one occurrence of a problem.
pub(crate) fn trace_id() -> String {
    request::current()
}

impl From<Refusal> for Problem {
    fn from(refusal: Refusal) -> Self {
        Self(refusal)
    }
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        problem.0
    }
}

impl From<EngineError> for Problem {
    fn from(error: EngineError) -> Self {
        Self(error.into())
    }
}

impl From<SceneError> for Problem {
    fn from(error: SceneError) -> Self {
        Self(error.into())
    }
}

impl From<AnalysisError> for Problem {
    fn from(error: AnalysisError) -> Self {
        Self(error.into())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Problem {}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let document = self.document();
        if self.status().is_server_error() {
            let (code, trace) = (self.code(), document.trace_id.as_str());
            tracing::error!(target: "triad", code, trace, "{}", document.detail);
        }
        let mut response = (self.status(), axum::Json(document)).into_response();
        response.extensions_mut().insert(ProblemCode(self.code()));
        response
            .headers_mut()
            .insert(header::CONTENT_TYPE, HeaderValue::from_static("application/problem+json"));
        response
    }
}
