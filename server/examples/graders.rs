//! Submissions that a server accepts, and that one, two and four graders grade in a second, by kind of question: programs on this
//! machine and its PostgreSQL.
//!
//! ```sh
//! cargo run --release -p triad --example graders
//! ```

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a measurement, not a product
#![allow(clippy::cast_precision_loss)]

mod kinds;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use triad_lessons::{Course, Lesson};
use triad_tests::load::Line;
use triad_tests::postgres::{Postgres, psql};
use triad_tests::program::{Server, triad};

/// Graders side by side, one submission at a time each.
const GRADERS: [usize; 3] = [1, 2, 4];
/// Those who hand in at once.
const CLIENTS: usize = 8;
/// Submissions of the quick kinds, and of those that take a run.
const COUNTS: [usize; 2] = [600, 120];
/// How often it is looked whether all are graded.
const LOOK: Duration = Duration::from_millis(50);

/// A program that ends with this.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn count(url: &str, statement: &str) -> usize {
    psql(url, statement).parse().unwrap_or_default()
}

fn program(words: &[&str], url: &str, folder: &Path) -> Command {
    let mut command = Command::new(triad());
    command.args(words).args(["--database", url]).current_dir(folder).stderr(Stdio::inherit());
    command
}

/// What so many students hand in, each a question of the kind with its answer for the student's own numbers: the lesson, and the body.
fn handed_in(course: &Course, kind: &str, count: usize) -> Vec<(String, Value)> {
    let asks = |lesson: &&Lesson| {
        lesson.exercise.questions.iter().any(|question| kinds::is_of(kind, &question.body))
    };
    let lessons: Vec<&Lesson> = course.lessons().iter().filter(asks).collect();
    let mut all = Vec::with_capacity(count);
    let mut n = 0;
    while all.len() < count {
        let (lesson, student) = (lessons[n % lessons.len()], format!("student {n}"));
        let mut own = lesson.variant(&student).expect("numbers of one's own");
        own.exercise.questions.retain(|question| kinds::is_of(kind, &question.body));
        // What is drawn from a pool is not asked of each student.
        let mut of_kind: Vec<_> = kinds::answered(&own).into_iter().filter(|(one, _)| *one == kind).collect();
        if !of_kind.is_empty() {
            let (_, answers) = of_kind.swap_remove(n / lessons.len() % of_kind.len());
            all.push((lesson.slug.clone(), json!({"student": student, "answers": answers})));
        }
        n += 1;
    }
    all
}

/// Hands in; submissions accepted in a second.
fn accepted(server: &Server, all: &[(String, Value)]) -> f64 {
    let (next, began) = (AtomicUsize::new(0), Instant::now());
    std::thread::scope(|scope| {
        for _ in 0..CLIENTS {
            scope.spawn(|| {
                let mut line = Line::open(&server.address);
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    let Some((slug, body)) = all.get(n) else { return };
                    let path = format!("/api/v1/lessons/{slug}/submissions");
                    let reply = line.ask("POST", &path, Some(body));
                    assert_eq!(reply.status, 202, "{}", reply.text());
                }
            });
        }
    });
    all.len() as f64 / began.elapsed().as_secs_f64()
}

/// Submissions graded in a second by so many graders, once the first is.
fn graded(url: &str, folder: &Path, graders: usize) -> f64 {
    const LEFT: &str = "SELECT COUNT(*) FROM grading WHERE state <> 'dead'";
    // What the server had begun is begun anew: nobody waits for the end of its claims.
    psql(url, "UPDATE grading SET state = 'queued', starts = 0, lease_until = 0");
    let all = count(url, LEFT);
    let start =
        || Ends(program(&["grader", "--slots", "1"], url, folder).stdout(Stdio::null()).spawn().unwrap());
    let _graders: Vec<Ends> = (0..graders).map(|_| start()).collect();
    let mut left = all;
    while left == all {
        std::thread::sleep(LOOK);
        left = count(url, LEFT);
    }
    let (from, began) = (left, Instant::now());
    while left > 0 {
        std::thread::sleep(LOOK);
        left = count(url, LEFT);
    }
    from as f64 / began.elapsed().as_secs_f64()
}

fn main() {
    let Some(postgres) = Postgres::start("graders side by side") else { return };
    let course = Course::embedded().expect("a course");
    println!("| kind | accepted a second | graded a second by 1, 2, 4 graders |\n|---|---|---|");
    for (rank, kind) in kinds::KINDS.into_iter().enumerate() {
        let all = handed_in(&course, kind, COUNTS[usize::from(rank > 3)]);
        let (mut taken, mut rates) = (Vec::new(), Vec::new());
        for graders in GRADERS {
            let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
            let server =
                Server::of(&mut program(&["serve", "--port", "0", "--at-once", "0"], &url, folder.path()));
            taken.push(accepted(&server, &all));
            // It would grade, too.
            drop(server);
            rates.push(format!("{:.0}", graded(&url, folder.path(), graders)));
        }
        taken.sort_by(f64::total_cmp);
        println!("| {kind} | {:.0} | {} |", taken[1], rates.join(", "));
    }
}
