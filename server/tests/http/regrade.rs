//! A faulty reference is mended: what would change is looked at, applied, seen by students, and taken back.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};
use triad::grader::{Grader, LEASE};
use triad::policy::Moment;
use triad::regrade::preview;
use triad::store::{CLASS, HOME, Store, identifier};
use triad_lessons::{Computed as Made, Course};

use crate::class::{Class, class};
use crate::leaving::table_of;

/// The files of a folder by their paths.
fn read(folder: &Path, at: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = format!("{at}{}", entry.file_name().and_then(|name| name.to_str()).expect("a name"));
        if entry.is_dir() {
            read(&entry, &format!("{name}/"), files);
        } else {
            files.insert(name, std::fs::read(&entry).expect("a file"));
        }
    }
}

/// The course with the file whose path ends so as an author edited it.
pub(crate) fn course_with(end: &str, edit: impl FnOnce(String) -> String) -> Course {
    let mut files = BTreeMap::new();
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../lessons/course"), "", &mut files);
    let path = files.keys().find(|path| path.ends_with(end)).expect("the file").clone();
    let edited = edit(String::from_utf8(files[&path].clone()).expect("text"));
    files.insert(path, edited.into_bytes());
    Course::from_files(files).expect("a course")
}

/// The course with one lesson whose tension at the bottom pays twice as much.
fn mended() -> Course {
    worth(6)
}

/// The course with one lesson whose tension at the bottom pays so many points.
fn worth(points: u32) -> Course {
    course_with("simple-pendulum/exercise.toml", |exercise| {
        let (head, tail) = exercise.split_once("id = \"tension-bottom\"").expect("the question");
        let new = format!("points = {points}");
        let changed = format!("{head}id = \"tension-bottom\"{}", tail.replacen("points = 3", &new, 1));
        assert_ne!(changed, exercise);
        changed
    })
}

impl Class {
    async fn submit(&self, who: &str, value: &str) -> Value {
        let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}});
        self.ask("POST", "/api/v1/lessons/simple-pendulum/submissions", who, Some(body)).await.json()
    }

    async fn see(&self, who: &str, path: &str) -> Value {
        self.ask("GET", path, who, None).await.json()
    }

    /// Looks at a regrade, with what grades where a gradebook is shared.
    async fn look(&self, owner: &str) -> Value {
        let grader = Grader::new(Arc::clone(&self.app.store), Arc::default(), Arc::default(), 1, LEASE);
        let grading = tokio::spawn(grader.run());
        let seen = self.ask("POST", "/api/v1/assignments/simple-pendulum/regrades", owner, None).await;
        grading.abort();
        assert_eq!(seen.status, 200, "{}", seen.json());
        seen.json()
    }

    async fn apply(&self, owner: &str, seen: &Value, choice: &str) {
        let path = format!("/api/v1/regrades/{}/apply", seen["id"].as_str().expect("an id"));
        let body = json!({"choice": choice, "reason": "mended"});
        assert_eq!(self.ask("POST", &path, owner, Some(body)).await.status, 204);
    }

    async fn set(&self, owner: &str, policy: Value) {
        let reply = self.ask("PUT", "/api/v1/assignments/simple-pendulum", owner, Some(policy)).await;
        assert_eq!(reply.status, 204);
    }

    /// Points by name.
    async fn points(&self, owner: &str) -> BTreeMap<String, f64> {
        let table = self.see(owner, "/api/v1/standings").await;
        let of = |row: &Value| {
            let points = row["lessons"]["simple-pendulum"]["points"].as_f64().unwrap_or(f64::NAN);
            (row["name"].as_str().expect("a name").to_owned(), points)
        };
        table["students"].as_array().expect("rows").iter().map(of).collect()
    }

    async fn tension(&self, who: &str) -> String {
        let lesson = self.see(who, "/api/v1/lessons/simple-pendulum").await;
        format!("{:.4}", 3.0 * 9.81 * lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass"))
    }
}

/// The old version and the new one ask the same of the same person: what does not depend on what was handed in is computed once, and
/// each judgement once for both.
#[tokio::test]
async fn a_preview_computes_nothing_twice() {
    let store = Store::in_memory();
    let lesson = Course::embedded().expect("a course").lesson("verification").expect("a lesson").clone();
    let table = |swing: f64| {
        let row = |k: u32| {
            let t = f64::from(k) / 40.0;
            format!("{t},{},{}\n", -libm::cos(2.0 * t) - swing * t, -swing * libm::sin(t * t))
        };
        "t,x,y\n".to_owned() + &(0..=400).map(row).collect::<String>()
    };
    for swing in [0.3, 0.4, 0.5] {
        let new = table_of(&store, &lesson, "Ada", &table(swing)).await;
        store.hand_in(&new).await.expect("keeps");
    }
    let edited = course_with("verification/exercise.toml", |exercise| {
        let (head, tail) = exercise.split_once("id = \"your-run\"").expect("the question");
        format!("{head}id = \"your-run\"{}", tail.replacen("points = 4", "points = 5", 1))
    });
    let edited = edited.lesson("verification").expect("a lesson");
    let seen = preview(&store, identifier(), HOME, edited, Arc::default()).await.expect("looks");
    assert_eq!((seen.shown.submissions, seen.shown.counts.program, seen.shown.of_other_versions), (3, 0, 3));
    let made = Made { references: 1, runs: 0, judgements: 3, mistaken: 5, waves: 1 };
    assert_eq!(seen.made, made);
}

