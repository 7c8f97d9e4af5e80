//! The live stream, over a real socket.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use serde_json::{Value, json};
use triad::limits::Limits;
use triad::session::Watched;
use triad::stream::{Delivery, Watcher};

use axum::body::{Body, Bytes};
use axum::http::Request;

use crate::{get, post, send, server, state};

/// A message of a WebSocket.
enum Message {
    Text(Value),
    Binary(Vec<u8>),
    Other,
}

/// As little of a WebSocket client as these tests need.
struct Client(BufReader<TcpStream>);

impl Client {
    fn open(address: SocketAddr, path: &str) -> Self {
        let mut socket = TcpStream::connect(address).expect("connects");
        // Ends a test that hangs, and decides nothing else.
        socket.set_read_timeout(Some(Duration::from_mins(5))).expect("a timeout");
        write!(
            socket,
            "GET {path} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        .expect("writes");
        let mut reader = BufReader::new(socket);
        let mut line = String::new();
        reader.read_line(&mut line).expect("a status");
        assert!(line.contains("101"), "{line}");
        while line.trim() != "" {
            line.clear();
            reader.read_line(&mut line).expect("a header");
        }
        Self(reader)
    }

    fn read(&mut self) -> Message {
        let mut head = [0_u8; 2];
        self.0.read_exact(&mut head).expect("a message");
        let length = match head[1] {
            126 => {
                let mut bytes = [0_u8; 2];
                self.0.read_exact(&mut bytes).expect("a length");
                u64::from(u16::from_be_bytes(bytes))
            }
            127 => {
                let mut bytes = [0_u8; 8];
                self.0.read_exact(&mut bytes).expect("a length");
                u64::from_be_bytes(bytes)
            }
            short => u64::from(short),
        };
        let mut payload = vec![0; usize::try_from(length).expect("fits")];
        self.0.read_exact(&mut payload).expect("a payload");
        match head[0] & 15 {
            1 => Message::Text(serde_json::from_slice(&payload).expect("JSON")),
            2 => Message::Binary(payload),
            _ => Message::Other,
        }
    }

    /// Reads until a text of that type comes; returns it with the blocks before it.
    fn until(&mut self, kind: &str) -> (Value, Vec<Vec<u8>>) {
        let mut blocks = Vec::new();
        loop {
            match self.read() {
                Message::Text(text) if text["type"] == kind => return (text, blocks),
                Message::Binary(block) => blocks.push(block),
                Message::Text(_) | Message::Other => {}
            }
        }
    }

    fn block(&mut self) -> Vec<u8> {
        loop {
            if let Message::Binary(block) = self.read() {
                return block;
            }
        }
    }
}

/// Reads the next block of a stream.
async fn next_block(mut client: Client) -> (Client, Vec<u8>) {
    let read = tokio::task::spawn_blocking(move || {
        let block = client.block();
        (client, block)
    });
    read.await.expect("reads")
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn watchers_get_the_history_then_what_is_new_and_are_told_of_a_reset_and_of_the_end() {
    let app = state(Limits::default());
    let server = triad::app(app.clone());
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.expect("a port");
    let address = listener.local_addr().expect("an address");
    let serving = server.clone();
    tokio::spawn(async move { axum::serve(listener, serving).await });

    let created =
        post(&server, "/api/v1/sessions", json!({"builtin": "spatial-double-pendulum"})).await.json();
    let path = created["links"]["self"].as_str().expect("a path").to_owned();
    post(&server, &format!("{path}/step"), json!({"seconds": 0.2})).await;
    let stream = format!("{path}/stream?recording=true");
    let open = |stream: String| tokio::task::spawn_blocking(move || Client::open(address, &stream));

    let first = open(stream.clone()).await.expect("opens");
    let (first, history) = next_block(first).await;
    assert_eq!(&history[..4], b"RRF2", "a complete recording");

    let state = post(&server, &format!("{path}/step"), json!({"seconds": 0.2})).await.json();
    assert_eq!(state["frames"], state["frames_encoded"], "everything is encoded while somebody watches");
    let encoded = state["frames_encoded"].clone();
    let second = open(stream).await.expect("opens");
    let (mut first, fresh) = next_block(first).await;
    assert_eq!(&fresh[..4], b"RRF2");
    assert!(fresh.len() < history.len(), "what is new is not sent with the history again");
    let state = get(&server, &path).await.json();
    assert_eq!(state["frames_encoded"], encoded, "a second watcher costs no encoding");
    let (second, old) = next_block(second).await;
    let (mut second, new) = next_block(second).await;
    assert_eq!([old, new], [history, fresh], "both see the same bytes");

    post(&server, &format!("{path}/reset"), "").await;
    let mut second = tokio::task::spawn_blocking(move || {
        second.until("reset");
        assert_eq!(&second.block()[..4], b"RRF2", "another recording begins");
        second
    })
    .await
    .expect("reads");
    app.sessions.clear();
    tokio::task::spawn_blocking(move || {
        first.until("closed");
        second.until("closed");
    })
    .await
    .expect("ends");
}

/// The times of the frames that a watcher of the numbers receives now.
fn times(watcher: &mut Watcher) -> Vec<f64> {
    let Some(Delivery::Blocks(blocks)) = watcher.poll() else { return Vec::new() };
    let of_block = |block: &Bytes| {
        let count = u32::from_le_bytes(block[8..12].try_into().expect("four")) as usize;
        let time = |k| f64::from_le_bytes(block[16 + 8 * k..24 + 8 * k].try_into().expect("eight"));
        (0..count).map(time).collect::<Vec<f64>>()
    };
    blocks.iter().flat_map(of_block).collect()
}

#[tokio::test]
async fn what_a_run_keeps_is_bounded_and_who_comes_late_sees_all_of_it_in_brief() {
    const MOST: usize = 160_000;
    let app = state(Limits { recording_bytes: MOST, ..Limits::default() });
    let server = triad::app(app.clone());
    let created = post(&server, "/api/v1/sessions", json!({"builtin": "simple-pendulum"})).await.json();
    let (path, id) =
        (created["links"]["self"].as_str().expect("a path"), created["id"].as_str().expect("an id"));
    let session = app.sessions.get(id).expect("a session");
    let (mut early, mut seen) = (session.watch(Watched::Track), Vec::new());
    let mut state = created.clone();
    for _ in 0..50 {
        state = post(&server, &format!("{path}/step"), json!({"seconds": 0.1})).await.json();
        assert!(state["error"].is_null(), "{state}");
        seen.extend(times(&mut early));
        let kept = app.sessions.bytes();
        assert!(kept > 1000 && kept <= MOST, "{kept} bytes");
    }
    assert_eq!(json!(seen.len()), state["frames"], "who watched from the start has seen every frame");
    let mut all = Vec::new();
    for time in times(&mut session.watch(Watched::Track)) {
        // As a page takes them: what comes again replaces what came before.
        all.retain(|before| *before < time);
        all.push(time);
    }
    assert_eq!((all.first(), all.last()), (Some(&0.0), state["time"].as_f64().as_ref()));
    let gap = all.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(all.len() < 400 && gap < 0.5, "{} frames, {gap} s", all.len());
    drop(early);
    app.sessions.remove(id).expect("closes");
    drop(session);
    while app.sessions.bytes() > 0 {
        tokio::task::yield_now().await;
    }
}

#[tokio::test]
async fn the_address_of_a_stream_tells_plain_requests_what_it_is() {
    let server = server();
    let created = post(&server, "/api/v1/sessions", json!({"builtin": "free-body"})).await.json();
    let stream = created["links"]["stream"].as_str().expect("a path").to_owned();
    get(&server, &stream).await.problem(426, "not-a-websocket");
    get(&server, "/api/v1/sessions/nothing/stream").await.problem(404, "unknown-session");
}

#[tokio::test]
async fn who_leaves_a_run_that_stands_still_is_not_counted_any_more() {
    let app = state(Limits::default());
    let server = triad::app(app.clone());
    let created = post(&server, "/api/v1/sessions", json!({"builtin": "free-body"})).await.json();
    let path = created["links"]["self"].as_str().expect("a path").to_owned();
    let session = app.sessions.get(created["id"].as_str().expect("an id")).expect("a session");
    let both = [Watched::Track, Watched::Recording].map(|what| session.watch(what));
    assert_eq!(get(&server, &path).await.json()["watchers"], 2);
    drop(both);
    assert_eq!(get(&server, &path).await.json()["watchers"], 0);
}

/// Threads of the viewer's library in this process.
#[cfg(target_os = "linux")]
fn encoding_threads() -> usize {
    let tasks = std::fs::read_dir("/proc/self/task").expect("threads");
    let name = |task: std::io::Result<std::fs::DirEntry>| {
        std::fs::read_to_string(task.expect("a thread").path().join("comm")).unwrap_or_default()
    };
    tasks
        .map(name)
        .filter(|name| name.starts_with("ChunkBatcher") || name.starts_with("RecordingStrea"))
        .count()
}

/// Open files and resident memory in kB of this process.
#[cfg(target_os = "linux")]
fn files_and_memory() -> (usize, u64) {
    let status = std::fs::read_to_string("/proc/self/status").expect("a status");
    let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("memory");
    let resident = resident.trim().trim_end_matches(" kB").parse().expect("a number");
    (std::fs::read_dir("/proc/self/fd").expect("files").count(), resident)
}

/// Sessions that are watched one after the other, unless `TRIAD_WATCHED` says otherwise.
#[cfg(target_os = "linux")]
const WATCHED: usize = 10;

#[cfg(target_os = "linux")]
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn watched_sessions_resets_and_cameras_leave_no_threads_behind() {
    let app = state(Limits::default());
    let server = triad::app(app.clone());
    let watched = std::env::var("TRIAD_WATCHED").map_or(WATCHED, |text| text.parse().expect("a number"));
    for k in 0..watched {
        if k % (watched / 10) == 0 {
            let (files, memory) = files_and_memory();
            println!("{k} sessions: {} threads, {files} files, {memory} kB", encoding_threads());
        }
        let created = post(&server, "/api/v1/sessions", json!({"builtin": "simple-pendulum"})).await.json();
        let path = created["links"]["self"].as_str().expect("a path").to_owned();
        let session = app.sessions.get(created["id"].as_str().expect("an id")).expect("a session");
        let mut watcher = session.watch(Watched::Recording);
        assert!(watcher.next().await.is_some());
        for view in ["front", "side"] {
            let request = Request::put(format!("{path}/camera")).header("content-type", "application/json");
            let request = request.body(Body::from(json!({"from": view}).to_string())).expect("a request");
            let reply = send(&server, request).await;
            assert_eq!(reply.status, 200, "{}", reply.json());
            post(&server, &format!("{path}/reset"), "").await;
        }
        app.sessions.remove(created["id"].as_str().expect("an id")).expect("closes");
    }
    // Each of these 50 recordings left six; other tests of this process watch a few of their own meanwhile.
    let mut left = encoding_threads();
    for _ in 0..100 {
        if left <= 40 {
            return;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
        left = encoding_threads();
    }
    panic!("{left} threads are left");
}
