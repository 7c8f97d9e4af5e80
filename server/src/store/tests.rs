use std::fs;
use std::path::PathBuf;

use serde_json::json;
use tempfile::TempDir;

use super::*;

/// Ends a test that hangs, and decides nothing else.
const HANG: Duration = Duration::from_mins(1);

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
pub(super) async fn hand_in(store: &Store, new: &HandIn) -> Result<Kept, StoreError> {
    loop {
        let person = store.person_named(HOME, &new.student).await?.unwrap_or_default();
        let (_, after) = store.earlier(HOME, &person, &new.lesson).await?;
        match store.hand_in(&HandIn { after, ..new.clone() }).await {
            Err(StoreError::Overtaken) => {}
            other => return other,
        }
    }
}

pub(super) async fn ids(store: &Store) -> Vec<String> {
    store.list(&all()).await.expect("lists").into_iter().map(|one| one.id).collect()
}

/// Six programs open one gradebook at once, and each hands in ten times.
pub(super) async fn six_share<O, S>(open: O) -> Store
where
    O: Fn() -> S,
    S: Future<Output = Store> + Send + 'static,
{
    let opened: Vec<_> = (0..6)
        .map(|_| {
            let opening = open();
            tokio::spawn(async move {
                let store = opening.await;
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
    stores.swap_remove(0)
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

/// Transactions in a log of SQLite: each ends with a frame that tells the size of the database (sqlite.org/fileformat2.html#walformat).
fn transactions(path: &Path) -> usize {
    let log = fs::read(path.with_extension("db-wal")).expect("a log");
    let number = |at: usize| u32::from_be_bytes(log[at..at + 4].try_into().expect("four"));
    let (page, salt) = (number(8) as usize, number(16));
    let frames = (32..log.len()).step_by(24 + page).filter(|at| number(at + 8) == salt);
    frames.filter(|at| number(at + 4) != 0).count()
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn what_comes_while_another_is_written_is_written_together_and_each_is_told_its_own() {
    let (_folder, path) = place();
    let store = Arc::new(open(&path).await);
    hand_in(&store, &new("ada")).await.expect("keeps");
    let before = transactions(&path);
    // Whoever writes now holds up all that come.
    let writing = store.write().await.expect("writes");
    let twice = HandIn { key: Some("twice".into()), ..new("twin") };
    let mut all: Vec<HandIn> = (0..20).map(|k| new(&format!("student {k}"))).collect();
    // One does not know of her first, two are one.
    all.extend([new("ada"), twice.clone(), HandIn { id: identifier(), ..twice.clone() }]);
    let asked: Vec<_> = all
        .into_iter()
        .map(|new| {
            let store = Arc::clone(&store);
            tokio::spawn(async move { store.hand_in(&new).await })
        })
        .collect();
    while store.together.waiting() < 23 {
        tokio::task::yield_now().await;
    }
    writing.rollback().await.expect("ends");
    let mut told = Vec::new();
    for one in asked {
        told.push(one.await.expect("ends"));
    }
    assert!(told[..20].iter().all(Result::is_ok), "{told:?}");
    assert!(matches!(told[20], Err(StoreError::Overtaken)), "{:?}", told[20]);
    let [Ok(first), Ok(second)] = &told[21..] else { panic!("{told:?}") };
    assert_eq!((&first.verdict["id"], &second.verdict["id"]), (&json!(twice.id), &json!(twice.id)));
    assert_eq!(transactions(&path) - before, 1, "one flush for all");
    assert_eq!(ids(&store).await.len(), 22);
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test(flavor = "multi_thread")]
async fn several_programs_make_and_share_one_file() {
    let (_folder, path) = place();
    six_share(|| {
        let path = path.clone();
        async move { open(&path).await }
    })
    .await;
}

/// A clock that was set back, or far ahead and back again, changes no order.
#[tokio::test]
async fn the_newest_is_what_was_kept_last_whatever_the_clock_said() {
    let (_folder, path) = place();
    let store = open(&path).await;
    let mut kept = Vec::new();
    for hours in [0, 400 * 365 * 24, -1, 0] {
        let at_that_hour = HandIn { received_at: now() + hours * 3_600_000, ..new("ada") };
        hand_in(&store, &at_that_hour).await.expect("keeps");
        kept.insert(0, at_that_hour.id);
    }
    assert_eq!(ids(&store).await, kept);
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
    let bound = |pages: &'static str| sqlx::query(pages).execute(&store.pools.writer);
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

/// Lists of large files do not hold up who hands in, nor the other way round.
#[tokio::test]
async fn who_reads_and_who_writes_do_not_wait_for_each_other() {
    let (_folder, path) = place();
    let store = open(&path).await;
    hand_in(&store, &new("ada")).await.expect("keeps");
    let writing = store.write().await.expect("begins");
    let read = tokio::time::timeout(HANG, ids(&store)).await;
    assert_eq!(read.expect("nobody waits for who writes").len(), 1);
    writing.rollback().await.expect("ends");
    let reading = store.snapshot().await.expect("reads");
    hand_in(&store, &new("emmy")).await.expect("nobody waits for who reads");
    drop(reading);
    assert_eq!(ids(&store).await.len(), 2);
}

/// Others who use the machine read no names and no grades, and a path is a path, whatever it looks like.
#[tokio::test]
async fn the_file_is_its_owners_alone_and_at_the_path_that_was_given() {
    for name in ["grades.db", "file:x.db?mode=memory", "?#%41 &", ":memory:"] {
        let (folder, _) = place();
        let path = folder.path().join(name);
        let store = open(&path).await;
        hand_in(&store, &new("ada")).await.expect("keeps");
        for entry in fs::read_dir(folder.path()).expect("a folder") {
            let entry = entry.expect("an entry");
            assert!(entry.file_name().to_string_lossy().starts_with(name), "{entry:?}");
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                let mode = entry.metadata().expect("a file").permissions().mode();
                assert_eq!(mode & 0o777, 0o600, "{entry:?}");
            }
        }
        store.close().await;
        assert_eq!(ids(&open(&path).await).await.len(), 1, "{name}");
    }
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
    let places = (100..whole.len()).step_by(whole.len() / 60);
    // The highest bit of a letter makes a text none.
    for (place, bit) in places.flat_map(|place| [(place, 1), (place, 0x80)]) {
        let mut bytes = whole.clone();
        bytes[place] ^= bit;
        fs::write(&path, bytes).expect("writes");
        let Ok(store) = Store::open(&path).await else {
            refused += 1;
            continue;
        };
        let listed = store.list(&all()).await;
        assert!(!matches!(listed, Err(StoreError::Sql(_))), "byte {place} hides all the others: {listed:?}");
        match (store.faults().await, listed) {
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
    sqlx::query("PRAGMA user_version = 99").execute(&store.pools.writer).await.expect("writes");
    store.close().await;
    assert!(matches!(Store::open(&path).await, Err(StoreError::Newer { found: 99, known: schema::FORMAT })));
}

#[tokio::test]
async fn a_file_that_is_no_database_is_refused_by_name() {
    let (folder, _) = place();
    let path = folder.path().join("notes.txt");
    fs::write(&path, "not a database, but long enough to be read as one".repeat(40)).expect("writes");
    let error = Store::open(&path).await.expect_err("refused");
    assert!(error.to_string().contains("notes.txt"), "{error}");
}
