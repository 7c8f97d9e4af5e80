//! A class at its busiest on one server: sessions play and are watched, connections say nothing, students ask and hand in, and
//! then the server is told to stop with all of that open. Counters are held; times are printed, for whoever measures:
//!
//! ```sh
//! TRIAD_LOAD=200 cargo test --release --workspace --test load -- --nocapture
//! ```

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::json;
use std::io::Write;
use std::net::TcpStream;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use triad_tests::load::{Line, Player, Waits, one_round};
use triad_tests::program::{HANG, Server, admin};

/// Sessions that play and are watched, unless `TRIAD_LOAD` says otherwise.
const SESSIONS: usize = 6;
/// Connections that say nothing, for each of them.
const IDLE: usize = 5;
/// As many at least: among fewer the memory of one is not seen.
const FEWEST_IDLE: usize = 300;
/// KiB that each of them costs at most.
const IDLE_COSTS: f64 = 100.0;
/// Students who ask at a time.
const CALLERS: usize = 4;
/// Rounds of questions in all, for each session.
const ROUNDS: usize = 4;
/// Between two rounds of one who asks, where it is measured: with four of them 200 students ask 50 times a second.
const PAUSE: Duration = Duration::from_millis(350);
/// After the last session, where it is measured: what runs held has gone back to the system.
const GIVEN_BACK: Duration = Duration::from_secs(40);
/// A server that is told to stop is gone by then, whatever hangs.
const STOPS: Duration = Duration::from_secs(20);
/// Bytes that one run keeps of what it has passed, and all of them together (`server/src/limits.rs`), but for the newest block
/// of each.
const ONE_KEEPS: usize = 17 << 20;
const ALL_KEPT: usize = 1100 << 20;
/// What a class looks at: three bodies in space.
const SCENE: &str = "spatial-slider-crank";

/// Callers ask in turns while the sessions play.
fn ask_around(server: &Server, players: &[Player], rounds: usize, pause: Duration) -> Waits {
    let waits = Waits::default();
    std::thread::scope(|scope| {
        for caller in 0..CALLERS {
            let waits = &waits;
            scope.spawn(move || {
                let mut line = Line::open(&server.address);
                for round in (caller..rounds).step_by(CALLERS) {
                    let session = &players[round % players.len()].path;
                    one_round(
                        waits,
                        &mut line,
                        session,
                        &format!("student {}", round % players.len()),
                        round,
                    );
                    std::thread::sleep(pause);
                }
            });
        }
    });
    waits
}

/// How far the runs came for each second that passed: the least and the median.
fn pace(before: &[f64], after: &[f64], wall: f64) -> [f64; 2] {
    let mut all: Vec<f64> = before.iter().zip(after).map(|(before, after)| (after - before) / wall).collect();
    all.sort_by(f64::total_cmp);
    [all[0], all[all.len() / 2]]
}

fn times(server: &Server, players: &[Player]) -> Vec<f64> {
    players.iter().map(|player| server.get(&player.path).json()["time"].as_f64().unwrap()).collect()
}

/// Bytes that the server keeps of what its runs have passed, as it counts them.
fn kept(log: &Path) -> usize {
    let counters = admin(log, "/metrics").text();
    let line = counters.lines().find_map(|line| line.strip_prefix("triad_sessions_bytes "));
    line.unwrap().parse().unwrap()
}

