//! A lecture against the running program: many follow one simulation, and nobody can harm it.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::time::Instant;
use triad_tests::lecture::{FollowerPage, LectureRun, Message, Seen, follow};
use triad_tests::program::{HANG, Server};

fn time(state: &Value) -> f64 {
    state["time"].as_f64().unwrap()
}

#[test]
fn many_follow_one_simulation_and_one_who_stalls_harms_nobody_and_catches_up() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let lecture = LectureRun::open(&server, "spatial-double-pendulum");
    let session = format!("/api/v1/sessions/{}", lecture.session);
    // One reads nothing at all, one leaves at once, the others follow.
    let mut stalled = FollowerPage::join(&server.address, &lecture.code, true);
    drop(FollowerPage::join(&server.address, &lecture.code, true));
    let crowd: Vec<FollowerPage> =
        (0..40).map(|_| FollowerPage::join(&server.address, &lecture.code, true)).collect();
    assert_eq!(server.post(&format!("{session}/play"), &json!({"speed": 2})).status, 200);
    // However long it takes: a follower who is told nothing more ends with an error.
    let start = Instant::now();
    let enough = |seen: &Seen| seen.states >= 10 && seen.blocks >= 1 && seen.time > 2.0;
    let watching: Vec<_> =
        crowd.into_iter().map(|one| std::thread::spawn(move || follow(one, start, enough))).collect();
    for thread in watching {
        let seen = thread.join().unwrap();
        assert!(enough(&seen), "{seen:?}");
    }
    let paused = server.post(&format!("{session}/pause"), &json!({})).json();
    assert_eq!(paused["frames"], paused["frames_encoded"], "encoded once, however many follow");
    // The one who stalled, and one who comes again, are told the newest state.
    let newest = time(&paused);
    stalled.until("state", |state| time(state) == newest);
    let mut again = FollowerPage::join(&server.address, &lecture.code, false);
    let state = again.until("state", |state| time(state) == newest);
    assert!(!state.to_string().contains(&lecture.session), "the session's own name stays with the presenter");
    // What the presenter looks at travels.
    assert_eq!(lecture.lead(&server, "PUT", "view", &json!({"view": {"joint": "hinge"}})).status, 204);
    again.until("room", |room| room["view"]["joint"] == "hinge");
    let told = server.get(&format!("/api/v1/rooms/{}/jacobian", lecture.code)).json();
    assert_eq!(told, server.get(&format!("{session}/jacobian")).json());
    // The end.
    assert_eq!(lecture.lead(&server, "DELETE", "", &json!({})).status, 204);
    again.until("closed", |_| true);
    assert_eq!(server.get(&format!("/api/v1/rooms/{}", lecture.code)).status, 404);
    server.stop();
}

#[test]
fn only_the_presenter_leads_and_nothing_of_an_answer_is_told_before_the_reveal() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let lecture = LectureRun::open(&server, "simple-pendulum");
    let room = format!("/api/v1/rooms/{}", lecture.code);
    let refused = server.post(&format!("{room}/reveal"), &json!({}));
    assert_eq!((refused.status, refused.json()["code"].as_str()), (403, Some("not-the-presenter")));
    let question = json!({"text": "Which sign has Fx?", "choices": ["+", "−"], "right": 1});
    assert_eq!(
        server.ask("PUT", &format!("{room}/question"), Some(question.to_string().as_bytes())).status,
        403
    );
    assert_eq!(lecture.lead(&server, "PUT", "question", &question).status, 204);
    let mut follower = FollowerPage::join(&server.address, &lecture.code, false);
    let asked = follower.until("room", |board| board["question"].is_object());
    for (voter, choice) in [("a", 0), ("b", 1), ("a", 1), ("c", 0)] {
        let vote = json!({"question": asked["question"]["number"], "voter": voter, "choice": choice});
        assert_eq!(server.post(&format!("{room}/answers"), &vote).status, 204);
    }
    let told = server.get(&room).json();
    for board in [&asked, &told] {
        let members: Vec<&String> = board["question"].as_object().unwrap().keys().collect();
        assert_eq!(members, ["again", "choices", "number", "text"], "neither counts nor the right choice");
    }
    let desk = lecture.lead(&server, "GET", "desk", &Value::Null).json();
    assert_eq!((&desk["tally"]["counts"], &desk["followers"]), (&json!([1, 2]), &json!(1)));
    assert_eq!(server.get(&format!("{room}/desk")).status, 403);
    assert_eq!(lecture.lead(&server, "POST", "reveal", &json!({})).status, 204);
    let result = follower.until("room", |board| board["question"]["result"].is_object());
    assert_eq!(
        result["question"]["result"],
        json!({"number": 1, "counts": [1, 2], "right": 1, "revealed": true})
    );
    let late = json!({"question": 1, "voter": "d", "choice": 0});
    assert_eq!(server.post(&format!("{room}/answers"), &late).status, 409);
    server.stop();
}

