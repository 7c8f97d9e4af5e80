//! A class: coming in, one's own numbers, the table of rights, and what other sites may not do.

use std::collections::BTreeSet;
use std::sync::Arc;

use axum::Router;
use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};
use triad::access::Access;
use triad::access::rights::{RIGHTS, Right};
use triad::app::App;
use triad::limits::Limits;
use triad::store::{CLASS, Role};
use triad_lessons::{Course, reference_submission};

use crate::{Reply, get, send, server, state};

/// A class, and how its people come in.
pub(crate) struct Class {
    pub(crate) app: App,
    pub(crate) server: Router,
    pub(crate) setup: String,
    pub(crate) code: String,
}

pub(crate) async fn class() -> Class {
    class_with(Limits::default()).await
}

pub(crate) async fn class_with(limits: Limits) -> Class {
    class_of(state(limits)).await
}

/// A class with a course and a gradebook of its own.
pub(crate) async fn class_of(app: App) -> Class {
    let row = app.store.ensure_course(CLASS, "Mechanics").await.expect("a class");
    let setup = app.store.invite(CLASS, "triad", Role::Owner).await.expect("an invitation");
    let app = app.with_access(Access::class(&row, false));
    Class { server: triad::app(app.clone()), app, setup, code: row.join_code }
}

impl Class {
    /// The same class on a server that was started anew, with a course.
    pub(crate) async fn again(&self, course: Arc<Course>) -> Self {
        let row = self.app.store.course(CLASS).await.expect("a class");
        let app = self.app.clone().with_access(Access::class(&row, false));
        let app = App { course, ..app };
        let (setup, code) = (self.setup.clone(), self.code.clone());
        Self { server: triad::app(app.clone()), app, setup, code }
    }

    /// Asks as the presenter of a lecture.
    pub(crate) async fn lead(&self, method: &str, path: &str, key: &str, body: Option<Value>) {
        let request = Request::builder().method(method).uri(path).header(header::AUTHORIZATION, key);
        let request = request.header(header::CONTENT_TYPE, "application/json");
        let body = body.map_or_else(Body::empty, |body| Body::from(body.to_string()));
        let reply = send(&self.server, request.body(body).expect("a request")).await;
        assert!(reply.status.is_success(), "{method} {path}: {}", reply.status);
    }

    /// Asks with a cookie; an empty one is nobody's.
    pub(crate) async fn ask(&self, method: &str, path: &str, cookie: &str, body: Option<Value>) -> Reply {
        let mut request = Request::builder().method(method).uri(path).header(header::COOKIE, cookie);
        if body.is_some() {
            request = request.header(header::CONTENT_TYPE, "application/json");
        }
        let body = body.map_or_else(Body::empty, |body| Body::from(body.to_string()));
        send(&self.server, request.body(body).expect("a request")).await
    }

    /// Comes in: the cookie, and what was told.
    pub(crate) async fn enter(&self, path: &str, body: Value) -> (String, Value) {
        let reply = self.ask("POST", path, "", Some(body)).await;
        assert!(reply.status.is_success(), "{}", reply.json());
        (cookie(&reply), reply.json())
    }

    pub(crate) async fn join(&self, name: &str) -> (String, Value) {
        self.enter("/api/v1/join", json!({"code": self.code, "name": name})).await
    }

    /// A cookie for each role, from nobody to the owner.
    pub(crate) async fn everybody(&self) -> Vec<(Option<Role>, String)> {
        let owner = self.enter("/api/v1/setup", json!({"token": self.setup, "name": "Owner"})).await.0;
        let mut all = vec![(None, String::new())];
        all.push((Some(Role::Student), self.join("Student").await.0));
        for role in [Role::Grader, Role::Instructor] {
            let body = json!({"role": role.name()});
            let invited = self.ask("POST", "/api/v1/invitations", &owner, Some(body)).await.json();
            let body = json!({"token": invited["token"], "name": role.name()});
            all.push((Some(role), self.enter("/api/v1/setup", body).await.0));
        }
        all.push((Some(Role::Owner), owner));
        all
    }
}

