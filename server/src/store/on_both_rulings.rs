//! What people set, allow and decide, changed in the tables alone, in every database: see `on_both.rs`.

#![allow(clippy::expect_used)] // a test that cannot go on says so

use sqlx::{AnyConnection, AssertSqlSafe};

use super::kind::Kind;
use super::on_both::fresh;
use super::tests::{hand_in, new};
use super::*;
use crate::policy::{Extension, Moment, Policy};

const LESSON: &str = "pendulum";

/// A course in which everything was set, allowed, decided, and some of it taken back; of two people.
async fn ruled() -> Store {
    let store = fresh().await;
    let mut people = Vec::new();
    for name in ["ada", "emmy"] {
        hand_in(&store, &new(name)).await.expect("keeps");
        people.push(store.person_named(HOME, name).await.expect("looks").expect("somebody"));
    }
    let [ada, emmy] = &people[..] else { unreachable!() };
    for most in [1, 3] {
        let policy = Policy { most_attempts: Some(most), falling: vec![1.0, 0.3], ..Policy::default() };
        store.set_policy(HOME, "triad", LESSON, &policy, None).await.expect("sets");
    }
    store.release(HOME, "triad", LESSON, true).await.expect("releases");
    store.release(HOME, "triad", "screw", true).await.expect("releases");
    store.release(HOME, "triad", "screw", false).await.expect("takes it back");
    for who in [ada, emmy] {
        let given = Extension {
            until: Some(Moment(4_000_000_000_123)),
            attempts: 2,
            reason: "was ill".into(),
            by: String::new(),
            at: Moment(0),
        };
        let give = |_: &Policy, _| Ok::<_, StoreError>(Some(given));
        store.extend(HOME, ada, who, LESSON, give).await.expect("allows");
    }
    store.extend(HOME, ada, emmy, LESSON, |_, _| Ok::<_, StoreError>(None)).await.expect("takes it back");
    for points in [Some(0.1 + 0.2), Some(-0.0), None] {
        store.decide(HOME, ada, emmy, LESSON, Said::points(points, "so")).await.expect("decides");
    }
    let mark = Said {
        kind: DecisionKind::Mark,
        question: Some("why"),
        points: Some(2.0),
        text: "clear and complete",
    };
    store.decide(HOME, ada, emmy, LESSON, mark).await.expect("marks");
    store
}

/// Takes away what keeps decisions, until the transaction ends.
async fn unguard(connection: &mut AnyConnection) {
    let kept = [
        ("decision_is_immutable", "decision"),
        ("decision_is_kept", "decision"),
        ("lesson_is_immutable", "lesson_version"),
    ];
    for (trigger, table) in kept {
        let on = if Kind::of(connection) == Kind::Postgres { format!("ON {table}") } else { String::new() };
        let drop = sqlx::query(AssertSqlSafe(format!("DROP TRIGGER {trigger} {on}")));
        drop.execute(&mut *connection).await.expect(trigger);
    }
}

#[tokio::test]
async fn what_was_set_allowed_or_decided_and_changed_in_the_tables_is_found() {
    let store = ruled().await;
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
    let decisions = "the decision about ";
    for (change, told, places) in [
        ("UPDATE assignment SET policy = '{}' WHERE slug = 'pendulum'", "the policy of pendulum is not", 1),
        (
            "UPDATE assignment SET policy = '{\"most_attempts\":9}' WHERE slug = 'screw'",
            "the policy of screw",
            1,
        ),
        ("UPDATE assignment SET released_at = NULL", "the results of pendulum are not released", 1),
        ("UPDATE assignment SET released_at = released_at + 1", "the results of pendulum are not", 1),
        ("UPDATE assignment SET released_at = 5 WHERE slug = 'screw'", "the results of screw", 1),
        ("UPDATE extension SET until = until + 1", "the extension of ", 1),
        ("UPDATE extension SET attempts = 3", "the extension of ", 1),
        ("UPDATE extension SET reason = 'was not ill'", "the extension of ", 1),
        ("UPDATE extension SET given_at = 0", "the extension of ", 1),
        ("DELETE FROM extension", "the extension of ", 1),
        (
            "INSERT INTO extension SELECT s.assignment, s.person, 1, 9, '', s.person, 1 FROM submission s \
          WHERE s.person NOT IN (SELECT person FROM extension)",
            "the extension of ",
            1,
        ),
        ("UPDATE decision SET amount = 0.3 WHERE amount > 0.1 AND amount < 1", decisions, 1),
        ("UPDATE decision SET amount = 1 WHERE amount IS NULL", decisions, 1),
        ("UPDATE decision SET kind = 'points' WHERE kind = 'mark'", decisions, 1),
        ("UPDATE decision SET question = 'other' WHERE kind = 'mark'", decisions, 1),
        ("UPDATE decision SET person = decided_by", decisions, 4),
        ("UPDATE decision SET n = 100 + n WHERE kind = 'mark'", decisions, 2),
        ("DELETE FROM decision WHERE kind = 'mark'", decisions, 1),
        ("UPDATE lesson_version SET bundle = '{}'", "the version ", 1),
    ] {
        let mut transaction = store.write().await.expect("begins");
        unguard(&mut transaction).await;
        let forge = sqlx::query(change).execute(&mut *transaction).await.expect(change);
        assert!(forge.rows_affected() > 0, "{change}");
        let faults = audit::faults(&mut transaction, HOME).await.expect("looks");
        assert_eq!(faults.len(), places, "{change}: {faults:?}");
        assert!(faults.iter().all(|fault| fault.starts_with(told)), "{change}: {faults:?}");
        transaction.rollback().await.expect("ends");
    }
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

/// What format 2 wrote into the log before policies had a form of their own.
#[tokio::test]
async fn decisions_and_bounds_of_format_2_are_read() {
    let store = ruled().await;
    let mut transaction = store.write().await.expect("begins");
    unguard(&mut transaction).await;
    let policy =
        "UPDATE assignment SET policy = '{\"most_attempts\":3}', released_at = NULL WHERE slug = 'pendulum'";
    let later = "DELETE FROM decision WHERE n > (SELECT MIN(n) FROM decision)";
    for change in [policy, "DELETE FROM extension", later] {
        sqlx::query(change).execute(&mut *transaction).await.expect(change);
    }
    let left = sqlx::query_as("SELECT n, person, decided_by, decided_at FROM decision");
    let left: (i64, String, String, i64) = left.fetch_one(&mut *transaction).await.expect("one is left");
    let (n, person, by, at) = (left.0, &left.1, &left.2, left.3);
    let mut rulings = rulings::Rulings::default();
    let mut entry = |n, what, subject, detail| {
        rulings.take(n, at, &log::Event { actor: by, what, subject, detail });
    };
    entry(n, rulings::DECIDED, person.as_str(), "[\"pendulum\",0.30000000000000004,\"so\"]");
    entry(n + 1, "bounded", LESSON, "any number of attempts");
    entry(n + 2, "bounded", LESSON, "3 attempts");
    let faults = rulings.faults(&mut transaction, HOME).await.expect("looks");
    assert_eq!(faults, Vec::<String>::new());
}
