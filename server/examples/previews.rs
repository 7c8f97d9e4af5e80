//! How long the preview of a regrade takes: so many submissions by as many students, each question of the course by itself, its text
//! edited, so that no verdict of before is the new one.
//!
//! ```sh
//! cargo run --release -p triad --example previews -- [LESSON]…
//! ```
//!
//! `TRIAD_SUBMISSIONS` submissions, 1,000. The digest is that of all new verdicts: it is the same for every program that gives the same.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a measurement, not a product
#![allow(clippy::cast_precision_loss)]

mod kinds;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::{Value, json};
use triad::handing::{Judged, Who, settled};
use triad::regrade::{Progress, preview};
use triad::store::hash::sha256;
use triad::store::{HOME, Store, Whose, identifier};
use triad::variants::Variants;
use triad_engine::analysis::Wanted;
use triad_lessons::{Course, Lesson};

/// Submissions to a lesson.
const SUBMISSIONS: usize = 1000;

/// Processor time of all threads, s.
fn processor() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").expect("Linux tells it");
    // Behind the program's name, which may have blanks: the 12th and 13th are the ticks of the program and of the system.
    let words: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    (words[11].parse::<f64>().unwrap() + words[12].parse::<f64>().unwrap()) / 100.0
}

/// What student `n` hands in of a kind: none where the kind is not asked of them.
fn answers(lesson: &Lesson, kind: &str, n: usize) -> Option<kinds::Answers> {
    let mut own = lesson.variant(&format!("student {n}")).expect("numbers of one's own");
    own.exercise.questions.retain(|question| kinds::is_of(kind, &question.body));
    let mut of_kind: Vec<_> = kinds::answered(&own).into_iter().filter(|(one, _)| *one == kind).collect();
    (!of_kind.is_empty()).then(|| of_kind.swap_remove(n % of_kind.len()).1)
}

/// Keeps so many submissions of a kind, each of another student.
async fn handed_in(store: &Arc<Store>, lesson: &Lesson, kind: &'static str, count: usize) {
    let next = Arc::new(AtomicUsize::new(0));
    let (variants, left) = (Arc::new(Variants::default()), Arc::new(AtomicUsize::new(count)));
    let hand_in = || {
        let (store, lesson, variants) = (Arc::clone(store), lesson.clone(), Arc::clone(&variants));
        let (next, left) = (Arc::clone(&next), Arc::clone(&left));
        tokio::task::spawn_blocking(move || {
            while left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_ok()
            {
                let (n, answers) = loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    if let Some(answers) = answers(&lesson, kind, n) {
                        break (n, answers);
                    }
                };
                let student = format!("student {n}");
                let body = json!({"student": student, "answers": answers}).to_string();
                let who = Who { course: HOME.to_owned(), whose: Whose::Named, student, seed: None };
                let wanted = Wanted::default();
                let judged = Judged::new(&variants, lesson.clone(), &body, who, None, &wanted).unwrap();
                tokio::runtime::Handle::current().block_on(async {
                    let now = jiff::Timestamp::now();
                    let new = settled(&store, &Arc::new(judged), identifier(), now).await.unwrap();
                    store.hand_in(&new).await.unwrap();
                });
            }
        })
    };
    for one in (0..2).map(|_| hand_in()).collect::<Vec<_>>() {
        one.await.expect("ends");
    }
}

/// The lesson with other words for who is right.
fn edited(lesson: &Lesson) -> Lesson {
    let mut bundle: Value = serde_json::from_str(&lesson.bundle()).unwrap();
    let text = bundle["files"]["exercise.toml"].as_str().unwrap().to_owned();
    let line = |line: &str| match line.strip_prefix("right = ") {
        // One quote, or three of those that reach over lines.
        Some(rest) => {
            let (quotes, words) = rest.split_at(if rest.starts_with("\"\"\"") { 3 } else { 1 });
            format!("right = {quotes}Edited. {words}\n")
        }
        None => format!("{line}\n"),
    };
    bundle["files"]["exercise.toml"] = text.lines().map(line).collect::<String>().into();
    bundle["hash"] = "edited".into();
    Lesson::from_bundle(&bundle.to_string()).unwrap()
}

/// Seconds, processor time, and the digest of the new verdicts.
async fn measured(lesson: &Lesson, kind: &'static str, count: usize) -> (f64, f64, String) {
    let store = Arc::new(Store::in_memory());
    handed_in(&store, lesson, kind, count).await;
    let before = processor();
    let progress = Arc::new(Progress::default());
    let seen = preview(&store, identifier(), HOME, &edited(lesson), progress).await.unwrap();
    let took = processor() - before;
    assert_eq!((seen.shown.submissions, seen.shown.counts.program), (count, 0), "{:?}", seen.shown.counts);
    let told = |record: &triad::store::Recorded| {
        let after = seen.verdicts(&record.id).unwrap().1.unwrap();
        (record.answers.clone(), after["questions"].to_string())
    };
    // Students come in any order: their answers do not.
    let all: BTreeSet<_> = store.recorded(HOME, None).await.unwrap().iter().map(told).collect();
    (seen.shown.seconds, took, sha256(&format!("{all:?}"))[..12].to_owned())
}

#[tokio::main(worker_threads = 2)]
async fn main() {
    let course = Course::embedded().expect("a course");
    let only: Vec<String> = std::env::args().skip(1).collect();
    let count = std::env::var("TRIAD_SUBMISSIONS").ok().map_or(SUBMISSIONS, |count| count.parse().unwrap());
    let mut all: BTreeMap<&str, Vec<(f64, &str)>> = BTreeMap::new();
    println!("| lesson | kind | preview of {count}, s | processor, s | digest |\n|---|---|---|---|---|");
    for lesson in course.lessons().iter().filter(|one| only.is_empty() || only.contains(&one.slug)) {
        for kind in kinds::KINDS {
            if lesson.exercise.questions.iter().any(|question| kinds::is_of(kind, &question.body)) {
                let (seconds, took, digest) = measured(lesson, kind, count).await;
                println!("| {} | {kind} | {seconds:.1} | {took:.1} | {digest} |", lesson.slug);
                all.entry(kind).or_default().push((seconds, &lesson.slug));
            }
        }
    }
    println!("\n| kind of question | middle, s | longest, s |\n|---|---|---|");
    for kind in kinds::KINDS {
        let Some(mut times) = all.remove(kind) else { continue };
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (middle, longest) = (times[times.len() / 2], times[times.len() - 1]);
        println!("| {kind} | {:.1} | {:.1} ({}) |", middle.0, longest.0, longest.1);
    }
}
