//! Reading requests, with errors that name the place.

use std::time::Duration;

use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, PathRejection, QueryRejection};
use axum::extract::{FromRequest, FromRequestParts, Path, Query, Request};
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;
use tokio::time::timeout;

use crate::problem::Problem;

/// How long a body may take to arrive: eight megabytes over a slow line.
const BODY_TIME: Duration = Duration::from_mins(1);

/// A request body in JSON. A missing body is read as `{}` where everything in it is optional.
#[derive(Debug)]
pub struct Json<T>(pub T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequest<S> for Json<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self, Problem> {
        let media = request.headers().get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok());
        let is_json = media.is_none_or(|media| {
            let essence = media.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
            essence == "application/json" || essence.ends_with("+json")
        });
        let stated = media.unwrap_or("nothing").to_owned();
        let bytes = whole_body(request, state, BODY_TIME).await?;
        if !is_json || (stated == "nothing" && !bytes.is_empty()) {
            return Err(Problem::new(
                StatusCode::UNSUPPORTED_MEDIA_TYPE,
                "not-json",
                format!("the body must be JSON; the content-type header says {stated}"),
                "send the header content-type: application/json",
            ));
        }
        if bytes.is_empty() {
            return match serde_json::from_str("{}") {
                Ok(value) => Ok(Self(value)),
                Err(_) => Err(Problem::new(
                    StatusCode::BAD_REQUEST,
                    "missing-body",
                    "the request has no body",
                    "send a JSON document; /api/openapi.json says what belongs into it",
                )),
            };
        }
        parse(&bytes).map(Self)
    }
}

/// The bytes of a body, as soon as all have arrived.
///
/// Errors if they do not within `time`, or are too many.
async fn whole_body<S: Send + Sync>(request: Request, state: &S, time: Duration) -> Result<Bytes, Problem> {
    let body = timeout(time, Bytes::from_request(request, state));
    body.await.map_err(|_| late_body())?.map_err(|rejection| unreadable_body(&rejection))
}

/// Reads JSON; errors point to the place.
pub fn parse<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Problem> {
    parse_as("the body", "compare with the request's schema in /api/openapi.json", bytes)
}

/// The same of something that is no body of a request: what it is, and where to look up what belongs into it.
pub fn parse_as<T: DeserializeOwned>(what: &str, hint: &'static str, bytes: &[u8]) -> Result<T, Problem> {
    let mut reader = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let pointer: String = error.path().iter().map(segment).collect();
        invalid(what, hint, &pointer, error.inner())
    })?;
    reader.end().map_err(|error| invalid(what, hint, "", &error))?;
    Ok(value)
}

fn segment(segment: &Segment) -> String {
    match segment {
        Segment::Seq { index } => format!("/{index}"),
        Segment::Map { key } | Segment::Enum { variant: key } => {
            format!("/{}", key.replace('~', "~0").replace('/', "~1"))
        }
        Segment::Unknown => String::new(),
    }
}

fn invalid(what: &str, hint: &'static str, pointer: &str, error: &serde_json::Error) -> Problem {
    use serde_json::error::Category;
    let (status, code, hint) = match error.classify() {
        Category::Data => (StatusCode::UNPROCESSABLE_ENTITY, "invalid-request", hint),
        Category::Syntax | Category::Eof | Category::Io => (
            StatusCode::BAD_REQUEST,
            "invalid-json",
            "check the brackets, quotation marks and commas at that place",
        ),
    };
    Problem::new(status, code, format!("{what} could not be read: {error}"), hint)
        .at(pointer, error.to_string())
}

fn late_body() -> Problem {
    Problem::new(
        StatusCode::REQUEST_TIMEOUT,
        "late-body",
        format!("the body did not arrive within {} s", BODY_TIME.as_secs()),
        "send the request again, over a better line",
    )
}

fn unreadable_body(rejection: &BytesRejection) -> Problem {
    if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE {
        return too_large(None);
    }
    Problem::new(
        StatusCode::BAD_REQUEST,
        "unreadable-body",
        format!("the body did not arrive whole: {}", rejection.body_text()),
        "send the request again",
    )
}

/// The answer to a body that exceeds the bound.
pub fn too_large(limit: Option<usize>) -> Problem {
    let most = limit.map(|bytes| format!(": {bytes} bytes")).unwrap_or_default();
    Problem::new(
        StatusCode::PAYLOAD_TOO_LARGE,
        "request-too-large",
        format!("the request's body is larger than this server takes{most}"),
        "send a smaller scene, or run it on the command line: triad run SCENE",
    )
}

/// The variable parts of an address.
#[derive(Debug)]
pub struct PathParameters<T>(pub T);

impl<T: DeserializeOwned + Send, S: Send + Sync> FromRequestParts<S> for PathParameters<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let found = Path::<T>::from_request_parts(parts, state).await;
        found.map(|Path(value)| Self(value)).map_err(|rejection: PathRejection| {
            Problem::new(
                StatusCode::BAD_REQUEST,
                "invalid-address",
                format!("the address could not be read: {}", rejection.body_text()),
                "see /api/openapi.json for the form of the addresses",
            )
        })
    }
}

/// The parameters after the question mark of an address.
#[derive(Debug)]
pub struct QueryParameters<T>(pub T);

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for QueryParameters<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let found = Query::<T>::from_request_parts(parts, state).await;
        found.map(|Query(value)| Self(value)).map_err(|rejection: QueryRejection| {
            Problem::new(
                StatusCode::BAD_REQUEST,
                "invalid-query",
                format!(
                    "the parameters after the question mark could not be read: {}",
                    rejection.body_text()
                ),
                "see /api/openapi.json for the parameters of each address",
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use axum::body::Body;
    use futures_util::stream::{StreamExt, iter, pending};

    use super::*;

    #[tokio::test]
    async fn a_body_that_does_not_end_is_not_waited_for() {
        let begun = iter([Ok::<_, Infallible>("{\"name\":")]).chain(pending());
        let request = Request::new(Body::from_stream(begun));
        let told = timeout(Duration::from_mins(1), whole_body(request, &(), Duration::from_millis(50)));
        let problem = told.await.expect("it is not waited for").expect_err("it is not whole");
        assert_eq!((problem.code(), problem.status()), ("late-body", StatusCode::REQUEST_TIMEOUT));
    }
}
