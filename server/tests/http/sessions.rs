//! Live sessions.

use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::http::Request;
use serde_json::{Value, json};
use tokio::time::timeout;
use triad::limits::Limits;
use triad::live::{self, Which};

use crate::class::class_with;
use crate::{get, post, send, server, state};

/// Ends a test that hangs, and decides nothing else: longer than a request may keep the engine busy.
const HANG: Duration = Duration::from_mins(5);

async fn start(server: &Router, body: Value) -> String {
    let reply = post(server, "/api/v1/sessions", body).await;
    assert_eq!(reply.status, 201, "{}", reply.json());
    let path = reply.headers["location"].to_str().expect("text").to_owned();
    assert_eq!(reply.json()["links"]["self"], path.as_str());
    path
}

fn close(number: &Value, expected: f64, within: f64) {
    let number = number.as_f64().expect("a number");
    assert!((number - expected).abs() <= within, "{number} is not {expected}");
}

#[tokio::test]
async fn a_session_steps_by_steps_and_by_seconds_and_starts_over() {
    let server = server();
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    let state = post(&server, &format!("{path}/step"), json!({"seconds": 0.25})).await.json();
    close(&state["time"], 0.25, 1e-12);
    assert_eq!(state["bodies"][0]["name"], "bob");
    assert_eq!(state["frames"], 26, "one at the start, one every 0.01 s");
    assert_eq!(state["frames_encoded"], 0, "nobody watches");
    // The end of the step that the state lies in, then two more.
    let first = post(&server, &format!("{path}/step"), "").await.json();
    let third = post(&server, &format!("{path}/step"), json!({"steps": 2})).await.json();
    assert_eq!(third["steps"].as_u64(), first["steps"].as_u64().map(|steps| steps + 2));
    assert_eq!(get(&server, &path).await.json()["time"], third["time"]);

    let again = post(&server, &format!("{path}/reset"), "").await.json();
    assert_eq!((&again["time"], &again["frames"], &again["steps"]), (&json!(0.0), &json!(1), &json!(0)));
    let repeated = post(&server, &format!("{path}/step"), json!({"seconds": 0.25})).await.json();
    assert_eq!(repeated["q"], state["q"], "the same run gives the same numbers");
    let end = post(&server, &format!("{path}/step"), json!({"seconds": 1000})).await.json();
    assert_eq!((&end["finished"], &end["time"]), (&json!(true), &json!(10.0)));
    close(&end["energy_drift"], 0.0, 1e-6);
}

#[tokio::test]
async fn time_runs_while_a_session_plays_and_stands_when_it_is_paused() {
    let app = state(Limits::default());
    let server = triad::app(app.clone());
    let path = start(&server, json!({"lesson": "simple-pendulum"})).await;
    let id = path.rsplit('/').next().expect("an id");
    let mut states = app.sessions.get(id).expect("the session").states();
    let state = post(&server, &format!("{path}/play"), json!({"speed": 4.0})).await.json();
    assert_eq!((&state["playing"], &state["speed"]), (&json!(true), &json!(4.0)));
    let runs = timeout(HANG, states.wait_for(|state| state.time > 0.4)).await;
    runs.expect("time runs").expect("it is there");
    let paused = post(&server, &format!("{path}/pause"), "").await.json();
    assert_eq!(paused["playing"], false);
    // The session's thread has come to this request: it does nothing between two of them while it is paused.
    get(&server, &format!("{path}/scene")).await;
    assert_eq!(get(&server, &path).await.json()["time"], paused["time"]);
    post(&server, &format!("{path}/play"), json!({"speed": 1000.0})).await;
    let end = timeout(HANG, states.wait_for(|state| state.finished)).await.expect("the end comes");
    let end = end.expect("it is there").time;
    assert_eq!(json!(end), state["duration"]);
}

