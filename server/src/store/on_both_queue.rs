//! What waits to be graded, in every database: see `on_both.rs`.

#![allow(clippy::expect_used, clippy::panic)] // a test that cannot go on says so

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use serde_json::json;

use super::on_both::fresh;
use super::tests::{hand_in, ids, new};
use super::*;
use crate::policy::Policy;

const LONG: Duration = Duration::from_mins(10);

fn waits(student: &str, lesson: &str) -> Accept {
    Accept {
        course: HOME.into(),
        lesson: lesson.into(),
        whose: Whose::Named,
        student: student.into(),
        body: json!({"answers": {}}).to_string(),
        seed: None,
        key: None,
        bundle: "the lesson".into(),
        request: "a-request".into(),
    }
}

async fn enqueue(store: &Store, student: &str, lesson: &str) -> String {
    match store.enqueue(&waits(student, lesson)).await.expect("takes it") {
        Accepted::Waiting(id) => id,
        Accepted::Kept(kept) => panic!("{kept:?}"),
    }
}

async fn claim(store: &Store, lease: Duration) -> Option<Job> {
    store.claim("a grader", lease).await.expect("claims")
}

/// What a grader would keep.
async fn verdict(store: &Store, job: &Job) -> HandIn {
    let plain = new(&job.accepted.student);
    let person = store.person_named(HOME, &job.accepted.student).await.expect("looks").expect("somebody");
    let (_, after) = store.earlier(HOME, &person, &job.accepted.lesson).await.expect("reads");
    let told = json!({"id": job.claim.id, "earned": 1.0, "gradable": true});
    HandIn {
        id: job.claim.id.clone(),
        lesson: job.accepted.lesson.clone(),
        key: job.accepted.key.clone(),
        verdict: told,
        after,
        ..plain
    }
}

async fn close(store: &Store, job: &Job) -> Result<(), StoreError> {
    store.close_claim(&job.claim, &verdict(store, job).await).await
}

#[tokio::test]
async fn fifty_of_one_do_not_delay_the_one_of_another() {
    let store = fresh().await;
    for k in 0..50 {
        enqueue(&store, "Ada", &format!("lesson {k}")).await;
    }
    let emmy = enqueue(&store, "Emmy", "pendulum").await;
    let place = store.waiting(&emmy).await.expect("reads").expect("waits");
    assert_eq!(place.before, Some(1));
    let first = claim(&store, LONG).await.expect("one");
    assert_eq!((first.accepted.student.as_str(), first.accepted.lesson.as_str()), ("Ada", "lesson 0"));
    assert_eq!(claim(&store, LONG).await.expect("one").claim.id, emmy);
    assert_eq!(claim(&store, LONG).await.expect("one").accepted.lesson, "lesson 1");
}

