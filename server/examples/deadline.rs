//! A deadline of many thousands, on paper: service times are measured on this machine first, then arrivals, servers, graders and the
//! database are simulated. The same words give the same arrivals.
//!
//! ```sh
//! cargo run --release -p triad --example deadline -- --students 100000
//! ```
//!
//! What is assumed, and not measured, is printed with the result.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a measurement, not a product
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]

mod kinds;

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
use std::time::Instant;

use triad::grading;
use triad::store::{HandIn, Store, Whose, identifier};
use triad::variants::Variants;
use triad_engine::analysis::Wanted;
use triad_lessons::{Course, Lesson, Submission};
use triad_tests::postgres::Postgres;

/// Students of one course: their submissions are entries of one log, one after the other.
const CLASS: usize = 300;
/// Submissions of each student on the last day.
const EACH: f64 = 5.0;
/// A day, s.
const DAY: f64 = 86_400.0;
/// What a server grades in the request, if it is begun and done within this, s.
const AT_ONCE: f64 = 0.3;
/// Processor time of a server for a request beside the verdict, s: `docs/OPERATING.md`.
const REQUEST: f64 = 0.002;
/// A commit that is written through to a disk of a data centre, s.
const COMMIT: f64 = 0.002;
/// Processors of the database.
const DATABASE: usize = 8;
/// A live session of a small mechanism on the server: processors and memory, MB (`docs/OPERATING.md`); the page's engine takes it.
const SESSION: (f64, f64) = (0.004, 5.0);

/// How many of a hundred submissions are of each kind; those with tables are wrong in three of five.
const SHARES: [f64; 7] = [62.0, 3.0, 12.0, 5.0, 5.0, 5.0, 8.0];

/// The kinds with their shares.
fn mix() -> impl Iterator<Item = (&'static str, f64)> {
    kinds::KINDS.into_iter().zip(SHARES)
}

/// Numbers that look random (SplitMix64), the same each time.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Times before the deadline: half of them over the day, most others within its last hour, some within its last minutes.
    fn before(&mut self) -> f64 {
        let mean = match self.unit() {
            u if u < 0.5 => return self.unit() * DAY,
            u if u < 0.9 => 3600.0,
            _ => 120.0,
        };
        (-mean * libm::log(1.0 - self.unit())).min(DAY)
    }
}

/// Processor time of this thread, s.
fn processor() -> f64 {
    // Giving way once makes the system bring its count up to date, which otherwise goes by ticks of 4 ms.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux tells it");
    text.split_whitespace().next().unwrap().parse::<f64>().unwrap() / 1e9
}

/// Processor times of verdicts by kind of question, s: each question of the course, answered rightly, and tables wrongly besides.
fn measure() -> BTreeMap<&'static str, Vec<f64>> {
    let course = Course::embedded().expect("a course");
    let variants = Variants::default();
    let mut times: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
    for lesson in course.lessons() {
        let own = variants.of(lesson, "somebody").expect("numbers");
        for (kind, answers) in kinds::answered(&own) {
            times.entry(kind).or_default().push(verdict(lesson, answers));
        }
    }
    times
}

/// One verdict, s, with making the student's own numbers, as a grader does who meets each student once: of as many as the system's
/// measure, some milliseconds, asks for.
fn verdict(lesson: &Lesson, answers: kinds::Answers) -> f64 {
    let submission = Submission { answers, ..Submission::default() };
    let mut body = serde_json::to_value(&submission).expect("JSON");
    body["student"] = "somebody".into();
    let body = body.to_string();
    let judge = || {
        let nobodys = Variants::default();
        grading::grade(lesson, &nobodys, &body, Some("somebody"), &Wanted::default()).expect("a verdict")
    };
    drop(judge());
    let (began, mut count) = (processor(), 0);
    while processor() - began < 0.05 {
        drop(judge());
        count += 1;
    }
    (processor() - began) / f64::from(count)
}