/// Waits until the server has no session, keeps nothing of those that it had, and has no more threads and files than so many.
fn settles(server: &Server, log: &Path, threads: f64, files: usize) {
    let began = Instant::now();
    while server.get("/api/v1/health").json()["sessions"] != 0
        || kept(log) > 0
        || server.threads() > threads
        || server.files() > files
    {
        let now = (server.threads(), server.files());
        assert!(began.elapsed() < HANG, "{now:?} threads and files, before {threads} and {files}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Half a head, half a body, a stream that nobody reads, a step that takes long: what a server meets when it is stopped.
fn hanging(server: &Server, session: &str) -> Vec<TcpStream> {
    let mut open: Vec<TcpStream> = (0..4).map(|_| TcpStream::connect(&server.address).unwrap()).collect();
    let host = &server.address;
    let step = json!({"seconds": 1e6}).to_string();
    let words = [
        format!("GET / HTTP/1.1\r\nHost: {host}\r\n"),
        format!("POST /api/v1/sessions HTTP/1.1\r\nHost: {host}\r\ncontent-length: 9\r\n\r\n{{"),
        format!(
            "GET {session}/stream?recording=true HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
             Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        ),
        format!(
            "POST {session}/step HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n{step}",
            step.len()
        ),
    ];
    for (socket, words) in open.iter_mut().zip(words) {
        socket.write_all(words.as_bytes()).unwrap();
    }
    open
}

/// Lets students ask while the sessions play, and prints how long they waited.
fn measure(server: &Server, players: &[Player], pause: Duration) {
    let (before, began, busy) = (times(server, players), Instant::now(), server.processor_time());
    let waits = ask_around(server, players, ROUNDS * players.len(), pause);
    let (wall, busy) = (began.elapsed().as_secs_f64(), server.processor_time().saturating_sub(busy));
    let [least, median] = pace(&before, &times(server, players), wall);
    println!("{} sessions of {SCENE} play and are watched, {wall:.1} s", players.len());
    println!("  simulated seconds a second: {median:.2} median, {least:.2} least");
    println!(
        "  server: {:.2} processors, {:.0} MB, {:.0} threads",
        busy.as_secs_f64() / wall,
        server.memory(),
        server.threads()
    );
    for (what, calls, [half, most, all]) in waits.table() {
        println!(
            "  {what:<10} {calls:>6} calls, ms: {half:>7.1} median, {most:>7.1} p99, {all:>7.1} longest"
        );
    }
}

#[test]
fn a_class_plays_and_watches_while_it_asks_and_hands_in() {
    let wanted = std::env::var("TRIAD_LOAD").ok().map(|count| count.parse().unwrap());
    let count: usize = wanted.unwrap_or(SESSIONS);
    let folder = tempfile::tempdir().unwrap();
    let most = (count + 1).to_string();
    let log = folder.path().join("log");
    let options = ["--max-sessions", &most, "--log", "json", "--admin-address", "127.0.0.1:0"];
    let server = Server::logging(folder.path(), &options, &log);
    // What comes with the first of everything is no growth.
    let first = Player::start(&server, SCENE);
    one_round(&Waits::default(), &mut Line::open(&server.address), &first.path, "first", 0);
    let path = first.path.clone();
    first.leave();
    server.ask("DELETE", &path, None);
    let (threads, files, memory) = (server.threads(), server.files(), server.memory());
    let idle: Vec<TcpStream> =
        (0..(IDLE * count).max(FEWEST_IDLE)).map(|_| TcpStream::connect(&server.address).unwrap()).collect();
    server.get("/api/v1/health");
    let each = (server.memory() - memory) * 1024.0 / idle.len() as f64;
    println!("{} idle connections: {each:.1} KiB each", idle.len());
    assert!(each <= IDLE_COSTS, "{each} KiB for a connection that says nothing");

    let players: Vec<Player> = (0..count).map(|_| Player::start(&server, SCENE)).collect();
    measure(&server, &players, wanted.map_or(Duration::ZERO, |_| PAUSE));
    let bytes = kept(&log);
    println!("  kept of what they passed: {:.1} MB", bytes as f64 / 1e6);
    assert!(bytes > 0 && bytes <= ALL_KEPT.min(count * ONE_KEEPS), "{bytes} bytes");
    // Nobody was sent away, every submission is kept, and every watcher was served.
    let kept = server.get("/api/v1/submissions?limit=1000").json();
    assert_eq!(kept.as_array().map(Vec::len), Some((1 + ROUNDS * count).min(1000)));
    for player in &players {
        assert!(player.received.load(Ordering::Relaxed) > 0, "{} was not served", player.path);
    }

    let paths: Vec<String> = players.iter().map(|player| player.path.clone()).collect();
    players.into_iter().for_each(Player::leave);
    drop(idle);
    for path in &paths {
        assert_eq!(server.ask("DELETE", path, None).status, 204);
    }
    // Threads of the runtime for what blocks, and connections to the gradebook, come and go; of each session nothing is left.
    settles(&server, &log, threads + 16.0, files + 16);
    std::thread::sleep(wanted.map_or(Duration::ZERO, |_| GIVEN_BACK));
    println!(
        "  afterwards: {:.0} MB, {:.0} threads ({threads:.0} before)",
        server.memory(),
        server.threads()
    );

    let last = Player::start(&server, SCENE);
    let open = hanging(&server, &last.path);
    let began = Instant::now();
    server.stop();
    let took = began.elapsed();
    println!("  stopped with {} that hang: {:.1} s", open.len(), took.as_secs_f64());
    assert!(took < STOPS, "{took:?}");
    last.leave();
}
