use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::json;
use sqlx::Executor;
use tempfile::TempDir;

use super::*;
use crate::policy::{Policy, Refusal};

/// A submission without anything special, at home.
pub(super) fn new(student: &str) -> HandIn {
    let id = identifier();
    HandIn {
        id: id.clone(),
        course: HOME.into(),
        lesson: "pendulum".into(),
        whose: Whose::Named,
        student: student.into(),
        received_at: now(),
        answers: json!({"q": {"value": "0.1"}}).to_string(),
        verdict: json!({"id": id, "earned": 0.1, "passed": false, "provenance": {"seed": student}}),
        seed: student.into(),
        counted: true,
        after: 0,
        key: None,
        bundle: "the lesson".into(),
    }
}

fn all() -> Query {
    Query { course: HOME.into(), limit: 1000, ..Query::default() }
}

/// Hands in as the server does: what came before is looked at first, and again where it was overtaken.
async fn hand_in(store: &Store, new: &HandIn) -> Result<Kept, StoreError> {
    loop {
        let person = store.person_named(HOME, &new.student).await?.unwrap_or_default();
        let (_, after) = store.earlier(HOME, &person, &new.lesson).await?;
        match store.hand_in(&HandIn { after, ..new.clone() }).await {
            Err(StoreError::Overtaken) => {}
            other => return other,
        }
    }
}

async fn ids(store: &Store) -> Vec<String> {
    store.list(&all()).await.expect("lists").into_iter().map(|one| one.id).collect()
}

/// A folder, and the path of a gradebook in it.
fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("grades.db");
    (folder, path)
}

async fn open(path: &Path) -> Store {
    Store::open(path).await.expect("opens")
}

#[tokio::test]
async fn what_was_handed_in_survives_a_restart_unchanged() {
    let (_folder, path) = place();
    let store = open(&path).await;
    let (ada, emmy) = (new("Ada"), new("Emmy"));
    assert_eq!(hand_in(&store, &ada).await.expect("keeps").attempts, 1);
    hand_in(&store, &emmy).await.expect("keeps");
    store.close().await;

    let store = open(&path).await;
    let found = store.list(&all()).await.expect("lists");
    assert_eq!([&found[0].id, &found[1].id], [&emmy.id, &ada.id], "newest first");
    assert_eq!((&found[1].verdict, found[1].answers.to_string()), (&ada.verdict, ada.answers.clone()));
    let person = store.person_named(HOME, " ADA ").await.expect("looks");
    assert!(person.is_some());
    let hers = store.list(&Query { person, ..all() }).await.expect("lists");
    assert_eq!(hers.iter().map(|one| one.student.as_str()).collect::<Vec<_>>(), ["Ada"]);
    assert_eq!(store.lesson_version(&hash::sha256("the lesson")).await.expect("kept"), "the lesson");
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test]
async fn records_can_be_neither_changed_nor_removed() {
    let store = Store::in_memory();
    let one = new("ada");
    hand_in(&store, &one).await.expect("keeps");
    assert!(hand_in(&store, &one).await.is_err(), "an id is used once");
    for table in ["submission", "verdict", "event"] {
        let mut transaction = store.write().await.expect("begins");
        let change = match table {
            "submission" => "UPDATE submission SET student = 'eve'",
            "verdict" => "UPDATE verdict SET earned = 10",
            _ => "UPDATE event SET actor = 'eve'",
        };
        assert!(sqlx::query(change).execute(&mut *transaction).await.is_err(), "{table}");
        let remove = match table {
            "submission" => "DELETE FROM submission",
            "verdict" => "DELETE FROM verdict",
            _ => "DELETE FROM event",
        };
        assert!(sqlx::query(remove).execute(&mut *transaction).await.is_err(), "{table}");
    }
}

