//! A deployment: programs of two versions work on one PostgreSQL for as long as it takes. Before a release with the program of the
//! one before:
//!
//! ```sh
//! TRIAD_OLD_PROGRAM=/usr/bin/triad cargo test --release --workspace --test upgrade -- --nocapture
//! ```
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::json;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use triad_tests::person::Person;
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, Server, triad};

/// What is handed in to: all of it, and by whoever is there.
const QUESTION: (&str, &str, &str) = ("simple-pendulum", "tension-bottom", "N");
const STUDENTS: usize = 4;
/// Submissions of each student before, and after, whatever changes: twenty at once are the most that one may hand in.
const EACH: usize = 4;

/// What a later version may do to tables on which this one works: each has a column more, there is a table more, and the format is
/// the next one. It holds what every program holds that makes or changes tables, and gives way as they do.
const LATER: &str = "BEGIN; SELECT pg_advisory_xact_lock(128034743084033); SET LOCAL lock_timeout = '200ms'; \
    DO $$ DECLARE one RECORD; BEGIN \
    FOR one IN SELECT table_name FROM information_schema.tables WHERE table_schema = 'public' LOOP \
    EXECUTE format('ALTER TABLE %I ADD COLUMN later TEXT NOT NULL DEFAULT ''later''', one.table_name); END LOOP; END $$; \
    CREATE TABLE later (id BIGINT PRIMARY KEY); UPDATE triad_format SET version = version + 1; COMMIT";

/// A program of some version on the database of the test.
struct Version<'a> {
    program: PathBuf,
    url: &'a str,
    folder: &'a Path,
}

/// A grader that ends with the test.
struct Grading(Child);

impl Drop for Grading {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Version<'_> {
    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(words).args(["--database", self.url]).current_dir(self.folder);
        command
    }

    fn server(&self, more: &[&str]) -> (Server, String) {
        Server::of_class(
            &mut self.command(&[&["serve", "--port", "0", "--class", "--new-owner"], more].concat()),
        )
    }

    fn grader(&self) -> Grading {
        Grading(self.command(&["grader", "--slots", "1"]).stdout(Stdio::null()).spawn().unwrap())
    }
}

/// What a statement tells, or why it failed.
fn told(url: &str, statement: &str) -> Result<String, String> {
    let told =
        Command::new("psql").args(["-qAtX", "-v", "ON_ERROR_STOP=1", "-c", statement, url]).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if told.status.success() { Ok(text(&told.stdout)) } else { Err(text(&told.stderr)) }
}

fn psql(url: &str, statement: &str) -> String {
    told(url, statement).unwrap()
}

