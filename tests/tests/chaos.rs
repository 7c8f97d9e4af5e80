//! Several servers and graders on one PostgreSQL, killed at any moment: nothing that was acknowledged is lost, each submission has
//! one verdict, and every verdict is the one that a single process makes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, run_json, triad};

/// Submissions in all, unless `TRIAD_CHAOS` says otherwise: 10000 take about a quarter of an hour.
const SUBMISSIONS: u32 = 60;
const SERVERS: usize = 3;
const GRADERS: usize = 4;
/// Those who hand in at once.
const CLIENTS: u32 = 8;
/// The time between two kills.
const LIFE: Duration = Duration::from_millis(250);

/// A program that is killed and started again; its address, where it is a server.
struct Process {
    child: Child,
    address: String,
}

impl Process {
    fn server(url: &str, folder: &Path) -> Self {
        // Nothing is answered at once: all of it goes through the queue.
        let mut child = Self::start(&["serve", "--port", "0", "--at-once", "0", "--database", url], folder);
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        lines.read_line(&mut line).unwrap();
        // Where the database is away as it starts it says so and ends.
        let at = line.split("http://").nth(1).and_then(|rest| rest.split_whitespace().next());
        let address = at.unwrap_or_default().to_owned();
        std::thread::spawn(move || std::io::copy(&mut lines, &mut std::io::sink()));
        Self { child, address }
    }

    fn grader(url: &str, folder: &Path) -> Self {
        let child = Self::start(&["grader", "--slots", "2", "--lease", "2", "--database", url], folder);
        Self { child, address: String::new() }
    }