#[tokio::test]
async fn a_prediction_is_made_once_and_a_forged_one_is_found() {
    let store = Store::in_memory();
    let say = |choice: &str| NewPrediction {
        course: HOME.into(),
        whose: Whose::Named,
        student: "Ada".into(),
        lesson: "pendulum".into(),
        prediction: "pull".into(),
        choice: Some(choice.into()),
        why: String::new(),
    };
    let (is_new, ada) = store.predict(&say("a")).await.expect("keeps");
    assert!(is_new);
    assert_eq!(store.predict(&say("b")).await.expect("finds"), (false, ada.clone()));
    let kept = store.predictions(HOME, Some(&ada), Some("pendulum")).await.expect("lists");
    assert_eq!(kept.iter().map(|one| one.choice.as_deref()).collect::<Vec<_>>(), [Some("a")]);
    assert_eq!(store.predictions(HOME, None, Some("screw")).await.expect("lists"), []);
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
    for change in ["UPDATE prediction SET choice = 'b'", "DELETE FROM prediction"] {
        assert!(sqlx::query(change).execute(&store.writer).await.is_err(), "{change}");
    }
    for forge in ["DROP TRIGGER prediction_is_immutable", "UPDATE prediction SET choice = 'b'"] {
        sqlx::query(forge).execute(&store.writer).await.expect("forges");
    }
    assert_eq!(
        store.faults().await.expect("looks").len(),
        2,
        "it is another, and the one that was made is missing"
    );
}