/// Asks for the presenter's desk until it says what is expected.
fn desk_until(server: &Server, lecture: &LectureRun, good: impl Fn(&Value) -> bool) -> Value {
    let start = Instant::now();
    loop {
        let desk = lecture.lead(server, "GET", "desk", &Value::Null).json();
        if good(&desk) {
            return desk;
        }
        assert!(start.elapsed() < HANG, "{desk}");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

#[test]
fn hands_count_until_they_are_put_down_or_leave_and_the_projectors_window_is_no_follower() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let lecture = LectureRun::open(&server, "simple-pendulum");
    let join = || FollowerPage::join(&server.address, &lecture.code, false);
    let (mut one, mut other, mut screen) = (join(), join(), join());
    one.tell(r#"{"roaming":true,"hand":true}"#);
    other.tell(r#"{"hand":true}"#);
    other.tell("no JSON, and nothing that counts");
    screen.tell(r#"{"screen":true}"#);
    let counts = |desk: &Value| {
        ["followers", "screens", "roaming", "hands"].map(|member| desk[member].as_u64().unwrap())
    };
    desk_until(&server, &lecture, |desk| counts(desk) == [2, 1, 1, 2]);
    // Followers are told that hands were put down, and put theirs down.
    assert_eq!(lecture.lead(&server, "DELETE", "hands", &json!({})).status, 204);
    other.until("room", |room| room["lowered"] == 1);
    other.tell(r#"{"hand":false}"#);
    desk_until(&server, &lecture, |desk| counts(desk) == [2, 1, 1, 1]);
    drop(one);
    drop(screen);
    desk_until(&server, &lecture, |desk| counts(desk) == [1, 0, 0, 0]);
    server.stop();
}

#[test]
fn a_lecture_goes_on_after_a_restart_of_the_server() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let lecture = LectureRun::open(&server, "spatial-double-pendulum");
    let session = format!("/api/v1/sessions/{}", lecture.session);
    let before = server.post(&format!("{session}/step"), &json!({"seconds": 1.3})).json();
    assert_eq!(lecture.lead(&server, "PUT", "view", &json!({"view": {"joint": "hinge"}})).status, 204);
    let mut follower = FollowerPage::join(&server.address, &lecture.code, false);
    follower.until("room", |room| room["view"]["joint"] == "hinge");
    let port = server.address.rsplit(':').next().unwrap().to_owned();
    server.stop();
    // Nobody was told that the lecture is over.
    loop {
        match follower.read() {
            Message::Close => break,
            Message::Text(told) => assert_ne!(told["type"], "closed"),
            Message::Block(_) | Message::Other => {}
        }
    }
    let server = Server::start_at(folder.path(), &port);
    let after = server.get(&session).json();
    assert_eq!(
        (&after["time"], &after["q"], &after["q_dot"]),
        (&before["time"], &before["q"], &before["q_dot"])
    );
    let mut again = FollowerPage::join(&server.address, &lecture.code, true);
    again.until("room", |room| room["view"]["joint"] == "hinge");
    again.until("state", |state| time(state) == time(&before));
    assert_eq!(lecture.lead(&server, "DELETE", "", &json!({})).status, 204);
    again.until("closed", |_| true);
    server.stop();
}
