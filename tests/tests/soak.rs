//! The life of a class, again and again, on two servers, a grader and PostgreSQL: students hand in and wait for their verdicts, play
//! and watch mechanisms, follow a lecture and vote; the teacher looks at the table and grades a lesson anew. What the programs
//! hold does not grow with it. In the tests a few rounds; for as many minutes as somebody wants to look:
//!
//! ```sh
//! TRIAD_SOAK=60 cargo test --release --workspace --test soak -- --nocapture
//! ```
//!
//! With `TRIAD_SOAK_KEPT=1` nothing that was handed in is taken away between rounds: the class grows as long as it is looked at.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use triad_tests::lecture::{FollowerPage, LectureRun, Message};
use triad_tests::person::Person;
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, Server, triad};
use triad_tests::vitals::Vitals;

/// Students of the class.
const STUDENTS: usize = 24;
/// Those of them who are at work at a time.
const AT_ONCE: usize = 3;
/// Rounds of the test: the first ones bring what comes with the first of everything.
const ROUNDS: [usize; 2] = [3, 4];
/// Between two rounds where it is looked at for long: nobody may hand in more than twenty times a minute.
const PAUSE: Duration = Duration::from_secs(3);
/// Handed in by all in the first rounds alone, and graded anew ever after: a regrade has as many submissions at the end as at first.
const REGRADED: (&str, &str, &str) = ("springs", "stretch", "m");
/// Handed in all the time: numbers of different lessons.
const LESSONS: [(&str, &str, &str); 3] = [
    ("simple-pendulum", "tension-bottom", "N"),
    ("slider-crank", "start-position", "m"),
    ("tops", "growth", "1/s"),
];
/// What threads and files may differ by between two moments at rest: those of the runtime for what blocks, and connections to the
/// database, come and go.
const COME_AND_GO: usize = 24;
/// What memory may differ by after a few rounds, MB: more than caches and the allocator's reserves took in any run, less than one
/// recording a round would.
const RESERVE: f64 = 60.0;
/// The same for each hour that it is looked at.
const EACH_HOUR: f64 = 24.0;

/// Opens a mechanism, watches it play, looks at its matrices, and leaves.
fn play(student: &Person, server: &Server) {
    let wanted = json!({"builtin": "spatial-slider-crank", "overrides": {"duration": 1e5}});
    let path = student.post(server, "/api/v1/sessions", &wanted).json()["links"]["self"].clone();
    let path = path.as_str().unwrap();
    let mut page = FollowerPage::open(&server.address, &format!("{path}/stream?recording=true"));
    student.post(server, &format!("{path}/play"), &json!({"speed": 4}));
    let mut blocks = 0;
    while blocks < 5 {
        blocks += usize::from(matches!(page.read(), Message::Block(_)));
    }
    student.get(server, &format!("{path}/jacobian"));
    student.post(server, &format!("{path}/pause"), &json!({}));
    student.ask(server, "DELETE", path, None);
}

/// The class and its programs.
struct Fleet {
    url: String,
    /// One answers at once what it can, the other leaves everything to graders.
    servers: [Server; 2],
    grader: Child,
    teacher: Person,
    students: Vec<Person>,
}

impl Drop for Fleet {
    fn drop(&mut self) {
        let _ = self.grader.kill();
        let _ = self.grader.wait();
    }
}

impl Fleet {
    fn start(url: &str, folder: &Path) -> Self {
        let program = |words: &[&str]| {
            let mut command = Command::new(triad());
            command.args(words).args(["--database", url]).current_dir(folder).stderr(Stdio::inherit());
            command
        };
        let serve = ["serve", "--port", "0", "--class", "--max-sessions", "30"];
        let (first, link) = Server::of_class(&mut program(&serve));
        let token = link.split_once('#').unwrap().1;
        let teacher = Person::enter(&first, "/api/v1/setup", &json!({"token": token, "name": "Prof"}));
        let second = Server::of(&mut program(&[&serve[..], &["--at-once", "0"]].concat()));
        let grader = program(&["grader", "--slots", "1"]).stdout(Stdio::null()).spawn().unwrap();
        let code = teacher.get(&first, "/api/v1/course")["join_code"].clone();
        let join = |k| {
            let name = format!("Student {k}");
            Person::enter(&first, "/api/v1/join", &json!({"code": code, "name": name}))
        };
        let students = (0..STUDENTS).map(join).collect();
        Self { url: url.to_owned(), servers: [first, second], grader, teacher, students }
    }