/// SQLite prepares each statement; the same words are for PostgreSQL.
#[tokio::test]
async fn every_statement_is_understood() {
    let store = Store::in_memory();
    let mut transaction = store.write().await.expect("begins");
    assert!(sql::ALL.len() > 15);
    for (name, text) in sql::ALL.iter().chain(OF_COURSE) {
        let prepared = transaction.prepare(sqlx::SqlStr::from_static(text)).await;
        assert!(prepared.is_ok(), "{name}: {prepared:?}");
        assert!(!text.contains('?') && !text.contains("rowid"), "{name} is in SQLite's words");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn of_two_hundred_at_once_three_attempts_are_three() {
    let (_folder, path) = place();
    let store = Arc::new(open(&path).await);
    let three = Policy { most_attempts: Some(3), ..Policy::default() };
    store.set_policy(HOME, "triad", "pendulum", &three).await.expect("sets");
    let sent: Vec<_> = (0..200)
        .map(|_| {
            let store = store.clone();
            tokio::spawn(async move { hand_in(&store, &new("ada")).await })
        })
        .collect();
    let (mut kept, mut refused) = (BTreeSet::new(), 0);
    for one in sent {
        match one.await.expect("ends") {
            Ok(one) => assert!(kept.insert(one.attempts)),
            Err(StoreError::Refused(Refusal::AttemptsUsed(3))) => refused += 1,
            Err(other) => panic!("{other}"),
        }
    }
    assert_eq!((kept, refused), (BTreeSet::from([1, 2, 3]), 197));
    assert_eq!(ids(&store).await.len(), 3);
    // What cannot be read is kept, uses no attempt and is not refused.
    let unread = HandIn { counted: false, ..new("ada") };
    assert_eq!(hand_in(&store, &unread).await.expect("keeps").attempts, 3);
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_request_that_is_repeated_is_one_submission() {
    let (_folder, path) = place();
    let store = Arc::new(open(&path).await);
    let sent: Vec<_> = (0..20)
        .map(|_| {
            let store = store.clone();
            tokio::spawn(
                async move { hand_in(&store, &HandIn { key: Some("k".into()), ..new("ada") }).await },
            )
        })
        .collect();
    let mut told = BTreeSet::new();
    for one in sent {
        let one = one.await.expect("ends").expect("keeps");
        assert_eq!(one.attempts, 1);
        told.insert(one.verdict["id"].to_string());
    }
    assert_eq!((told.len(), ids(&store).await.len()), (1, 1));
    hand_in(&store, &HandIn { key: Some("k".into()), ..new("emmy") }).await.expect("a key is one person's");
    hand_in(&store, &HandIn { key: Some("l".into()), ..new("ada") }).await.expect("another");
    assert_eq!(ids(&store).await.len(), 3);
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test(flavor = "multi_thread")]
async fn several_programs_make_and_share_one_file() {
    let (_folder, path) = place();
    let opened: Vec<_> = (0..6)
        .map(|_| {
            let path = path.clone();
            tokio::spawn(async move {
                let store = open(&path).await;
                for _ in 0..10 {
                    hand_in(&store, &new("ada")).await.expect("keeps");
                }
                store
            })
        })
        .collect();
    let mut stores = Vec::new();
    for one in opened {
        stores.push(one.await.expect("ends"));
    }
    assert_eq!(ids(&stores[0]).await.len(), 60);
    assert_eq!(stores[5].faults().await.expect("looks"), Vec::<String>::new());
}

/// What is moved, replaced or removed, the database or its log of changes: nothing is acknowledged that a restart forgets.
#[tokio::test]
async fn a_file_that_is_taken_away_takes_no_submissions() {
    for (file, replaced) in [("grades.db", false), ("grades.db", true), ("grades.db-wal", false)] {
        let (folder, path) = place();
        let store = open(&path).await;
        hand_in(&store, &new("ada")).await.expect("keeps");
        let away = folder.path().join("away");
        fs::rename(folder.path().join(file), &away).expect("moves");
        if replaced {
            fs::copy(&away, folder.path().join(file)).expect("copies");
        }
        let refused = hand_in(&store, &new("ada")).await;
        assert!(matches!(refused, Err(StoreError::Moved(_))), "{file}: {refused:?}");
        assert!(matches!(store.ready().await, Err(StoreError::Moved(_))));
        fs::rename(&away, folder.path().join(file)).expect("moves back");
        hand_in(&store, &new("ada")).await.expect("keeps again");
        store.close().await;
        assert_eq!(ids(&open(&path).await).await.len(), 2, "{file}");
    }
}

#[tokio::test]
async fn a_full_disk_keeps_nothing_halfway_and_recovers() {
    let (_folder, path) = place();
    let store = open(&path).await;
    hand_in(&store, &new("ada")).await.expect("keeps");
    let bound = |pages: &'static str| sqlx::query(pages).execute(&store.writer);
    // As many pages as there are: what a disk without room does.
    bound("PRAGMA max_page_count = 1").await.expect("bounds");
    let large = HandIn { answers: "\"long\"".to_owned() + &" ".repeat(1 << 20), ..new("emmy") };
    let refused = hand_in(&store, &large).await;
    assert!(matches!(refused, Err(StoreError::Full)), "{refused:?}");
    assert_eq!(ids(&store).await.len(), 1);
    bound("PRAGMA max_page_count = 1000000").await.expect("bounds");
    hand_in(&store, &large).await.expect("keeps");
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test]
async fn a_program_that_holds_the_file_is_waited_for_and_then_named() {
    let (_folder, path) = place();
    let (store, other) = (open(&path).await, open(&path).await);
    let held = other.write().await.expect("begins");
    let refused = hand_in(&store, &new("ada")).await;
    assert!(matches!(refused, Err(StoreError::Busy)), "{refused:?}");
    held.rollback().await.expect("ends");
    hand_in(&store, &new("ada")).await.expect("keeps");
    assert_eq!(ids(&store).await.len(), 1);
}

/// One byte anywhere: the file is refused, or the fault is found, or the byte holds nothing.
#[tokio::test]
async fn a_flipped_byte_is_found() {
    let (_folder, path) = place();
    let store = open(&path).await;
    for k in 0..20 {
        let answers = json!({"file": "0123456789".repeat(800)}).to_string();
        hand_in(&store, &HandIn { answers, ..new(&format!("student {k}")) }).await.expect("keeps");
    }
    let before = store.list(&all()).await.expect("lists");
    store.close().await;
    let whole = fs::read(&path).expect("reads");
    let (mut refused, mut found, mut harmless) = (0, 0, 0);
    for place in (100..whole.len()).step_by(whole.len() / 60) {
        let mut bytes = whole.clone();
        bytes[place] ^= 1;
        fs::write(&path, bytes).expect("writes");
        let Ok(store) = Store::open(&path).await else {
            refused += 1;
            continue;
        };
        match (store.faults().await, store.list(&all()).await) {
            (Ok(faults), Ok(now)) if faults.is_empty() => {
                assert!(now == before, "byte {place} changed a submission unseen");
                harmless += 1;
            }
            _ => found += 1,
        }
        store.close().await;
    }
    assert!(refused > 0 && found > 10, "{refused} refused, {found} found, {harmless} harmless");
}

#[tokio::test]
async fn a_database_of_a_later_version_is_refused() {
    let (_folder, path) = place();
    let store = open(&path).await;
    sqlx::query("PRAGMA user_version = 99").execute(&store.writer).await.expect("writes");
    store.close().await;
    assert!(matches!(Store::open(&path).await, Err(StoreError::Newer { found: 99, known: 4 })));
}

#[tokio::test]
async fn a_file_that_is_no_database_is_refused_by_name() {
    let (folder, _) = place();
    let path = folder.path().join("notes.txt");
    fs::write(&path, "not a database, but long enough to be read as one".repeat(40)).expect("writes");
    let error = Store::open(&path).await.expect_err("refused");
    assert!(error.to_string().contains("notes.txt"), "{error}");
}

/// What comes between settling and keeping is known to the verdict that is kept, or it is not kept.
#[tokio::test]
async fn a_verdict_that_does_not_know_what_came_before_is_not_kept() {
    let store = Store::in_memory();
    store.hand_in(&new("ada")).await.expect("keeps");
    let refused = store.hand_in(&new("ada")).await;
    assert!(matches!(refused, Err(StoreError::Overtaken)), "{refused:?}");
    assert_eq!(ids(&store).await.len(), 1);
    store.hand_in(&HandIn { lesson: "another".into(), ..new("ada") }).await.expect("another lesson");
    hand_in(&store, &new("ada")).await.expect("keeps what knows");
    assert_eq!(ids(&store).await.len(), 3);
}

/// PostgreSQL prepares each statement too, where it is installed: in a cluster of its own that is thrown away.
#[test]
fn every_statement_is_understood_by_postgresql() {
    use std::fmt::Write;

    let mut script = String::new();
    let added = sql::ADDED_4.iter().filter(|text| text.starts_with("CREATE TABLE"));
    for text in sql::TABLES.iter().chain(sql::ADDED).chain(added) {
        let _ = writeln!(script, "{text};");
    }
    for (k, (name, text)) in sql::ALL.iter().chain(OF_COURSE).enumerate() {
        let _ = writeln!(script, "PREPARE p{k}_{name} AS {text};");
    }
    // It refuses to be run by root; whoever is root makes it run as nobody.
    let folder = tempfile::tempdir().expect("a folder");
    let run = r#"set -e
        export LC_ALL=C; cd "$1"
        as() { if [ "$(id -u)" = 0 ]; then setpriv --reuid=65534 --regid=65534 --clear-groups "$@"; else "$@"; fi; }
        command -v initdb pg_ctl psql > missing || exit 77
        if [ "$(id -u)" = 0 ]; then chown 65534:65534 "$1"; fi
        as initdb --pgdata="$1/data" --auth=trust --username=triad > initdb.log 2>&1 || exit 77
        as pg_ctl --pgdata="$1/data" --log="$1/server.log" --wait \
            --options="-c listen_addresses='' -c unix_socket_directories='$1' -c fsync=off" start > start.log 2>&1 || exit 77
        psql --host="$1" --username=triad --dbname=postgres --set=ON_ERROR_STOP=1 --quiet --file=statements.sql && told=0 || told=1
        as pg_ctl --pgdata="$1/data" --mode=immediate stop > stop.log 2>&1
        exit $told"#;
    fs::write(folder.path().join("statements.sql"), &script).expect("writes");
    let ran = std::process::Command::new("sh").args(["-c", run, "sh"]).arg(folder.path()).output();
    let Ok(ran) = ran.map(|ran| (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned()))
    else {
        return;
    };
    if ran.0 == Some(77) {
        println!("skipped: PostgreSQL is not installed here (Debian: apt-get install postgresql)");
        return;
    }
    assert_eq!(ran.0, Some(0), "{}", ran.1);
}
