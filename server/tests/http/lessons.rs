//! Lessons, hints, submissions.

use axum::body::Body;
use axum::http::Request;
use serde_json::{Value, json};

use triad::app::App;
use triad::limits::Limits;
use triad::store::Store;
use triad_lessons::Course;

use crate::{get, post, send, server};

#[tokio::test]
async fn lessons_are_listed_and_shown_without_their_answers() {
    let server = server();
    let list = get(&server, "/api/v1/lessons").await.json();
    let slugs: Vec<&str> =
        list.as_array().expect("a list").iter().filter_map(|l| l["slug"].as_str()).collect();
    assert!(slugs.contains(&"simple-pendulum"), "{slugs:?}");
    for slug in slugs {
        let reply = get(&server, &format!("/api/v1/lessons/{slug}")).await;
        assert_eq!(reply.status, 200);
        let lesson = reply.json();
        assert!(lesson["html"].as_str().is_some_and(|html| html.len() > 200));
        let questions = lesson["exercise"]["questions"].as_array().expect("questions");
        assert!(questions.len() >= 3);
        for question in questions {
            for secret in ["reference", "right", "misconceptions", "feedback", "provenance", "source"] {
                assert!(question.get(secret).is_none(), "{slug}: {secret} left the server");
            }
            let hints = question["hints_available"].as_u64().expect("a count");
            let id = question["id"].as_str().expect("an id");
            for k in 1..=hints {
                let hint = get(&server, &format!("/api/v1/lessons/{slug}/questions/{id}/hints/{k}")).await;
                assert!(hint.json()["html"].is_string(), "{slug} {id} {k}");
            }
            let beyond = format!("/api/v1/lessons/{slug}/questions/{id}/hints/{}", hints + 1);
            get(&server, &beyond).await.problem(404, "unknown-hint");
        }
    }
}

#[tokio::test]
async fn what_does_not_exist_is_answered_with_what_does() {
    let server = server();
    let problem = get(&server, "/api/v1/lessons/simple-pendulm").await.problem(404, "unknown-lesson");
    assert!(problem["hint"].as_str().is_some_and(|hint| hint.contains("simple-pendulum")), "{problem}");
    get(&server, "/api/v1/lessons/simple-pendulum/questions/zzz/hints/1")
        .await
        .problem(404, "unknown-question");
    get(&server, "/api/v1/lessons/simple-pendulum/questions/period/hints/x")
        .await
        .problem(400, "invalid-address");
    post(&server, "/api/v1/lessons/zzz/submissions", json!({"answers": {}}))
        .await
        .problem(404, "unknown-lesson");
}

/// The answer that passes, as the lessons' own check makes it.
fn reference() -> Value {
    let course = Course::embedded().expect("a course");
    let lesson = course.lesson("simple-pendulum").expect("the lesson");
    let mut submission = triad_lessons::reference_submission(lesson);
    submission.student = Some("ada".into());
    // The numbers that everybody sees.
    submission.seed = Some(String::new());
    serde_json::to_value(&submission).expect("JSON")
}

#[tokio::test]
async fn a_right_and_a_wrong_submission_are_graded_kept_and_listed() {
    let server = server();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let right = post(&server, path, reference()).await;
    assert_eq!(right.status, 201, "{}", right.json());
    let verdict = right.json();
    assert_eq!(verdict["passed"], true);
    assert_eq!(verdict["earned"], verdict["possible"]);
    assert_eq!(verdict["student"], "ada");
    assert!(verdict["id"].is_string() && verdict["submitted_at"].is_string());
    assert!(verdict["provenance"]["lesson_hash"].is_string());

    let wrong = post(
        &server,
        path,
        json!({"student": "eve", "answers": {"period": {"value": "9.0000", "unit": "s"}}}),
    )
    .await;
    assert_eq!(wrong.json()["passed"], false);

    // Who has passed is told the right answers; others are not, and what is listed for everybody has none.
    let opened = |document: &Value| document.to_string().matches("reference_html").count();
    assert_eq!(opened(&verdict), 5, "{verdict}");
    assert_eq!(opened(&wrong.json()), 0);
    assert_eq!(opened(&get(&server, "/api/v1/submissions").await.json()), 0);

    let all = get(&server, "/api/v1/submissions").await.json();
    assert_eq!(all.as_array().map(Vec::len), Some(2));
    let ada = get(&server, "/api/v1/submissions?student=ada&lesson=simple-pendulum&limit=5").await.json();
    assert_eq!(ada[0]["id"], verdict["id"]);
    assert!(ada[0]["answers"]["period"].is_object());
    assert_eq!(get(&server, "/api/v1/submissions?student=nobody").await.json(), json!([]));
}