#[tokio::test]
async fn a_session_tells_its_events_and_the_singular_positions_that_it_passes() {
    let server = server();
    let mut scene = get(&server, "/api/v1/scenes/simple-pendulum").await.json();
    let angle = json!({"type": "angle", "joint": "pin"});
    scene["events"] = json!([
        {"name": "lowest", "of": angle, "value": std::f64::consts::FRAC_PI_2},
        {"name": "halt", "of": angle, "value": 2.5, "stop": true},
    ]);
    let path = start(&server, json!({"scene": scene})).await;
    let none = |state: &Value| {
        assert_eq!((&state["events"], &state["passages"]), (&json!([]), &json!([])), "{state}");
        assert_eq!((&state["earlier_events"], &state["earlier_passages"]), (&json!(0), &json!(0)));
    };
    none(&get(&server, &path).await.json());
    let lowest = post(&server, &format!("{path}/step"), json!({"seconds": 0.7})).await.json();
    assert_eq!(
        (&lowest["events"][0]["name"], &lowest["events"][0]["stop"]),
        (&json!("lowest"), &json!(false))
    );
    close(&lowest["events"][0]["time"], 0.591_960, 1e-6);
    assert!(lowest["events"][0]["error"].as_f64().is_some_and(|error| error < 1e-5), "{lowest}");
    let heavier = json!({"places": {"/bodies/0/mass": 2.0}, "then": "continue"});
    let changed = post(&server, &format!("{path}/parameters"), heavier).await.json();
    assert_eq!(changed["events"], lowest["events"], "earlier ones stay");
    let end = post(&server, &format!("{path}/step"), json!({"seconds": 100})).await.json();
    assert_eq!((&end["events"][0], &end["events"][1]["name"]), (&lowest["events"][0], &json!("halt")));
    assert_eq!((&end["events"][1]["stop"], &end["finished"]), (&json!(true), &json!(true)));
    assert_eq!((&end["events"][1]["time"], end["events"].as_array().map(Vec::len)), (&end["time"], Some(2)));
    none(&post(&server, &format!("{path}/reset"), "").await.json());

    let path = start(&server, json!({"builtin": "n-four-bar:2"})).await;
    let passed = post(&server, &format!("{path}/step"), json!({"seconds": 1})).await.json();
    let first = &passed["passages"][0];
    assert!(first["time"].as_f64().is_some_and(|time| (0.0..1.0).contains(&time)), "{passed}");
    assert!(first["joints"].as_array().is_some_and(|joints| joints.len() > 2), "{passed}");
    assert_eq!(first.as_object().map(serde_json::Map::len), Some(2), "as `triad run` tells them");
    assert_eq!(passed["events"], json!([]));
    none(&post(&server, &format!("{path}/reset"), "").await.json());
}

#[tokio::test]
async fn the_jacobian_and_the_multipliers_have_names() {
    let server = server();
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    post(&server, &format!("{path}/step"), json!({"seconds": 0.5})).await;
    let jacobian = get(&server, &format!("{path}/jacobian")).await.json();
    let (rows, columns) =
        (jacobian["rows"].as_array().expect("rows"), jacobian["columns"].as_array().expect("columns"));
    assert_eq!(columns.len(), 12);
    assert!(columns.contains(&json!("bob.ux")), "{columns:?}");
    for entry in jacobian["entries"].as_array().expect("entries") {
        assert!(entry[0].as_u64().is_some_and(|row| row < rows.len() as u64));
        assert!(entry[1].as_u64().is_some_and(|column| column < 12));
        assert!(entry[2].is_number() && entry[3].is_boolean());
    }
    let joints = get(&server, &format!("{path}/multipliers")).await.json();
    assert_eq!(
        (&joints[0]["joint"], &joints[0]["on"], &joints[0]["by"]),
        (&json!("pin"), &json!("bob"), &json!("ground"))
    );
    assert_eq!(joints[0]["expressed_in"], "world");
    assert!(joints[0]["rows"][0]["value"].is_number());
}

#[tokio::test]
async fn sessions_are_bounded_deleted_and_forgotten() {
    let app = state(Limits { sessions: 2, ..Limits::default() });
    let server = triad::app(app.clone());
    let body = json!({"builtin": "free-body"});
    let first = start(&server, body.clone()).await;
    start(&server, body.clone()).await;
    post(&server, "/api/v1/sessions", &body).await.problem(503, "too-many-sessions");
    let delete = || Request::delete(&first).body(Body::empty()).expect("a request");
    assert_eq!(send(&server, delete()).await.status, 204);
    send(&server, delete()).await.problem(404, "unknown-session");
    get(&server, &first).await.problem(404, "unknown-session");
    post(&server, &format!("{first}/step"), "").await.problem(404, "unknown-session");
    start(&server, body).await;
    app.sessions.expire(&Limits { idle: Duration::ZERO, ..Limits::default() });
    assert!(app.sessions.is_empty());
}

