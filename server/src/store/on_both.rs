//! What holds in every database: these tests run in memory, and once more on PostgreSQL where it is installed.

#![allow(clippy::expect_used, clippy::panic)] // a test that cannot go on says so

use std::collections::BTreeSet;
use std::sync::Arc;

use sqlx::{AssertSqlSafe, Executor, Row};
use triad_tests::postgres::{self, Postgres};

use super::copies::tests::{all as listed, exported, new as with_work, whole};
use super::kind::Kind;
use super::tests::{hand_in, ids, new, six_share};
use super::*;
use crate::policy::{Extension, Moment, Policy, Refusal};

/// An empty gradebook: in memory, or where PostgreSQL is given in a database of its own.
pub(super) async fn fresh() -> Store {
    match postgres::given() {
        None => Store::in_memory(),
        Some(server) => at(&server.database()).await,
    }
}

async fn at(address: &str) -> Store {
    Store::at(&address.parse().expect("an address")).await.expect("opens")
}

#[test]
fn everything_here_holds_on_postgresql_too() {
    let Some(server) = Postgres::start("the gradebook on PostgreSQL") else { return };
    server.again(&["store::on_both"], &["everything_here_holds_on_postgresql_too"]);
}

/// Whoever asks for one person's work reads the rows of that person, however many others there are.
#[tokio::test]
async fn one_persons_work_is_found_by_the_person() {
    let store = fresh().await;
    let of_person =
        [sql::HANDED_OF, sql::SUBMISSIONS_OF, sql::PREDICTIONS_OF, sql::ATTEMPTS, sql::LAST_SUBMISSION];
    for statement in of_person {
        let mut reading = store.pools.readers.begin().await.expect("begins");
        let (explain, place, by_person, by_reading_all) = match Kind::of(&reading) {
            Kind::Sqlite => ("EXPLAIN QUERY PLAN", "detail", "person=?", "SCAN"),
            Kind::Postgres => {
                // Of tables as small as these the whole is read first, if it may be.
                reading.execute("SET LOCAL enable_seqscan = off").await.expect("sets");
                ("EXPLAIN", "QUERY PLAN", "person = ", "Seq Scan on submission")
            }
        };
        let explained = format!("{explain} {statement}");
        let mut plan = sqlx::query(AssertSqlSafe(explained));
        for place in ["$1", "$2", "$3"].into_iter().filter(|place| statement.contains(place)) {
            plan = plan.bind(place);
        }
        if statement.contains("$4") {
            plan = plan.bind(1_i64);
        }
        let lines = plan.fetch_all(&mut *reading).await.expect("plans");
        let lines: Vec<String> = lines.iter().map(|line| line.get(place)).collect();
        assert!(lines.iter().any(|line| line.contains(by_person)), "{statement}: {lines:#?}");
        assert!(!lines.iter().any(|line| line.contains(by_reading_all)), "{statement}: {lines:#?}");
    }
}

/// Several programs make the tables at once; one of a later version is refused.
#[tokio::test(flavor = "multi_thread")]
async fn several_programs_make_and_share_one_database() {
    let Some(server) = postgres::given() else { return };
    let address = server.database();
    let store = six_share(|| {
        let address = address.clone();
        async move { at(&address).await }
    })
    .await;
    let later = sqlx::query("UPDATE triad_format SET version = 99");
    later.execute(&store.pools.writer).await.expect("writes");
    let refused = Store::at(&address.parse().expect("an address")).await;
    assert!(matches!(refused, Err(StoreError::Newer { found: 99, known: schema::FORMAT })), "{refused:?}");
}