    /// A lecture: it is followed by way of both servers, a question is asked, answered and shown.
    fn lecture(&self, round: usize) {
        let server = &self.servers[round % 2];
        let run = json!({"builtin": "spatial-double-pendulum", "overrides": {"duration": 1e5}});
        let run = self.teacher.post(server, "/api/v1/sessions", &run).json();
        let room = self.teacher.post(server, "/api/v1/rooms", &json!({ "session": run["id"] })).json();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let lecture =
            LectureRun { session: text(&run["id"]), code: text(&room["code"]), key: text(&room["key"]) };
        let session = format!("/api/v1/sessions/{}", lecture.session);
        let mut hall: Vec<FollowerPage> =
            (0..6).map(|k| FollowerPage::join(&self.servers[k % 2].address, &lecture.code, k < 2)).collect();
        self.teacher.post(server, &format!("{session}/play"), &json!({}));
        let question = json!({"text": "Which way?", "choices": ["up", "down"], "right": 0});
        assert!(lecture.lead(server, "PUT", "question", &question).status < 300);
        let path = format!("/api/v1/rooms/{}", lecture.code);
        let number = server.get(&path).json()["question"]["number"].clone();
        for (k, follower) in hall.iter_mut().enumerate() {
            let vote = json!({"question": number, "voter": format!("voter-{k}"), "choice": k % 2});
            assert_eq!(self.servers[k % 2].post(&format!("{path}/answers"), &vote).status, 204);
            follower.until("state", |state| state["time"].as_f64().unwrap() > 0.2);
        }
        assert!(lecture.lead(server, "POST", "reveal", &json!({})).status < 300);
        hall[0].until("room", |room| room["question"]["result"]["counts"] == json!([3, 3]));
        assert!(lecture.lead(server, "DELETE", "", &json!({})).status < 300);
        self.teacher.ask(server, "DELETE", &session, None);
    }

    /// Takes away what was handed in but for what is graded anew, as if a term had ended: requests that look at all that a class has
    /// handed in take memory for as much, and a class of one hour is not to have a year's. The records are immutable to programs.
    fn end_term(&self) {
        let kept = format!("(SELECT id FROM assignment WHERE slug = '{}')", REGRADED.0);
        let gone = format!("(SELECT id FROM submission WHERE assignment NOT IN {kept})");
        let statement = format!(
            "BEGIN; SET LOCAL session_replication_role = replica; DELETE FROM verdict WHERE submission IN {gone}; \
             DELETE FROM submission WHERE assignment NOT IN {kept}; DELETE FROM judging; COMMIT"
        );
        let done =
            Command::new("psql").args(["-q", "-v", "ON_ERROR_STOP=1", "-c", &statement, &self.url]).status();
        assert!(done.unwrap().success());
    }

    /// What a class does in a minute or so; how many submissions that were.
    fn round(&self, round: usize, is_first: bool) -> usize {
        std::thread::scope(|scope| {
            let at_work = (0..AT_ONCE).map(|place| {
                scope.spawn(move || {
                    let mine = self.students.iter().enumerate().skip(place).step_by(AT_ONCE);
                    for (k, student) in mine {
                        let server = &self.servers[(k + round) % 2];
                        let what = LESSONS[(k / AT_ONCE + round) % LESSONS.len()];
                        student.hand_in(server, what, &format!("{round}.25"));
                        if is_first {
                            student.hand_in(server, REGRADED, &format!("{k}.25"));
                        }
                        student.get(server, &format!("/api/v1/lessons/{}", what.0));
                        student.get(server, "/api/v1/record");
                        if k % 4 == round % 4 {
                            play(student, server);
                        }
                    }
                })
            });
            at_work.collect::<Vec<_>>().into_iter().for_each(|one| one.join().unwrap());
        });
        self.lecture(round);
        let server = &self.servers[round % 2];
        let regrade = format!("/api/v1/assignments/{}/regrades", REGRADED.0);
        let seen = self.teacher.post(server, &regrade, &json!({})).json();
        assert_eq!(seen["counts"]["up"], 0, "{seen}");
        self.teacher.get(server, "/api/v1/standings");
        self.teacher.get(server, "/api/v1/glance");
        // What was judged is judged again in the next round, too.
        if std::env::var_os("TRIAD_SOAK_KEPT").is_none() {
            self.end_term();
        }
        STUDENTS * (1 + usize::from(is_first))
    }