#[tokio::test]
async fn text_where_a_number_belongs_is_kept_and_uses_no_attempt() {
    let server = server();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let body = json!({"student": "ada", "answers": {"period": {"value": "quite long", "unit": "s"}}});
    let reply = post(&server, path, body).await;
    assert_eq!(reply.status, 200);
    let verdict = reply.json();
    assert_eq!(verdict["gradable"], false);
    let marks: Vec<&Value> =
        verdict["questions"].as_array().expect("questions").iter().map(|q| &q["verdict"]).collect();
    assert!(marks.contains(&&json!("invalid")), "{marks:?}");
    let kept = get(&server, "/api/v1/submissions").await.json();
    assert_eq!(
        (&kept[0]["id"], &kept[0]["answers"]["period"]["value"]),
        (&verdict["id"], &json!("quite long"))
    );
}

#[tokio::test]
async fn a_request_that_is_repeated_is_told_the_same_verdict() {
    let server = server();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let ask = async |key: &str, body: Value| {
        let request =
            Request::post(path).header("content-type", "application/json").header("idempotency-key", key);
        send(&server, request.body(Body::from(body.to_string())).expect("a request")).await
    };
    let first = ask("k1", reference()).await;
    let again = ask("k1", reference()).await;
    assert_eq!((first.status.as_u16(), first.json()), (201, again.json()));
    assert_ne!(ask("k2", reference()).await.json()["id"], first.json()["id"]);
    assert_eq!(get(&server, "/api/v1/submissions").await.json().as_array().map(Vec::len), Some(2));
    ask(&"k".repeat(201), reference()).await.problem(400, "invalid-key");
}

#[tokio::test]
async fn spellings_of_a_name_are_one_student() {
    let server = server();
    let path = "/api/v1/lessons/joint-reactions/submissions";
    let handed =
        async |student: &str| post(&server, path, json!({"student": student, "answers": {}})).await.json();
    let (composed, decomposed) = (handed("Zo\u{eb}").await, handed(" Zoe\u{308} ").await);
    assert_eq!(composed["student"], decomposed["student"]);
    assert_eq!(composed["provenance"], decomposed["provenance"], "the same numbers");
    let listed = get(&server, "/api/v1/submissions?student=ZO%C3%8B").await.json();
    assert_eq!(listed.as_array().map(Vec::len), Some(2));
}

#[tokio::test]
async fn what_is_typed_is_read_back_without_being_judged() {
    let server = server();
    let read = async |question: &str, body: Value| {
        post(&server, &format!("/api/v1/lessons/simple-pendulum/questions/{question}/reading"), body).await
    };
    let tension = read("tension-bottom", json!({"value": "3*9.81 newton"})).await.json();
    assert_eq!(tension, json!({"text": "29.43 newton"}));
    let wrong = read("tension-bottom", json!({"value": "1", "unit": "kN"})).await.json();
    assert_eq!(wrong, json!({"text": "1 kN = 1000 N"}), "right or wrong, it looks the same");
    let problem = read("tension-bottom", json!({"value": "lots"})).await.json();
    assert!(problem["problem"].as_str().expect("words").contains("not a number"), "{problem}");
    let pasted = read("force-on-ground", json!({"value": "array([1., 2., 3.]) N"})).await.json();
    assert_eq!(pasted, json!({"text": "(1, 2, 3) N", "cells": ["1. N", "2. N", "3. N"]}));
    read("sign-of-lambda", json!({"value": "a"})).await.problem(404, "not-typed");
    read("nothing", json!({"value": "1"})).await.problem(404, "unknown-question");
}