/// Changes the tables as a later program does.
fn change(url: &str) {
    let began = Instant::now();
    while let Err(said) = told(url, LATER) {
        assert!(said.contains("lock timeout") && began.elapsed() < HANG, "{said}");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// A teacher and students.
fn class(server: &Server, link: &str) -> (Person, Vec<Person>) {
    let token = link.split_once('#').unwrap().1;
    let teacher = Person::enter(server, "/api/v1/setup", &json!({"token": token, "name": "Prof"}));
    let code = teacher.get(server, "/api/v1/course")["join_code"].clone();
    let join =
        |k| Person::enter(server, "/api/v1/join", &json!({"code": code, "name": format!("Student {k}")}));
    (teacher, (0..STUDENTS).map(join).collect())
}

/// Everybody hands in some more by way of all servers; how many submissions that were.
fn hand_in(servers: &[&Server], students: &[Person], from: usize) -> usize {
    let count = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for (k, student) in students.iter().enumerate() {
            let count = &count;
            scope.spawn(move || {
                for n in 0..EACH {
                    let server = servers[(k + n) % servers.len()];
                    student.hand_in(server, QUESTION, &format!("{}.{k}", from + n));
                    count.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
    });
    count.into_inner()
}

/// Each submission has one verdict, and the log is as it was written.
fn all_is_there(url: &str, expected: usize) {
    let count = |table: &str| psql(url, &format!("SELECT COUNT(*) FROM {table}")).parse::<usize>().unwrap();
    assert_eq!((count("submission"), count("verdict")), (expected, expected));
    assert_eq!((count("grading"), count("judging")), (0, count("judging")), "nothing waits");
}

/// Everything that writes or reads whole rows does so on tables that have more columns than it knows; what starts then is refused.
#[test]
fn programs_go_on_while_a_later_one_adds_to_their_tables() {
    let Some(postgres) = Postgres::start("a later program's tables under this one") else { return };
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let this = Version { program: triad().to_owned(), url: &url, folder: folder.path() };
    let (first, link) = this.server(&[]);
    let (second, _) = this.server(&["--at-once", "0"]);
    let _grader = this.grader();
    let (teacher, students) = class(&first, &link);
    let both = [&first, &second];
    let mut handed = hand_in(&both, &students, 0);

    // In the middle of it.
    let changed = AtomicBool::new(false);
    handed += std::thread::scope(|scope| {
        let changing = scope.spawn(|| {
            change(&url);
            changed.store(true, Ordering::Relaxed);
        });
        let mut count = 0;
        while count == 0 || !changed.load(Ordering::Relaxed) {
            count += hand_in(&both, &students[..1], 10 + count);
        }
        changing.join().unwrap();
        count
    });
    handed += hand_in(&both, &students, 30);
    all_is_there(&url, handed);

    let person = teacher.get(&second, "/api/v1/people")[1]["id"].clone();
    let decision = json!({"lesson": QUESTION.0, "points": 2.5, "reason": "right in another frame"});
    let path = format!("/api/v1/people/{}/decisions", person.as_str().unwrap());
    teacher.post(&first, &path, &decision);
    let regrade =
        teacher.post(&first, &format!("/api/v1/assignments/{}/regrades", QUESTION.0), &json!({})).json();
    assert_eq!(regrade["submissions"], handed, "{regrade}");
    let apply = format!("/api/v1/regrades/{}/apply", regrade["id"].as_str().unwrap());
    teacher.post(&first, &apply, &json!({"choice": "better", "reason": "once more"}));
    let table = teacher.get(&second, "/api/v1/standings");
    assert!(table.to_string().contains("2.5"), "{table}");
    let export = teacher.ask(&first, "GET", "/api/v1/course/export", None).text();
    assert_eq!(export.lines().filter(|line| line.starts_with("[\"submission\"")).count(), handed);
    students[0].get(&second, "/api/v1/me/data");

    let late = this.command(&["serve", "--port", "0", "--class"]).output().unwrap();
    let said = String::from_utf8_lossy(&late.stderr);
    assert!(!late.status.success() && said.contains("newer"), "{said}");
    // Who signs in, plays and goes does so to the last.
    let run = students[1].post(&second, "/api/v1/sessions", &json!({"builtin": "simple-pendulum"})).json();
    students[1].ask(&first, "DELETE", run["links"]["self"].as_str().unwrap(), None);
    first.stop();
    second.stop();
}

/// The programs of the version before make the tables and take what is handed in; those of this one come beside them, and the old
/// ones go.
#[test]
fn old_and_new_programs_share_a_database_for_a_deployment() {
    let Some(postgres) = Postgres::start("a deployment") else { return };
    let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
    let old = std::env::var_os("TRIAD_OLD_PROGRAM").map_or_else(|| triad().to_owned(), PathBuf::from);
    let format = || psql(&url, "SELECT version FROM triad_format");
    let old = Version { program: old, url: &url, folder: folder.path() };
    let new = Version { program: triad().to_owned(), url: &url, folder: folder.path() };
    let (before, link) = old.server(&["--at-once", "0"]);
    let old_grader = old.grader();
    let (teacher, students) = class(&before, &link);
    let mut handed = hand_in(&[&before], &students, 0);
    let was = format();

    let (after, _) = new.server(&["--at-once", "0"]);
    let _new_grader = new.grader();
    println!("format {was} before, {} with the new program", format());
    for from in [10, 20] {
        handed += hand_in(&[&before, &after], &students, from);
    }
    assert_eq!(teacher.get(&before, "/api/v1/people"), teacher.get(&after, "/api/v1/people"));
    // Those of before are told to go in the middle of it, and end what they have.
    before.ask_to_stop();
    drop(old_grader);
    handed += hand_in(&[&after], &students, 30);
    before.stop();
    all_is_there(&url, handed);
    let seen = teacher.get(&after, "/api/v1/standings");
    assert_eq!(seen["students"].as_array().map(Vec::len), Some(STUDENTS), "{seen}");
    let builds = psql(&url, "SELECT build, COUNT(*) FROM verdict GROUP BY build");
    println!("{handed} submissions, one verdict each, by build: {}", builds.replace('\n', ", "));
}
