use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::json;
use tempfile::TempDir;
use tokio::sync::mpsc;

use super::super::*;

/// A submission with a name, a file and a verdict that says who it is about.
pub(in crate::store) fn new(student: &str, after: i64) -> HandIn {
    let plain = tests::new(student);
    let question = json!({"id": "q", "earned": 0.1, "possible": 1.0, "verdict": "wrong", "message_html": "<p>You wrote 7.</p>"});
    HandIn {
        answers: json!({"q": {"file": "the work of a student"}}).to_string(),
        verdict: json!({"id": plain.id, "student": student, "earned": 0.1, "possible": 1.0, "passed": false, "questions": [question],
            "provenance": {"seed": student, "parameters": {}}}),
        after,
        ..plain
    }
}

struct Place {
    folder: TempDir,
    store: Store,
}

impl Place {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

/// A gradebook with the work of two.
async fn place() -> Place {
    let folder = tempfile::tempdir().expect("a folder");
    let store = open(&folder.path().join("grades.db")).await;
    for student in ["Zebedee", "Emmy"] {
        store.hand_in(&new(student, 0)).await.expect("keeps");
    }
    let ada = store.person_named(HOME, "zebedee").await.expect("looks").expect("Zebedee");
    store
        .decide(HOME, "triad", &ada, "pendulum", Said::points(Some(0.7), "right in another frame"))
        .await
        .expect_err("triad is nobody");
    let emmy = store.person_named(HOME, "emmy").await.expect("looks").expect("Emmy");
    store
        .decide(HOME, &emmy, &ada, "pendulum", Said::points(Some(0.7), "right in another frame"))
        .await
        .expect("decides");
    Place { folder, store }
}

async fn open(path: &Path) -> Store {
    Store::open(path).await.expect("opens")
}

pub(in crate::store) async fn all(store: &Store) -> Vec<StoredSubmission> {
    store.list(&Query { course: HOME.into(), limit: 1000, ..Query::default() }).await.expect("lists")
}

pub(in crate::store) async fn whole(store: &Store) -> bool {
    store.faults().await.expect("looks").is_empty()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_backup_made_during_submissions_is_the_gradebook_of_one_moment() {
    let place = place().await;
    let (store, copy) = (Arc::new(place.store), place.folder.path().join("copy.db"));
    let busy = Arc::clone(&store);
    let writing = tokio::spawn(async move {
        for k in 0..40 {
            busy.hand_in(&new(&format!("student {k}"), 0)).await.expect("keeps");
        }
    });
    let copied = store.backup(&copy).await.expect("copies");
    writing.await.expect("ends");
    assert!((2..=42).contains(&copied.submissions) && copied.events > copied.submissions, "{copied:?}");
    assert!(matches!(store.backup(&copy).await, Err(StoreError::Exists(path)) if path == copy));

    let back = place.folder.path().join("back.db");
    assert_eq!(restore(&copy, &back).await.expect("restores").submissions, copied.submissions);
    let (then, now) = (all(&open(&back).await).await, all(&store).await);
    assert_eq!(then.len(), usize::try_from(copied.submissions).expect("some"));
    assert!(then.iter().all(|one| now.contains(one)), "what was copied is what stands there");
    assert!(matches!(restore(&copy, &back).await, Err(StoreError::Exists(_))));
    let left: BTreeSet<String> = fs::read_dir(place.folder.path())
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    assert!(!left.iter().any(|name| name.contains("part")), "{left:?}");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        assert_eq!(copy.metadata().expect("a file").permissions().mode() & 0o777, 0o600);
    }
}

#[tokio::test]
async fn a_backup_that_is_damaged_or_none_is_not_restored() {
    let place = place().await;
    let (copy, back) = (place.path("copy.db"), place.path("back.db"));
    place.store.backup(&copy).await.expect("copies");
    let good = fs::read(&copy).expect("reads");
    let at = good.windows(11).position(|bytes| bytes == b"the work of").expect("an answer");
    let mut bad = good.clone();
    bad[at] = b'T';
    fs::write(&copy, &bad).expect("writes");
    assert!(matches!(restore(&copy, &back).await, Err(StoreError::Damaged(_))));
    fs::write(&copy, b"").expect("writes");
    assert!(matches!(restore(&copy, &back).await, Err(StoreError::Foreign(_))));
    fs::write(&copy, "no database at all, only text of some length".repeat(100)).expect("writes");
    assert!(restore(&copy, &back).await.is_err());
    assert!(!back.exists(), "nothing is left of what was refused");
    fs::write(&copy, good).expect("writes");
    fs::write(place.path("back.db-wal"), b"of an earlier one").expect("writes");
    assert!(matches!(restore(&copy, &back).await, Err(StoreError::Exists(_))));
}

pub(in crate::store) async fn exported(store: &Store, to: &Path) {
    let (pieces, mut received): (Pieces, _) = mpsc::channel(4);
    let (sent, ()) = tokio::join!(
        async {
            let pieces = pieces;
            store.export(HOME, &pieces).await
        },
        async {
            let mut file = fs::File::create(to).expect("a file");
            while let Some(piece) = received.recv().await {
                file.write_all(&piece.expect("a piece")).expect("writes");
            }
        }
    );
    sent.expect("exports");
}

#[tokio::test]
async fn a_course_moves_whole_and_only_once() {
    let place = place().await;
    let file = place.path("course.triad");
    exported(&place.store, &file).await;
    let other = open(&place.path("other.db")).await;
    let came = other.import(&file).await.expect("comes in");
    assert!(came.rows > 10, "{came:?}");
    assert_eq!(all(&other).await, all(&place.store).await);
    let (mut here, mut there) = (
        place.store.handed(HOME, None, None).await.expect("reads"),
        other.handed(HOME, None, None).await.expect("reads"),
    );
    for list in [&mut here, &mut there] {
        list.sort_by(|a, b| a.person.cmp(&b.person));
    }
    assert_eq!(here, there);
    assert_eq!(
        place.store.decisions(HOME, None, None).await.expect("reads"),
        other.decisions(HOME, None, None).await.expect("reads")
    );
    assert_eq!(
        place.store.course(HOME).await.expect("a course"),
        other.course(HOME).await.expect("a course")
    );
    assert!(whole(&other).await);
    assert_eq!(other.import(&file).await.expect("is there").rows, 0, "nothing comes twice");
    other.hand_in(&new("Third", 0)).await.expect("goes on");
    assert_eq!(other.import(&file).await.expect("is there").rows, 0, "nor when the course went on");
    assert_eq!(all(&other).await.len(), 3);

    // Another course stands there already; a file from there does not fit here either.
    let third = open(&place.path("third.db")).await;
    third.hand_in(&new("Zebedee", 0)).await.expect("keeps");
    assert!(matches!(third.import(&file).await, Err(StoreError::Foreign(_))));
    exported(&other, &file).await;
    assert!(
        matches!(place.store.import(&file).await, Err(StoreError::Foreign(_))),
        "the same course, further on"
    );
    assert_eq!((all(&third).await.len(), all(&place.store).await.len()), (1, 2));
}

#[tokio::test]
async fn a_file_that_is_cut_changed_or_newer_brings_nothing_in() {
    let place = place().await;
    let file = place.path("course.triad");
    exported(&place.store, &file).await;
    let text = fs::read_to_string(&file).expect("text");
    let other = open(&place.path("other.db")).await;
    let newer = text.replacen(&format!("\"format\":{}", schema::FORMAT), "\"format\":99", 1);
    let resealed = |text: &str| {
        let rows: Vec<&str> = text.lines().collect();
        let body = format!("{}\n", rows[..rows.len() - 1].join("\n"));
        let end = json!({"rows": rows.len() - 2, "sha256": hash::sha256(&body)});
        format!("{body}{end}\n")
    };
    let last = text.lines().last().expect("a line").len();
    for (what, bad) in [
        ("cut", text[..text.len() / 2].to_owned()),
        ("without its end", text[..text.len() - last - 1].to_owned()),
        ("changed", text.replacen("the work", "The work", 1)),
        ("changed and sealed anew", resealed(&text.replacen("the work", "The work", 1))),
        ("newer", resealed(&newer)),
        ("other columns", resealed(&text.replacen("\"name_key\"", "\"nick\"", 1))),
        ("other tables", resealed(&text.replacen("[\"decision\"", "[\"sqlite_schema\"", 1))),
        ("not a course", "{\"triad\":\"scene\"}\n".into()),
        ("nothing", String::new()),
    ] {
        fs::write(&file, bad).expect("writes");
        let refused = other.import(&file).await;
        assert!(refused.is_err(), "{what}");
        if what == "newer" {
            assert!(matches!(refused, Err(StoreError::Newer { found: 99, .. })));
        }
        assert_eq!(all(&other).await.len(), 0, "{what}");
    }
    fs::write(&file, text).expect("writes");
    other.import(&file).await.expect("the whole one comes in");
}

#[tokio::test]
async fn every_table_is_taken_along_or_left_on_purpose() {
    let known: BTreeSet<&str> =
        OF_COURSE.iter().map(|(table, _)| *table).chain(LEFT.iter().copied()).collect();
    let tables = sql::TABLES
        .iter()
        .chain(sql::ADDED)
        .chain(sql::ADDED_4)
        .chain(sql::ADDED_5)
        .chain(sql::lti::ADDED_6)
        .chain(sql::ADDED_7)
        .chain(sql::ADDED_8)
        .chain(sql::ADDED_10)
        .filter_map(|text| text.strip_prefix("CREATE TABLE ")?.split(' ').next());
    assert_eq!(tables.collect::<BTreeSet<_>>(), known);
}

#[tokio::test]
async fn who_is_erased_leaves_grades_and_a_log_that_is_whole() {
    for answers_stay in [false, true] {
        let place = place().await;
        let store = &place.store;
        let ada = store.person_named(HOME, "Zebedee").await.expect("looks").expect("Zebedee");
        let before = store.handed(HOME, None, None).await.expect("reads");
        assert!(!store.events_of(HOME, &ada).await.expect("reads").is_empty());
        store.erase(HOME, "triad", &ada, "asked for it", answers_stay).await.expect("erases");
        assert_eq!(store.handed(HOME, None, None).await.expect("reads"), before, "points stay");
        assert_eq!(store.person_named(HOME, "zebedee").await.expect("looks"), None);
        assert!(whole(store).await);
        let hers = Query { course: HOME.into(), person: Some(ada.clone()), limit: 9, ..Query::default() };
        let hers = store.list(&hers).await.expect("lists").remove(0);
        assert_eq!((hers.student.as_str(), &hers.verdict["earned"]), ("", &json!(0.1)));
        assert_eq!(hers.answers == json!({}), !answers_stay);
        assert_eq!(hers.verdict.to_string().contains("You wrote"), answers_stay);
        // Whom nobody asked for is as before, and records are kept as before.
        assert_eq!(all(store).await.iter().filter(|one| one.student == "Emmy").count(), 1);
        let mut transaction = store.write().await.expect("begins");
        for change in [
            "UPDATE submission SET answers = '7'",
            "UPDATE verdict SET earned = 9",
            "UPDATE membership SET seed = ''",
        ] {
            assert!(sqlx::query(change).execute(&mut *transaction).await.is_err(), "{change}");
        }
        transaction.rollback().await.expect("ends");
        // The bytes themselves are gone: from the file, from its log, and from a backup.
        let copy = place.path("copy.db");
        store.backup(&copy).await.expect("copies");
        store.close().await;
        for file in [place.path("grades.db"), copy] {
            let bytes = fs::read(&file).expect("reads");
            assert!(
                !bytes.windows(7).any(|word| word.eq_ignore_ascii_case(b"zebedee")),
                "{}",
                file.display()
            );
        }
    }
}

#[tokio::test]
async fn one_person_cannot_fill_the_disk_and_all_together_neither() {
    let place = place().await;
    let quotas = Quotas { person_bytes: 1 << 20, ..Quotas::default() };
    let large = |student: &str, after| HandIn {
        answers: json!("x".repeat(400_000)).to_string(),
        ..new(student, after)
    };
    let store = place.store.with_quotas(quotas);
    let mut after = 0;
    for _ in 0..2 {
        store.hand_in(&large("Max", after)).await.expect("keeps");
        let max = store.person_named(HOME, "Max").await.expect("looks").expect("Max");
        after = store.earlier(HOME, &max, "pendulum").await.expect("reads").1;
    }
    let refused = store.hand_in(&large("Max", after)).await;
    assert!(matches!(refused, Err(StoreError::QuotaUsed(_))), "{refused:?}");
    store.hand_in(&new("Max", after)).await.expect("what is small is kept");
    store.hand_in(&large("Moritz", 0)).await.expect("others have their own");
    let store = store.with_quotas(Quotas { file_bytes: 1 << 20, ..quotas });
    let refused = store.hand_in(&new("Third", 0)).await;
    assert!(matches!(refused, Err(StoreError::QuotaUsed(_))), "{refused:?}");
    let store = store.with_quotas(Quotas { person_submissions: 3, ..quotas });
    assert!(store.hand_in(&new("Max", 0)).await.is_err());
    assert!(whole(&store).await);
}