/// Submissions that one course of this PostgreSQL keeps a second, and eight courses: `None` where it is not installed.
fn database() -> Option<(f64, f64)> {
    let server = Postgres::start("what PostgreSQL bears: half a millisecond is assumed")?;
    let runtime = tokio::runtime::Runtime::new().unwrap();
    Some(runtime.block_on(async {
        let url = server.database().parse().expect("an address");
        let store = std::sync::Arc::new(Store::at(&url).await.expect("opens"));
        for k in 0..8 {
            store.ensure_course(&format!("course {k}"), "Mechanics").await.expect("a course");
        }
        (rate(&store, 1).await, rate(&store, 8).await)
    }))
}

async fn rate(store: &std::sync::Arc<Store>, courses: usize) -> f64 {
    const EACH: usize = 50;
    let began = Instant::now();
    let handing: Vec<_> = (0..8)
        .map(|k| {
            let store = std::sync::Arc::clone(store);
            tokio::spawn(async move {
                for n in 0..EACH {
                    let new = submission(&format!("course {}", k % courses), &format!("{courses} {k} {n}"));
                    store.hand_in(&new).await.expect("keeps");
                }
            })
        })
        .collect();
    for one in handing {
        one.await.expect("ends");
    }
    (8 * EACH) as f64 / began.elapsed().as_secs_f64()
}

fn submission(course: &str, student: &str) -> HandIn {
    let id = identifier();
    HandIn {
        course: course.to_owned(),
        lesson: "simple-pendulum".to_owned(),
        whose: Whose::Named,
        student: student.to_owned(),
        seed: String::new(),
        received_at: jiff::Timestamp::now().as_millisecond(),
        answers: "{}".to_owned(),
        verdict: serde_json::json!({"id": id, "earned": 1.0, "possible": 1.0, "passed": true, "gradable": true, "questions": [],
            "provenance": {"seed": "", "parameters": {}}}),
        counted: true,
        after: 0,
        key: None,
        bundle: "{}".to_owned(),
        id,
    }
}

/// Things that do one job at a time each: when each is free.
struct Hands(BinaryHeap<Reverse<u64>>);

impl Hands {
    fn new(count: usize) -> Self {
        Self((0..count).map(|_| Reverse(0)).collect())
    }

    /// When something that comes at `at` is begun.
    fn free(&self, at: f64) -> f64 {
        self.0.peek().map_or(f64::INFINITY, |Reverse(free)| *free as f64 / 1e6).max(at)
    }

    /// Does something from `at` on as soon as one is free; when it is done.
    fn work(&mut self, at: f64, time: f64) -> f64 {
        let done = self.free(at) + time;
        self.0.pop();
        self.0.push(Reverse((done * 1e6) as u64));
        done
    }
}

/// A submission: when it comes, of which course, and what its verdict takes.
type Arrival = (f64, usize, f64);

