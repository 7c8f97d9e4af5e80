//! A class on one server: sessions that play and are watched, connections that say nothing, and callers who measure how long
//! they wait meanwhile.

use crate::lecture::FollowerPage;
use crate::program::{HANG, Reply, Server};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Longer than any measurement, s.
pub const ENDLESS: f64 = 1e5;

/// A connection that is kept, as a browser keeps it.
#[derive(Debug)]
pub struct Line {
    reader: BufReader<TcpStream>,
    address: String,
}

impl Line {
    /// Connects.
    pub fn open(address: &str) -> Self {
        let socket = TcpStream::connect(address).unwrap();
        socket.set_read_timeout(Some(HANG)).unwrap();
        socket.set_nodelay(true).unwrap();
        Self { reader: BufReader::new(socket), address: address.to_owned() }
    }

    /// Asks, and waits for the whole answer.
    pub fn ask(&mut self, method: &str, path: &str, body: Option<&Value>) -> Reply {
        let body = body.map(Value::to_string).unwrap_or_default();
        let length = body.len();
        let head = format!("{method} {path} HTTP/1.1\r\nHost: {}\r\nAccept: */*\r\n", self.address);
        let about = format!("Content-Type: application/json\r\nContent-Length: {length}\r\n");
        let about = if method == "GET" { "" } else { about.as_str() };
        self.reader.get_mut().write_all(format!("{head}{about}\r\n{body}").as_bytes()).unwrap();
        let mut answer = Vec::new();
        while !answer.ends_with(b"\r\n\r\n") {
            assert!(self.reader.read_until(b'\n', &mut answer).unwrap() > 0, "the server hung up on {path}");
        }
        let mut reply = Reply::parse(&answer);
        let length = reply.head.lines().find_map(|line| line.strip_prefix("content-length:"));
        reply.body = vec![0; length.map_or(0, |length| length.trim().parse().unwrap())];
        self.reader.read_exact(&mut reply.body).unwrap();
        reply
    }
}

/// A session that plays and whose numbers are read and thrown away, as by a page.
#[derive(Debug)]
pub struct Player {
    /// Its address.
    pub path: String,
    /// Messages that its watcher has received.
    pub received: Arc<AtomicUsize>,
    socket: TcpStream,
    watcher: std::thread::JoinHandle<()>,
}

impl Player {
    /// Begins a session of a built-in scene that does not end, watches it and lets it play.
    pub fn start(server: &Server, scene: &str) -> Self {
        let wanted = json!({ "builtin": scene, "overrides": {"duration": ENDLESS} });
        let created = server.post("/api/v1/sessions", &wanted);
        assert_eq!(created.status, 201, "{}", created.text());
        let path = created.json()["links"]["self"].as_str().unwrap().to_owned();
        let mut page = FollowerPage::open(&server.address, &format!("{path}/stream"));
        let socket = page.socket();
        let received = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&received);
        let watcher = std::thread::spawn(move || {
            while page.skim() {
                count.fetch_add(1, Ordering::Relaxed);
            }
        });
        assert_eq!(server.post(&format!("{path}/play"), &json!({})).status, 200);
        Self { path, received, socket, watcher }
    }

    /// Leaves, without a word.
    pub fn leave(self) {
        let _ = self.socket.shutdown(Shutdown::Both);
        self.watcher.join().unwrap();
    }
}

/// How long callers waited, by what they asked.
#[derive(Debug, Default)]
pub struct Waits(Mutex<BTreeMap<&'static str, Vec<Duration>>>);

impl Waits {
    /// Asks once, and notes how long it took.
    pub fn ask(&self, line: &mut Line, what: &'static str, method: &str, path: &str, body: Option<&Value>) {
        let began = Instant::now();
        let reply = line.ask(method, path, body);
        let took = began.elapsed();
        assert!((200..300).contains(&reply.status), "{method} {path}: {} {}", reply.status, reply.text());
        self.0.lock().unwrap().entry(what).or_default().push(took);
    }

    /// Each kind with the number of calls, and the waits that half, 99 of 100 and all of them did not exceed, ms.
    pub fn table(&self) -> Vec<(String, usize, [f64; 3])> {
        let mut waits = std::mem::take(&mut *self.0.lock().unwrap());
        let all: Vec<Duration> = waits.values().flatten().copied().collect();
        waits.insert("all", all);
        let row = |(what, mut waits): (&str, Vec<Duration>)| {
            waits.sort();
            let at = |percent: usize| waits[(waits.len() - 1) * percent / 100].as_secs_f64() * 1e3;
            (what.to_owned(), waits.len(), [at(50), at(99), at(100)])
        };
        waits.into_iter().map(row).collect()
    }
}

/// What one student at their page asks: how the run stands, its matrix, the lesson's text, and a submission.
pub fn one_round(waits: &Waits, line: &mut Line, session: &str, student: &str, round: usize) {
    waits.ask(line, "health", "GET", "/api/v1/health", None);
    waits.ask(line, "state", "GET", session, None);
    waits.ask(line, "Jacobian", "GET", &format!("{session}/jacobian"), None);
    waits.ask(line, "lesson", "GET", "/api/v1/lessons/simple-pendulum", None);
    let answers = json!({"tension-bottom": {"value": format!("{round}.5"), "unit": "N"}});
    let body = json!({"student": student, "answers": answers});
    waits.ask(line, "submission", "POST", "/api/v1/lessons/simple-pendulum/submissions", Some(&body));
}
