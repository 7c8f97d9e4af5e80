//! The gradebook of the running program from outside: killed in the middle of submissions, copied, moved, and brought back.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use triad_tests::program::{HANG, Server, assert_problem, run, run_json};

/// How often the server is killed, unless `TRIAD_KILLS` says otherwise: 1000 take a quarter of an hour.
const KILLS: u32 = 25;
/// Those who hand in at once.
const CLIENTS: u32 = 8;
/// The longest that a server lives after its first submission, ms.
const LIFE: f64 = 300.0;

/// A submission as its sender sees it.
#[derive(Debug, Clone)]
struct Sent {
    student: String,
    /// Its `Idempotency-Key`.
    key: String,
    value: u32,
}

impl Sent {
    /// Hands it in; the id under which it is kept, if the answer came whole.
    fn hand_in(&self, address: &str) -> Option<String> {
        let answers = json!({"tension-bottom": {"value": format!("{}.5", self.value), "unit": "N"}});
        let body = json!({"student": self.student, "answers": answers}).to_string();
        let mut stream = TcpStream::connect(address).ok()?;
        stream.set_read_timeout(Some(HANG)).ok()?;
        write!(
            stream,
            "POST /api/v1/lessons/simple-pendulum/submissions HTTP/1.0\r\nHost: {address}\r\nIdempotency-Key: {}\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            self.key,
            body.len()
        )
        .ok()?;
        let mut answer = String::new();
        stream.read_to_string(&mut answer).ok()?;
        let (head, body) = answer.split_once("\r\n\r\n")?;
        let verdict: Value = serde_json::from_str(body).ok()?;
        assert!(head.starts_with("HTTP/1.0 201"), "{answer}");
        Some(verdict["id"].as_str().unwrap().to_owned())
    }
}

/// What the clients know.
#[derive(Debug, Default)]
struct Known {
    /// Ids of what was acknowledged, by key.
    acknowledged: BTreeMap<String, String>,
    /// What was sent and not answered: it may be kept or not.
    open: Vec<Sent>,
}

/// One client: hands in without pause until the server is gone.
fn client(address: &str, round: u32, number: u32, known: &Mutex<Known>, stop: &AtomicBool) {
    for value in 0.. {
        let student = format!("student {round} {number}");
        let sent = Sent { key: format!("{round}-{number}-{value}"), student, value };
        let answer = sent.hand_in(address);
        let mut known = known.lock().unwrap();
        match answer {
            Some(id) => drop(known.acknowledged.insert(sent.key, id)),
            None => known.open.push(sent),
        }
        if stop.load(Ordering::Relaxed) {
            return;
        }
    }
}

