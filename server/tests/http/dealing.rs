//! A class keeps the numbers that it was dealt when a lesson is mended, in the middle of it and in a regrade.

use std::sync::Arc;

use serde_json::{Value, json};
use triad::app::App;
use triad::dealing;
use triad::grader::{Grader, LEASE};
use triad::limits::Limits;
use triad_lessons::Course;

use crate::class::{Class, class_of};
use crate::regrade::course_with;
use crate::state;

/// So many that some of them have numbers that the new misconception refuses: it does so for more than half.
const STUDENTS: usize = 14;
const LESSON: &str = "/api/v1/lessons/simple-pendulum";

/// The pendulum knows one mistake more, which is nearly right for masses around 2.5 kg.
fn mended() -> Course {
    course_with("simple-pendulum/exercise.toml", |exercise| {
        let (head, tail) = exercise.split_once("id = \"tension-bottom\"").expect("the question");
        let new = "[[question.misconception]]\nid = \"by-eye\"\nvalue = \"29.43*m*(1+0.01*(m-2.5))\"\nfeedback = \"Look again.\"\n\n";
        let tail =
            tail.replacen("[[question.misconception]]", &format!("{new}[[question.misconception]]"), 1);
        format!("{head}id = \"tension-bottom\"{tail}")
    })
}

async fn masses(class: &Class, students: &[String]) -> Vec<f64> {
    let mut masses = Vec::new();
    for who in students {
        let lesson = class.ask("GET", LESSON, who, None).await.json();
        masses.push(lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass"));
    }
    masses
}

/// What would be worth less by a regrade.
async fn down(class: &Class, owner: &str) -> Value {
    let preview = "/api/v1/assignments/simple-pendulum/regrades";
    class.ask("POST", preview, owner, None).await.json()["counts"]["down"].clone()
}

#[tokio::test]
async fn who_has_looked_keeps_the_numbers_and_what_was_right_stays_right() {
    let app = state(Limits::default());
    let course = dealing::as_before(&app.store, (*app.course).clone()).await.expect("a course");
    let class = class_of(App { course: Arc::new(course), ..app }).await;
    // Where graders share the gradebook they judge again, too.
    let grader = Grader::new(Arc::clone(&class.app.store), Arc::default(), Arc::default(), 1, LEASE);
    let grading = tokio::spawn(grader.run());
    let owner = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await.0;
    let mut students = Vec::new();
    for k in 0..STUDENTS {
        students.push(class.join(&format!("Student {k}")).await.0);
    }
    let before = masses(&class, &students).await;
    let hand_in = async |class: &Class, k: usize| {
        let answer = json!({"value": format!("{:.4}", 29.43 * before[k]), "unit": "N"});
        let body = json!({"answers": {"tension-bottom": answer}});
        let verdict =
            class.ask("POST", &format!("{LESSON}/submissions"), &students[k], Some(body)).await.json();
        verdict["earned"].clone()
    };
    for k in 0..STUDENTS / 2 {
        assert_eq!(hand_in(&class, k).await, json!(3.0));
    }

    // As it would be without: some have other numbers, and their right answers are wrong.
    let plain = class.again(mended().into()).await;
    let differ = masses(&plain, &students).await.iter().zip(&before).filter(|(a, b)| a != b).count();
    assert!(differ > 0 && down(&plain, &owner).await.as_u64() > Some(0), "{differ}");

    let course = dealing::as_before(&class.app.store, mended()).await.expect("a course");
    let class = class.again(course.into()).await;
    assert_eq!(masses(&class, &students).await, before);
    assert_eq!(down(&class, &owner).await, json!(0));
    for k in STUDENTS / 2..STUDENTS {
        assert_eq!(hand_in(&class, k).await, json!(3.0), "on paper since before the change");
    }
    let rebuilt = triad::regrade::check(&class.app.store, triad::store::CLASS).await.expect("rebuilds");
    assert!(rebuilt.changed.is_empty() && rebuilt.same == STUDENTS, "{rebuilt:?}");

    // It is the version that dealt first which is kept, and no other for the sake of dealing.
    let kept = class.app.store.lesson_versions("jacobian").await.expect("versions");
    assert_eq!(kept.len(), 1);
    grading.abort();
}