/// The cookie that a reply sets, as it is sent back.
fn cookie(reply: &Reply) -> String {
    let set = reply.headers[header::SET_COOKIE].to_str().expect("text");
    assert!(set.contains("HttpOnly") && set.contains("SameSite=Lax") && set.contains("Path=/"), "{set}");
    set.split(';').next().unwrap_or_default().to_owned()
}

#[tokio::test]
async fn every_operation_asks_for_the_right_that_the_table_says() {
    let class = class().await;
    let everybody = class.everybody().await;
    let document = get(&class.server, "/api/openapi.json").await.json();
    let mut asked = 0;
    let mut described = BTreeSet::new();
    for (path, item) in document["paths"].as_object().expect("paths") {
        for method in item.as_object().expect("methods").keys() {
            let method = method.to_uppercase();
            described.insert((method.clone(), path.clone()));
            let listed = RIGHTS.iter().find(|(m, p, _)| *m == method && p == path);
            let right = listed.unwrap_or_else(|| panic!("{method} {path} is not in the table of rights")).2;
            if path == "/api/v1/sign-out" {
                continue;
            }
            let filled = path.replace("{slug}", "screw").replace("{code}", "none").replace("{k}", "1");
            let filled = filled.replace("{name}", "free-fall").replace("{language}", "python");
            let filled = filled.replace("{id}", "none").replace("{person}", "none");
            let filled = filled.replace("{question}", "none").replace("{submission}", "none");
            for (role, cookie) in &everybody {
                let reply = class.ask(&method, &filled, cookie, None).await;
                let may = match right {
                    Right::Anyone | Right::Key => true,
                    Right::Role(needed) => role.is_some_and(|role| role >= needed),
                };
                let code = if reply.media().contains("problem") {
                    reply.json()["code"].clone()
                } else {
                    Value::Null
                };
                let refused = code == "sign-in-needed" || code == "not-yours";
                assert_eq!(refused, !may, "{method} {path} as {role:?}: {} {code}", reply.status);
                let expected = if role.is_none() { 401 } else { 403 };
                assert!(
                    may || reply.status.as_u16() == expected,
                    "{method} {path} as {role:?}: {}",
                    reply.status
                );
                asked += 1;
            }
        }
    }
    assert!(asked > 300, "{asked}");
    for (method, path, _) in RIGHTS {
        assert!(
            described.contains(&((*method).to_owned(), (*path).to_owned())),
            "{method} {path} does not exist"
        );
    }
}

#[tokio::test]
async fn a_student_joins_comes_back_and_goes() {
    let class = class().await;
    let (first, told) = class.join(" Zoe\u{308}  Z ").await;
    assert_eq!((&told["person"]["name"], &told["person"]["role"]), (&json!("Zoë Z"), &json!("student")));
    let words = told["words"].as_str().expect("words").to_owned();
    assert_eq!(words.split(' ').count(), 4);
    let me = class.ask("GET", "/api/v1/me", &first, None).await.json();
    assert_eq!((&me["mode"], &me["person"]["id"]), (&json!("class"), &told["person"]["id"]));
    assert_eq!(class.ask("GET", "/api/v1/me", "", None).await.json().get("person"), None);

    let again = json!({"code": class.code, "name": "zoë z"});
    class.ask("POST", "/api/v1/join", "", Some(again)).await.problem(409, "name-taken");
    let wrong = json!({"code": "wrong", "name": "Eve"});
    class.ask("POST", "/api/v1/join", "", Some(wrong)).await.problem(403, "wrong-code");

    let back = json!({"name": "ZOË z", "words": words.replace(' ', "-").to_uppercase()});
    let (second, _) = class.enter("/api/v1/return", back).await;
    let (third, _) = class.enter("/api/v1/return", json!({"link": told["link"]})).await;
    for cookie in [&second, &third] {
        let me = class.ask("GET", "/api/v1/me", cookie, None).await.json();
        assert_eq!(me["person"]["id"], told["person"]["id"]);
    }
    for wrong in [
        json!({"name": "Zoë Z", "words": "acorn acorn acorn acorn"}),
        json!({"link": "x"}),
        json!({"name": "Eve", "words": words}),
    ] {
        class.ask("POST", "/api/v1/return", "", Some(wrong)).await.problem(403, "wrong-words");
    }
    class.ask("POST", "/api/v1/sign-out", &second, None).await;
    class.ask("GET", "/api/v1/submissions", &second, None).await.problem(401, "sign-in-needed");
    assert_eq!(class.ask("GET", "/api/v1/submissions", &third, None).await.json(), json!([]));
}