/// Rows of a table in an export, as the program writes it.
fn rows(export: &Path, table: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(export).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.filter(|line| line[0] == table).map(|mut line| line[1].take()).collect()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_server_that_is_killed_loses_nothing_acknowledged_and_doubles_nothing() {
    let kills = std::env::var("TRIAD_KILLS").map_or(KILLS, |kills| kills.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let known = Arc::new(Mutex::new(Known::default()));
    let began = Instant::now();
    for round in 0..kills {
        let server = Server::start(folder.path());
        // Who got no answer sends again under the same key.
        let again = std::mem::take(&mut known.lock().unwrap().open);
        for sent in again {
            let id = sent.hand_in(&server.address).unwrap();
            known.lock().unwrap().acknowledged.insert(sent.key, id);
        }
        let stop = Arc::new(AtomicBool::new(false));
        let clients: Vec<_> = (0..CLIENTS)
            .map(|number| {
                let (known, stop, address) = (Arc::clone(&known), Arc::clone(&stop), server.address.clone());
                std::thread::spawn(move || client(&address, round, number, &known, &stop))
            })
            .collect();
        // Spread evenly over all moments, by the golden section.
        std::thread::sleep(Duration::from_secs_f64(LIFE * (f64::from(round) * 0.618_034).fract() / 1e3));
        stop.store(true, Ordering::Relaxed);
        drop(server);
        for client in clients {
            client.join().unwrap();
        }
        if round % 100 == 99 {
            println!("{} kills, {} acknowledged", round + 1, known.lock().unwrap().acknowledged.len());
        }
    }
    let known = known.lock().unwrap();
    let (database, export) = (folder.path().join("grades.db"), folder.path().join("home.triad"));
    assert!(run(&["class", "export", text(&export), "--database", text(&database)]).status.success());
    let kept = rows(&export, "submission");
    let by_key: BTreeMap<&str, &str> =
        kept.iter().map(|row| (row["request_key"].as_str().unwrap(), row["id"].as_str().unwrap())).collect();
    assert_eq!(by_key.len(), kept.len(), "a key is one submission");
    for (key, id) in &known.acknowledged {
        assert_eq!(by_key.get(key.as_str()), Some(&id.as_str()), "{key} was acknowledged");
    }
    // What is kept beyond that was sent, and its answer did not arrive before the last kill.
    let open: BTreeSet<&str> = known.open.iter().map(|sent| sent.key.as_str()).collect();
    let beyond = by_key.keys().filter(|key| !known.acknowledged.contains_key(**key)).count();
    assert!(by_key.keys().all(|key| known.acknowledged.contains_key(*key) || open.contains(*key)));
    assert_eq!(rows(&export, "verdict").len(), kept.len());
    let (code, faults) = run_json(&["grades", "--check", "--database", text(&database)]);
    assert_eq!((code, faults), (0, json!([])), "the log is whole");
    println!(
        "{kills} kills, {} acknowledged, 0 lost, 0 doubled, {beyond} kept of {} without an answer, {:.0} s",
        known.acknowledged.len(),
        open.len(),
        began.elapsed().as_secs_f64()
    );
    assert!(known.acknowledged.len() > kills as usize, "{}", known.acknowledged.len());
}

#[test]
fn a_gradebook_is_copied_while_it_is_used_and_brought_back_moved_and_thinned() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (database, copy, back, export, moved, ada) =
        (at("grades.db"), at("copy.db"), at("back.db"), at("home.triad"), at("moved.db"), at("ada.json"));
    let server = Server::start(folder.path());
    for (k, student) in ["Ada", "Emmy"].into_iter().enumerate() {
        let sent = Sent { student: student.into(), key: student.into(), value: u32::try_from(k).unwrap() };
        sent.hand_in(&server.address).unwrap();
    }
    let (code, told) = run_json(&["backup", &copy, "--database", &database]);
    assert_eq!((code, &told["submissions"]), (0, &json!(2)), "{told}");
    let refused = |arguments: &[&str], expected: &str| {
        let (code, told) = run_json(arguments);
        assert!(code == 3 || code == 4, "{told}");
        assert_eq!(told["code"], expected, "{told}");
    };
    refused(&["backup", &copy, "--database", &database], "file-exists");
    refused(&["restore", &copy, "--database", &database], "file-exists");
    refused(&["restore", &at("none.db"), "--database", &back], "no-such-file");
    assert_eq!(run_json(&["restore", &copy, "--database", &back]).0, 0);
    assert_eq!(run_json(&["class", "export", &export, "--database", &back]).0, 0);
    refused(&["class", "export", &export, "--database", &back], "file-exists");
    refused(&["class", "import", &copy, "--database", &moved], "foreign-file");
    assert!(run_json(&["class", "import", &export, "--database", &moved]).1["rows"].as_u64() > Some(10));
    assert_eq!(run_json(&["class", "import", &export, "--database", &moved]).1["rows"], 0);
    let grades = |database: &str| run_json(&["grades", "--database", database]);
    assert_eq!(grades(&moved), grades(&database));
    assert_eq!(run_json(&["regrade", "--check", "--database", &moved]).1["same"], 2);

    refused(&["class", "copy", "Nobody", &ada, "--database", &moved], "unknown-person");
    assert_eq!(run_json(&["class", "copy", "ada", &ada, "--database", &moved]).0, 0);
    let hers: Value = serde_json::from_str(&std::fs::read_to_string(&ada).unwrap()).unwrap();
    assert_eq!(hers["submissions"][0]["answers"]["tension-bottom"]["value"], "0.5");
    assert!(!hers.to_string().contains("Emmy"));
    let erase = ["class", "erase", "Ada", "--reason", "asked for it", "--database", &moved];
    assert_eq!(run_json(&erase).0, 0);
    refused(&erase, "unknown-person");
    let erased = |one: &Value| one["name"].as_str().unwrap().starts_with("Erased");
    assert_eq!(grades(&moved).1["students"].as_array().unwrap().iter().filter(|one| erased(one)).count(), 1);
    assert_eq!(run_json(&["grades", "--check", "--database", &moved]), (0, json!([])));
    assert_eq!(run_json(&["regrade", "--check", "--database", &moved]).0, 0);
    server.stop();
}

/// A small disk of its own, gone at the end of the test.
struct Disk(tempfile::TempDir);

impl Disk {
    /// One with room for so many megabytes; none where this machine does not let us.
    fn of(megabytes: u32) -> Option<Self> {
        let disk = Self(tempfile::tempdir().unwrap());
        disk.mount(&["-t", "tmpfs", "-o", &format!("size={megabytes}m"), "tmpfs"]).then_some(disk)
    }

    fn mount(&self, how: &[&str]) -> bool {
        let mut mount = Command::new("mount");
        mount.args(how).arg(self.0.path()).stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success())
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("--lazy").arg(self.0.path()).stderr(Stdio::null()).status();
    }
}

