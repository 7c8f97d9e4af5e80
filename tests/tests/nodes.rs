//! Several servers on one PostgreSQL behind any proxy: whoever is asked for what lives in another hands the request on.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;
use triad_tests::lecture::{FollowerPage, LectureRun};
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, Reply, Server, assert_problem, triad};

fn start(url: &str, folder: &Path, port: &str) -> Server {
    let mut command = Command::new(triad());
    command.args(["serve", "--port", port, "--database", url]).current_dir(folder);
    Server::of(command.stderr(Stdio::inherit()))
}

fn new_run(server: &Server) -> Reply {
    server.post("/api/v1/sessions", &json!({ "builtin": "spatial-double-pendulum" }))
}

/// The server's name, as it stands in what lives there.
fn name(id: &str) -> &str {
    id.split_once('-').unwrap().0
}

#[test]
fn what_lives_in_one_server_is_reached_by_way_of_the_others() {
    let Some(postgres) = Postgres::start("several servers that hand requests on") else { return };
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let (here, there) = (start(&url, folder.path(), "0"), start(&url, folder.path(), "0"));

    let lecture = LectureRun::open(&here, "spatial-double-pendulum");
    let session = format!("/api/v1/sessions/{}", lecture.session);
    assert_eq!(name(&lecture.session), &lecture.code[..2]);
    let stepped = there.post(&format!("{session}/step"), &json!({"seconds": 0.5}));
    assert_eq!((stepped.status, stepped.json()["time"].as_f64()), (200, Some(0.5)));
    assert_eq!(here.get(&session).json()["time"], 0.5, "it is the same run");
    assert_eq!(there.get("/api/v1/sessions/ZZ-1").status, 404, "no server has that name");

    // A WebSocket, and what the presenter says, go by way of the other as well.
    let mut follower = FollowerPage::join(&there.address, &lecture.code.to_lowercase(), false);
    assert_eq!(lecture.lead(&there, "PUT", "view", &json!({"view": {"joint": "hinge"}})).status, 204);
    follower.until("room", |room| room["view"]["joint"] == "hinge");
    assert_eq!(there.post(&format!("{session}/play"), &json!({"speed": 2})).status, 200);
    follower.until("state", |state| state["time"].as_f64().unwrap() > 1.0);

    // A room is opened where its run is, and a browser's next run is begun where its others are.
    let room = there.post("/api/v1/rooms", &json!({ "session": lecture.session })).json();
    assert_eq!(&room["code"].as_str().unwrap()[..2], &lecture.code[..2]);
    let first = new_run(&here);
    let cookie =
        first.head.lines().find(|line| line.starts_with("set-cookie: triad-node=")).unwrap().to_owned();
    let node = cookie["set-cookie: ".len()..]
        .split(';')
        .next()
        .unwrap()
        .to_uppercase()
        .replace("TRIAD-NODE", "triad-node");
    let body = json!({"builtin": "simple-pendulum"}).to_string();
    let cookie = format!("Cookie: {node}\r\n");
    let begun = there.ask_with("POST", "/api/v1/sessions", &cookie, Some(body.as_bytes()));
    assert_eq!(name(begun.json()["id"].as_str().unwrap()), name(&lecture.session));
    assert_ne!(name(new_run(&there).json()["id"].as_str().unwrap()), name(&lecture.session));
    assert_problem(&there.post("/api/v1/rooms", &json!({})).json(), "invalid-request", "");

    // It ends in the middle: at first it does not answer, then it is gone, and new runs are begun elsewhere.
    drop(here);
    assert_problem(&there.get(&session).json(), "node-away", "");
    // What twenty seconds of silence bring about.
    let wait = Command::new("psql").args(["-qc", "UPDATE node SET seen_at = seen_at - 20000", &url]).status();
    assert!(wait.unwrap().success());
    let gone = there.get(&session);
    assert_eq!(gone.status, 410);
    assert_problem(&gone.json(), "node-gone", "");
    let begun = there.ask_with("POST", "/api/v1/sessions", &cookie, Some(body.as_bytes()));
    assert_eq!(begun.status, 201);
}

/// A server that is restarted has its name and its runs again; until then the others say that they are gone.
#[test]
fn a_server_that_comes_back_has_what_lived_in_it() {
    let Some(postgres) = Postgres::start("a server that comes back") else { return };
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port().to_string();
    let (here, there) = (start(&url, folder.path(), &free), start(&url, folder.path(), "0"));
    let id = new_run(&here).json()["id"].as_str().unwrap().to_owned();
    let session = format!("/api/v1/sessions/{id}");
    let state = here.post(&format!("{session}/step"), &json!({"seconds": 0.25})).json();
    here.stop();
    assert_problem(&there.get(&session).json(), "node-gone", "");
    let _back = start(&url, folder.path(), &free);
    let began = Instant::now();
    let mut seen = Value::Null;
    while seen["bodies"] != state["bodies"] {
        assert!(began.elapsed() < HANG, "{seen}");
        seen = there.get(&session).json();
    }
    assert_eq!(seen["time"], 0.25);
}

/// The link on the slides leads into the room, whichever server answers; where the lecture's server is gone it waits for the next one.
#[test]
fn a_room_with_a_name_is_found_by_way_of_the_others() {
    let Some(postgres) = Postgres::start("a room with a name on several servers") else { return };
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let (here, there) = (start(&url, folder.path(), "0"), start(&url, folder.path(), "0"));
    let open = |server: &Server, run: &Reply| {
        let wish =
            json!({"session": run.json()["id"], "name": "mbs-2026", "secret": "an instructor's secret"});
        server.post("/api/v1/rooms", &wish)
    };
    let room = "/api/v1/rooms/MBS-2026";
    assert_problem(&there.get(room).json(), "unknown-room", "");
    // Asked of one server, of a run that lives in the other.
    assert_eq!(open(&there, &new_run(&here)).json()["code"], "mbs-2026");
    for server in [&here, &there] {
        assert_eq!(server.get(room).json()["title"], "Spatial double pendulum");
    }
    FollowerPage::join(&there.address, "mbs-2026", false).until("room", |room| room["code"] == "mbs-2026");
    here.stop();
    assert_problem(&there.get(room).json(), "room-not-open", "");
    // Next week in the server that is left.
    assert_eq!(open(&there, &new_run(&there)).status, 201);
    assert_eq!(there.get(room).json()["code"], "mbs-2026");
}
