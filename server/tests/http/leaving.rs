//! What was begun for somebody who left ends, over real sockets: here nothing else would end it.

use std::io::Write;
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::http::Request;
use serde_json::{Value, json};
use tokio::task::yield_now;
use tokio::time::timeout;
use triad::handing::{Judged, Who, settled};
use triad::limits::Limits;
use triad::regrade::{Progress, preview};
use triad::store::{HOME, HandIn, Store, Whose, identifier};
use triad::variants::Variants;
use triad_engine::analysis::Wanted;
use triad_lessons::{Course, Lesson, reference_submission};

use crate::{get, post, send, state};

/// Longer than any machine takes here, and less than what is computed for those who stay.
const PATIENCE: Duration = Duration::from_mins(5);

/// A time that no run reaches while somebody waits for it, s.
const END: f64 = 1e5;

/// The longest run that there is, s, of a mechanism that takes hours for it.
const LONG: f64 = 1e6;
const LARGE: &str = "/api/v1/scenes/n-four-bar:40";

/// A server whose requests may compute for as long as they like.
async fn patient() -> (Router, SocketAddr) {
    let server = triad::app(state(Limits { command_time: Duration::from_hours(24), ..Limits::default() }));
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.expect("a port");
    let address = listener.local_addr().expect("an address");
    let serving = server.clone();
    tokio::spawn(async move { axum::serve(listener, serving).await });
    (server, address)
}

