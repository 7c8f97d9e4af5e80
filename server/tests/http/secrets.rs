//! No endpoint tells an answer: everything that a student can ask for is asked for, and every byte is searched.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use triad_lessons::exercise::Body;
use triad_lessons::submission::{Answer, Entry};
use triad_lessons::{Course, Lesson, reference_submission};

use crate::{Reply, get, post, server};

/// Significant digits from which a number is one of its own.
const DIGITS: usize = 8;

/// What must not be told: why a right answer is right, what slips are recognised, sources, the right numbers.
#[derive(Default)]
struct Secrets {
    texts: BTreeSet<String>,
    numbers: BTreeSet<String>,
}

/// The digits of all numbers in a text that have enough of them, cut to that many.
fn numbers_in(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for piece in text.split(|c: char| !(c.is_ascii_digit() || c == '.')) {
        let digits: String = piece.chars().filter(char::is_ascii_digit).collect();
        let digits = digits.trim_start_matches('0');
        // Zeros at the end and rounded ninths are no digits of their own.
        if digits.trim_end_matches('0').len() > DIGITS
            && !digits.contains("00000")
            && !digits.contains("99999")
        {
            found.insert(digits[..=DIGITS].to_owned());
        }
    }
    found
}

/// A text as it stands inside JSON.
fn inside(text: &str) -> String {
    serde_json::to_string(text).expect("JSON").trim_matches('"').to_owned()
}

fn secrets(lesson: &Lesson) -> Secrets {
    let mut secrets = Secrets::default();
    let mut text = |text: &str| {
        if text.len() > 20 {
            secrets.texts.insert(inside(text));
        }
    };
    let mut files = String::new();
    for question in &lesson.exercise.questions {
        text(&question.source);
        text(&question.right);
        match &question.body {
            Body::Quantity(q) => q.misconceptions.iter().for_each(|m| text(&m.feedback)),
            Body::Choice { options, .. } => options.iter().for_each(|o| text(&o.reason)),
            Body::Formula(f) => f.misconceptions.iter().for_each(|(.., feedback)| text(feedback)),
            Body::Model(m) => m.watches().iter().for_each(|w| text(&w.feedback)),
            Body::Implement(_) | Body::Trajectory(_) | Body::Tuning(_) => {}
        }
        if let Body::Quantity(q) = &question.body {
            for x in q.reference.iter().chain(q.misconceptions.iter().flat_map(|m| &m.value)) {
                files.push_str(&format!(" {x:.12} "));
            }
        }
    }
    for answer in reference_submission(lesson).answers.values() {
        // The table of a motion is what the run shows; the equations and the author's scene are not shown anywhere.
        if let Some(file) = answer.file.as_deref().filter(|f| f.starts_with('{')) {
            files.push_str(file);
        }
    }
    secrets.numbers = numbers_in(&files);
    secrets
}

/// Secrets that a response holds and that the lesson does not show anyway.
fn leaks(reply: &str, secrets: &Secrets, shown: &BTreeSet<String>, with_numbers: bool) -> Vec<String> {
    let mut found: Vec<String> =
        secrets.texts.iter().filter(|s| reply.contains(s.as_str())).cloned().collect();
    if with_numbers {
        let told = numbers_in(reply);
        found.extend(secrets.numbers.intersection(&told).filter(|n| !shown.contains(*n)).cloned());
    }
    found
}

fn text(reply: &Reply) -> String {
    String::from_utf8_lossy(&reply.bytes).into_owned()
}

/// What the author shows on purpose: text, scenario, prompts, hints. Numbers in it are no secrets.
fn shown(lesson: &Lesson) -> BTreeSet<String> {
    let view = lesson.public_view();
    let mut all = format!("{} {}", view.html, view.scene);
    for question in &lesson.exercise.questions {
        all += &question.prompt;
        all += &question.hints.join(" ");
    }
    // The equations contain the numbers of the states.
    for dealt in lesson.exercise.questions.iter().filter_map(|q| lesson.deal(&q.id)) {
        all += &serde_json::to_string(&dealt.expect("states")).expect("JSON");
    }
    for step in &view.steps {
        all += &step.html;
    }
    numbers_in(&all)
}

/// Every address of the interface that can be looked at, filled in for a lesson, a question and a session.
fn addresses(document: &Value, slug: &str, question: &str, session: &str, seed: &str) -> Vec<String> {
    let paths = document["paths"].as_object().expect("paths");
    let looked = paths.iter().filter(|(path, item)| item.get("get").is_some() && !path.ends_with("/stream"));
    let fill = |path: &String| {
        let id = if path.contains("/sessions/") { session } else { question };
        let path = path.replace("{slug}", slug).replace("{id}", id).replace("{k}", "1");
        let path = path.replace("{language}", "python").replace("{name}", "simple-pendulum");
        let whose = !seed.is_empty() && path.contains("/lessons/") && !path.contains("/starters/");
        if whose { format!("{path}?seed={seed}") } else { path }
    };
    looked.map(|(path, _)| fill(path)).collect()
}

