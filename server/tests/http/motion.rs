//! Recorded runs, for pictures that play without a session, and the one view that other sites may frame.

use std::io::Read;

use axum::body::Body;
use axum::http::{Request, header};
use flate2::read::GzDecoder;
use serde_json::{Map, Value};

use crate::{Reply, get, send, server};

#[tokio::test]
async fn scenes_and_lessons_have_recorded_runs_and_pictures_packed_for_those_who_read_gzip() {
    let server = server();
    let motion = get(&server, "/api/v1/scenes/rssr/motion").await;
    assert_eq!(motion.headers[header::CACHE_CONTROL], "public, max-age=300");
    let plain = motion.json();
    assert_eq!(plain["bodies"].as_array().map(Vec::len), Some(3));
    assert_eq!(plain["until"], 3.0, "its whole run");
    let request = Request::get("/api/v1/scenes/rssr/motion").header(header::ACCEPT_ENCODING, "gzip");
    let packed = send(&server, request.body(Body::empty()).expect("a request")).await;
    assert_eq!(packed.headers[header::CONTENT_ENCODING], "gzip");
    let mut text = String::new();
    GzDecoder::new(packed.bytes.as_ref()).read_to_string(&mut text).expect("gzip");
    assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON"), plain);
    let lesson = get(&server, "/api/v1/lessons/simple-pendulum/motion").await.json();
    assert_eq!(lesson["bodies"].as_array().map(Vec::len), Some(1));
    let pictures = get(&server, "/api/v1/pictures").await.json();
    let lessons = get(&server, "/api/v1/lessons").await.json();
    assert_eq!(
        pictures["lessons"].as_object().map(Map::len),
        lessons.as_array().map(Vec::len),
        "each lesson has its picture"
    );
    assert_eq!(pictures["scenes"]["n-four-bar:2"]["until"], 0.0, "at the start");
}

#[tokio::test]
async fn what_costs_much_or_is_unknown_is_refused() {
    let server = server();
    let large = get(&server, "/api/v1/scenes/spatial-chain:100/motion").await;
    large.problem(422, "scene-too-large");
    get(&server, "/api/v1/scenes/nothing/motion").await.problem(404, "unknown-scene");
    get(&server, "/api/v1/lessons/nothing/motion").await.problem(404, "unknown-lesson");
}

#[tokio::test]
async fn other_sites_may_frame_recorded_runs_and_nothing_else() {
    let server = server();
    let framed = get(&server, "/embed/scenes/rssr").await;
    assert!(!framed.headers.contains_key(header::X_FRAME_OPTIONS));
    let policy =
        |reply: &Reply| reply.headers[header::CONTENT_SECURITY_POLICY].to_str().expect("text").to_owned();
    assert!(policy(&framed).contains("frame-ancestors *;"));
    for path in ["/", "/scenes/rssr", "/embedded/x", "/room/ABCDE", "/api/v1/scenes/rssr/motion", "/docs/"] {
        let reply = get(&server, path).await;
        assert_eq!(reply.headers[header::X_FRAME_OPTIONS], "SAMEORIGIN", "{path}");
        assert!(!policy(&reply).contains("frame-ancestors *"), "{path}");
    }
}