#[test]
fn a_disk_that_is_full_or_read_only_is_named_and_loses_nothing() {
    let Some(disk) = Disk::of(4) else {
        eprintln!("full and read-only disks are not tried: it takes root, and a system that mounts tmpfs");
        return;
    };
    let folder = disk.0.path();
    let server = Server::start(folder);
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let hand_in = |student: usize| {
        let value = format!("{student}.5{}", " ".repeat(100_000));
        let answers = json!({"tension-bottom": {"value": value, "unit": "N"}});
        server.post(path, &json!({"student": format!("student {student}"), "answers": answers}))
    };
    let mut kept = 0;
    let refused = loop {
        let reply = hand_in(kept);
        if reply.status >= 300 {
            break reply;
        }
        kept += 1;
        assert!(kept < 200, "4 MB hold no 20 MB");
    };
    assert_eq!(refused.status, 507);
    assert_problem(&refused.json(), "disk-full", "");
    let listed =
        |server: &Server| server.get("/api/v1/submissions?limit=1000").json().as_array().unwrap().len();
    assert_eq!(listed(&server), kept);
    // Room is made while it runs.
    assert!(disk.mount(&["-o", "remount,size=64m"]));
    assert!(hand_in(kept).status < 300);
    server.stop();

    assert!(disk.mount(&["-o", "remount,ro"]));
    let database = folder.join("grades.db");
    let (code, told) = run_json(&["serve", "--port", "0", "--database", text(&database)]);
    assert_eq!(code, 4, "{told}");
    assert_problem(&told, "database-unavailable", "");
    assert!(told["detail"].as_str().unwrap().contains("Read-only file system"), "{told}");
    assert!(disk.mount(&["-o", "remount,rw"]));
    let server = Server::start(folder);
    assert_eq!(listed(&server), kept + 1);
    server.stop();
}

#[test]
fn two_servers_on_one_file_keep_what_each_acknowledged() {
    const EACH: u32 = 40;
    let folder = tempfile::tempdir().unwrap();
    let servers = [Server::start(folder.path()), Server::start(folder.path())];
    let known = Mutex::new(Known::default());
    std::thread::scope(|scope| {
        for number in 0..CLIENTS {
            // Each student by way of both servers.
            let (known, servers) = (&known, &servers);
            scope.spawn(move || {
                for value in 0..EACH / CLIENTS {
                    let sent = Sent {
                        student: format!("student {}", number / 2),
                        key: format!("{number}-{value}"),
                        value,
                    };
                    let id = sent.hand_in(&servers[number as usize % 2].address).unwrap();
                    known.lock().unwrap().acknowledged.insert(sent.key, id);
                }
            });
        }
    });
    let listed = |server: &Server| {
        let all = server.get("/api/v1/submissions?limit=1000").json();
        all.as_array()
            .unwrap()
            .iter()
            .map(|one| one["id"].as_str().unwrap().to_owned())
            .collect::<BTreeSet<_>>()
    };
    let acknowledged: BTreeSet<String> = known.lock().unwrap().acknowledged.values().cloned().collect();
    assert_eq!(acknowledged.len(), EACH as usize);
    for server in &servers {
        assert_eq!(listed(server), acknowledged, "each server knows of both's");
    }
    servers.into_iter().for_each(Server::stop);
    let database = folder.path().join("grades.db");
    assert_eq!(run_json(&["grades", "--check", "--database", text(&database)]), (0, json!([])));
    assert_eq!(run_json(&["regrade", "--check", "--database", text(&database)]).1["same"], EACH);
}