/// Programs that start at once on tables of an earlier version: one brings them up to date, the others wait for it.
#[tokio::test(flavor = "multi_thread")]
async fn of_programs_that_start_at_once_one_brings_the_tables_up_to_date() {
    // Tells every change of a table.
    const WATCH: [&str; 3] = [
        "CREATE TABLE changed (tag TEXT NOT NULL, name TEXT NOT NULL)",
        "CREATE FUNCTION watch() RETURNS event_trigger LANGUAGE plpgsql AS $$ BEGIN INSERT INTO changed SELECT command_tag, \
         object_identity FROM pg_event_trigger_ddl_commands() WHERE object_type IN ('table', 'index', 'trigger'); END $$",
        "CREATE EVENT TRIGGER watch ON ddl_command_end EXECUTE FUNCTION watch()",
    ];
    const CHANGES: &str = "SELECT tag || ' ' || name FROM changed ORDER BY 1";
    let Some(server) = postgres::given() else { return };
    let mut seen = Vec::new();
    for programs in [1, 6] {
        let address = server.database();
        let store = Store::of_server(&address).expect("an address");
        let mut transaction = store.write().await.expect("begins");
        if schema::make_of_format_2(&mut transaction).await.expect("makes") {
            transaction.commit().await.expect("is kept");
        }
        for statement in WATCH {
            store.pools.writer.execute(statement).await.expect("watches");
        }
        let opening: Vec<_> = (0..programs)
            .map(|_| {
                let address = address.clone();
                tokio::spawn(async move { at(&address).await })
            })
            .collect();
        for one in opening {
            let opened = one.await.expect("ends");
            hand_in(&opened, &new("ada")).await.expect("keeps");
        }
        let found: Vec<(String,)> =
            sqlx::query_as(CHANGES).fetch_all(&store.pools.readers).await.expect("reads");
        assert!(found.len() > 20, "{found:?}");
        seen.push(found);
    }
    assert_eq!(seen[0], seen[1], "six at once change what one does");
}

/// Tables that are brought up to date in the middle of somebody's transaction wait for it, and never make it fail.
#[tokio::test(flavor = "multi_thread")]
async fn a_change_of_the_tables_gives_way_to_those_who_work_on_them() {
    let Some(server) = postgres::given() else { return };
    let address = server.database();
    let store = Store::of_server(&address).expect("an address");
    let mut transaction = store.write().await.expect("begins");
    assert!(schema::make_of_format_2(&mut transaction).await.expect("makes"));
    transaction.commit().await.expect("is kept");

    // The change of `assignment` comes first and that of `verdict` after it: here it is the other way round.
    let mut working = store.write().await.expect("begins");
    working.execute("LOCK TABLE verdict IN ACCESS SHARE MODE").await.expect("is free");
    let opening = tokio::spawn(async move { at(&address).await });
    // Longer than the server waits before it looks who waits for whom.
    tokio::time::sleep(Duration::from_millis(1500)).await;
    assert!(!opening.is_finished());
    working.execute("LOCK TABLE assignment IN ACCESS SHARE MODE").await.expect("is given way to");
    working.commit().await.expect("is kept");
    hand_in(&opening.await.expect("ends"), &new("ada")).await.expect("keeps");
}

/// What keeps a server's database from being opened is told with its remedy, and without the password.
#[tokio::test]
async fn a_server_that_refuses_is_told_with_what_to_do() {
    let opened = async |address: &str| {
        let location = address.parse().expect("an address");
        let Err(StoreError::Connect { place, hint, .. }) = Store::at(&location).await else {
            panic!("{address} was opened")
        };
        assert!(!place.contains("secret"), "{place}");
        hint
    };
    let gone = opened("postgres://ada:secret@localhost/grades?host=/nowhere").await;
    assert!(gone.contains("start PostgreSQL"), "{gone}");
    let Some(server) = postgres::given() else { return };
    let missing = opened(&server.address("none")).await;
    assert!(missing.contains("createdb"), "{missing}");
    let stranger = server.address("postgres").replace("triad@", "ada:secret@");
    let stranger = opened(&stranger).await;
    assert!(stranger.contains("password"), "{stranger}");
    server.ask("CREATE ROLE guest LOGIN");
    let guest = opened(&server.database().replace("triad@", "guest@")).await;
    assert!(guest.contains("owner"), "{guest}");
    let null = Store::at(&server.database().parse().expect("an address")).await.expect("opens");
    let refused = null.person_named(HOME, "a\0b").await.err();
    let refused = refused.or(null.course("a\0b").await.err());
    assert!(matches!(refused, Some(StoreError::Letters(_))), "{refused:?}");
    server.ask("CREATE DATABASE ascii ENCODING 'SQL_ASCII' TEMPLATE template0");
    let ascii = opened(&server.address("ascii")).await;
    assert!(ascii.contains("UTF8"), "{ascii}");
}