#[tokio::test]
#[allow(clippy::too_many_lines)] // one regrade from the first look to its end
async fn a_regrade_is_looked_at_applied_seen_and_taken_back() {
    let class = class().await;
    // Where graders share the gradebook they judge again, too.
    let grader = Grader::new(Arc::clone(&class.app.store), Arc::default(), Arc::default(), 1, LEASE);
    let grading = tokio::spawn(grader.run());
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let ((ada, _), (eve, _)) = (class.join("Ada").await, class.join("Eve").await);
    let first = class.submit(&ada, "1.000").await;
    class.submit(&ada, &class.tension(&ada).await).await;
    class.submit(&eve, "1.000").await;
    let preview = "/api/v1/assignments/simple-pendulum/regrades";
    let same = class.ask("POST", preview, &owner, None).await.json();
    assert_eq!((&same["counts"]["same"], &same["people"]), (&json!(3), &json!([])), "{same}");

    // Late by half: what counts is counted anew.
    let ago = json!(Moment::now().after(-3_600_000));
    let late = json!({"due": ago, "late": [{"until": Moment::now().after(3_600_000), "share": 0.5}]});
    class.ask("PUT", "/api/v1/assignments/simple-pendulum", &owner, Some(late)).await;
    let class = class.again(mended().into()).await;
    let seen = class.ask("POST", preview, &owner, None).await.json();
    assert_eq!(
        (&seen["counts"]["up"], &seen["counts"]["program"], &seen["of_other_versions"]),
        (&json!(1), &json!(0), &json!(3))
    );
    let hers =
        seen["people"].as_array().expect("people").iter().find(|one| one["name"] == "Ada").expect("Ada");
    assert_eq!((&hers["before"], &hers["after"]), (&json!(1.5), &json!(3.0)), "{hers}");
    let id = seen["id"].as_str().expect("an id");
    let changed = hers["submissions"].as_array().expect("a list").iter().find(|one| one["changed"] == "up");
    let submission = changed.expect("the right one")["id"].as_str().expect("an id");
    let both = class.see(&owner, &format!("/api/v1/regrades/{id}/submissions/{submission}")).await;
    assert_eq!((&both["before"]["earned"], &both["after"]["earned"]), (&json!(3.0), &json!(6.0)));

    // Somebody hands in meanwhile: the preview is out of date, and nothing is changed.
    class.submit(&eve, "2.000").await;
    let apply = async |id: &str, reason: &str| {
        let body = json!({"choice": "better", "reason": reason});
        class.ask("POST", &format!("/api/v1/regrades/{id}/apply"), &owner, Some(body)).await
    };
    apply(id, "too few points").await.problem(409, "out-of-date");
    let seen = class.ask("POST", preview, &owner, None).await.json();
    let id = seen["id"].as_str().expect("an id");
    apply(id, " ").await.problem(422, "invalid-decision");
    // Both ask to look again; the regrade answers the one for whom it changes something.
    let words = json!({"lesson": "simple-pendulum", "text": "is this worth so little?"});
    for who in [&ada, &eve] {
        let asked = class.ask("POST", "/api/v1/record/requests", who, Some(words.clone())).await;
        assert_eq!(asked.status, 201, "{}", asked.json());
    }
    let asks = async |who: &str| class.see(who, "/api/v1/record").await["lessons"][0]["asked"] == true;
    assert!(asks(&ada).await && asks(&eve).await);
    assert_eq!(apply(id, "the question was worth too little").await.status, 204);
    assert!(!asks(&ada).await && asks(&eve).await);
    apply(id, "twice").await.problem(409, "out-of-date");
    let points = async || class.see(&ada, "/api/v1/record").await["lessons"][0].clone();
    let record = points().await;
    assert_eq!(record["standing"]["points"]["points"], 3.0);
    assert_eq!(record["regrades"][0]["reason"], "the question was worth too little");
    assert_eq!(record["regrades"][0]["points"], json!([1.5, 3.0]));
    let given = class.see(&ada, &format!("/api/v1/submissions/{submission}/verdicts")).await;
    assert_eq!(given.as_array().map(Vec::len), Some(2), "what was told before stays readable");
    class.submit(&eve, "3.000").await;
    let rebuilt = triad::regrade::check(&class.app.store, CLASS).await.expect("rebuilds");
    assert!(rebuilt.changed.is_empty() && rebuilt.same >= 8, "{rebuilt:?}");

    let applied = class.see(&owner, "/api/v1/regrades").await;
    let undo = format!("/api/v1/regrades/{}/undo", applied[0]["id"].as_str().expect("an id"));
    assert_eq!(class.ask("POST", &undo, &owner, None).await.status, 204);
    class.ask("POST", &undo, &owner, None).await.problem(404, "unknown-entry");
    assert!(asks(&ada).await, "what answered is taken back");
    assert_eq!(points().await["standing"]["points"]["points"], 1.5);
    let listed = class.see(&ada, "/api/v1/submissions").await;
    assert_eq!((&listed[1]["id"], &listed[1]["earned"]), (&first["id"], &json!(0.0)));
    let rebuilt = triad::regrade::check(&class.app.store, CLASS).await.expect("rebuilds");
    assert!(rebuilt.changed.is_empty(), "{rebuilt:?}");
    grading.abort();
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

/// Whether an answer was told is a fact of the moment in which something was handed in, whatever is set since.
#[tokio::test]
async fn a_regrade_goes_by_what_was_told_then() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let ((ada, _), (bob, _)) = (class.join("Ada").await, class.join("Bob").await);
    let never = json!({"reveal": {"reference": "never"}});
    class.set(&owner, never.clone()).await;
    let wrong: Vec<String> = (1..7).map(|k| format!("{k}.000")).collect();
    for value in &wrong {
        class.submit(&ada, value).await;
    }
    assert_eq!(class.submit(&ada, &class.tension(&ada).await).await["earned"], 3.0);
    class.set(&owner, json!({})).await;
    for value in &wrong {
        class.submit(&bob, value).await;
    }
    assert_eq!(class.submit(&bob, &class.tension(&bob).await).await["earned"], 0.0, "he was told it");
    for policy in [json!({}), never.clone()] {
        class.set(&owner, policy).await;
        let same = class.look(&owner).await;
        assert_eq!((&same["counts"]["same"], &same["people"]), (&json!(14), &json!([])), "{same}");
        assert_eq!(same["of_other_versions"], 0, "{same}");
    }
    // It was told to him, so that it earns nothing now either.
    assert_eq!(class.submit(&bob, &format!("{}0", class.tension(&bob).await)).await["earned"], 0.0);

    let class = class.again(mended().into()).await;
    let seen = class.look(&owner).await;
    class.apply(&owner, &seen, "replace").await;
    assert_eq!(class.points(&owner).await, [("Ada".to_owned(), 6.0), ("Bob".to_owned(), 0.0)].into());
    let rebuilt = triad::regrade::check(&class.app.store, CLASS).await.expect("rebuilds");
    assert_eq!((rebuilt.changed.len(), rebuilt.same), (0, 30), "{rebuilt:?}");
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test]
async fn who_is_erased_keeps_the_points_in_a_regrade() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let ((ada, told), (bob, _)) = (class.join("Ada").await, class.join("Bob").await);
    for who in [&ada, &bob] {
        class.submit(who, &class.tension(who).await).await;
    }
    let erase = format!("/api/v1/people/{}/erase", told["person"]["id"].as_str().expect("an id"));
    let reason = json!({"reason": "asked for it"});
    assert_eq!(class.ask("POST", &erase, &owner, Some(reason)).await.status, 204);
    let rebuilt = triad::regrade::check(&class.app.store, CLASS).await.expect("rebuilds");
    assert_eq!((rebuilt.same, rebuilt.changed.len()), (1, 0), "{rebuilt:?}");
    let same = class.look(&owner).await;
    assert_eq!((&same["submissions"], &same["people"]), (&json!(1), &json!([])), "{same}");

    let class = class.again(mended().into()).await;
    let seen = class.look(&owner).await;
    class.apply(&owner, &seen, "replace").await;
    let points: Vec<f64> = class.points(&owner).await.into_values().collect();
    assert_eq!(points, [6.0, 3.0], "Bob, and who was erased");
}

