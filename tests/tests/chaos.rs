//! Several servers and graders on one PostgreSQL, killed at any moment: nothing that was acknowledged is lost, each submission has
//! one verdict, and every verdict is the one that a single process makes.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use triad_tests::park::{Killed, Park};
use triad_tests::postgres::{Postgres, psql};
use triad_tests::program::{HANG, run, run_json};

/// Submissions in all, unless `TRIAD_CHAOS` says otherwise.
const SUBMISSIONS: u32 = 60;
/// Submissions of one student in a large run: each is settled with those before.
const EACH: u32 = 25;
/// Students at least.
const STUDENTS: u32 = 40;
/// Those who hand in at once.
const CLIENTS: u32 = 8;
/// Longest that a server is waited for: it may be cut off, or gone.
const PATIENCE: Duration = Duration::from_secs(20);

/// One submission, sent again under its key until a server has taken it: which one, and what it said.
fn hand_in(park: &Park, number: u32, students: u32) -> (usize, Value) {
    let student = format!("student {}", number % students);
    let answers = json!({"tension-bottom": {"value": format!("{}.5", number % 97), "unit": "N"}});
    let body = json!({"student": student, "answers": answers}).to_string();
    let began = Instant::now();
    for turn in number as usize.. {
        assert!(began.elapsed() < HANG, "submission {number} is taken by nobody");
        let server = turn % park.servers();
        let answer = park.address(server).and_then(|address| ask(&address, number, &body));
        if let Some((200..=202, told)) = answer {
            return (server, told);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    unreachable!()
}

fn ask(address: &str, number: u32, body: &str) -> Option<(u16, Value)> {
    let mut stream = TcpStream::connect_timeout(&address.parse().ok()?, PATIENCE).ok()?;
    stream.set_read_timeout(Some(PATIENCE)).ok()?;
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

/// How often each student hands in what is judged. Of thousands of numbers a few are near enough to the right one to be sent back for
/// their digits, which takes no attempt.
fn judged(students: u32, export: &Path) -> BTreeMap<String, u64> {
    let told = |row: &Value| serde_json::from_str::<Value>(row["body"].as_str().unwrap()).unwrap();
    let verdicts = rows(export, "verdict");
    let sent_back: BTreeSet<_> = verdicts
        .iter()
        .filter(|row| told(row)["gradable"] != true)
        .map(|row| &row["submission"])
        .map(Value::to_string)
        .collect();
    assert!(sent_back.len() * 100 <= verdicts.len(), "{} of {} sent back", sent_back.len(), verdicts.len());
    let mut each = BTreeMap::new();
    for row in rows(export, "submission") {
        if !sent_back.contains(&row["id"].to_string()) {
            let number: u32 = row["request_key"].as_str().unwrap().parse().unwrap();
            *each.entry(format!("student {}", number % students)).or_default() += 1;
        }
    }
    each
}

/// Rows of a table in an export.
fn rows(export: &Path, table: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(export).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.filter(|line| line[0] == table).map(|mut line| line[1].take()).collect()
}

/// Has PostgreSQL write down each submission that is begun anew because whoever had it is gone: when, and who had it.
const WATCH: [&str; 3] = [
    "CREATE TABLE taken_over (at BIGINT NOT NULL, worker TEXT NOT NULL)",
    "CREATE FUNCTION watch() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN INSERT INTO taken_over VALUES \
     (CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT), OLD.worker); RETURN NEW; END $$",
    "CREATE TRIGGER watch AFTER UPDATE ON grading FOR EACH ROW \
     WHEN (OLD.state = 'running' AND NEW.fence > OLD.fence) EXECUTE FUNCTION watch()",
];

/// How long it took from the end of each program until another one had begun again what it had: of graders, and of servers, whose
/// claims hold longer. Of several submissions that one had, the first counts.
fn times_to_take_over(url: &str, killed: &[Killed]) -> [Vec<f64>; 2] {
    let rows = psql(url, "SELECT split_part(worker, ' ', 1), MIN(at) FROM taken_over GROUP BY worker");
    let mut times = [Vec::new(), Vec::new()];
    for row in rows.lines() {
        let (id, at) = row.split_once('|').unwrap();
        let (id, at): (u32, i64) = (id.parse().unwrap(), at.parse().unwrap());
        // Numbers of processes come again.
        let end = killed.iter().rev().find(|one| one.id == id && one.at <= at);
        if let Some(one) = end {
            times[usize::from(!one.is_grader)].push((at - one.at) as f64 / 1000.0);
        }
    }
    for times in &mut times {
        times.sort_by(f64::total_cmp);
    }
    times
}

#[test]
#[allow(clippy::too_many_lines)] // one evening of a class
fn nothing_is_lost_or_graded_twice_whatever_dies() {
    let Some(postgres) = Postgres::start("servers and graders that are killed") else { return };
    let submissions = std::env::var("TRIAD_CHAOS").map_or(SUBMISSIONS, |count| count.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let url = postgres.database();
    let students = STUDENTS.max(submissions / EACH);
    let park = Arc::new(Park::start(&postgres, &url, folder.path()));
    let next = Arc::new(AtomicU32::new(0));
    let clock = || {
        postgres
            .ask("SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT)")
            .parse::<i64>()
            .unwrap()
    };
    for statement in WATCH {
        psql(&url, statement);
    }
    let first = clock();
    let began = Instant::now();
    let clients: Vec<_> = (0..CLIENTS)
        .map(|_| {
            let (park, next) = (Arc::clone(&park), Arc::clone(&next));
            std::thread::spawn(move || {
                let mut told = Vec::new();
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= submissions {
                        return told;
                    }
                    let (server, answer) = hand_in(&park, number, students);
                    told.push((server, number.to_string(), answer["id"].as_str().unwrap().to_owned()));
                }
            })
        })
        .collect();
    let (killer, disturber) = (Arc::clone(&park), Arc::clone(&park));
    let killer = std::thread::spawn(move || killer.kill());
    let disturber = std::thread::spawn(move || disturber.disturb());
    for part in 1..3 {
        while next.load(Ordering::Relaxed) < submissions * part / 3 {
            std::thread::sleep(Duration::from_millis(10));
        }
        postgres.crash();
        println!("{part} of 3 parts accepted after {:.0} s", began.elapsed().as_secs_f64());
    }
    let told: Vec<_> = clients.into_iter().flat_map(|client| client.join().unwrap()).collect();
    let by = [0, 1, 2].map(|server| told.iter().filter(|(by, ..)| *by == server).count());
    let told: BTreeMap<_, _> = told.into_iter().map(|(_, key, id)| (key, id)).collect();
    let accepted = began.elapsed();
    let last = clock();
    park.rest();
    let (killed, cuts) = (killer.join().unwrap(), disturber.join().unwrap());
    let waiting = || run_json(&["grader", "--look", "--database", &url]).1;
    let mut state = waiting();
    while state["waiting"] != 0 {
        assert!(began.elapsed() < accepted + 10 * HANG, "{state}");
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
    let times = rows(&export, "submission").into_iter().map(|row| row["received_at"].as_i64().unwrap());
    assert!(
        times.clone().all(|at| (first..=last).contains(&at)),
        "by the clock of the database: {first} {last}"
    );
    let mut attempts = judged(students, &export);
    for line in String::from_utf8(run(&["grades", "--jsonl", "--database", &url]).stdout).unwrap().lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        let student = attempts.remove(line["student"].as_str().unwrap());
        assert_eq!(student, line["attempts"].as_u64(), "{line}");
    }
    assert_eq!(attempts, BTreeMap::new(), "attempts are exact");
    assert_eq!(run_json(&["grades", "--check", "--database", &url]), (0, json!([])), "the log is whole");
    // A single process, on a copy in a file, makes each verdict again, byte for byte.
    let file = folder.path().join("single.db");
    let file = file.to_str().unwrap();
    assert_eq!(run_json(&["class", "import", export.to_str().unwrap(), "--database", file]).0, 0);
    let (code, rebuilt) = run_json(&["regrade", "--check", "--database", file]);
    assert_eq!((code, &rebuilt["same"]), (0, &json!(submissions)), "{rebuilt}");
    let kills = killed.len();
    println!(
        "{submissions} submissions of {students} students, by servers {by:?}, {kills} kills, one in {:.0} ms, 2 crashes of PostgreSQL, {cuts} cuts of a network and of a cable: 0 lost, \
         0 doubled, {aside} put aside on the way; accepted in {:.0} s, graded in {:.0} s, {:.1} a second",
        (accepted / u32::try_from(kills).unwrap()).as_secs_f64() * 1000.0,
        accepted.as_secs_f64(),
        all.as_secs_f64(),
        f64::from(submissions) / all.as_secs_f64()
    );
    for (times, what) in
        times_to_take_over(&url, &killed).iter().zip(["grader (lease 2 s)", "server (lease 15 s)"])
    {
        match (times.get(times.len() / 2), times.last()) {
            (Some(median), Some(longest)) => println!(
                "what a {what} had as it was killed was begun again by another after {median:.1} s in the median, {longest:.1} s at \
                 most, {} times",
                times.len()
            ),
            _ => println!("no {what} had anything as it was killed"),
        }
    }
}
