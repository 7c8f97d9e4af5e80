//! Several servers and graders on one PostgreSQL, killed at any moment: nothing that was acknowledged is lost, each submission has
//! one verdict, and every verdict is the one that a single process makes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant, SystemTime};
use triad_tests::cable::Cable;
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, run_json, triad};

/// Submissions in all, unless `TRIAD_CHAOS` says otherwise.
const SUBMISSIONS: u32 = 60;
/// Submissions of one student in a large run: each is settled with those before.
const EACH: u32 = 25;
/// Students at least.
const STUDENTS: u32 = 40;
const SERVERS: usize = 3;
const GRADERS: usize = 4;
/// Those who hand in at once.
const CLIENTS: u32 = 8;
/// The time between two kills.
const LIFE: Duration = Duration::from_millis(250);
/// How long a cable is held up: longer than the leases of the graders.
const STALL: Duration = Duration::from_secs(3);

/// Debian's package of that name.
const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

/// Where a program runs: by which address it finds the database, and how far its clock is off, in words of faketime.
#[derive(Debug, Clone)]
struct Machine {
    url: String,
    clock: Option<&'static str>,
}

impl Machine {
    /// So many machines: of the first the clock is half an hour fast, of the second the cable is held up and cut, of the third the
    /// clock is half an hour slow.
    fn park(count: usize, url: &str, by_cable: &str) -> Vec<Self> {
        let is_there = Path::new(FAKETIME).exists();
        let machine = |k| Self {
            url: if k == 1 { by_cable.to_owned() } else { url.to_owned() },
            clock: [Some("+30m"), None, Some("-30m")].get(k).copied().flatten().filter(|_| is_there),
        };
        (0..count).map(machine).collect()
    }
}

/// A program that is killed and started again; its address, where it is a server.
struct Process {
    child: Child,
    address: String,
}

impl Process {
    fn server(machine: &Machine, folder: &Path) -> Self {
        // Nothing is answered at once: all of it goes through the queue.
        let mut child = Self::start(&["serve", "--port", "0", "--at-once", "0"], machine, folder);
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        lines.read_line(&mut line).unwrap();
        // Where the database is away as it starts it says so and ends.
        let at = line.split("http://").nth(1).and_then(|rest| rest.split_whitespace().next());
        let address = at.unwrap_or_default().to_owned();
        std::thread::spawn(move || std::io::copy(&mut lines, &mut std::io::sink()));
        Self { child, address }
    }

    fn grader(machine: &Machine, folder: &Path) -> Self {
        let child = Self::start(&["grader", "--slots", "2", "--lease", "2"], machine, folder);
        Self { child, address: String::new() }
    }