/// From a file to wherever these tests run and back: every row, and what is written next follows from them.
#[tokio::test]
async fn a_course_moves_between_databases_and_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first.triad"), folder.path().join("second.triad"));
    let file = Store::open(&folder.path().join("grades 50%.db")).await.expect("opens");
    for student in ["Zebedee", "Émilie", "aaron", "Ärger"] {
        file.hand_in(&with_work(student, 0)).await.expect("keeps");
    }
    let person = file.person_named(HOME, "aaron").await.expect("looks").expect("aaron");
    let points = Said::points(Some(0.1 + 0.2), "right in another frame");
    file.decide(HOME, &person, &person, "pendulum", points).await.expect("decides");
    exported(&file, &first).await;

    let other = fresh().await;
    let came = other.import(&first).await.expect("comes in");
    assert!(came.rows > 20, "{came:?}");
    assert_eq!(other.import(&first).await.expect("is there").rows, 0, "nothing comes twice");
    assert!(whole(&other).await);
    assert_eq!(listed(&other).await, listed(&file).await);
    assert_eq!(
        other.people(HOME).await.expect("reads"),
        file.people(HOME).await.expect("reads"),
        "in one order"
    );
    assert_eq!(
        other.decisions(HOME, None, None).await.expect("reads"),
        file.decisions(HOME, None, None).await.expect("reads")
    );
    other.hand_in(&with_work("Fifth", 0)).await.expect("goes on");
    exported(&other, &second).await;

    let back = Store::in_memory();
    back.import(&second).await.expect("comes back");
    assert!(whole(&back).await);
    assert_eq!(listed(&back).await, listed(&other).await);
}

#[tokio::test]
async fn who_is_erased_leaves_a_log_that_is_whole_and_records_that_are_kept() {
    let store = fresh().await;
    store.hand_in(&with_work("Zebedee", 0)).await.expect("keeps");
    let person = store.person_named(HOME, "Zebedee").await.expect("looks").expect("Zebedee");
    store.erase(HOME, "triad", &person, "asked for it", false).await.expect("erases");
    assert!(whole(&store).await);
    let left = listed(&store).await.remove(0);
    assert_eq!((left.student.as_str(), left.answers), ("", serde_json::json!({})));
    let change = sqlx::query("UPDATE submission SET answers = '7'").execute(&store.pools.writer).await;
    assert!(change.is_err(), "records are kept as before");
}

/// What is missing once and there the next time is kept by the same statement, whichever comes first.
#[tokio::test]
async fn what_may_be_missing_is_kept_in_any_order() {
    let store = fresh().await;
    store.hand_in(&with_work("Zebedee", 0)).await.expect("keeps");
    let person = store.person_named(HOME, "Zebedee").await.expect("looks").expect("Zebedee");
    let points = [None, Some(2.5), None, Some(0.1 + 0.2)];
    // One connection writes; it is taken again each time, with what it has prepared.
    for given in points {
        let said = Said::points(given, "looked at once more");
        store.decide(HOME, &person, &person, "pendulum", said).await.expect("decides");
    }
    let kept = store.decisions(HOME, None, None).await.expect("reads");
    assert_eq!(kept.iter().map(|one| one.points).collect::<Vec<_>>(), points);
    for until in [None, Some(Moment(5)), None] {
        let more = Extension { until, attempts: 1, reason: "ill".into(), by: String::new(), at: Moment(0) };
        store
            .extend(HOME, &person, &person, "pendulum", |_, _| Ok::<_, StoreError>(Some(more)))
            .await
            .expect("extends");
        let kept = store.extensions(HOME, None, None).await.expect("reads");
        assert_eq!(kept.iter().map(|(_, _, one)| one.until).collect::<Vec<_>>(), [until]);
    }
}