fn arrivals(students: usize, times: &BTreeMap<&str, Vec<f64>>) -> Vec<Arrival> {
    let mut random = Random(2026);
    let mut all = Vec::new();
    for student in 0..students {
        // As many as before a coin falls on its other side.
        while random.unit() < EACH / (EACH + 1.0) {
            let (mut u, mut takes) = (random.unit() * 100.0, 0.001);
            for (kind, share) in mix() {
                if u < share {
                    let known = times.get(kind).filter(|known| !known.is_empty());
                    takes = known.map_or(0.001, |known| known[(random.unit() * known.len() as f64) as usize]);
                    break;
                }
                u -= share;
            }
            all.push((DAY - random.before(), student / CLASS, takes));
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// What came of one evening.
struct Evening {
    /// Times to the verdict, s, in order.
    waits: Vec<f64>,
    /// Those that were answered in their requests.
    at_once: usize,
    /// When the last verdict was there, s after the deadline.
    last: f64,
}

fn evening(arrivals: &[Arrival], servers: usize, graders: usize, keeps: f64) -> Evening {
    let (mut web, mut grading, mut disk) = (Hands::new(servers), Hands::new(graders), Hands::new(DATABASE));
    let mut logs: BTreeMap<usize, f64> = BTreeMap::new();
    let mut waits = Vec::with_capacity(arrivals.len());
    let (mut at_once, mut last) = (0, 0.0_f64);
    for &(at, course, takes) in arrivals {
        // A course's log is one chain: who adds to it holds it until that is written through.
        let mut keep = |ready: f64| {
            let log = logs.entry(course).or_default();
            let begun = log.max(ready);
            *log = disk.work(begun, keeps) + COMMIT;
            *log
        };
        let done = if graders == 0 || web.free(at) + REQUEST + takes <= at + AT_ONCE {
            at_once += 1;
            keep(web.work(at, REQUEST + takes))
        } else {
            let accepted = keep(web.work(at, REQUEST));
            keep(grading.work(accepted, takes))
        };
        last = last.max(done - DAY);
        waits.push(done - at);
    }
    waits.sort_by(f64::total_cmp);
    Evening { waits, at_once, last }
}

fn report_times(times: &BTreeMap<&str, Vec<f64>>) -> f64 {
    println!(
        "| a verdict on | processor time, middle (longest) | a core judges in a second |\n|---|---|---|"
    );
    let mut mean = 0.0;
    for (kind, share) in mix() {
        let Some(known) = times.get(kind) else { continue };
        let mut known = known.clone();
        known.sort_by(f64::total_cmp);
        let (middle, longest) = (known[known.len() / 2], known[known.len() - 1]);
        let average = known.iter().sum::<f64>() / known.len() as f64;
        mean += share / 100.0 * average;
        println!("| {kind} | {:.2} ({:.1}) ms | {:.0} |", middle * 1e3, longest * 1e3, 1.0 / average);
    }
    mean
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let told = words.iter().position(|word| word == "--students").and_then(|at| words.get(at + 1));
    let students: usize = told.map_or(100_000, |text| text.parse().expect("a number of students"));
    let times = measure();
    let mean = report_times(&times);
    let rates = database();
    // What a submission costs the database beside the commit, of all its connections together.
    let keeps = rates.map_or(0.0005, |(_, eight)| (1.0 / eight).min(0.01));
    let all = arrivals(students, &times);
    let peak = (0..60 * 24)
        .map(|m| DAY - 60.0 * f64::from(m))
        .map(|end| all.partition_point(|one| one.0 < end) - all.partition_point(|one| one.0 < end - 60.0));
    let peak = peak.max().unwrap_or_default() as f64 / 60.0;
    println!(
        "\n{students} students in courses of {CLASS}, {} submissions in a day, {peak:.0} a second in the fullest minute; a verdict \
         takes {:.1} ms on average, a request {:.0} ms more",
        all.len(),
        mean * 1e3,
        REQUEST * 1e3
    );
    if let Some((one, eight)) = rates {
        println!(
            "this machine's PostgreSQL keeps {one:.0} submissions a second of one course, {eight:.0} of eight, without writing through; \
             assumed: {DATABASE} processors, {:.0} ms to write through, so that one course takes {:.0} a second",
            COMMIT * 1e3,
            1.0 / (COMMIT + keeps)
        );
    }
    println!(
        "\n| cores of servers | cores of graders | answered in the request | middle | 99 of 100 | longest | last verdict after the deadline |"
    );
    println!("|---|---|---|---|---|---|---|");
    let needed = (peak * (mean + REQUEST)).ceil().max(1.0) as usize;
    for (servers, graders) in [
        (needed.div_ceil(4), 0),
        (needed.div_ceil(4), needed.div_ceil(4)),
        (needed.div_ceil(2), needed.div_ceil(2)),
        (needed, 0),
        (needed, needed),
        (2 * needed, 0),
    ] {
        let seen = evening(&all, servers, graders, keeps);
        let at = |part: f64| seen.waits[((seen.waits.len() - 1) as f64 * part) as usize];
        println!(
            "| {servers} | {graders} | {:.1} % | {:.3} s | {:.2} s | {:.1} s | {:.1} s |",
            100.0 * seen.at_once as f64 / all.len() as f64,
            at(0.5),
            at(0.99),
            at(1.0),
            seen.last
        );
    }
    // Whoever hands in within ten minutes has a mechanism open.
    let open = all.partition_point(|one| one.0 < DAY) - all.partition_point(|one| one.0 < DAY - 600.0);
    println!(
        "\nlive sessions of those who hand in within the last ten minutes, all playing: {open}, {:.0} cores and {:.0} GB on servers; none \
         where the page's own engine computes",
        open as f64 * SESSION.0,
        open as f64 * SESSION.1 / 1e3
    );
}