#[tokio::test]
async fn no_student_takes_the_places_of_all() {
    let class = class_with(Limits { sessions_each: 2, ..Limits::default() }).await;
    let ((ada, _), (eve, _)) = (class.join("Ada").await, class.join("Eve").await);
    let begin = async |who: &str| {
        class.ask("POST", "/api/v1/sessions", who, Some(json!({"builtin": "free-body"}))).await
    };
    let id = |state: Value| state["id"].as_str().expect("an id").to_owned();
    let (first, second) = (id(begin(&ada).await.json()), id(begin(&ada).await.json()));
    // What was used longest ago, and is not looked at, goes.
    class.app.sessions.get(&first).expect("hers").state();
    let third = id(begin(&ada).await.json());
    assert!(class.app.sessions.get(&second).is_err() && class.app.sessions.get(&first).is_ok());
    let look = |id: &str| class.app.sessions.get(id).expect("hers").watch(triad::session::Watched::Track);
    let watched = [look(&first), look(&third)];
    begin(&ada).await.problem(503, "too-many-sessions");
    assert_eq!(begin(&eve).await.status, 201, "others have places of their own");
    drop(watched);
    assert_eq!(begin(&ada).await.status, 201);
    assert_eq!(class.app.sessions.len(), 3);
    // Who teaches shows several.
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    for _ in 0..3 {
        assert_eq!(begin(&owner).await.status, 201);
    }
}

#[tokio::test]
async fn a_bound_on_time_or_on_the_recording_is_told_and_survived() {
    let server = triad::app(state(Limits { command_time: Duration::ZERO, ..Limits::default() }));
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    let problem = post(&server, &format!("{path}/step"), json!({"seconds": 5})).await;
    problem.problem(503, "time-budget-exceeded");
    let state = get(&server, &path).await.json();
    assert!(state["error"].is_null() && state["time"].as_f64().is_some_and(|time| time > 0.0));
}

#[tokio::test]
async fn a_recording_that_grows_too_long_is_thinned_and_the_run_goes_on() {
    let server = triad::app(state(Limits { recording_bytes: 100_000, ..Limits::default() }));
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    let state = post(&server, &format!("{path}/step"), json!({"seconds": 5})).await.json();
    assert!(state["error"].is_null(), "{}", state["error"]);
    assert_eq!((&state["time"], &state["frames"]), (&json!(5.0), &json!(501)));
    for at in ["0", "2.5", "5"] {
        let told = get(&server, &format!("{path}/multipliers?at={at}")).await;
        assert_eq!(told.status, 200, "{at}");
    }
}

#[tokio::test]
async fn a_pause_ends_what_waits_before_it() {
    let server = server();
    let path = start(&server, json!({"builtin": "n-four-bar:10", "overrides": {"duration": 1e5}})).await;
    let address = format!("{path}/step");
    let step = || post(&server, &address, json!({"seconds": 9e4}));
    let pause = async {
        tokio::time::sleep(Duration::from_millis(300)).await;
        post(&server, &format!("{path}/pause"), "").await
    };
    let all = async { tokio::join!(step(), step(), step(), pause) };
    let (first, second, third, pause) = timeout(HANG, all).await.expect("a pause is answered");
    assert_eq!((first.status.as_u16(), pause.status.as_u16()), (200, 200), "the first ends where it is");
    second.problem(409, "interrupted");
    third.problem(409, "interrupted");
    assert!(pause.json()["error"].is_null());
    assert_eq!(post(&server, &format!("{path}/step"), json!({"seconds": 0.1})).await.status, 200);
}

#[tokio::test]
async fn a_run_that_hardly_moves_can_be_stopped_and_closed() {
    let server = triad::app(state(Limits { command_time: Duration::from_millis(200), ..Limits::default() }));
    let overrides = json!({"stabilization": {"kind": "baumgarte", "alpha": 1e6, "beta": 1e6}, "every": 5.0});
    let path = start(&server, json!({"builtin": "simple-pendulum", "overrides": overrides})).await;
    let step = post(&server, &format!("{path}/step"), json!({"seconds": 10})).await;
    step.problem(503, "time-budget-exceeded");
    post(&server, &format!("{path}/play"), "").await;
    let pause = format!("{path}/pause");
    let paused = timeout(HANG, post(&server, &pause, "")).await.expect("a pause is answered").json();
    assert_eq!((&paused["playing"], &paused["finished"]), (&json!(false), &json!(false)));
    let delete = Request::delete(&path).body(Body::empty()).expect("a request");
    assert_eq!(send(&server, delete).await.status, 204);
    get(&server, &path).await.problem(404, "unknown-session");
}

