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
use triad_lessons::Course;
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

/// Hands in so many, each of a student of its own; submissions accepted in a second.
fn accepted(server: &Server, of_kind: &[(String, Value)], count: usize) -> f64 {
    let (next, began) = (AtomicUsize::new(0), Instant::now());
    std::thread::scope(|scope| {
        for _ in 0..CLIENTS {
            scope.spawn(|| {
                let mut line = Line::open(&server.address);
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    if n >= count {
                        return;
                    }
                    let (slug, answers) = &of_kind[n % of_kind.len()];
                    let body = json!({"student": format!("student {n}"), "answers": answers});
                    let path = format!("/api/v1/lessons/{slug}/submissions");
                    let reply = line.ask("POST", &path, Some(&body));
                    assert_eq!(reply.status, 202, "{}", reply.text());
                }
            });
        }
    });
    count as f64 / began.elapsed().as_secs_f64()
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
        let mut of_kind = Vec::new();
        for lesson in course.lessons() {
            // What is drawn from a pool is not asked of each of these students.
            let of_all = |answers: &kinds::Answers| {
                let mut asked = lesson.exercise.questions.iter().filter(|one| answers.contains_key(&one.id));
                asked.all(|question| question.pool.is_none())
            };
            let wanted = |(one, answers): &(&str, kinds::Answers)| *one == kind && of_all(answers);
            for (_, answers) in kinds::answered(lesson).into_iter().filter(wanted) {
                of_kind.push((lesson.slug.clone(), serde_json::to_value(answers).expect("JSON")));
            }
        }
        let count = COUNTS[usize::from(rank > 3)];
        let (mut taken, mut rates) = (Vec::new(), Vec::new());
        for graders in GRADERS {
            let (url, folder) = (postgres.database(), tempfile::tempdir().unwrap());
            let server =
                Server::of(&mut program(&["serve", "--port", "0", "--at-once", "0"], &url, folder.path()));
            taken.push(accepted(&server, &of_kind, count));
            // It would grade, too.
            drop(server);
            rates.push(format!("{:.0}", graded(&url, folder.path(), graders)));
        }
        taken.sort_by(f64::total_cmp);
        println!("| {kind} | {:.0} | {} |", taken[1], rates.join(", "));
    }
}
