//! A lecture's votes, and what followers ask.

use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::http::Request;
use serde_json::{Value, json};
use triad::app::App;
use triad::limits::Limits;
use triad::live::{self, Which};
use triad::store::Role;

use crate::class::class;
use crate::{Reply, get, post, send, server, state};

/// A room with its presenter's key.
struct Room {
    path: String,
    key: String,
}

impl Room {
    async fn open(server: &Router) -> Self {
        let begun = post(server, "/api/v1/sessions", json!({"builtin": "simple-pendulum"})).await.json();
        let room = post(server, "/api/v1/rooms", json!({"session": begun["id"]})).await.json();
        let text = |member: &str| room[member].as_str().expect("text").to_owned();
        Self { path: format!("/api/v1/rooms/{}", text("code")), key: text("key") }
    }

    async fn lead(&self, server: &Router, method: &str, what: &str, body: Value) -> Reply {
        let request = Request::builder().method(method).uri(format!("{}{what}", self.path));
        let request = request
            .header("authorization", format!("Bearer {}", self.key))
            .header("content-type", "application/json");
        send(server, request.body(Body::from(body.to_string())).expect("a request")).await
    }

    /// Everybody answers the question that is asked.
    async fn vote(&self, server: &Router, choices: &[usize]) {
        let number = get(server, &self.path).await.json()["question"]["number"].clone();
        for (k, choice) in choices.iter().enumerate() {
            let vote = json!({"question": number, "voter": format!("v{k}"), "choice": choice});
            assert_eq!(post(server, &format!("{}/answers", self.path), vote).await.status, 204);
        }
    }