#[tokio::test]
async fn the_table_that_a_question_asks_for_is_written_of_a_run_of_ones_own() {
    let server = server();
    let lesson = get(&server, "/api/v1/lessons/verification?student=Ada").await.json();
    let mut scene = lesson["scene"].clone();
    // The question asks for a rod of one's own length, which its text tells.
    let questions = lesson["exercise"]["questions"].as_array().expect("questions");
    let asked = questions.iter().find(|question| question["id"] == "your-run").expect("it");
    let start = asked["prompt_html"].as_str().and_then(|text| text.split("x=").nth(1)).expect("the start");
    let start: f64 = start.split('<').next().expect("a number").parse().expect("a number");
    scene["bodies"][0]["position"] = json!([start, 0, 0]);
    let path = "/api/v1/lessons/verification/questions/your-run/table";
    let table = async |scene: &Value| {
        let reply = post(&server, path, json!({"scene": scene})).await;
        assert!(reply.status == 200 && reply.media().starts_with("text/csv"), "{}", reply.media());
        String::from_utf8(reply.bytes.to_vec()).expect("text")
    };
    let judged = async |text: &str| {
        let answers = json!({"your-run": {"file": text}});
        let body = json!({"student": "Ada", "answers": answers});
        let verdict = post(&server, "/api/v1/lessons/verification/submissions", body).await.json();
        let all = verdict["questions"].as_array().expect("questions").clone();
        all.iter().find(|question| question["id"] == "your-run").expect("it")["verdict"].clone()
    };
    let text = table(&scene).await;
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        (lines[0], lines[1], lines.len()),
        ("t,x,y", format!("0,{start},0").as_str(), 1002),
        "a row each 0.01 s, as the scene says"
    );
    assert_eq!(judged(&text).await, "right");
    // What was changed in the run is in its table: it is graded like any other.
    let mut other = scene.clone();
    other["gravity"] = json!([0, -3, 0]);
    other["simulation"]["every"] = json!(100);
    let text = table(&other).await;
    assert_eq!(text.lines().count(), 42, "often enough to be read, whatever the scene says");
    assert_eq!(judged(&text).await, "wrong");
    let mut nameless = scene.clone();
    nameless["bodies"][0]["name"] = json!("weight");
    nameless["joints"][0]["body_j"] = json!("weight");
    let problem = post(&server, path, json!({"scene": nameless})).await.problem(422, "not-measured");
    assert!(problem["detail"].as_str().is_some_and(|detail| detail.contains("bob")), "{problem}");
    for (question, code) in [("blind", "no-table-asked"), ("nothing", "unknown-question")] {
        let path = format!("/api/v1/lessons/verification/questions/{question}/table");
        post(&server, &path, json!({"scene": scene})).await.problem(404, code);
    }
}

#[tokio::test]
async fn a_submission_must_say_whose_it_is_and_what_it_answers() {
    let server = server();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    post(&server, path, json!({"answers": {}})).await.problem(422, "invalid-student");
    post(&server, path, json!({"student": "x".repeat(101), "answers": {}}))
        .await
        .problem(422, "invalid-student");
    let problem = post(&server, path, json!({"student": "a", "answers": {"period": {"vlaue": "1"}}})).await;
    let problem = problem.problem(422, "submission-unreadable");
    assert_eq!(problem["errors"][0]["pointer"], "#/answers/period/vlaue");
    let problem = post(&server, path, json!({"student": "a", "answers": {"zzz": {"value": "1"}}})).await;
    assert_eq!(problem.problem(422, "unknown-question")["errors"][0]["pointer"], "#/answers/zzz");
}

/// Whatever comes at once, each verdict knows of all submissions before it: it comes out again when all are graded in turn.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn submissions_at_once_are_settled_one_after_the_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = Store::open(&folder.path().join("grades.db")).await.expect("opens");
    let app = App::new(Course::embedded().expect("a course"), store, Limits::default());
    let server = triad::app(app.clone());
    let sent: Vec<_> = (0..24)
        .map(|k| {
            let server = server.clone();
            // Wrong ones, each another: how many there were is told with each.
            let value = format!("{k}.5");
            let body = json!({"student": "ada", "seed": "", "answers": {"tension-bottom": {"value": value, "unit": "N"}}});
            tokio::spawn(async move { post(&server, "/api/v1/lessons/simple-pendulum/submissions", body).await.status })
        })
        .collect();
    for one in sent {
        assert_eq!(one.await.expect("answers"), 201);
    }
    let rebuilt = triad::regrade::check(&app.store, triad::store::HOME).await.expect("rebuilds");
    assert_eq!((rebuilt.same, &rebuilt.changed), (24, &Vec::new()));
}