#[tokio::test]
async fn an_invitation_is_used_once_and_the_last_owner_stays() {
    let class = class().await;
    let setup = json!({"token": class.setup, "name": "Prof", "title": "Mechanics II"});
    let (owner, told) = class.enter("/api/v1/setup", setup.clone()).await;
    class
        .ask("POST", "/api/v1/setup", "", Some(json!({"token": class.setup, "name": "Eve"})))
        .await
        .problem(404, "unknown-entry");
    let course = class.ask("GET", "/api/v1/course", &owner, None).await.json();
    assert_eq!((&course["title"], &course["join_code"]), (&json!("Mechanics II"), &json!(class.code)));
    let own = format!("/api/v1/people/{}/role", told["person"]["id"].as_str().expect("an id"));
    class.ask("PUT", &own, &owner, Some(json!({"role": "student"}))).await.problem(409, "last-owner");
    class.ask("PUT", &own, &owner, Some(json!({"role": "king"}))).await.problem(422, "unknown-role");

    let closed = class
        .ask("PUT", "/api/v1/course", &owner, Some(json!({"join_open": false, "new_code": true})))
        .await
        .json();
    assert_ne!(closed["join_code"], course["join_code"]);
    let late = json!({"code": closed["join_code"], "name": "Late"});
    class.ask("POST", "/api/v1/join", "", Some(late)).await.problem(403, "wrong-code");
}

#[tokio::test]
async fn numbers_belong_to_the_member_and_are_taken_from_no_request() {
    let class = class().await;
    let (ada, _) = class.join("Ada").await;
    let (eve, _) = class.join("Eve").await;
    let lesson = "/api/v1/lessons/joint-reactions";
    let view = class.ask("GET", lesson, &ada, None).await.json();
    assert_eq!(view["seed"], "Ada", "the name stands for the seed, which stays here");
    assert_eq!(view, class.ask("GET", lesson, &ada, None).await.json());
    let states = "/api/v1/lessons/jacobian/questions/program/states";
    let of = async |cookie: &str| class.ask("GET", states, cookie, None).await.json();
    let (hers, others) = (of(&ada).await, of(&eve).await);
    assert_ne!(hers["states"], others["states"]);
    assert_eq!(hers["seed"], "Ada");
    for path in [format!("{lesson}?seed=Ada"), format!("{lesson}?student=Ada"), format!("{states}?seed=x")] {
        class.ask("GET", &path, &eve, None).await.problem(403, "not-your-numbers");
    }
    let session = json!({"lesson": "joint-reactions", "seed": "Ada"});
    class.ask("POST", "/api/v1/sessions", &eve, Some(session)).await.problem(403, "not-your-numbers");

    // Somebody who computes with the name alone has other numbers: the class's secret enters.
    let course = Course::embedded().expect("a course");
    let by_name = course.lesson("joint-reactions").expect("the lesson").variant("Ada").expect("a variant");
    let submit = format!("{lesson}/submissions");
    let mut guessed = serde_json::to_value(reference_submission(&by_name)).expect("JSON");
    class
        .ask("POST", &submit, &ada, Some(json!({"seed": "Ada", "answers": {}})))
        .await
        .problem(403, "not-your-numbers");
    guessed.as_object_mut().expect("an object").retain(|key, _| key == "answers");
    let verdict = class.ask("POST", &submit, &ada, Some(guessed)).await;
    assert_eq!(verdict.status, 201, "{}", verdict.json());
    assert_eq!(
        (&verdict.json()["passed"], &verdict.json()["provenance"]["seed"]),
        (&json!(false), &json!(""))
    );
    assert_eq!(verdict.json()["student"], "Ada");

    let list = async |cookie: &str| class.ask("GET", "/api/v1/submissions", cookie, None).await.json();
    assert_eq!((list(&ada).await.as_array().map(Vec::len), list(&eve).await), (Some(1), json!([])));
}