/// What a verdict earns may count later: a decision is taken back, more time is given.
#[tokio::test]
async fn better_lowers_no_verdict_that_does_not_count_now() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let ((ada, told), (bob, _)) = (class.join("Ada").await, class.join("Bob").await);
    let path = format!("/api/v1/people/{}/decisions", told["person"]["id"].as_str().expect("an id"));
    class.submit(&ada, &class.tension(&ada).await).await;
    let decide = async |points: Value| {
        let body = json!({"lesson": "simple-pendulum", "points": points, "reason": "a bonus"});
        assert_eq!(class.ask("POST", &path, &owner, Some(body)).await.status, 201);
    };
    decide(json!(4)).await;
    class.submit(&bob, &class.tension(&bob).await).await;
    class.set(&owner, json!({"due": Moment::now().after(-3_600_000)})).await;
    let again = class.again(worth(1).into()).await;
    let seen = again.look(&owner).await;
    assert!(seen["people"].as_array().expect("people").iter().all(|one| one["before"] == one["after"]));
    again.apply(&owner, &seen, "better").await;
    decide(Value::Null).await;
    again.set(&owner, json!({})).await;
    assert_eq!(again.points(&owner).await, [("Ada".to_owned(), 3.0), ("Bob".to_owned(), 3.0)].into());
}

