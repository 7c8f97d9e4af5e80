//! What is not graded at once, where graders share the gradebook: it waits, is graded, and is told to nobody else.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};
use triad::grader::{Grader, LEASE};
use triad::limits::Limits;
use triad_tests::postgres;

use crate::class::{Class, class_with};
use crate::{Reply, send};

const ADDRESS: &str = "/api/v1/lessons/simple-pendulum/submissions";

async fn hand_in(class: &Class, cookie: &str, key: &str, value: &str) -> Reply {
    let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}}).to_string();
    let request = Request::post(ADDRESS)
        .header(header::CONTENT_TYPE, "application/json")
        .header(header::COOKIE, cookie)
        .header("idempotency-key", key);
    send(&class.server, request.body(Body::from(body)).expect("a request")).await
}

/// Asks until it is no longer waiting.
async fn graded(class: &Class, cookie: &str, at: &str) -> Value {
    loop {
        let state = class.ask("GET", at, cookie, None).await.json();
        if state["state"] != "waiting" {
            return state;
        }
        tokio::task::yield_now().await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn what_takes_longer_is_graded_in_its_turn_and_told_to_its_author() {
    if postgres::given().is_none() {
        // A gradebook of one server is graded by it, in the request.
        return;
    }
    let class = class_with(Limits { at_once: Duration::ZERO, ..Limits::default() }).await;
    let (ada, _) = class.join("Ada").await;
    let (emmy, _) = class.join("Emmy").await;
    let reply = hand_in(&class, &ada, "one", "9.81").await;
    let state = reply.json();
    assert_eq!(
        (reply.status.as_u16(), &state["state"], &state["before"]),
        (202, &json!("waiting"), &json!(0))
    );
    let at = reply.headers[header::LOCATION].to_str().expect("text").to_owned();
    assert_eq!(at, format!("/api/v1/submissions/{}", state["id"].as_str().expect("an id")));
    let again = hand_in(&class, &ada, "one", "9.81").await;
    assert_eq!((again.status.as_u16(), &again.json()["id"]), (202, &state["id"]), "it is the same");
    let second = hand_in(&class, &emmy, "one", "1").await.json();
    assert_eq!(second["before"], 1);
    class.ask("GET", &at, &emmy, None).await.problem(404, "unknown-entry");
    class.ask("GET", &at, "", None).await.problem(401, "sign-in-needed");
    assert_eq!(class.ask("GET", "/api/v1/submissions", &ada, None).await.json(), json!([]));

    let grader =
        Grader::new(Arc::clone(&class.app.store), Arc::clone(&class.app.variants), Arc::default(), 2, LEASE);
    let grading = tokio::spawn(Arc::clone(&grader).run());
    let state = graded(&class, &ada, &at).await;
    assert_eq!(state["state"], "graded", "{state}");
    let verdict = &state["verdict"];
    assert_eq!((&verdict["student"], &verdict["provenance"]["seed"]), (&json!("Ada"), &json!("")));
    let told = hand_in(&class, &ada, "one", "9.81").await;
    assert_eq!((told.status.as_u16(), &told.json()), (201, verdict), "the same as in the answer");
    class.ask("GET", &at, &emmy, None).await.problem(404, "unknown-entry");
    let others = format!("/api/v1/submissions/{}", second["id"].as_str().expect("an id"));
    assert_eq!(graded(&class, &emmy, &others).await["state"], "graded");
    grading.abort();
    grader.finish(2).await;
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test(flavor = "multi_thread")]
async fn what_no_grader_could_grade_is_refused_before_it_waits() {
    if postgres::given().is_none() {
        return;
    }
    let class = class_with(Limits { at_once: Duration::ZERO, ..Limits::default() }).await;
    let (ada, _) = class.join("Ada").await;
    let body = json!({"answers": {"of-another-lesson": {"value": "1"}}});
    class.ask("POST", ADDRESS, &ada, Some(body)).await.problem(422, "unknown-question");
    assert_eq!(class.ask("GET", "/api/v1/submissions", &ada, None).await.json(), json!([]));
    assert_eq!(
        class.app.store.gradings().await.expect("looks"),
        (0, 0),
        "nothing waits, nothing is put aside"
    );
}