#[tokio::test]
async fn every_verdict_is_rebuilt_byte_for_byte() {
    let class = class().await;
    let (ada, _) = class.join("Ada").await;
    let course = Course::embedded().expect("a course");
    for lesson in course.lessons() {
        let path = format!("/api/v1/lessons/{}/submissions", lesson.slug);
        // Of a pool only what was drawn for her is asked.
        let shown = class.ask("GET", &format!("/api/v1/lessons/{}", lesson.slug), &ada, None).await.json();
        let asked = shown["exercise"]["questions"].as_array().expect("questions").clone();
        let mut reference = reference_submission(lesson);
        reference.answers.retain(|id, _| asked.iter().any(|question| question["id"] == json!(id)));
        let reference = serde_json::to_value(reference).expect("JSON");
        let body = json!({"answers": reference["answers"]});
        let reply = class.ask("POST", &path, &ada, Some(body)).await;
        assert!(reply.status.is_success() || reply.status == 429, "{}", reply.json());
    }
    let rebuilt = triad::regrade::check(&class.app.store, CLASS).await.expect("rebuilds");
    assert!(rebuilt.changed.is_empty() && rebuilt.same >= 20, "{rebuilt:?}");
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test]
async fn a_teacher_sees_decides_and_takes_the_table_along() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let (ada, told) = class.join("=Ada").await;
    let id = told["person"]["id"].as_str().expect("an id");
    let submit = "/api/v1/lessons/simple-pendulum/submissions";
    let answers = |value: &str| json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}});
    // Three times the weight of her own bob.
    let lesson = class.ask("GET", "/api/v1/lessons/simple-pendulum", &ada, None).await.json();
    let mass = lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass");
    let right = format!("{:.4}", 3.0 * 9.81 * mass);
    for value in [right.as_str(), "1.000", "not a number"] {
        class.ask("POST", submit, &ada, Some(answers(value))).await;
    }
    let table = async || class.ask("GET", "/api/v1/standings", &owner, None).await.json();
    let reached = table().await["students"][0]["lessons"]["simple-pendulum"].clone();
    assert_eq!(
        (&reached["points"], &reached["attempts"], &reached["passed"]),
        (&json!(3.0), &json!(2), &json!(false))
    );
    let attempts = class.ask("GET", &format!("/api/v1/people/{id}/submissions"), &owner, None).await.json();
    assert_eq!(attempts.as_array().map(Vec::len), Some(3));

    let decisions = format!("/api/v1/people/{id}/decisions");
    let decide = async |points: Value, reason: &str| {
        let body = json!({"lesson": "simple-pendulum", "points": points, "reason": reason});
        class.ask("POST", &decisions, &owner, Some(body)).await
    };
    decide(json!(12), "").await.problem(422, "invalid-decision");
    decide(json!(1000), "too many").await.problem(422, "invalid-decision");
    assert_eq!(decide(json!(12), "right, by another way").await.status, 201);
    let reached = table().await["students"][0]["lessons"]["simple-pendulum"].clone();
    assert_eq!(
        (&reached["points"], &reached["earned"], &reached["passed"]),
        (&json!(12.0), &json!(3.0), &json!(true))
    );
    assert_eq!(
        (&reached["decided"]["by"], &reached["decided"]["reason"]),
        (&json!("Prof"), &json!("right, by another way"))
    );
    let csv = class.ask("GET", "/api/v1/standings.csv?for=canvas", &owner, None).await;
    let text = String::from_utf8_lossy(&csv.bytes).into_owned();
    assert!(text.contains("\"'=Ada\"") && text.contains("\"12\""), "{text}");
    assert_eq!(decide(Value::Null, "taken back").await.status, 201);
    assert_eq!(table().await["students"][0]["lessons"]["simple-pendulum"]["points"], json!(3.0));

    let bound = class
        .ask("PUT", "/api/v1/assignments/simple-pendulum", &owner, Some(json!({"most_attempts": 2})))
        .await;
    assert_eq!(bound.status, 204);
    class.ask("POST", submit, &ada, Some(answers(&right))).await.problem(409, "attempts-used");
}