/// Points before and after, and what is told of a regrade, follow from more than verdicts.
#[tokio::test]
async fn what_is_decided_set_or_allowed_meanwhile_makes_a_preview_stale() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let (ada, told) = class.join("Ada").await;
    class.submit(&ada, &class.tension(&ada).await).await;
    let id = told["person"]["id"].as_str().expect("an id");
    let class = class.again(mended().into()).await;
    let (people, lesson) = (format!("/api/v1/people/{id}"), "/api/v1/assignments/simple-pendulum".to_owned());
    let apply = async |seen: &Value| {
        let path = format!("/api/v1/regrades/{}/apply", seen["id"].as_str().expect("an id"));
        let body = json!({"choice": "replace", "reason": "mended"});
        class.ask("POST", &path, &owner, Some(body)).await
    };
    let decision = json!({"lesson": "simple-pendulum", "points": 2, "reason": "agreed"});
    let more = json!({"attempts": 1, "reason": "was ill"});
    for (method, path, body, said) in [
        ("POST", format!("{people}/decisions"), decision, "points were decided"),
        ("PUT", lesson.clone(), json!({"most_attempts": 5}), "the policy was set anew"),
        ("PUT", format!("{lesson}/extensions/{id}"), more, "an extension was given"),
    ] {
        let seen = class.look(&owner).await;
        let done = class.ask(method, &path, &owner, Some(body)).await;
        assert!(done.status.is_success(), "{path}: {}", done.status);
        let refused = apply(&seen).await.problem(409, "out-of-date");
        assert!(refused["detail"].as_str().is_some_and(|text| text.starts_with(said)), "{refused}");
    }
    assert_eq!(class.see(&owner, "/api/v1/regrades").await, json!([]), "nothing was changed");
    // A remark decides nothing.
    let seen = class.look(&owner).await;
    let words = json!({"lesson": "simple-pendulum", "text": "Well done."});
    let said = class.ask("POST", &format!("{people}/comments"), &owner, Some(words)).await;
    assert_eq!((said.status.as_u16(), apply(&seen).await.status.as_u16()), (201, 204));
}

/// The course on the disk is another after a restart; what was graded is what it was.
#[tokio::test]
async fn an_edited_lesson_takes_no_pass_away_before_a_regrade() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let ((ada, _), (bob, told)) = (class.join("Ada").await, class.join("Bob").await);
    let lenient = course_with("simple-pendulum/exercise.toml", |exercise| {
        let lenient = exercise.replacen("pass_mark = 0.7", "pass_mark = 0.2", 1);
        assert_ne!(lenient, exercise);
        lenient
    });
    let class = class.again(lenient.into()).await;
    class.submit(&ada, &class.tension(&ada).await).await;
    class.submit(&bob, "1.000").await;
    let path = format!("/api/v1/people/{}/decisions", told["person"]["id"].as_str().expect("an id"));
    let body = json!({"lesson": "simple-pendulum", "points": 2.5, "reason": "right in another frame"});
    assert_eq!(class.ask("POST", &path, &owner, Some(body)).await.status, 201);
    let passed = async |class: &Class| {
        let table = class.see(&owner, "/api/v1/standings").await;
        let of = |row: &Value| row["lessons"]["simple-pendulum"]["passed"] == true;
        table["students"].as_array().expect("rows").iter().map(of).collect::<Vec<bool>>()
    };
    assert_eq!(passed(&class).await, [true, true], "of 12 points 2.4 are enough");
    let class = class.again(mended().into()).await;
    assert_eq!(passed(&class).await, [true, true], "now 10.5 of 15 are");
    assert_eq!(class.see(&ada, "/api/v1/record").await["lessons"][0]["standing"]["points"]["passed"], true);
    let seen = class.look(&owner).await;
    for one in seen["people"].as_array().expect("people") {
        assert_eq!(one["passed"], json!([true, false]), "{one}");
    }
    class.apply(&owner, &seen, "better").await;
    assert_eq!(passed(&class).await, [true, true], "more points that pass no more are a loss");
    class.apply(&owner, &class.look(&owner).await, "replace").await;
    assert_eq!(passed(&class).await, [false, false]);
}
