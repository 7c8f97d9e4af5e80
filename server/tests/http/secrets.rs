//! No endpoint tells an answer: everything that a student can ask for is asked for, and every byte is searched.

use std::fmt::Write as _;

use std::collections::BTreeSet;
use std::net::SocketAddr;
use std::pin::Pin;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::Request;
use axum::middleware::Next;
use axum::response::Response;
use serde_json::{Value, json};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use triad_lessons::answers::{Answer, TypedValue};
use triad_lessons::exercise::QuestionBody as Question;
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
            Question::Quantity(q) => q.misconceptions.iter().for_each(|m| text(&m.feedback)),
            Question::Choice { options, .. } => options.iter().for_each(|o| text(&o.reason)),
            Question::Formula(f) => f.misconceptions.iter().for_each(|(.., feedback)| text(feedback)),
            Question::Explanation(e) => text(&e.example),
            Question::Model(m) => m.watches().iter().for_each(|w| text(&w.feedback)),
            Question::Diagram(_) | Question::Implement(_) | Question::Trajectory(_) | Question::Tuning(_) => {
            }
        }
        if let Question::Quantity(q) = &question.body {
            for x in q.reference.iter().chain(q.misconceptions.iter().flat_map(|m| &m.value)) {
                let _ = write!(files, " {x:.12} ");
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
    for dealt in lesson.exercise.questions.iter().filter_map(|q| lesson.instances(&q.id)) {
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
        let text = |t: &str| Some(TypedValue::Text(t.to_owned()));
        let answer = match &question.body {
            Question::Quantity(q) if q.size == [1, 1] => {
                Answer { value: text("123456.7"), ..Answer::default() }
            }
            Question::Quantity(q) => {
                let row = |n: usize| TypedValue::List(vec![TypedValue::Text("123456.7".to_owned()); n]);
                let value = match q.size {
                    [n, 1] => row(n),
                    [rows, columns] => TypedValue::List(vec![row(columns); rows]),
                };
                Answer { value: Some(value), ..Answer::default() }
            }
            // No words of one's own, to which a good explanation would be told.
            Question::Choice { .. } | Question::Explanation(_) => Answer::default(),
            Question::Formula(f) => {
                Answer { value: text(&format!("12345*{}", f.symbols[0])), ..Answer::default() }
            }
            Question::Diagram(d) => Answer { diagram: Some(d.reference[..1].to_vec()), ..Answer::default() },
            Question::Implement(_) | Question::Model(_) | Question::Trajectory(_) => {
                Answer { file: Some("{\"states\": []}".to_owned()), ..Answer::default() }
            }
            Question::Tuning(t) => Answer {
                settings: Some(triad_lessons::answers::RunSettings {
                    integrator: t.integrators[0],
                    tolerance: TypedValue::Number(0.1),
                    baumgarte: None,
                }),
                ..Answer::default()
            },
        };
        (question.id.clone(), serde_json::to_value(answer).expect("JSON"))
    });
    Value::Object(answers.collect())
}