/// Wrong answers to every question, one of each kind.
fn wrong(lesson: &Lesson) -> Value {
    let answers = lesson.exercise.questions.iter().map(|question| {
        let text = |t: &str| Some(Entry::Text(t.to_owned()));
        let answer = match &question.body {
            Body::Quantity(q) if q.size == [1, 1] => Answer { value: text("123456.7"), ..Answer::default() },
            Body::Quantity(q) => {
                let row = |n: usize| Entry::List(vec![Entry::Text("123456.7".to_owned()); n]);
                let value = match q.size {
                    [n, 1] => row(n),
                    [rows, columns] => Entry::List(vec![row(columns); rows]),
                };
                Answer { value: Some(value), ..Answer::default() }
            }
            Body::Choice { .. } => Answer::default(),
            Body::Formula(f) => {
                Answer { value: text(&format!("12345*{}", f.symbols[0])), ..Answer::default() }
            }
            Body::Implement(_) | Body::Model(_) | Body::Trajectory(_) => {
                Answer { file: Some("{\"states\": []}".to_owned()), ..Answer::default() }
            }
            Body::Tuning(t) => Answer {
                settings: Some(triad_lessons::submission::Settings {
                    integrator: t.integrators[0],
                    tolerance: Entry::Number(0.1),
                    baumgarte: None,
                }),
                ..Answer::default()
            },
        };
        (question.id.clone(), serde_json::to_value(answer).expect("JSON"))
    });
    Value::Object(answers.collect())
}

#[tokio::test]
async fn no_endpoint_tells_an_answer() {
    let server = server();
    let course = Course::embedded().expect("a course");
    let document = get(&server, "/api/openapi.json").await.json();
    let mut asked = 0;
    for (lesson, seed) in course.lessons().iter().flat_map(|lesson| [(lesson, ""), (lesson, "ada")]) {
        if !seed.is_empty() && !lesson.has_variants() {
            continue;
        }
        let own = if seed.is_empty() { lesson.clone() } else { lesson.variant(seed).expect("a variant") };
        let (secrets, shown) = (secrets(&own), shown(&own));
        let slug = &lesson.slug;
        let started = post(&server, "/api/v1/sessions", json!({"lesson": slug, "seed": seed})).await.json();
        let session = started["id"].as_str().unwrap_or("none").to_owned();
        for question in &own.exercise.questions {
            for path in addresses(&document, slug, &question.id, &session, seed) {
                let reply = get(&server, &path).await;
                // A run shows its numbers: reading them off it is what the student is meant to do.
                let run = path.contains("/sessions/") || path.contains("/scenes/");
                let found = leaks(&text(&reply), &secrets, &shown, !run);
                assert!(found.is_empty(), "{path} tells {found:?}");
                asked += 1;
            }
            for k in 1..=question.hints.len() {
                let path = format!("/api/v1/lessons/{slug}/questions/{}/hints/{k}?seed={seed}", question.id);
                let found = leaks(&text(&get(&server, &path).await), &secrets, &shown, true);
                assert!(found.is_empty(), "{path} tells {found:?}");
            }
        }
        let path = format!("/api/v1/lessons/{slug}/submissions");
        for answers in [json!({}), wrong(&own)] {
            let reply =
                post(&server, &path, json!({"student": "eve", "seed": seed, "answers": answers})).await;
            let found = leaks(&text(&reply), &secrets, &shown, true);
            assert!(found.is_empty(), "a wrong submission to {slug} is told {found:?}: {}", text(&reply));
        }
        crate::send(
            &server,
            axum::http::Request::delete(format!("/api/v1/sessions/{session}"))
                .body(axum::body::Body::empty())
                .expect("a request"),
        )
        .await;
    }
    println!("{asked} answers of the server searched");
    assert!(asked > 500);
}

/// The search finds what it is for: put into a reply, each kind of secret is seen.
#[test]
fn an_answer_in_a_reply_would_be_found() {
    let course = Course::embedded().expect("a course");
    for (slug, id, put) in [
        ("simple-pendulum", "period", "2.36784194757"),
        ("simple-pendulum", "tension-bottom", "Three times the weight: one part carries it"),
        ("slider-crank", "scene", "0.190787840283389"),
    ] {
        let lesson = course.lesson(slug).expect("the lesson");
        let clean = serde_json::to_string(&lesson.public_view()).expect("JSON");
        let found = |reply: &str| leaks(reply, &secrets(lesson), &shown(lesson), true);
        assert!(found(&clean).is_empty(), "{:?}", found(&clean));
        let whole = lesson.question(id).map(|q| q.right.clone()).unwrap_or_default();
        let put = if whole.starts_with(put) { inside(&whole) } else { put.to_owned() };
        assert!(!found(&format!("{clean}{{\"reference\": \"{put}\"}}")).is_empty(), "{slug} {put}");
    }
}
