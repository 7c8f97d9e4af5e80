//! The HTTP interface, called in process.

// The exemption of the lints for tests does not reach the helpers beside them.
#![allow(clippy::expect_used, clippy::panic)]

mod analysis;
mod bad_input;
mod below;
mod bounds;
mod changes;
mod class;
mod dealing;
mod described;
mod document;
mod explanations;
mod generated;
mod glance;
mod leaving;
mod lectures;
mod lessons;
mod lti;
mod motion;
mod oidc;
mod policy;
mod predictions;
mod queue;
mod regrade;
mod schema;
mod secrets;
mod sessions;
mod streams;
mod term;
mod variants;

use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes, to_bytes};
use axum::http::{HeaderMap, Request, StatusCode, header};
use serde_json::Value;
use tower::ServiceExt;
use triad::app::App;
use triad::limits::Limits;
use triad::store::Store;
use triad_lessons::Course;
use triad_tests::postgres::{self, Postgres};

/// A server with the built-in course and a gradebook in memory, or in a database of its own where PostgreSQL is given.
#[allow(clippy::needless_pass_by_value)] // a test's own limits
fn state(limits: Limits) -> App {
    let store = postgres::given()
        .map_or_else(Store::in_memory, |server| Store::of_server(&server.database()).expect("an address"));
    // What these tests hand in is answered at once, however busy the machine is.
    let usual = limits.at_once == Limits::default().at_once;
    let at_once = if usual { Duration::from_hours(1) } else { limits.at_once };
    App::new(Course::embedded().expect("a course"), store, Limits { at_once, ..limits })
}

/// Every test of this program once more, with PostgreSQL.
#[test]
fn the_whole_interface_is_the_same_on_postgresql() {
    const ITSELF: &str = "the_whole_interface_is_the_same_on_postgresql";
    let Some(server) = Postgres::start("the HTTP interface on PostgreSQL") else { return };
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    runtime.block_on(async {
        let template = server.template().parse().expect("an address");
        Store::at(&template).await.expect("makes its tables").close().await;
    });
    server.again(&[], &[ITSELF]);
}

fn server() -> Router {
    triad::app(state(Limits::default()))
}

/// What came back.
struct Reply {
    status: StatusCode,
    headers: HeaderMap,
    bytes: Bytes,
}

impl Reply {
    fn json(&self) -> Value {
        serde_json::from_slice(&self.bytes).expect("JSON")
    }

    fn media(&self) -> &str {
        self.headers.get(header::CONTENT_TYPE).map_or("", |value| value.to_str().expect("text"))
    }

    /// The document of a refusal; checks everything that all refusals share.
    fn problem(&self, status: u16, code: &str) -> Value {
        let document = self.json();
        assert_eq!(self.status.as_u16(), status, "{document}");
        assert_eq!(self.media(), "application/problem+json");
        assert_eq!(document["code"], code, "{document}");
        assert_eq!(document["status"], status);
        for member in ["type", "title", "detail", "hint", "trace_id"] {
            assert!(document[member].as_str().is_some_and(|text| !text.is_empty()), "{member}: {document}");
        }
        assert!(document["errors"].is_array());
        document
    }
}

async fn send(server: &Router, request: Request<Body>) -> Reply {
    let response = server.clone().oneshot(request).await.expect("answers");
    let (parts, body) = response.into_parts();
    let bytes = to_bytes(body, 512 << 20).await.expect("a body");
    Reply { status: parts.status, headers: parts.headers, bytes }
}

async fn get(server: &Router, path: &str) -> Reply {
    send(server, Request::get(path).body(Body::empty()).expect("a request")).await
}

async fn post(server: &Router, path: &str, body: impl ToString) -> Reply {
    let request = Request::post(path).header(header::CONTENT_TYPE, "application/json");
    send(server, request.body(Body::from(body.to_string())).expect("a request")).await
}
