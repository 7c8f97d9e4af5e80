//! Everything that can be wrong with a request is told with its place and a remedy, and the server lives on.

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};
use triad::limits::Limits;

use crate::{get, post, send, server, state};

fn scene() -> Value {
    json!({
        "name": "bar",
        "bodies": [{"name": "bar", "mass": 1.0, "inertia": {"principal": [1.0, 1.0, 1.0]}}],
        "joints": [{"name": "pin", "type": "spherical", "body_i": "ground", "body_j": "bar", "point": [0, 0, 0]}]
    })
}

#[tokio::test]
async fn scenes_are_refused_at_the_place_that_is_wrong() {
    let server = server();
    let start = json!({"scene": scene()});
    assert_eq!(post(&server, "/api/v1/sessions", &start).await.status, 201, "the scene itself is good");
    let cases: [(&str, Value, &str); 8] = [
        ("/bodies/0/mass", json!("heavy"), "/bodies/0/mass"),
        ("/bodies/0/mass", json!(0.0), "/bodies/0/mass"),
        ("/bodies/0/mass", json!(-1.0), "/bodies/0/mass"),
        ("/bodies/0/inertia", json!({"principal": [1.0, 1.0, 5.0]}), "/bodies/0/inertia"),
        ("/bodies/0", json!({"name": "bar", "mass": 1.0, "colour": "red"}), "/bodies/0/colour"),
        ("/joints/0/body_j", json!("bra"), "/joints/0/body_j"),
        ("/joints/0/type", json!("hinge"), "/joints/0/type"),
        ("/gravity", json!([0.0, 1.0]), "/gravity"),
    ];
    for (place, value, pointer) in cases {
        let mut wrong = scene();
        match place {
            "/gravity" => wrong["gravity"] = value,
            _ => *wrong.pointer_mut(place).expect("the place") = value,
        }
        let check = post(&server, "/api/v1/check", &wrong).await;
        let session = post(&server, "/api/v1/sessions", json!({"scene": wrong})).await;
        for (reply, prefix) in [(check, ""), (session, "/scene")] {
            let document = reply.json();
            assert_eq!(reply.status, 422, "{document}");
            assert_eq!(reply.media(), "application/problem+json");
            let found = document["errors"][0]["pointer"].as_str().unwrap_or_default();
            assert!(found.starts_with(&format!("#{prefix}{pointer}")), "{pointer}: {document}");
            assert!(document["hint"].as_str().is_some_and(|hint| !hint.is_empty()), "{document}");
        }
    }
    assert_eq!(get(&server, "/api/v1/health").await.json()["status"], "ok");
}

#[tokio::test]
async fn a_scene_with_too_many_bodies_is_refused_before_it_is_built() {
    let server = server();
    let mut large = scene();
    let body = large["bodies"][0].clone();
    let bodies: Vec<Value> = (0..600)
        .map(|k| {
            let mut body = body.clone();
            body["name"] = json!(format!("bar-{k}"));
            body
        })
        .collect();
    large["bodies"] = json!(bodies);
    let problem = post(&server, "/api/v1/check", &large).await.problem(422, "scene-too-large");
    assert_eq!(problem["errors"][0]["pointer"], "#/bodies");
    let problem = post(&server, "/api/v1/sessions", json!({"scene": large})).await;
    assert_eq!(problem.problem(422, "scene-too-large")["errors"][0]["pointer"], "#/scene/bodies");
    post(&server, "/api/v1/sessions", json!({"builtin": "n-four-bar:900"}))
        .await
        .problem(422, "scene-too-large");
    post(&server, "/api/v1/sessions", json!({"builtin": "n-four-bar:1000000"}))
        .await
        .problem(404, "scene-number");
}

#[tokio::test]
async fn joints_drivers_and_loads_are_bounded_together() {
    let server = triad::app(state(Limits { connections: 40, ..Limits::default() }));
    let mut crowded = scene();
    let joints = crowded["joints"].as_array().expect("joints").len();
    let push = |k: usize| json!({"type": "force", "name": format!("push {k}"), "body": crowded["bodies"][0]["name"], "force": [0, 0, 0]});
    let loads: Vec<Value> = (0..=40 - joints).map(push).collect();
    let enough = loads[..40 - joints].to_vec();
    crowded["loads"] = json!(loads);
    let problem = post(&server, "/api/v1/sessions", json!({"scene": crowded})).await;
    assert_eq!(problem.problem(422, "scene-too-large")["errors"][0]["pointer"], "#/scene/loads");
    crowded["loads"] = json!(enough);
    assert_eq!(post(&server, "/api/v1/sessions", json!({"scene": crowded})).await.status, 201);
}

#[tokio::test]
async fn joints_that_meet_at_one_body_are_bounded_before_their_products_are() {
    let server = server();
    let joint = |k: usize| {
        let point = [0.001 * k as f64, (k % 7) as f64, 1.0];
        json!({"name": format!("j{k}"), "type": "spherical", "body_i": "ground", "body_j": "plate", "point": point})
    };
    let plate = |joints: usize| {
        let inertia = json!({"principal": [1, 1, 1]});
        json!({"name": "plate", "bodies": [{"name": "plate", "mass": 1, "inertia": inertia, "position": [0, 0, 0]}],
            "joints": (0..joints).map(joint).collect::<Vec<_>>()})
    };
    // Their factorization would take 53 GB.
    let problem = post(&server, "/api/v1/check", plate(2000)).await.problem(422, "scene-too-large");
    assert_eq!(problem["errors"][0]["pointer"], "#/joints");
    let problem = post(&server, "/api/v1/sessions", json!({"scene": plate(2000)})).await;
    assert_eq!(problem.problem(422, "scene-too-large")["errors"][0]["pointer"], "#/scene/joints");
    let problem = post(&server, "/api/v1/analyses/assembly", json!({"scene": plate(400)})).await;
    problem.problem(422, "scene-too-large");
    let checked = post(&server, "/api/v1/check", plate(60)).await;
    assert_eq!((checked.status.as_u16(), &checked.json()["rank"]), (200, &json!(12)));
}