/// Asks for something, and says no more.
fn ask(address: SocketAddr, path: &str, body: &Value) -> TcpStream {
    let mut socket = TcpStream::connect(address).expect("connects");
    let body = body.to_string();
    let head = "Host: localhost\r\nContent-Type: application/json";
    write!(socket, "POST {path} HTTP/1.1\r\n{head}\r\nContent-Length: {}\r\n\r\n{body}", body.len())
        .expect("asks");
    socket
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_step_ends_as_its_caller_leaves() {
    let (server, address) = patient().await;
    let endless = json!({"builtin": "spatial-slider-crank", "overrides": {"duration": END}});
    let created = post(&server, "/api/v1/sessions", endless).await.json();
    let path = created["links"]["self"].as_str().expect("a path").to_owned();
    let caller = ask(address, &format!("{path}/step"), &json!({"seconds": END}));
    // One that waits for its turn behind it, and leaves too, is not begun.
    let other = ask(address, &format!("{path}/step"), &json!({"seconds": END}));
    drop((caller, other));
    let path = format!("{path}/step");
    let step = post(&server, &path, json!({"steps": 1}));
    let state = timeout(PATIENCE, step).await.expect("it is its turn").json();
    assert!(state["time"].as_f64().is_some_and(|time| time < END), "{state}");
    assert_eq!(state["error"], Value::Null, "{state}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_session_whose_caller_leaves_while_it_is_made_takes_no_place() {
    let server = triad::app(state(Limits { sessions: 1, ..Limits::default() }));
    let sessions = "/api/v1/sessions";
    let mut scene = get(&server, "/api/v1/scenes/simple-pendulum").await.json();
    scene["bodies"][0]["mass"] = json!(-1.0);
    // Refused for its mass where there is a place.
    let is_full = || async { post(&server, sessions, json!({"scene": scene})).await.status == 503 };
    loop {
        let asked = server.clone();
        let caller = tokio::spawn(async move {
            // Whoever tries whether there is a place takes it for a moment.
            loop {
                let made = post(&asked, sessions, json!({"builtin": "spatial-chain:499"})).await;
                if made.status != 503 {
                    return made.json();
                }
            }
        });
        while !is_full().await {}
        caller.abort();
        let Ok(made) = caller.await else { break };
        let made = made["links"]["self"].as_str().expect("a path").to_owned();
        let delete = Request::delete(made).body(Body::empty()).expect("a request");
        assert_eq!(send(&server, delete).await.status, 204, "it was too late to leave");
    }
    let given_back = async { while is_full().await {} };
    timeout(PATIENCE, given_back).await.expect("nobody knows of what takes the place");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_table_ends_as_its_caller_leaves_and_gives_its_place_to_others() {
    let (server, address) = patient().await;
    let scene = get(&server, "/api/v1/scenes/spatial-slider-crank").await.json();
    let table = |until: f64, every: f64| json!({"scene": scene, "until": until, "every": every});
    // The longest that a scene may last: one second more is refused, and computes nothing.
    let longest = table(1e6, 1e3);
    let refused = post(&server, "/api/v1/analyses/table", table(1e6 + 1.0, 1e3)).await;
    refused.problem(422, "out-of-range");
    let places = std::thread::available_parallelism().map_or(1, usize::from);
    let callers: Vec<_> = (0..places).map(|_| ask(address, "/api/v1/analyses/table", &longest)).collect();
    drop(callers);
    let others = post(&server, "/api/v1/analyses/table", table(0.1, 0.1));
    let reply = timeout(PATIENCE, others).await.expect("it is its turn");
    assert_eq!(reply.status, 200);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_check_and_a_robot_wait_for_their_turn_and_are_not_begun_for_who_leaves_before() {
    let app = state(Limits { command_time: Duration::from_hours(24), ..Limits::default() });
    let server = triad::app(app.clone());
    let scene = get(&server, LARGE).await.json();
    let urdf = r#"<robot name="stone"><link name="base"/></robot>"#;
    let endless = json!({"scene": scene, "until": LONG, "every": 0.01 * LONG});
    let asked = |path: &'static str, body: Value| {
        let server = server.clone();
        tokio::spawn(async move { post(&server, path, body).await.status.as_u16() })
    };
    // Two more than there are places.
    let others = std::thread::available_parallelism().map_or(1, usize::from).saturating_sub(1).max(1) + 2;
    let tables: Vec<_> = (0..others).map(|_| asked("/api/v1/analyses/table", endless.clone())).collect();
    let waiting = async |more: usize| {
        let all = async {
            while app.work.waiting() < more {
                yield_now().await;
            }
        };
        timeout(PATIENCE, all).await.expect("they wait");
    };
    let before = 2;
    waiting(before).await;
    let check = asked("/api/v1/check", scene.clone());
    let robot = asked("/api/v1/import/urdf", json!({"urdf": urdf, "with": {"root": "ground"}}));
    waiting(before + 2).await;
    assert!(!check.is_finished() && !robot.is_finished());
    let left = asked("/api/v1/check", scene.clone());
    waiting(before + 3).await;
    left.abort();
    assert!(left.await.expect_err("it left").is_cancelled());
    assert_eq!(app.work.waiting(), before + 2, "it has not asked");
    tables.iter().for_each(tokio::task::JoinHandle::abort);
    let both = async { (check.await.expect("ends"), robot.await.expect("ends")) };
    assert_eq!(timeout(PATIENCE, both).await.expect("it is their turn"), (200, 200));
}

/// A table of a motion that a student hands in at home, judged.
pub(crate) async fn table_of(store: &Store, lesson: &Lesson, student: &str, file: &str) -> HandIn {
    let (course, whose) = (HOME.to_owned(), Whose::Named);
    let who = Who { course, whose, student: student.to_owned(), seed: None };
    let body = json!({"student": student, "answers": {"your-run": {"file": file}}}).to_string();
    let judged = Judged::new(&Variants::default(), lesson.clone(), &body, who, None, &Wanted::default());
    let judged = Arc::new(judged.expect("judges"));
    settled(store, &judged, identifier(), jiff::Timestamp::now()).await.expect("settles")
}

/// A gradebook with so many tables of a motion, each of a student with other numbers.
async fn with_tables(count: usize) -> (Arc<Store>, Lesson) {
    let store = Arc::new(Store::in_memory());
    let lesson = Course::embedded().expect("a course").lesson("verification").expect("a lesson").clone();
    let file = reference_submission(&lesson).answers["your-run"].file.clone().expect("a table");
    let new = table_of(&store, &lesson, "0", &file).await;
    for k in 0..count {
        let (id, student) = (identifier(), k.to_string());
        let mut verdict = new.verdict.clone();
        (verdict["id"], verdict["student"]) = (json!(id), json!(student));
        let one = HandIn { id, student: student.clone(), seed: student, verdict, ..new.clone() };
        store.hand_in(&one).await.expect("keeps");
    }
    (store, lesson)
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_preview_of_a_regrade_ends_as_its_caller_leaves() {
    let (store, lesson) = with_tables(400).await;
    loop {
        let progress = Arc::new(Progress::default());
        let (asked, told, lesson) = (Arc::clone(&store), Arc::clone(&progress), lesson.clone());
        let looking =
            tokio::spawn(async move { preview(&asked, identifier(), HOME, &lesson, told).await.map(drop) });
        let begun = async {
            while progress.now().0 == 0 {
                yield_now().await;
            }
        };
        timeout(PATIENCE, begun).await.expect("begins");
        looking.abort();
        if looking.await.is_ok() {
            // It was too late to leave.
            continue;
        }
        // Whoever computes tells how far it is.
        let ended = async {
            while Arc::strong_count(&progress) > 1 {
                yield_now().await;
            }
        };
        timeout(PATIENCE, ended).await.expect("ends");
        let (done, of) = progress.now();
        assert!(0 < done && done < of, "{done} of {of}");
        return;
    }
}