#[tokio::test]
async fn other_sites_and_other_names_are_refused() {
    let home = server();
    let ask = async |method: &str, path: &str, headers: &[(&str, &str)]| {
        let mut request = Request::builder().method(method).uri(path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        send(&home, request.body(Body::empty()).expect("a request")).await
    };
    let (lessons, sessions) = ("/api/v1/lessons", "/api/v1/sessions/none/play");
    ask("GET", lessons, &[("host", "rebound.evil.example")]).await.problem(421, "unknown-host");
    assert_eq!(ask("GET", lessons, &[("host", "127.0.0.1:8080")]).await.status, 200);
    let here = ("host", "localhost:8080");
    for foreign in [
        ("origin", "https://evil.example"),
        ("origin", "null"),
        ("sec-fetch-site", "cross-site"),
        ("origin", "http://localhost:1"),
    ] {
        ask("POST", sessions, &[here, foreign]).await.problem(403, "foreign-origin");
        ask("GET", "/api/v1/rooms/none/stream", &[here, foreign, ("upgrade", "websocket")])
            .await
            .problem(403, "foreign-origin");
    }
    for own in [("origin", "http://localhost:8080"), ("sec-fetch-site", "same-origin"), ("accept", "*/*")] {
        assert_eq!(ask("POST", sessions, &[here, own]).await.status, 404);
    }
    let reply = ask("GET", lessons, &[here]).await;
    assert_eq!(reply.headers["x-content-type-options"], "nosniff");
    // Everything that is sent says what may run and load in it.
    for (path, policy) in [
        ("/", "default-src 'self'; script-src 'self' 'wasm-unsafe-eval' blob:;"),
        ("/lessons/screw", "connect-src 'self' ws://localhost:8080 wss://localhost:8080 data: blob:;"),
        ("/nowhere", "script-src 'self'"),
        ("/docs/", "default-src 'none'; script-src 'self';"),
        ("/docs/none", "default-src 'none'; script-src 'self';"),
        ("/stress", "default-src 'none'; style-src 'unsafe-inline';"),
        (lessons, "default-src 'none'; frame-ancestors 'none'"),
        ("/api/openapi.json", "default-src 'none'"),
        ("/livez", "default-src 'none'"),
        ("/assets/none.js", "default-src 'none'"),
    ] {
        let reply = ask("GET", path, &[here]).await;
        let told = reply.headers["content-security-policy"].to_str().expect("text");
        assert!(told.contains(policy), "{path}: {told}");
        let scripts = told.split(';').find(|part| part.trim().starts_with("script-src")).unwrap_or_default();
        assert!(!scripts.contains("unsafe-inline") && !scripts.contains("'unsafe-eval'"), "{path}: {told}");
    }
    // At home there is no class to come into.
    ask("POST", "/api/v1/join", &[here]).await.problem(404, "no-class");
    assert_eq!(get(&home, "/api/v1/me").await.json()["mode"], "home");
}