#[tokio::test]
async fn what_one_hands_in_to_a_lesson_is_graded_in_its_order() {
    let store = fresh().await;
    let (first, second) =
        (enqueue(&store, "Ada", "pendulum").await, enqueue(&store, "Ada", "pendulum").await);
    let job = claim(&store, LONG).await.expect("one");
    assert_eq!(job.claim.id, first);
    assert_eq!(claim(&store, LONG).await.map(|job| job.claim.id), None, "the second waits for the first");
    let refused = store.hand_in(&new("Ada")).await;
    assert!(matches!(refused, Err(StoreError::Behind)), "what is graded at once waits too: {refused:?}");
    close(&store, &job).await.expect("closes");
    let job = claim(&store, LONG).await.expect("now");
    assert_eq!(job.claim.id, second);
    close(&store, &job).await.expect("closes");
    assert_eq!(ids(&store).await, [second, first]);
    assert_eq!(store.gradings().await.expect("counts"), (0, 0));
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

/// Who stalls beyond the lease loses the claim: another one grades it, and what comes late is not kept.
#[tokio::test]
async fn a_claim_that_is_lost_keeps_no_verdict() {
    let store = fresh().await;
    enqueue(&store, "Ada", "pendulum").await;
    let stalled = claim(&store, Duration::ZERO).await.expect("one");
    tokio::time::sleep(Duration::from_millis(5)).await;
    let other = claim(&store, LONG).await.expect("it is taken over");
    assert_eq!((&other.claim.id, other.start), (&stalled.claim.id, 2));
    assert!(!store.renew(&stalled.claim, LONG).await.expect("asks"));
    assert!(store.renew(&other.claim, LONG).await.expect("asks"));
    assert!(matches!(close(&store, &stalled).await, Err(StoreError::Fenced)));
    assert_eq!(ids(&store).await.len(), 0);
    close(&store, &other).await.expect("closes");
    assert!(matches!(close(&store, &other).await, Err(StoreError::Fenced)), "once");
    assert_eq!(ids(&store).await.len(), 1);
}

/// What ends its graders is put aside after three starts, uses no attempt, and can be graded again.
#[tokio::test]
async fn what_ends_its_graders_is_put_aside() {
    let store = fresh().await;
    let once = Policy { most_attempts: Some(1), ..Policy::default() };
    store.set_policy(HOME, "triad", "pendulum", &once, None).await.expect("sets");
    let id = enqueue(&store, "Ada", "pendulum").await;
    for start in 1..=STARTS {
        assert_eq!(claim(&store, Duration::ZERO).await.expect("one").start, start);
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    assert!(claim(&store, LONG).await.is_none());
    assert_eq!(store.gradings().await.expect("counts"), (0, 1));
    assert_eq!(store.waiting(&id).await.expect("reads").expect("is there").before, None);
    let second = enqueue(&store, "Ada", "pendulum").await;
    assert_ne!(second, id, "no attempt is used");
    assert_eq!(store.grade_again().await.expect("again"), 1);
    assert_eq!(claim(&store, LONG).await.expect("one").claim.id, id);
    // What fails by itself waits a little, and is put aside as well.
    let job = claim(&store, LONG).await;
    assert!(job.is_none(), "the second waits for the first");
}

#[tokio::test]
async fn what_could_not_be_graded_waits_before_it_is_tried_again() {
    let store = fresh().await;
    let id = enqueue(&store, "Ada", "pendulum").await;
    let job = claim(&store, LONG).await.expect("one");
    store.give_back(&job, "the machine was busy").await.expect("gives back");
    assert!(claim(&store, LONG).await.is_none(), "not at once");
    assert_eq!(store.waiting(&id).await.expect("reads").expect("waits").before, Some(0));
    let last = Job { start: STARTS, ..job };
    store.give_back(&last, "late").await.expect("is heard");
    assert_eq!(store.gradings().await.expect("counts"), (1, 0), "who has no claim gives nothing back");
}

#[tokio::test]
async fn what_a_program_cannot_read_is_left_to_others_and_was_not_begun() {
    let store = fresh().await;
    let id = enqueue(&store, "Ada", "pendulum").await;
    for _ in 0..=STARTS {
        let job = loop {
            if let Some(job) = claim(&store, LONG).await {
                break job;
            }
            tokio::time::sleep(Duration::from_millis(20)).await;
        };
        assert_eq!((job.start, &job.claim.id), (1, &id));
        store.leave(&job, "of a later version").await.expect("leaves it");
        assert!(claim(&store, LONG).await.is_none(), "not at once");
    }
    assert_eq!(store.gradings().await.expect("counts"), (1, 0));
}

#[tokio::test(flavor = "multi_thread")]
async fn attempts_that_wait_are_counted() {
    let store = Arc::new(fresh().await);
    let three = Policy { most_attempts: Some(3), ..Policy::default() };
    store.set_policy(HOME, "triad", "pendulum", &three, None).await.expect("sets");
    hand_in(&store, &new("Ada")).await.expect("keeps");
    let sent: Vec<_> = (0..40)
        .map(|k| {
            let store = Arc::clone(&store);
            let one = Accept { key: Some(format!("{}", k % 20)), ..waits("Ada", "pendulum") };
            tokio::spawn(async move { store.enqueue(&one).await })
        })
        .collect();
    let (mut taken, mut refused) = (BTreeSet::new(), 0);
    for one in sent {
        match one.await.expect("ends") {
            Ok(Accepted::Waiting(id)) => drop(taken.insert(id)),
            Err(StoreError::BeingGraded) => refused += 1,
            other => panic!("{other:?}"),
        }
    }
    // A key that was taken is told again.
    assert_eq!(taken.len(), 2);
    assert!((36..=38).contains(&refused), "{refused}");
}

/// As many graders as there are: each submission is claimed by one.
#[tokio::test(flavor = "multi_thread")]
async fn many_who_claim_at_once_get_each_one_once() {
    let store = Arc::new(fresh().await);
    for k in 0..20 {
        enqueue(&store, &format!("student {k}"), "pendulum").await;
    }
    let claiming: Vec<_> = (0..8)
        .map(|_| {
            let store = Arc::clone(&store);
            tokio::spawn(async move {
                let mut mine = Vec::new();
                while let Some(job) = claim(&store, LONG).await {
                    close(&store, &job).await.expect("closes");
                    mine.push(job.claim.id);
                }
                mine
            })
        })
        .collect();
    let mut all = Vec::new();
    for one in claiming {
        all.extend(one.await.expect("ends"));
    }
    // Whoever passes over the last that another holds goes home; nothing is left or done twice.
    assert_eq!((all.len(), all.iter().collect::<BTreeSet<_>>().len()), (20, 20));
    assert_eq!(ids(&store).await.len(), 20);
    assert_eq!(store.faults().await.expect("looks"), Vec::<String>::new());
}

/// The lesson that is to judge, with its SHA-256.
fn mended(sha256: &str) -> [(String, String, String); 1] {
    [(sha256.to_owned(), "pendulum".to_owned(), "the mended lesson".to_owned())]
}

/// So many submissions that a regrade asks about, and the SHA-256 of the lesson that is to judge them.
async fn regraded(store: &Store, count: usize) -> String {
    let mut asked = Vec::new();
    let lesson = hash::sha256("the mended lesson");
    for k in 0..count {
        let kept = hand_in(store, &new(&format!("student {k}"))).await.expect("keeps");
        let submission = kept.verdict["id"].as_str().expect("an id").to_owned();
        asked.push(NewJudging { submission, lesson_sha256: lesson.clone() });
    }
    store.ask_judgings(&mended(&lesson), &asked).await.expect("asks");
    lesson
}

async fn again(store: &Store, lease: Duration, all_the_same: bool) -> Vec<Judging> {
    store.claim_judgings(lease, 8, all_the_same).await.expect("claims")
}

#[tokio::test]
async fn a_student_goes_before_a_thousand_that_are_judged_again() {
    let store = fresh().await;
    let lesson = regraded(&store, 1000).await;
    let batch = again(&store, LONG, false).await;
    assert_eq!((batch.len(), store.students_wait().await.expect("looks")), (8, false));

    // As soon as somebody hands in nothing more is begun, and what is claimed is left.
    let ada = enqueue(&store, "Ada", "pendulum").await;
    assert!(store.students_wait().await.expect("looks"));
    assert_eq!(again(&store, LONG, false).await, []);
    let done: Vec<_> = batch[..1].iter().map(|one| (one.clone(), "right".to_owned())).collect();
    store.keep_judgings(&done, &batch[1..]).await.expect("keeps");
    assert_eq!(store.judgings_open(&lesson).await.expect("counts"), 999);
    let job = claim(&store, LONG).await.expect("hers");
    assert_eq!(job.claim.id, ada);
    // While hers is graded nobody waits: whoever has time goes on, with what was left first.
    let next = again(&store, LONG, false).await;
    assert!(batch[1..].iter().all(|left| next.iter().any(|one| one.submission == left.submission)));
    close(&store, &job).await.expect("closes");
}

/// Who ends in the middle holds nothing up, what is judged twice is kept once, and what ends its graders is told.
#[tokio::test]
async fn what_is_judged_again_is_judged_whatever_ends() {
    let store = fresh().await;
    let lesson = regraded(&store, 20).await;
    let first = again(&store, Duration::ZERO, false).await;
    tokio::time::sleep(Duration::from_millis(5)).await;
    let second = again(&store, Duration::ZERO, false).await;
    let names = |batch: &[Judging]| batch.iter().map(|one| one.submission.clone()).collect::<BTreeSet<_>>();
    assert_eq!(names(&first), names(&second), "they are claimed anew");
    for (batch, word) in [(&second, "kept"), (&first, "late")] {
        let done: Vec<_> = batch[..4].iter().map(|one| (one.clone(), word.to_owned())).collect();
        store.keep_judgings(&done, &[]).await.expect("keeps");
    }
    let told = store.judged(&lesson).await.expect("reads");
    assert_eq!(told.iter().map(|one| one.told.as_deref()).collect::<Vec<_>>(), [Some("kept"); 4]);
    tokio::time::sleep(Duration::from_millis(5)).await;
    // The other four were begun twice; the third start is the last.
    assert_eq!(again(&store, Duration::ZERO, false).await.len(), 8);
    tokio::time::sleep(Duration::from_millis(5)).await;
    let told = store.judged(&lesson).await.expect("reads");
    assert_eq!((told.len(), told.iter().filter(|one| one.told.is_none()).count()), (8, 4));
    assert_eq!(store.judgings_open(&lesson).await.expect("counts"), 12);
    let put_aside = told.iter().find(|one| one.told.is_none()).expect("one").submission.clone();
    let asked = [NewJudging { submission: put_aside.clone(), lesson_sha256: lesson.clone() }];
    store.ask_judgings(&mended(&lesson), &asked).await.expect("asks again");
    assert_eq!(store.judgings_open(&lesson).await.expect("counts"), 13);
}

#[tokio::test(flavor = "multi_thread")]
async fn many_who_judge_again_get_each_one_once() {
    let store = Arc::new(fresh().await);
    let lesson = regraded(&store, 100).await;
    let judging: Vec<_> = (0..8)
        .map(|_| {
            let store = Arc::clone(&store);
            tokio::spawn(async move {
                let mut mine = Vec::new();
                loop {
                    let batch = again(&store, LONG, false).await;
                    if batch.is_empty() {
                        return mine;
                    }
                    mine.extend(batch.iter().map(|one| one.submission.clone()));
                    let done: Vec<_> = batch.into_iter().map(|one| (one, String::new())).collect();
                    store.keep_judgings(&done, &[]).await.expect("keeps");
                }
            })
        })
        .collect();
    let mut all = Vec::new();
    for one in judging {
        all.extend(one.await.expect("ends"));
    }
    assert_eq!((all.len(), all.iter().collect::<BTreeSet<_>>().len()), (100, 100));
    assert_eq!(store.judged(&lesson).await.expect("reads").len(), 100);
}