/// Of two who follow an invitation at once one comes in.
#[tokio::test(flavor = "multi_thread")]
async fn an_invitation_is_for_one() {
    let store = Arc::new(fresh().await);
    store.ensure_course(CLASS, "Mechanics").await.expect("makes");
    let token = store.invite(CLASS, "triad", Role::Owner).await.expect("invites");
    let come = |k: usize| {
        let (store, token) = (Arc::clone(&store), token.clone());
        let back = Return { phrase: "words".into(), link: format!("link {k}") };
        tokio::spawn(async move { store.accept(&token, &format!("Owner {k}"), &back).await.is_ok() })
    };
    let asked: Vec<_> = (0..8).map(come).collect();
    let mut came = 0;
    for one in asked {
        came += usize::from(one.await.expect("ends"));
    }
    assert_eq!((came, store.people(CLASS).await.expect("reads").len()), (1, 1));
}

#[tokio::test]
async fn records_can_be_neither_changed_nor_removed() {
    let store = fresh().await;
    let one = new("ada");
    hand_in(&store, &one).await.expect("keeps");
    assert!(hand_in(&store, &one).await.is_err(), "an id is used once");
    for change in [
        "UPDATE submission SET student = 'eve'",
        "DELETE FROM submission",
        "UPDATE verdict SET earned = 10",
        "DELETE FROM verdict",
        "UPDATE event SET actor = 'eve'",
        "DELETE FROM event",
        "UPDATE membership SET seed = 'eve'",
    ] {
        let refused = sqlx::query(change).execute(&store.pools.writer).await.expect_err(change).to_string();
        assert!(refused.contains("immutable") || refused.contains("kept"), "{change}: {refused}");
    }
}

#[tokio::test]
async fn a_prediction_is_made_once_and_a_forged_one_is_found() {
    let store = fresh().await;
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
        assert!(sqlx::query(change).execute(&store.pools.writer).await.is_err(), "{change}");
    }
    let mut transaction = store.write().await.expect("begins");
    database::stand_aside(&mut transaction, true).await.expect("stands aside");
    let forge = sqlx::query("UPDATE prediction SET choice = 'b'");
    forge.execute(&mut *transaction).await.expect("forges");
    database::stand_aside(&mut transaction, false).await.expect("keeps them again");
    transaction.commit().await.expect("commits");
    assert_eq!(
        store.faults().await.expect("looks").len(),
        2,
        "it is another, and the one that was made is missing"
    );
}

/// Each database prepares each statement.
#[tokio::test]
async fn every_statement_is_understood() {
    let store = fresh().await;
    let mut transaction = store.write().await.expect("begins");
    assert!(sql::ALL.len() > 70);
    for (name, text) in sql::ALL.iter().chain(sql::lti::ALL).chain(OF_COURSE) {
        let prepared = transaction.prepare(sqlx::SqlStr::from_static(text)).await;
        assert!(prepared.is_ok(), "{name}: {:?}", prepared.err());
        assert!(!text.contains('?') && !text.contains("rowid"), "{name} is in SQLite's words");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn of_two_hundred_at_once_three_attempts_are_three() {
    let store = Arc::new(fresh().await);
    let three = Policy { most_attempts: Some(3), ..Policy::default() };
    store.set_policy(HOME, "triad", "pendulum", &three, None).await.expect("sets");
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
    let store = Arc::new(fresh().await);
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

/// What comes between settling and keeping is known to the verdict that is kept, or it is not kept.
#[tokio::test]
async fn a_verdict_that_does_not_know_what_came_before_is_not_kept() {
    let store = fresh().await;
    store.hand_in(&new("ada")).await.expect("keeps");
    let refused = store.hand_in(&new("ada")).await;
    assert!(matches!(refused, Err(StoreError::Overtaken)), "{refused:?}");
    assert_eq!(ids(&store).await.len(), 1);
    store.hand_in(&HandIn { lesson: "another".into(), ..new("ada") }).await.expect("another lesson");
    hand_in(&store, &new("ada")).await.expect("keeps what knows");
    assert_eq!(ids(&store).await.len(), 3);
}
