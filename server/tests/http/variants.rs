//! Each student's own numbers: in the lesson, its hints, its scene, its states and its grade.

use serde_json::{Value, json};
use triad_lessons::{Course, reference_submission};

use crate::{get, post, server};

#[tokio::test]
async fn a_student_gets_the_same_numbers_everywhere() {
    let server = server();
    let course = Course::embedded().expect("a course");
    let own = course.lesson("joint-reactions").expect("the lesson").variant("ada").expect("a variant");
    let numbers: Vec<(&str, f64)> = own.parameters.iter().collect();
    let mass = numbers.iter().find(|(name, _)| *name == "m").expect("m").1;

    let by_name = get(&server, "/api/v1/lessons/joint-reactions?student=ada").await.json();
    let by_seed = get(&server, "/api/v1/lessons/joint-reactions?seed=ada").await.json();
    assert_eq!(by_name, by_seed);
    assert_eq!((&by_name["seed"], &by_name["has_variants"]), (&json!("ada"), &json!(true)));
    assert_eq!(by_name["scene"]["bodies"][0]["mass"], json!(mass));
    let prompt = by_name["exercise"]["questions"][0]["prompt_html"].as_str().expect("text");
    assert!(prompt.contains(&format!("m={mass}")), "{prompt}");
    let everybody = get(&server, "/api/v1/lessons/joint-reactions").await.json();
    assert_eq!((&everybody["seed"], &everybody["scene"]["bodies"][0]["mass"]), (&json!(""), &json!(2)));

    let session =
        post(&server, "/api/v1/sessions", json!({"lesson": "joint-reactions", "seed": "ada"})).await;
    assert_eq!(session.json()["bodies"][0]["mass"], json!(mass));

    let path = "/api/v1/lessons/joint-reactions/submissions";
    let mut right = serde_json::to_value(reference_submission(&own)).expect("JSON");
    right["student"] = json!("ada");
    let verdict = post(&server, path, &right).await.json();
    assert_eq!(verdict["passed"], true, "{verdict}");
    assert_eq!(verdict["provenance"]["parameters"]["m"], json!(mass));
    // The same answers under another name are about other numbers.
    right["student"] = json!("emmy");
    assert_eq!(post(&server, path, &right).await.json()["passed"], false);
    // A seed that was chosen counts before the name.
    right["seed"] = json!("ada");
    assert_eq!(post(&server, path, &right).await.json()["passed"], true);
    get(&server, &format!("/api/v1/lessons/joint-reactions?seed={}", "x".repeat(101)))
        .await
        .problem(422, "invalid-seed");
}

#[tokio::test]
async fn states_and_starters_are_handed_out() {
    let server = server();
    let base = "/api/v1/lessons/jacobian/questions/program";
    let states = |seed: &str| format!("{base}/states?seed={seed}");
    let ada = get(&server, &states("ada")).await.json();
    assert_eq!(ada["states"].as_array().map(Vec::len), Some(5));
    assert_eq!(ada["rows"].as_array().map(Vec::len), Some(21));
    assert_eq!(ada, get(&server, &states("ada")).await.json());
    assert_ne!(ada["states"], get(&server, &states("emmy")).await.json()["states"]);
    for (language, says) in [
        ("python", "import json"),
        ("octave", "jsondecode"),
        ("matlab", "jsondecode"),
        ("julia", "using JSON"),
    ] {
        let reply = get(&server, &format!("{base}/starters/{language}")).await;
        let text = String::from_utf8_lossy(&reply.bytes).into_owned();
        assert!(reply.media().starts_with("text/plain") && text.contains(says), "{language}: {text}");
    }
    get(&server, &format!("{base}/starters/cobol")).await.problem(404, "unknown-language");
    get(&server, "/api/v1/lessons/jacobian/questions/size/states").await.problem(404, "not-to-implement");
    get(&server, "/api/v1/lessons/jacobian/questions/zzz/states").await.problem(404, "unknown-question");
}

#[tokio::test]
async fn a_file_is_kept_but_a_list_only_tells_its_length() {
    let server = server();
    let path = "/api/v1/lessons/jacobian/submissions";
    let file = Course::embedded().expect("a course").lesson("jacobian").expect("the lesson").clone();
    let own = file.variant("ada").expect("a variant");
    let mut right = serde_json::to_value(reference_submission(&own)).expect("JSON");
    right["student"] = json!("ada");
    let verdict = post(&server, path, &right).await;
    assert_eq!((verdict.status.as_u16(), &verdict.json()["passed"]), (201, &Value::Bool(true)));
    let list = get(&server, "/api/v1/submissions?student=ada").await.json();
    let bytes = list[0]["answers"]["program"]["file"]["bytes"].as_u64().expect("a length");
    assert_eq!(bytes, right["answers"]["program"]["file"].as_str().expect("text").len() as u64);
}

#[tokio::test]
async fn a_student_gets_the_questions_that_were_drawn_and_no_others() {
    let server = server();
    let course = Course::embedded().expect("a course");
    let whole = course.lesson("exam").expect("the lesson");
    let own = whole.variant("ada").expect("a variant");
    let ids = |view: &Value| -> Vec<String> {
        let questions = view["exercise"]["questions"].as_array().expect("questions");
        questions.iter().map(|q| q["id"].as_str().unwrap_or_default().to_owned()).collect()
    };
    let drawn: Vec<String> = own.exercise.questions.iter().map(|q| q.id.clone()).collect();
    assert_eq!(ids(&get(&server, "/api/v1/lessons/exam?student=ada").await.json()), drawn);
    assert_eq!(ids(&get(&server, "/api/v1/lessons/exam").await.json()).len(), drawn.len());
    let path = "/api/v1/lessons/exam/submissions";
    let mut right = serde_json::to_value(reference_submission(&own)).expect("JSON");
    right["student"] = json!("ada");
    let verdict = post(&server, path, &right).await.json();
    assert_eq!((&verdict["passed"], &verdict["possible"]), (&json!(true), &json!(whole.exercise.possible())));
    let mut all = serde_json::to_value(reference_submission(whole)).expect("JSON");
    all["student"] = json!("ada");
    post(&server, path, &all).await.problem(422, "unknown-question");
}