/// Asks for everything that a student of these lessons can ask for; how much was asked, and what was told.
async fn crawl(server: &Router, lessons: &[Lesson]) -> (usize, Vec<String>) {
    let document = get(server, "/api/openapi.json").await.json();
    let (mut asked, mut told) = (0, Vec::new());
    for (lesson, seed) in lessons.iter().flat_map(|lesson| [(lesson, ""), (lesson, "ada")]) {
        if !seed.is_empty() && !lesson.has_variants() {
            continue;
        }
        let own = if seed.is_empty() { lesson.clone() } else { lesson.variant(seed).expect("a variant") };
        let (secrets, shown) = (secrets(&own), shown(&own));
        let mut search = |path: &str, reply: &Reply| {
            // A run shows its numbers: reading them off it is what the student is meant to do.
            let run =
                ["/sessions", "/scenes/", "/motion", "/pictures"].iter().any(|part| path.contains(part));
            let found = leaks(&text(reply), &secrets, &shown, !run);
            asked += 1;
            told.extend((!found.is_empty()).then(|| format!("{path} tells {found:?}")));
        };
        let slug = &lesson.slug;
        let path = "/api/v1/sessions";
        let reply = post(server, path, json!({"lesson": slug, "seed": seed})).await;
        search(path, &reply);
        let session = reply.json()["id"].as_str().unwrap_or("none").to_owned();
        let mut paths = vec!["/".to_owned(), format!("/lessons/{slug}"), "/api/openapi.json".to_owned()];
        for question in &own.exercise.questions {
            paths.extend(addresses(&document, slug, &question.id, &session, seed));
            paths.extend(
                (1..=question.hints.len()).map(|k| {
                    format!("/api/v1/lessons/{slug}/questions/{}/hints/{k}?seed={seed}", question.id)
                }),
            );
        }
        for path in paths {
            let reply = get(server, &path).await;
            search(&path, &reply);
        }
        let path = format!("/api/v1/lessons/{slug}/submissions");
        for answers in [json!({}), wrong(&own)] {
            let reply =
                post(server, &path, json!({"student": "eve", "seed": seed, "answers": answers})).await;
            search(&path, &reply);
        }
        crate::send(
            server,
            Request::delete(format!("/api/v1/sessions/{session}")).body(Body::empty()).expect("a request"),
        )
        .await;
    }
    (asked, told)
}

#[tokio::test]
async fn no_endpoint_tells_an_answer() {
    let course = Course::embedded().expect("a course");
    let (asked, told) = crawl(&server(), course.lessons()).await;
    assert!(told.is_empty(), "{told:#?}");
    println!("{asked} answers of the server searched");
    assert!(asked > 500);
}

/// The files of a site are in everybody's hands, for ever.
#[tokio::test]
async fn no_file_of_an_exported_site_tells_an_answer() {
    let course = Course::embedded().expect("a course");
    let lessons = course.lessons().to_vec();
    let files = triad::site::data(course).await.expect("the course as files");
    let mut told = Vec::new();
    for lesson in &lessons {
        let (secrets, shown) = (secrets(lesson), shown(lesson));
        for (path, bytes) in &files {
            // What one lesson asks, another may tell.
            let own = path.starts_with(&format!("data/lessons/{}.", lesson.slug))
                || path.starts_with(&format!("data/lessons/{}/", lesson.slug));
            if path.starts_with("data/lessons/") && !own {
                continue;
            }
            let found = leaks(&String::from_utf8_lossy(bytes), &secrets, &shown, own);
            told.extend((!found.is_empty()).then(|| format!("{path} tells {found:?}")));
        }
        let view: Value =
            serde_json::from_slice(&files[&format!("data/lessons/{}.json", lesson.slug)]).expect("JSON");
        let asked = view["exercise"]["questions"].as_array().map_or(0, Vec::len);
        assert_eq!(asked == 0, lesson.exercise.questions.is_empty(), "questions are shown: {}", lesson.slug);
        assert_eq!(view["predictions"], json!([]), "their results are told by a server");
    }
    assert!(told.is_empty(), "{told:#?}");
    assert!(files.len() > 2 * lessons.len(), "{}", files.len());
}

/// All that a WebSocket sends until the session is deleted, which is when it has told its state: the stream ends with a
/// message, not with silence. Frames of a server are not masked, so that texts stand in them as they are.
async fn overheard(server: &Router, address: SocketAddr, path: &str, session: &str) -> String {
    let mut socket = TcpStream::connect(address).await.expect("a connection");
    let hello = format!(
        "GET {path} HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
    );
    socket.write_all(hello.as_bytes()).await.expect("a request");
    let (mut heard, mut part) = (Vec::new(), vec![0; 64 << 10]);
    let mut deleted = false;
    loop {
        let count = socket.read(&mut part).await.expect("what is told");
        assert!(count > 0, "the stream broke off");
        heard.extend_from_slice(&part[..count]);
        let text = String::from_utf8_lossy(&heard);
        if text.contains(r#"{"type":"closed"}"#) {
            return text.into_owned();
        }
        // A state, and blocks of the recording before or after it.
        if !deleted && text.contains("frames_encoded") && text.contains("RRF2") {
            deleted = true;
            let gone = Request::delete(session).body(Body::empty()).expect("a request");
            crate::send(server, gone).await;
        }
    }
}