    fn start(arguments: &[&str], machine: &Machine, folder: &Path) -> Child {
        let mut command = Command::new(triad());
        if let Some(clock) = machine.clock {
            // What is waited for by the program itself takes as long as ever.
            command
                .env("LD_PRELOAD", FAKETIME)
                .env("FAKETIME", clock)
                .env("FAKETIME_DONT_FAKE_MONOTONIC", "1");
        }
        command
            .args(arguments)
            .args(["--database", &machine.url])
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped());
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
fn hand_in(servers: &[Mutex<Process>], number: u32, students: u32) -> Value {
    let student = format!("student {}", number % students);
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

/// The time, in milliseconds since 1970.
fn now() -> i64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
    i64::try_from(since.as_millis()).unwrap()
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

/// A program that was killed: its number, when, in milliseconds since 1970, and whether it was a grader.
type Killed = (u32, i64, bool);

/// How long it took from the end of each program until another one had begun again what it had: of graders, and of servers, whose
/// claims hold longer. Of several submissions that one had, the first counts.
fn times_to_take_over(url: &str, killed: &[Killed]) -> [Vec<f64>; 2] {
    let rows = psql(url, "SELECT split_part(worker, ' ', 1), MIN(at) FROM taken_over GROUP BY worker");
    let mut times = [Vec::new(), Vec::new()];
    for row in rows.lines() {
        let (id, at) = row.split_once('|').unwrap();
        let (id, at): (u32, i64) = (id.parse().unwrap(), at.parse().unwrap());
        // Numbers of processes come again.
        let end = killed.iter().rev().find(|(of, when, _)| *of == id && *when <= at);
        if let Some((_, when, is_grader)) = end {
            times[usize::from(!is_grader)].push((at - when) as f64 / 1000.0);
        }
    }
    for times in &mut times {
        times.sort_by(f64::total_cmp);
    }
    times
}

fn psql(url: &str, statement: &str) -> String {
    let told =
        Command::new("psql").args(["-qAtX", "-v", "ON_ERROR_STOP=1", "-c", statement, url]).output().unwrap();
    assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
    String::from_utf8_lossy(&told.stdout).trim().to_owned()
}

/// What is killed, and where each was.
#[derive(Clone)]
struct Park {
    servers: Arc<Vec<Mutex<Process>>>,
    graders: Arc<Vec<Mutex<Process>>>,
    machines: Arc<[Vec<Machine>; 2]>,
    folder: Arc<PathBuf>,
    stop: Arc<AtomicBool>,
}

impl Park {
    fn start(machines: [Vec<Machine>; 2], folder: &Path) -> Self {
        let [at, graders_at] = &machines;
        // The first makes the tables.
        let servers = at.iter().map(|machine| Mutex::new(Process::server(machine, folder))).collect();
        let graders = graders_at.iter().map(|machine| Mutex::new(Process::grader(machine, folder))).collect();
        let (folder, stop) = (Arc::new(folder.to_owned()), Arc::default());
        Self {
            servers: Arc::new(servers),
            graders: Arc::new(graders),
            machines: machines.into(),
            folder,
            stop,
        }
    }

    fn is_over(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Kills one after the other, in an order without a rhythm, and starts another in its place.
    fn kill(&self) -> Vec<Killed> {
        let mut killed = Vec::new();
        while !self.is_over() {
            std::thread::sleep(LIFE);
            let which = (killed.len() as f64 * 0.618_034).fract() * (SERVERS + GRADERS) as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below seven
            let which = which as usize;
            let [servers, graders] = &*self.machines;
            let is_grader = which >= SERVERS;
            let place = if is_grader { &self.graders[which - SERVERS] } else { &self.servers[which] };
            let mut place = place.lock().unwrap();
            let id = place.child.id();
            // The next one takes a moment to start: this one ends now.
            let _ = place.child.kill();
            let _ = place.child.wait();
            killed.push((id, now(), is_grader));
            *place = if is_grader {
                Process::grader(&graders[which - SERVERS], &self.folder)
            } else {
                Process::server(&servers[which], &self.folder)
            };
        }
        killed
    }

    /// Holds the cable up for longer than leases last, and cuts it, in turns.
    fn disturb(&self, cable: &Cable) -> u32 {
        let mut cuts = 0;
        while !self.is_over() {
            std::thread::sleep(2 * LIFE);
            cable.hold_up(3 * LIFE);
            cable.cut();
            cuts += 1;
            std::thread::sleep(2 * LIFE);
            cable.hold_up(STALL);
        }
        cuts
    }
}

#[test]
#[allow(clippy::too_many_lines)] // one evening of a class
fn nothing_is_lost_or_graded_twice_whatever_dies() {
    let Some(postgres) = Postgres::start("servers and graders that are killed") else { return };
    let submissions = std::env::var("TRIAD_CHAOS").map_or(SUBMISSIONS, |count| count.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let url = postgres.database();
    let (cable, by_cable) = postgres.by_cable(&url);
    let students = STUDENTS.max(submissions / EACH);
    if !Path::new(FAKETIME).exists() {
        println!(
            "left out: clocks that are off: faketime is not installed (Debian: apt-get install libfaketime)"
        );
    }
    let machines = [SERVERS, GRADERS].map(|count| Machine::park(count, &url, &by_cable));
    let park = Park::start(machines, folder.path());
    let (servers, next) = (Arc::clone(&park.servers), Arc::new(AtomicU32::new(0)));
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
                        hand_in(&servers, number, students)["id"].as_str().unwrap().to_owned(),
                    );
                }
            })
        })
        .collect();
    let killer = std::thread::spawn({
        let park = park.clone();
        move || park.kill()
    });
    let disturber = std::thread::spawn({
        let park = park.clone();
        move || park.disturb(&cable)
    });
    for part in 1..3 {
        while next.load(Ordering::Relaxed) < submissions * part / 3 {
            std::thread::sleep(Duration::from_millis(10));
        }
        postgres.crash();
    }
    let told: BTreeMap<String, String> =
        clients.into_iter().flat_map(|client| client.join().unwrap()).collect();
    let accepted = began.elapsed();
    let last = clock();
    park.stop.store(true, Ordering::Relaxed);
    let (killed, cuts) = (killer.join().unwrap(), disturber.join().unwrap());
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
    let times = rows(&export, "submission").into_iter().map(|row| row["received_at"].as_i64().unwrap());
    assert!(
        times.clone().all(|at| (first..=last).contains(&at)),
        "by the clock of the database: {first} {last}"
    );
    assert_eq!(run_json(&["grades", "--check", "--database", &url]), (0, json!([])), "the log is whole");
    // A single process, on a copy in a file, makes each verdict again, byte for byte.
    let file = folder.path().join("single.db");
    let file = file.to_str().unwrap();
    assert_eq!(run_json(&["class", "import", export.to_str().unwrap(), "--database", file]).0, 0);
    let (code, rebuilt) = run_json(&["regrade", "--check", "--database", file]);
    assert_eq!((code, &rebuilt["same"]), (0, &json!(submissions)), "{rebuilt}");
    let kills = killed.len();
    println!(
        "{submissions} submissions of {students} students, {kills} kills, 2 crashes of PostgreSQL, {cuts} cuts of a cable: 0 lost, \
         0 doubled, {aside} put aside on the way; accepted in {:.0} s, graded in {:.0} s, {:.1} a second",
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