#[tokio::test]
async fn a_run_that_diverges_says_so_and_its_last_good_state_stays() {
    let server = server();
    let mut scene = get(&server, "/api/v1/scenes/simple-pendulum").await.json();
    scene["loads"] = json!([{"name": "push", "type": "force", "body": "bob", "force": {"kind": "fixed", "vector": [0, -1e308, 0]}}]);
    let path = start(&server, json!({"scene": scene})).await;
    post(&server, &format!("{path}/step"), json!({"seconds": 1})).await.problem(422, "diverged");
    let state = get(&server, &path).await.json();
    assert_eq!((&state["error"]["code"], &state["q"][0]), (&json!("diverged"), &json!(-1.0)));
    post(&server, &format!("{path}/step"), "").await.problem(409, "session-stopped");
    assert_eq!(get(&server, &format!("{path}/jacobian")).await.status, 200);
}

#[tokio::test]
async fn settings_of_a_scene_can_be_replaced() {
    let server = server();
    let body = json!({"builtin": "simple-pendulum", "overrides": {"duration": 0.5, "every": 0.25, "tolerance": 1e-6}});
    let path = start(&server, body).await;
    let state = post(&server, &format!("{path}/step"), json!({"seconds": 9})).await.json();
    assert_eq!((&state["time"], &state["duration"], &state["frames"]), (&json!(0.5), &json!(0.5), &json!(3)));
}

/// A server that is restarted: the run stands where it stood, to the last bit, and the room shows it under the same code and key.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn sessions_and_rooms_go_on_after_a_restart_where_they_were() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("grades.db.live");
    let first = state(Limits::default());
    let server = triad::app(first.clone());
    let begun = post(&server, "/api/v1/sessions", json!({"builtin": "spatial-double-pendulum"})).await.json();
    let (id, path) = (begun["id"].as_str().expect("an id"), begun["links"]["self"].as_str().expect("a path"));
    post(&server, &format!("{path}/step"), json!({"seconds": 0.7})).await;
    let change = json!({"places": {"/bodies/0/mass": 2.0}, "then": "continue"});
    assert_eq!(post(&server, &format!("{path}/parameters"), change).await.status, 200);
    let before = post(&server, &format!("{path}/step"), json!({"seconds": 0.4})).await.json();
    let room = post(&server, "/api/v1/rooms", json!({"session": id})).await.json();
    let (code, key) = (room["code"].as_str().expect("a code"), room["key"].as_str().expect("a key"));
    let lead = async |server: &Router, method: &str, path: &str, body: Value| {
        let request = Request::builder().method(method).uri(format!("/api/v1/rooms/{code}{path}"));
        let request = request
            .header("authorization", format!("Bearer {key}"))
            .header("content-type", "application/json");
        send(server, request.body(Body::from(body.to_string())).expect("a request")).await
    };
    assert_eq!(lead(&server, "PUT", "/view", json!({"view": {"joint": "upper"}})).await.status, 204);
    live::keep(&file, &first.sessions, &first.lectures, Which::All).await.expect("writes");

    let second = state(Limits::default());
    let back = || live::bring_back(&file, &second.sessions, &second.lectures, &second.limits);
    assert_eq!((back(), file.exists()), (1, false));
    let server = triad::app(second.clone());
    let after = get(&server, path).await.json();
    for member in ["id", "title", "source", "time", "q", "q_dot", "changes", "bodies", "playing", "speed"] {
        assert_eq!(after[member], before[member], "{member}");
    }
    let shown = get(&server, &format!("/api/v1/rooms/{code}")).await.json();
    assert_eq!((&shown["view"]["joint"], &shown["title"]), (&json!("upper"), &before["title"]));
    let on = post(&server, &format!("{path}/step"), json!({"seconds": 0.1})).await.json();
    assert!(on["time"].as_f64() > before["time"].as_f64(), "it goes on");
    let scene = get(&server, &format!("{path}/scene")).await.json();
    assert_eq!(
        (&scene["scene"]["bodies"][0]["mass"], scene["original"] == scene["scene"]),
        (&json!(2.0), false)
    );
    // In case of a crash what a lecture shows is written too, and nothing else.
    post(&server, "/api/v1/sessions", json!({"builtin": "free-fall"})).await;
    live::keep(&file, &second.sessions, &second.lectures, Which::Shown).await.expect("writes");
    let text = std::fs::read_to_string(&file).expect("text");
    assert!(text.contains(id) && !text.contains("free-fall"));
    assert_eq!(lead(&server, "DELETE", "", Value::Null).await.status, 204, "the presenter's key is the same");
    live::keep(&file, &second.sessions, &second.lectures, Which::Shown).await.expect("removes");
    assert!(!file.exists());
    std::fs::write(&file, &text[..text.len() / 2]).expect("writes");
    assert_eq!(back(), 2, "what is damaged is forgotten");
}
