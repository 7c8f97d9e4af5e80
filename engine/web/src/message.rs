//! What passes between the page and the engine: requests as HTTP has them, answers, and what is streamed of a run.

use http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use triad_session::refusal::Refusal;

/// A request. The method `OPEN` streams the run at the path, and `CLOSE` ends that.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// By which the answer is known.
    pub id: u32,
    /// The method, in capitals.
    pub method: String,
    /// The address below `/api/v1`, with its query.
    pub path: String,
    /// The body.
    #[serde(default)]
    pub body: Value,
}

impl Request {
    /// The words of the path, without the query; not decoded.
    pub fn words(&self) -> Vec<&str> {
        let path = self.path.split('?').next().unwrap_or_default();
        path.split('/').filter(|word| !word.is_empty()).collect()
    }

    /// The query, read as `T`.
    ///
    /// # Errors
    ///
    /// [`Refusal`]: it is none.
    pub fn query<'a, T: Deserialize<'a>>(&'a self) -> Result<T, Refusal> {
        let query = self.path.split_once('?').map_or("", |(_, query)| query);
        serde_urlencoded::from_str(query).map_err(|error| {
            Refusal::new(
                StatusCode::BAD_REQUEST,
                "invalid-query",
                error.to_string(),
                "see the parameters of this address in the interface's description",
            )
        })
    }

    /// The body, read as `T`.
    ///
    /// # Errors
    ///
    /// [`Refusal`]: it is none.
    pub fn body<T: for<'a> Deserialize<'a>>(&self) -> Result<T, Refusal> {
        let empty = serde_json::json!({});
        let body = if self.body.is_null() { &empty } else { &self.body };
        T::deserialize(body).map_err(|error| {
            Refusal::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "invalid-body",
                error.to_string(),
                "see the body of this request in the interface's description",
            )
        })
    }
}

/// The body of an answer, or why there is none.
pub type Answer = Result<Vec<u8>, Refusal>;

/// A value as the body of an answer.
///
/// # Errors
///
/// [`Refusal`]: it cannot be written as JSON.
pub fn json(value: &impl Serialize) -> Answer {
    serde_json::to_vec(value).map_err(|error| {
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, "internal", error.to_string(), "report this")
    })
}

/// What a message begins with: one line of JSON. What follows the line is what it carries.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Head<'a> {
    Answer { answer: u32, status: u16 },
    Streamed { run: &'a str, binary: bool },
}

fn with(head: &Head, body: &[u8]) -> Vec<u8> {
    let mut message = serde_json::to_vec(head).unwrap_or_default();
    message.push(b'\n');
    message.extend_from_slice(body);
    message
}

/// The answer to request `id`.
pub fn answer(id: u32, answer: Answer) -> Vec<u8> {
    let body = answer.map(|body| (StatusCode::OK, body));
    let (status, body) = body.unwrap_or_else(|refusal| {
        // Nobody keeps a log here in which this occurrence could be looked up.
        let document = refusal.document("in-this-page".to_owned());
        (refusal.status(), serde_json::to_vec(&document).unwrap_or_default())
    });
    with(&Head::Answer { answer: id, status: status.as_u16() }, &body)
}

/// A text that is streamed of a run, as its JSON.
pub fn streamed(run: &str, text: &[u8]) -> Vec<u8> {
    with(&Head::Streamed { run, binary: false }, text)
}

/// A block of frames that is streamed of a run.
pub fn block(run: &str, block: &[u8]) -> Vec<u8> {
    with(&Head::Streamed { run, binary: true }, block)
}