    fn start(arguments: &[&str], folder: &Path) -> Child {
        let mut command = Command::new(triad());
        command.args(arguments).current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped());
        command.stderr(Stdio::null()).spawn().unwrap()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One submission, sent again under its key until a server has taken it.
fn hand_in(servers: &[Mutex<Process>], number: u32) -> Value {
    let student = format!("student {}", number % 40);
    let answers = json!({"tension-bottom": {"value": format!("{}.5", number % 97), "unit": "N"}});
    let body = json!({"student": student, "answers": answers}).to_string();
    let began = Instant::now();
    for turn in number as usize.. {
        assert!(began.elapsed() < HANG, "submission {number} is taken by nobody");
        let address = servers[turn % servers.len()].lock().unwrap().address.clone();
        if let Some((200..=202, told)) = ask(&address, number, &body) {
            return told;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    unreachable!()
}

fn ask(address: &str, number: u32, body: &str) -> Option<(u16, Value)> {
    let mut stream = TcpStream::connect(address).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(20))).ok()?;
    write!(
        stream,
        "POST /api/v1/lessons/simple-pendulum/submissions HTTP/1.0\r\nHost: {address}\r\nIdempotency-Key: {number}\r\n\
         Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    )
    .ok()?;
    let mut answer = String::new();
    stream.read_to_string(&mut answer).ok()?;
    let (head, body) = answer.split_once("\r\n\r\n")?;
    let status = head.split_whitespace().nth(1)?.parse().ok()?;
    Some((status, serde_json::from_str(body).ok()?))
}

/// Rows of a table in an export.
fn rows(export: &Path, table: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(export).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.filter(|line| line[0] == table).map(|mut line| line[1].take()).collect()
}

/// Kills one after the other, in an order without a rhythm, and starts another in its place.
fn kill(
    servers: &[Mutex<Process>],
    graders: &[Mutex<Process>],
    url: &str,
    folder: &Path,
    stop: &AtomicBool,
) -> u32 {
    let mut kills = 0;
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(LIFE);
        let which = (f64::from(kills) * 0.618_034).fract() * (SERVERS + GRADERS) as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below seven
        let which = which as usize;
        match servers.get(which) {
            Some(server) => *server.lock().unwrap() = Process::server(url, folder),
            None => *graders[which - SERVERS].lock().unwrap() = Process::grader(url, folder),
        }
        kills += 1;
    }
    kills
}

#[test]
#[allow(clippy::too_many_lines)] // one evening of a class
fn nothing_is_lost_or_graded_twice_whatever_dies() {
    let Some(postgres) = Postgres::start("servers and graders that are killed") else { return };
    let submissions = std::env::var("TRIAD_CHAOS").map_or(SUBMISSIONS, |count| count.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let url = postgres.database();
    // The first makes the tables.
    let servers: Vec<_> = (0..SERVERS).map(|_| Mutex::new(Process::server(&url, folder.path()))).collect();
    let graders: Vec<_> = (0..GRADERS).map(|_| Mutex::new(Process::grader(&url, folder.path()))).collect();
    let (servers, graders) = (Arc::new(servers), Arc::new(graders));
    let (next, stop) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicBool::new(false)));
    let began = Instant::now();
    let clients: Vec<_> = (0..CLIENTS)
        .map(|_| {
            let (servers, next) = (Arc::clone(&servers), Arc::clone(&next));
            std::thread::spawn(move || {
                let mut told = BTreeMap::new();
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= submissions {
                        return told;
                    }
                    told.insert(
                        number.to_string(),
                        hand_in(&servers, number)["id"].as_str().unwrap().to_owned(),
                    );
                }
            })
        })
        .collect();
    let killer = {
        let (servers, graders, stop) = (Arc::clone(&servers), Arc::clone(&graders), Arc::clone(&stop));
        let (url, folder) = (url.clone(), folder.path().to_owned());
        std::thread::spawn(move || kill(&servers, &graders, &url, &folder, &stop))
    };
    for part in 1..3 {
        while next.load(Ordering::Relaxed) < submissions * part / 3 {
            std::thread::sleep(Duration::from_millis(10));
        }
        postgres.crash();
    }
    let told: BTreeMap<String, String> =
        clients.into_iter().flat_map(|client| client.join().unwrap()).collect();
    let accepted = began.elapsed();
    stop.store(true, Ordering::Relaxed);
    let kills = killer.join().unwrap();
    let waiting = || run_json(&["grader", "--look", "--database", &url]).1;
    let mut state = waiting();
    while state["waiting"] != 0 {
        assert!(began.elapsed() < 10 * HANG, "{state}");
        std::thread::sleep(Duration::from_millis(100));
        state = waiting();
    }
    let aside = state["aside"].as_u64().unwrap();
    if aside > 0 {
        // Three graders of one submission were killed: somebody lets it be graded again.
        run_json(&["grader", "--again", "--database", &url]);
        while waiting()["waiting"] != 0 {
            std::thread::sleep(Duration::from_millis(100));
        }
    }
    let all = began.elapsed();

    let export = folder.path().join("home.triad");
    assert_eq!(run_json(&["class", "export", export.to_str().unwrap(), "--database", &url]).0, 0);
    let kept: BTreeMap<String, String> = rows(&export, "submission")
        .iter()
        .map(|row| (row["request_key"].as_str().unwrap().to_owned(), row["id"].as_str().unwrap().to_owned()))
        .collect();
    assert_eq!(kept, told, "what was acknowledged is kept under its name, once");
    assert_eq!(kept.len(), submissions as usize);
    assert_eq!(rows(&export, "verdict").len(), kept.len(), "one verdict each");
    assert_eq!(run_json(&["grades", "--check", "--database", &url]), (0, json!([])), "the log is whole");
    // A single process, on a copy in a file, makes each verdict again, byte for byte.
    let file = folder.path().join("single.db");
    let file = file.to_str().unwrap();
    assert_eq!(run_json(&["class", "import", export.to_str().unwrap(), "--database", file]).0, 0);
    let (code, rebuilt) = run_json(&["regrade", "--check", "--database", file]);
    assert_eq!((code, &rebuilt["same"]), (0, &json!(submissions)), "{rebuilt}");
    println!(
        "{submissions} submissions, {kills} kills, 2 crashes of PostgreSQL: 0 lost, 0 doubled, {aside} put aside on the way; \
         accepted in {:.0} s, graded in {:.0} s",
        accepted.as_secs_f64(),
        all.as_secs_f64()
    );
}