    async fn ask(&self, server: &Router, voter: &str, text: &str) -> Reply {
        post(server, &format!("{}/remarks", self.path), json!({"text": text, "voter": voter})).await
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_second_vote_stands_beside_the_first_and_both_are_hidden_until_the_reveal() {
    let server = server();
    let room = Room::open(&server).await;
    assert_eq!(room.lead(&server, "POST", "/second-vote", json!({})).await.status, 409, "nothing is asked");
    let question = json!({"text": "Which way?", "choices": ["up", "down"], "right": 0});
    assert_eq!(room.lead(&server, "PUT", "/question", question).await.status, 204);
    room.vote(&server, &[0, 1, 1]).await;
    assert_eq!(room.lead(&server, "POST", "/second-vote", json!({})).await.status, 204);
    let asked = get(&server, &room.path).await.json()["question"].clone();
    assert_eq!((&asked["number"], &asked["again"]), (&json!(2), &json!(true)));
    assert_eq!(asked.get("result"), None, "neither vote is told");
    assert_eq!(
        post(&server, &format!("{}/answers", room.path), json!({"question": 1, "voter": "v0", "choice": 1}))
            .await
            .status,
        409,
        "the first vote is over"
    );
    room.vote(&server, &[0, 0, 1]).await;
    let desk = room.lead(&server, "GET", "/desk", Value::Null).await.json();
    assert_eq!((&desk["tally"]["counts"], &desk["tally"]["before"]), (&json!([2, 1]), &json!([1, 2])));
    assert_eq!(desk["question"]["text"], "Which way?");
    assert_eq!(room.lead(&server, "POST", "/reveal", json!({})).await.status, 204);
    assert_eq!(
        get(&server, &room.path).await.json()["question"]["result"],
        json!({"number": 2, "counts": [2, 1], "before": [1, 2], "right": 0, "revealed": true})
    );
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_question_from_the_hall_is_seen_by_the_presenter_first_and_bounded() {
    let server = server();
    let room = Room::open(&server).await;
    assert_eq!(room.ask(&server, "a", "Why is the multiplier negative?").await.status, 204);
    let soon = room.ask(&server, "a", "And here?").await;
    assert_eq!((soon.status.as_u16(), &soon.json()["code"]), (429, &json!("remark-too-soon")));
    let long = room.ask(&server, "b", &"x".repeat(301)).await;
    assert_eq!((long.status.as_u16(), &long.json()["code"]), (422, &json!("invalid-remark")));
    // Nobody but the presenter knows of it, and nobody learns who asked.
    let public = get(&server, &room.path).await;
    assert!(!public.json().to_string().contains("multiplier"));
    let desk = room.lead(&server, "GET", "/desk", Value::Null).await.json();
    let waits = json!([{"number": 1, "text": "Why is the multiplier negative?", "shown": false}]);
    assert_eq!(desk["remarks"], waits);
    for (method, what) in [("PUT", "/remarks/1"), ("DELETE", "/remarks/1"), ("DELETE", "/hands")] {
        let request = Request::builder().method(method).uri(format!("{}{what}", room.path));
        let request = request.header("content-type", "application/json");
        let body = Body::from(json!({"shown": true}).to_string());
        let reply = send(&server, request.body(body).expect("a request")).await;
        assert_eq!(reply.status, 403, "{method} {what} without the key");
    }
    assert_eq!(room.lead(&server, "PUT", "/remarks/1", json!({"shown": true})).await.status, 204);
    assert_eq!(get(&server, &room.path).await.json()["remark"]["text"], "Why is the multiplier negative?");
    assert_eq!(room.lead(&server, "PUT", "/remarks/2", json!({"shown": true})).await.status, 404);
    assert_eq!(room.lead(&server, "DELETE", "/remarks/1", json!({})).await.status, 204);
    assert_eq!(get(&server, &room.path).await.json()["remark"], Value::Null);
}

/// The server is restarted between a vote and its reveal: nobody has to vote again, and no question is lost.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn votes_and_questions_outlive_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("grades.db.live");
    let first = state(Limits::default());
    let server = triad::app(first.clone());
    let room = Room::open(&server).await;
    let question = json!({"text": "Which way?", "choices": ["up", "down"], "right": 0});
    assert_eq!(room.lead(&server, "PUT", "/question", question).await.status, 204);
    room.vote(&server, &[1, 1]).await;
    assert_eq!(room.lead(&server, "POST", "/second-vote", json!({})).await.status, 204);
    room.vote(&server, &[0, 1]).await;
    assert_eq!(room.ask(&server, "a", "Why?").await.status, 204);
    let before = room.lead(&server, "GET", "/desk", Value::Null).await.json();
    live::keep(&file, &first.sessions, &first.lectures, Which::All).await.expect("writes");

    let second = state(Limits::default());
    assert_eq!(live::bring_back(&file, &second.sessions, &second.lectures, &second.limits), 1);
    let server = triad::app(second);
    assert_eq!(room.lead(&server, "GET", "/desk", Value::Null).await.json(), before);
    // Who has voted may still change their mind, and does not count twice.
    room.vote(&server, &[0, 0]).await;
    assert_eq!(room.lead(&server, "POST", "/reveal", json!({})).await.status, 204);
    let result = get(&server, &room.path).await.json()["question"]["result"].clone();
    assert_eq!((&result["counts"], &result["before"]), (&json!([2, 0]), &json!([0, 2])));
}

/// Nobody takes the seats of all rooms, nor more of one than it has; who leaves gives theirs back.
#[tokio::test]
async fn rooms_and_their_seats_are_bounded() {
    let app = state(Limits { lectures: 2, followers: 3, ..Limits::default() });
    let server = triad::app(app.clone());
    let room = Room::open(&server).await;
    let code = room.path.rsplit('/').next().expect("a code");
    let lecture = app.lectures.get(code).expect("open");
    let seats: Vec<_> = (0..3).map(|_| lecture.join().expect("a seat")).collect();
    let refused = lecture.join().expect_err("none is left");
    assert_eq!((refused.status().as_u16(), refused.code()), (503, "room-full"));
    drop(seats);
    assert!(lecture.join().is_ok());
    Room::open(&server).await;
    let begun = post(&server, "/api/v1/sessions", json!({"builtin": "free-body"})).await.json();
    let third = post(&server, "/api/v1/rooms", json!({"session": begun["id"]})).await;
    third.problem(503, "too-many-rooms");
    assert_eq!(room.lead(&server, "DELETE", "", json!({})).await.status, 204);
    Room::open(&server).await;
}

/// A room's code lets people follow; only its key leads, and nothing that is almost the key.
#[tokio::test]
async fn only_who_has_the_key_of_a_room_leads() {
    let server = server();
    let room = Room::open(&server).await;
    let code = room.path.rsplit('/').next().expect("a code").to_owned();
    let other = Room::open(&server).await;
    let almost =
        [room.key[..room.key.len() - 1].to_owned(), format!("{}0", room.key), room.key.to_uppercase() + "x"];
    for key in [String::new(), code, other.key].into_iter().chain(almost) {
        let thief = Room { path: room.path.clone(), key };
        for (method, what, body) in [
            ("DELETE", "", json!({})),
            ("PUT", "/view", json!({"view": {"joint": "pin"}})),
            ("GET", "/desk", Value::Null),
            ("PUT", "/question", json!({"text": "Which way?", "choices": ["up", "down"]})),
            ("DELETE", "/question", json!({})),
            ("POST", "/reveal", json!({})),
            ("POST", "/second-vote", json!({})),
            ("PUT", "/remarks/1", json!({"shown": true})),
            ("DELETE", "/remarks/1", json!({})),
            ("DELETE", "/hands", json!({})),
        ] {
            let refused = thief.lead(&server, method, what, body).await;
            refused.problem(403, "not-the-presenter");
        }
    }
    assert_eq!(room.lead(&server, "GET", "/desk", Value::Null).await.status, 200);
}

/// Opens a room under a name, with the secret of somebody at home.
async fn named(server: &Router, name: &str, secret: &str) -> Reply {
    let begun = post(server, "/api/v1/sessions", json!({"builtin": "simple-pendulum"})).await.json();
    post(server, "/api/v1/rooms", json!({"session": begun["id"], "name": name, "secret": secret})).await
}

/// The address on the slides stays the same each week, and nobody else opens a lecture there.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_room_has_a_name_that_its_owner_opens_again() {
    const OWN: &str = "an instructor's secret";
    const OTHER: &str = "somebody else's secret";
    let first = state(Limits::default());
    let server = triad::app(first.clone());
    get(&server, "/api/v1/rooms/mbs-2026").await.problem(404, "unknown-room");
    let opened = named(&server, "MBS-2026", OWN).await.json();
    assert_eq!((&opened["code"], &opened["page"]), (&json!("mbs-2026"), &json!("/room/mbs-2026")));
    for typed in ["mbs-2026", "MBS-2026"] {
        assert_eq!(get(&server, &format!("/api/v1/rooms/{typed}")).await.json()["title"], "Simple pendulum");
    }
    let refused = named(&server, "mbs-2026", OTHER).await.problem(409, "room-name-taken");
    assert_eq!(refused["errors"][0]["pointer"], "#/name");
    // From another page of the owner's the same lecture goes on: its followers stay.
    let again = named(&server, "mbs-2026", OWN).await.json();
    assert_eq!((&again["key"], first.lectures.len()), (&opened["key"], 1));
    let room =
        Room { path: "/api/v1/rooms/mbs-2026".into(), key: again["key"].as_str().expect("text").into() };
    assert_eq!(room.lead(&server, "DELETE", "", json!({})).await.status, 204);
    get(&server, "/api/v1/rooms/mbs-2026").await.problem(404, "room-not-open");
    // Next week, after a restart.
    let server = triad::app(App { lectures: Arc::default(), ..first });
    named(&server, "mbs-2026", OTHER).await.problem(409, "room-name-taken");
    let next = named(&server, "mbs-2026", OWN).await.json();
    assert!(next["code"] == "mbs-2026" && next["key"] != opened["key"]);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn names_of_rooms_are_bounded_and_kept_by_a_secret() {
    const SECRET: &str = "sixteen letters.";
    let server = triad::app(state(Limits { lectures: 100, ..Limits::default() }));
    for name in ["short", "mbs 2026", "mbs--2026", "../../etc", "x".repeat(41).as_str(), "mbs_2026"] {
        named(&server, name, SECRET).await.problem(422, "invalid-room-name");
    }
    named(&server, "mbs-2026", "short").await.problem(422, "missing-room-secret");
    for k in 0..20 {
        assert_eq!(named(&server, &format!("term-{k:03}"), SECRET).await.status, 201);
    }
    named(&server, "term-020", SECRET).await.problem(409, "too-many-room-names");
    assert_eq!(named(&server, "term-003", SECRET).await.status, 201, "those that are there are opened again");
    assert_eq!(named(&server, "term-020", "another's secret").await.status, 201);
}

/// In a class a name belongs to who teaches there, on whatever computer they sign in.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn in_a_class_a_room_belongs_to_a_person() {
    let class = class().await;
    let mut opened = Vec::new();
    for (role, cookie) in class.everybody().await {
        let begun =
            class.ask("POST", "/api/v1/sessions", &cookie, Some(json!({"builtin": "free-body"}))).await;
        let wish = json!({"session": begun.json()["id"], "name": "mbs-2026"});
        let reply = class.ask("POST", "/api/v1/rooms", &cookie, Some(wish.clone())).await;
        match role {
            None => drop(reply.problem(401, "sign-in-needed")),
            Some(Role::Student) => drop(reply.problem(403, "not-yours")),
            Some(_) if opened.is_empty() => {
                assert_eq!(reply.status, 201, "{}", reply.json());
                opened.push(cookie);
            }
            Some(_) => drop(reply.problem(409, "room-name-taken")),
        }
    }
    let owner = &opened[0];
    let begun = class.ask("POST", "/api/v1/sessions", owner, Some(json!({"builtin": "free-body"}))).await;
    let wish = json!({"session": begun.json()["id"], "name": "mbs-2026"});
    assert_eq!(class.ask("POST", "/api/v1/rooms", owner, Some(wish)).await.status, 201);
}