#[tokio::test]
async fn no_stream_tells_an_answer() {
    let (course, server) = (Course::embedded().expect("a course"), server());
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
    let address = listener.local_addr().expect("an address");
    let served = server.clone();
    tokio::spawn(async move { axum::serve(listener, served).await });
    for lesson in course.lessons() {
        let state = post(&server, "/api/v1/sessions", json!({"lesson": lesson.slug})).await.json();
        let session = state["links"]["self"].as_str().expect("a session").to_owned();
        post(&server, &format!("{session}/play"), json!({})).await;
        let stream = format!("{}?recording=true", state["links"]["stream"].as_str().expect("a stream"));
        let heard = overheard(&server, address, &stream, &session).await;
        assert!(
            heard.contains("101 Switching Protocols") && heard.contains("frames"),
            "{}: {heard}",
            lesson.slug
        );
        let told = leaks(&heard, &secrets(lesson), &BTreeSet::new(), false);
        assert!(told.is_empty(), "{} tells {told:?}", lesson.slug);
    }
}

/// A server that lets something slip at one address is caught by the same crawl.
#[tokio::test]
async fn a_leak_at_any_address_is_found() {
    let course = Course::embedded().expect("a course");
    let lesson = course.lesson("simple-pendulum").expect("the lesson");
    let right = inside(&lesson.question("tension-bottom").expect("the question").right);
    for (path, leak) in [
        ("/api/v1/lessons", "2.36784194757"),
        ("/api/v1/lessons/simple-pendulum", "2.36784194757"),
        ("/api/v1/lessons/simple-pendulum/questions/period/hints/1", "2.36784194757"),
        ("/api/v1/lessons/simple-pendulum/submissions", "2.36784194757"),
        ("/api/openapi.json", "2.36784194757"),
        ("/lessons/simple-pendulum", "2.36784194757"),
        ("/api/v1/sessions", right.as_str()),
    ] {
        let leaking = server().layer(axum::middleware::from_fn(leak_at(path, leak)));
        let (_, told) = crawl(&leaking, std::slice::from_ref(lesson)).await;
        assert!(!told.is_empty(), "{leak} at {path} was not found");
        assert!(told.iter().all(|t| t.split(['?', ' ']).next() == Some(path)), "{told:#?}");
    }
}

/// Puts a text into what is answered at one address, as a careless field would.
fn leak_at(
    path: &str,
    leak: &str,
) -> impl Fn(Request<Body>, Next) -> Pin<Box<dyn Future<Output = Response> + Send>> + Clone + use<> {
    let (path, leak) = (path.to_owned(), format!(" {{\"leak\": \"{leak}\"}}"));
    move |request, next| {
        let here = request.uri().path() == path;
        let leak = leak.clone();
        Box::pin(async move {
            let response = next.run(request).await;
            if !here {
                return response;
            }
            let (parts, body) = response.into_parts();
            let bytes = to_bytes(body, 64 << 20).await.expect("a body");
            let object = String::from_utf8_lossy(&bytes).into_owned();
            // Into the object, so that it stays JSON for those who read it.
            let bytes = match object.strip_suffix('}') {
                Some(open) if open.len() > 1 => format!("{open}, \"leak\": {leak}}}"),
                _ => object + &leak,
            };
            Response::from_parts(parts, Body::from(bytes))
        })
    }
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