#[tokio::test]
async fn a_million_bodies_and_a_hundred_megabytes_are_refused_by_their_size() {
    let server = triad::app(state(Limits { request_bytes: 100_000, ..Limits::default() }));
    let million = r#"{"name":"b","mass":1},"#.repeat(20_000);
    post(&server, "/api/v1/check", format!(r#"{{"name":"x","bodies":[{million}]}}"#))
        .await
        .problem(413, "request-too-large");
    // The same without an announced length.
    let chunks = Body::new(http_body_util::Full::new(axum::body::Bytes::from(million)));
    let request = Request::post("/api/v1/check").header(header::CONTENT_TYPE, "application/json");
    send(&server, request.body(chunks).expect("a request")).await.problem(413, "request-too-large");
    let announced = Request::post("/api/v1/check")
        .header(header::CONTENT_TYPE, "application/json")
        .header(header::CONTENT_LENGTH, "104857600");
    send(&server, announced.body(Body::from("{}")).expect("a request"))
        .await
        .problem(413, "request-too-large");
    assert_eq!(get(&server, "/api/v1/health").await.status, 200);
}

#[tokio::test]
async fn bodies_that_are_not_json_or_not_what_belongs_there() {
    let server = server();
    let sessions = "/api/v1/sessions";
    post(&server, sessions, "{").await.problem(400, "invalid-json");
    post(&server, sessions, "{} x").await.problem(400, "invalid-json");
    post(&server, sessions, "NaN").await.problem(400, "invalid-json");
    post(&server, sessions, "").await.problem(422, "what-to-simulate");
    post(&server, sessions, json!({"builtin": "free-body", "lesson": "x"}))
        .await
        .problem(422, "what-to-simulate");
    post(&server, sessions, json!({"builtin": 7})).await.problem(422, "invalid-request");
    let typo = post(&server, sessions, json!({"builtn": "free-body"})).await.problem(422, "invalid-request");
    assert_eq!(typo["errors"][0]["pointer"], "#/builtn");
    let unknown = post(&server, sessions, json!({"builtin": "fre-body"})).await;
    assert!(unknown.json()["hint"].as_str().is_some_and(|hint| hint.contains("free-body")));
    post(&server, sessions, json!({"lesson": "zzz"})).await.problem(404, "unknown-lesson");
    let form = Request::post(sessions).header(header::CONTENT_TYPE, "application/x-www-form-urlencoded");
    send(&server, form.body(Body::from("builtin=free-body")).expect("a request"))
        .await
        .problem(415, "not-json");
    let deep = format!(r#"{{"scene": {}1{}}}"#, "[".repeat(5000), "]".repeat(5000));
    post(&server, sessions, deep).await.problem(400, "invalid-json");
}

#[tokio::test]
async fn steps_and_speeds_have_bounds() {
    let server = server();
    let path =
        post(&server, "/api/v1/sessions", json!({"builtin": "free-body"})).await.json()["links"]["self"]
            .clone();
    let path = path.as_str().expect("a path");
    for (verb, body, code) in [
        ("step", json!({"steps": 0}), "out-of-range"),
        ("step", json!({"steps": 100_001}), "out-of-range"),
        ("step", json!({"steps": -1}), "invalid-request"),
        ("step", json!({"steps": 1, "seconds": 1}), "out-of-range"),
        ("step", json!({"seconds": 0}), "out-of-range"),
        ("step", json!({"seconds": -1}), "out-of-range"),
        ("step", json!({"seconds": "1"}), "invalid-request"),
        ("play", json!({"speed": 0}), "out-of-range"),
        ("play", json!({"speed": 1e9}), "out-of-range"),
        ("play", json!({"sped": 1}), "invalid-request"),
    ] {
        let problem = post(&server, &format!("{path}/{verb}"), &body).await.problem(422, code);
        assert!(!problem["errors"].as_array().expect("a list").is_empty(), "{verb} {body}");
    }
    get(&server, "/api/v1/submissions?limit=many").await.problem(400, "invalid-query");
    get(&server, "/api/v1/submissions?lmit=1").await.problem(400, "invalid-query");
}

#[tokio::test]
async fn addresses_and_methods_that_do_not_exist() {
    let server = server();
    get(&server, "/api/v1/nothing").await.problem(404, "not-found");
    get(&server, "/api").await.problem(404, "not-found");
    get(&server, "/assets/nothing.js").await.problem(404, "not-found");
    get(&server, "/api/v1/scenes/nothing").await.problem(404, "unknown-scene");
    // What is no page of ours is told as such, in the page's own words, and no probe takes it for an answer.
    for path in ["/healthz", "/metrics", "/admin/", "/lesson/simple-pendulum"] {
        let reply = get(&server, path).await;
        assert_eq!((reply.status.as_u16(), reply.media()), (404, "text/html; charset=utf-8"), "{path}");
    }
    get(&server, "/robots.txt").await.problem(404, "not-found");
    get(&server, "/lessons/../../etc/passwd").await.problem(404, "not-found");
    let put = |path: &str| Request::put(path).body(Body::empty()).expect("a request");
    send(&server, put("/api/v1/health")).await.problem(405, "method-not-allowed");
    send(&server, put("/")).await.problem(405, "method-not-allowed");
    let page = get(&server, "/lessons/simple-pendulum").await;
    assert_eq!((page.status.as_u16(), page.media()), (200, "text/html; charset=utf-8"));
}