    /// Waits until no run is left, and looks at the programs.
    fn at_rest(&self) -> [Vitals; 3] {
        let began = Instant::now();
        while self.servers.iter().any(|server| server.get("/api/v1/health").json()["sessions"] != 0) {
            assert!(began.elapsed() < HANG, "runs are left over");
            std::thread::sleep(Duration::from_millis(50));
        }
        let [first, second] = &self.servers;
        [first.vitals(), second.vitals(), Vitals::of(self.grader.id())]
    }
}

/// How much a quantity grows in a unit of time, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (time, value) = (mean(|point| point.0), mean(|point| point.1));
    let [mut over, mut under] = [0.0; 2];
    for point in points {
        over += (point.0 - time) * (point.1 - value);
        under += (point.0 - time) * (point.0 - time);
    }
    over / under
}

const NAMES: [&str; 3] = ["server that answers at once", "server that leaves all to graders", "grader"];

/// Looks on for some minutes, printing what is held once a minute.
fn look_on(fleet: &Fleet, minutes: f64, postgres: &Postgres) {
    let (began, mut submissions) = (Instant::now(), 0);
    let passed = || began.elapsed().as_secs_f64() / 60.0;
    println!(
        "| minute | submissions | server 1: MB, threads, files | server 2 | grader | connections of PostgreSQL |"
    );
    println!("|---|---|---|---|---|---|");
    let (mut seen, mut next, mut round) = (Vec::new(), 1.0, ROUNDS[0]);
    while passed() < minutes {
        submissions += fleet.round(round, false);
        round += 1;
        std::thread::sleep(PAUSE);
        if passed() < next {
            continue;
        }
        next = passed().floor() + 1.0;
        let (at, vitals) = (passed(), fleet.at_rest());
        let cells = vitals.map(|one| format!("{:.1}, {:.0}, {}", one.memory, one.threads, one.files));
        let backends =
            postgres.ask("SELECT COUNT(*) FROM pg_stat_activity WHERE backend_type = 'client backend'");
        println!("| {at:.1} | {submissions} | {} | {backends} |", cells.join(" | "));
        seen.push((at / 60.0, vitals));
    }
    // What comes with the first of everything, and the allocator's reserves, are there after a third of the time.
    let later = &seen[seen.len() / 3..];
    for (k, name) in NAMES.iter().enumerate() {
        let each_hour = |of: fn(&Vitals) -> f64| {
            slope(&later.iter().map(|(hour, vitals)| (*hour, of(&vitals[k]))).collect::<Vec<_>>())
        };
        let [memory, threads, files] =
            [each_hour(|one| one.memory), each_hour(|one| one.threads), each_hour(|one| one.files as f64)];
        println!("{name}: {memory:+.1} MB, {threads:+.1} threads, {files:+.1} files an hour");
        if minutes >= 30.0 {
            assert!(memory < EACH_HOUR, "the {name} grows");
        }
    }
}

#[test]
fn what_programs_hold_does_not_grow_with_the_life_of_a_class() {
    let Some(postgres) = Postgres::start("the life of a class for long") else { return };
    let minutes: Option<f64> = std::env::var("TRIAD_SOAK").ok().map(|minutes| minutes.parse().unwrap());
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let fleet = Fleet::start(&url, folder.path());
    let [first, more] = ROUNDS;
    for round in 0..first {
        fleet.round(round, round == 0);
    }
    let before = fleet.at_rest();
    match minutes {
        Some(minutes) => look_on(&fleet, minutes, &postgres),
        None => (first..first + more).for_each(|round| _ = fleet.round(round, false)),
    }
    let after = fleet.at_rest();
    for ((name, before), after) in NAMES.iter().zip(before).zip(after) {
        println!("{name}: {before:?}, then {after:?}");
        let hours = minutes.unwrap_or(0.0) / 60.0;
        assert!(after.threads <= before.threads + COME_AND_GO as f64, "{name}: {before:?}, then {after:?}");
        assert!(after.files <= before.files + COME_AND_GO, "{name}: {before:?}, then {after:?}");
        let most = before.memory + RESERVE + EACH_HOUR * hours;
        assert!(after.memory <= most, "{name}: {before:?}, then {after:?}");
    }
    assert_eq!(postgres.ask("SELECT 1"), "1");
}
