//! Pools of questions: each student gets some, the same for ever, worth as much as anybody's.

use std::collections::{BTreeMap, BTreeSet};

use super::course;
use crate::files::{Files, skeleton};
use crate::{Course, Submission, grade, reference_submission};

/// A lesson with pools: five of eight, three of five, and two questions for everybody.
const SLUG: &str = "find-the-mistake";
/// Students who get a hand.
const STUDENTS: usize = 60;

fn ids(lesson: &crate::Lesson) -> Vec<String> {
    lesson.exercise.questions.iter().map(|q| q.id.clone()).collect()
}

#[test]
fn everybody_gets_as_many_worth_as_much_and_all_are_asked_of_somebody() {
    let course = course();
    let whole = course.lesson(SLUG).unwrap();
    let (mut seen, mut hands) = (BTreeSet::new(), BTreeSet::new());
    for k in 0..STUDENTS {
        let own = whole.variant_in(&format!("student-{k}"), "secret").unwrap();
        assert_eq!(ids(&own), ids(&whole.variant_in(&format!("student-{k}"), "secret").unwrap()));
        let of =
            |pool: Option<&str>| own.exercise.questions.iter().filter(|q| q.pool.as_deref() == pool).count();
        assert_eq!([of(Some("numbers")), of(Some("glance")), of(None)], [5, 3, 2]);
        let points: f64 = own.exercise.questions.iter().map(|q| q.points).sum();
        assert!((points - whole.exercise.possible()).abs() < 1e-12, "{points}");
        let verdict = grade(&own, &reference_submission(&own)).unwrap();
        assert!(verdict.passed && (verdict.possible - points).abs() < 1e-12);
        seen.extend(ids(&own));
        hands.insert(ids(&own));
    }
    assert_eq!(seen.len(), whole.exercise.questions.len());
    // Of 56 times 10 hands, 60 students see nearly 60.
    assert!(hands.len() > 50, "{}", hands.len());
}

#[test]
fn what_was_not_drawn_is_neither_shown_nor_graded() {
    let course = course();
    let whole = course.lesson(SLUG).unwrap();
    for own in [whole.variant("ada").unwrap(), whole.for_nobody()] {
        let view = serde_json::to_string(&own.public_view()).unwrap();
        let drawn = ids(&own);
        assert_eq!(drawn.len(), 10);
        for other in whole.exercise.questions.iter().filter(|q| !drawn.contains(&q.id)) {
            assert!(!view.contains(&format!("\"{}\"", other.id)), "{}", other.id);
            let all = reference_submission(whole).answers;
            let answers = BTreeMap::from([(other.id.clone(), all[&other.id].clone())]);
            let error = grade(&own, &Submission { answers, ..Submission::default() }).unwrap_err();
            assert_eq!(error.code(), "unknown-question");
        }
    }
}

/// The skeleton's lesson with this at the head of its exercise and a pool for one of its questions.
fn refused(head: &str, pools: &[(&str, &str)]) -> String {
    let mut files = Files::new();
    files.insert("course.toml".to_owned(), b"format_version = 1\ntitle = \"x\"\n".to_vec());
    for (name, text) in skeleton::files(1, "own") {
        let mut text = text.replace("TODO", "With care.");
        if name == "exercise.toml" {
            for (id, pool) in pools {
                text = text.replacen(
                    &format!("id = \"{id}\"\n"),
                    &format!("id = \"{id}\"\npool = \"{pool}\"\n"),
                    1,
                );
            }
            text = text.replacen("[parameters]", &format!("[draw]\n{head}\n\n[parameters]"), 1);
        }
        files.insert(format!("01-own/{name}"), text.into_bytes());
    }
    Course::from_files(files).map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn a_pool_that_cannot_be_dealt_fairly_is_refused() {
    assert_eq!(refused("some = 1", &[("why", "some")]), "");
    for (head, pools, says) in [
        ("", &[("why", "some")][..], "nothing is drawn from its pool some"),
        ("some = 2", &[("why", "some")], "2 of the 1 questions of the pool some are drawn"),
        ("some = 0", &[("why", "some")], "0 of the 1 questions of the pool some are drawn"),
        ("some = 1", &[("why", "some"), ("force", "some")], "it has other points than force"),
    ] {
        let error = refused(head, pools);
        assert!(error.contains(says), "{says}: {error}");
    }
}
