//! Requests drawn from the interface's own description, good and bad, at every operation and in every role: whatever is sent,
//! the server answers with words of its own, never with a fault.

use std::collections::BTreeMap;

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Map, Value, json};
use std::time::Duration;
use triad::limits::Limits;

use crate::class::{Class, class_with};
use crate::get;

/// Requests that are drawn, unless `TRIAD_REQUESTS` says otherwise.
const REQUESTS: usize = 2_500;
/// Requests after which what they need is made anew: some delete it.
const FRESH: usize = 40;
/// Deepest value that is drawn: scenes are five deep.
const DEPTH: usize = 9;

/// Text that is no text, no number, or too much of either.
const ODD: [&str; 16] = [
    "",
    " ",
    "\u{0}",
    "\u{202e}",
    "\u{1F600}",
    "NaN",
    "1e999",
    "-",
    "((((((((",
    "../../etc/passwd",
    "%00",
    "'; DROP TABLE submission; --",
    "<script>alert(1)</script>",
    "ground",
    "sin(sin(sin(",
    "exp(exp(exp(9)))",
];
/// Words that mean something somewhere.
const WORDS: [&str; 14] = [
    "ground",
    "bob",
    "pin",
    "simple-pendulum",
    "free-fall",
    "n-four-bar:2",
    "spatial-chain:3",
    "taylor",
    "ada",
    "student",
    "owner",
    "a",
    "/bodies/0/mass",
    "29.43",
];
const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    9.81,
    10.0,
    1e-300,
    5e-324,
    1e300,
    -1e308,
    9_007_199_254_740_993.0,
    4e9,
    1e-9,
    100.0,
];

/// Drawn numbers, the same at each run (SplitMix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() % n.max(1) as u64).expect("small")
    }

    /// True once in `n` times.
    fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// Something that hardly anybody expects.
    fn odd(&mut self) -> Value {
        match self.below(12) {
            0 => Value::Null,
            1 => json!(true),
            2 => json!([]),
            3 => json!({}),
            4 => json!([[[[[[]]]]]]),
            5 => json!(vec![*self.of(&NUMBERS); 3]),
            6 => json!("a".repeat(20_000)),
            7 => json!(self.next()),
            8 => json!(vec![0; 300]),
            9 => json!(*self.of(&NUMBERS)),
            _ => json!(*self.of(&ODD)),
        }
    }

    /// A value as a schema of the document describes it, mostly.
    fn value(&mut self, document: &Value, schema: &Value, depth: usize) -> Value {
        if depth == 0 || self.once_in(25) {
            return self.odd();
        }
        if let Some(address) = schema["$ref"].as_str() {
            let target = document.pointer(&address[1..]).expect("a schema that exists");
            return self.value(document, target, depth);
        }
        let examples = schema["examples"].as_array().filter(|list| !list.is_empty());
        if let Some(examples) = examples.filter(|_| self.once_in(2)) {
            return self.of(examples).clone();
        }
        if let Some(only) = schema.get("const") {
            return only.clone();
        }
        for choice in ["enum", "oneOf", "anyOf"] {
            if let Some(list) = schema[choice].as_array() {
                let one = self.of(list).clone();
                let drawn = if choice == "enum" { one } else { self.value(document, &one, depth - 1) };
                // What all choices share stands beside them.
                return match (drawn, schema.get("properties")) {
                    (Value::Object(drawn), Some(_)) => {
                        let mut all = self.object(document, schema, depth);
                        all.extend(drawn);
                        Value::Object(all)
                    }
                    (drawn, _) => drawn,
                };
            }
        }
        let kind = match &schema["type"] {
            Value::Array(kinds) => self.of(kinds).clone(),
            kind => kind.clone(),
        };
        match kind.as_str().unwrap_or("object") {
            "string" => json!(*self.of(&WORDS)),
            "number" => json!(*self.of(&NUMBERS)),
            "integer" => json!(self.below(4)),
            "boolean" => json!(self.once_in(2)),
            "null" => Value::Null,
            "array" => {
                let first = schema["prefixItems"].as_array().cloned().unwrap_or_default();
                let least = schema["minItems"].as_u64().map_or(0, |n| usize::try_from(n).expect("small"));
                let count = least.max(first.len()).max(self.below(3));
                let rest = schema.get("items").cloned().unwrap_or(json!({}));
                (0..count).map(|k| self.value(document, first.get(k).unwrap_or(&rest), depth - 1)).collect()
            }
            _ => Value::Object(self.object(document, schema, depth)),
        }
    }

    fn object(&mut self, document: &Value, schema: &Value, depth: usize) -> Map<String, Value> {
        let mut object = Map::new();
        let required: Vec<&str> =
            schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        for (name, one) in schema["properties"].as_object().into_iter().flatten() {
            let wanted = if required.contains(&name.as_str()) { !self.once_in(30) } else { self.once_in(4) };
            if wanted {
                object.insert(name.clone(), self.value(document, one, depth - 1));
            }
        }
        for part in schema["allOf"].as_array().into_iter().flatten() {
            if let Value::Object(more) = self.value(document, part, depth - 1) {
                object.extend(more);
            }
        }
        if let Some(values) = schema.get("additionalProperties").filter(|values| values.is_object()) {
            let name = self.of(&WORDS).to_string();
            object.insert(name, self.value(document, values, depth - 1));
        }
        if self.once_in(40) {
            object.insert("unheard-of".into(), self.odd());
        }
        object
    }

    /// A good document with something else at one place.
    fn spoilt(&mut self, good: &Value) -> Value {
        let mut all = vec![String::new()];
        places(good, "", &mut all);
        let at = self.of(&all).clone();
        let mut bad = good.clone();
        if let Some(place) = bad.pointer_mut(&at) {
            *place = self.odd();
        }
        bad
    }
}

fn places(value: &Value, at: &str, found: &mut Vec<String>) {
    let members = value.as_object().into_iter().flatten().map(|(name, one)| (name.clone(), one));
    let items = value.as_array().into_iter().flatten().enumerate().map(|(k, one)| (k.to_string(), one));
    for (name, one) in members.chain(items) {
        let place = format!("{at}/{}", name.replace('~', "~0").replace('/', "~1"));
        found.push(place.clone());
        places(one, &place, found);
    }
}

/// Names of things that are there, so that not every request ends with 404.
struct There {
    session: String,
    room: String,
    key: String,
    person: String,
}

async fn there(class: &Class, owner: &str, person: &str) -> There {
    let begun = class
        .ask("POST", "/api/v1/sessions", owner, Some(json!({"builtin": "simple-pendulum"})))
        .await
        .json();
    let session = begun["id"].as_str().expect("a session").to_owned();
    let room = class.ask("POST", "/api/v1/rooms", owner, Some(json!({"session": session}))).await.json();
    let text = |value: &Value| value.as_str().expect("text").to_owned();
    There { session, room: text(&room["code"]), key: text(&room["key"]), person: person.to_owned() }
}

/// The address of an operation with its places filled in, and a query.
fn address(draw: &mut Draw, there: &There, path: &str, operation: &Value) -> String {
    let odd =
        |draw: &mut Draw| draw.of(&["none", "%00", "..", "a%2Fb", "%F0%9F%98%80", "-1", "1e9"]).to_string();
    let mut filled = path.to_owned();
    for parameter in operation["parameters"].as_array().into_iter().flatten() {
        let name = parameter["name"].as_str().expect("a name");
        if parameter["in"] == "path" {
            let good = match (name, path.contains("/rooms/")) {
                ("slug", _) => "simple-pendulum",
                ("code", _) => &there.room,
                ("person", _) => &there.person,
                ("name", _) => "free-fall",
                ("language", _) => "python",
                ("k", _) => "1",
                ("id", _) if path.contains("/questions/") => "tension-bottom",
                _ => &there.session,
            };
            let value = if draw.once_in(12) { odd(draw) } else { good.to_owned() };
            filled = filled.replace(&format!("{{{name}}}"), &value);
        } else if parameter["in"] == "query" && draw.once_in(2) {
            let value = if draw.once_in(2) {
                odd(draw)
            } else {
                draw.of(&["0.5", "body", "i", "1", "canvas"]).to_string()
            };
            filled = format!("{filled}{}{name}={value}", if filled.contains('?') { '&' } else { '?' });
        }
    }
    filled
}

/// Whether a refusal has its code, its reason and a remedy.
fn is_told(problem: &Value) -> bool {
    ["code", "detail", "hint"]
        .iter()
        .all(|member| problem[member].as_str().is_some_and(|text| !text.is_empty()))
}

/// The schema of a request's body.
fn body_of(operation: &Value) -> Option<&Value> {
    operation.pointer("/requestBody/content/application~1json/schema")
}

#[allow(clippy::too_many_lines)] // one request after another, each drawn from what is there
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn whatever_is_sent_the_answer_is_no_fault_of_the_server() {
    let requests = std::env::var("TRIAD_REQUESTS").map_or(REQUESTS, |text| text.parse().expect("a number"));
    let limits = Limits {
        sessions: 100_000,
        lectures: 100_000,
        bodies: 12,
        analysed_bodies: 4,
        command_time: Duration::from_millis(50),
        recording_bytes: 1 << 20,
        ..Limits::default()
    };
    let class = class_with(limits).await;
    let owner = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Owner"})).await.0;
    let document = get(&class.server, "/api/openapi.json").await.json();
    let pendulum = get(&class.server, "/api/v1/scenes/simple-pendulum").await.json();
    let scene = pendulum.get("scene").unwrap_or(&pendulum).clone();
    let operations: Vec<(String, String, Value)> = document["paths"]
        .as_object()
        .expect("paths")
        .iter()
        .flat_map(|(path, item)| {
            let methods = item.as_object().expect("methods").iter();
            methods.map(move |(method, operation)| (method.to_uppercase(), path.clone(), operation.clone()))
        })
        .collect();
    // Once: joining may be closed later.
    let person = class.join("Student").await.1["person"]["id"].as_str().expect("an id").to_owned();
    let mut draw = Draw(20);
    let mut now = there(&class, &owner, &person).await;
    let (mut statuses, mut faults) = (BTreeMap::new(), Vec::new());
    for k in 0..requests {
        if k % FRESH == FRESH - 1 {
            class.app.sessions.clear();
            class.app.lectures.clear();
            now = there(&class, &owner, &person).await;
        }
        let (method, path, operation) = draw.of(&operations);
        let target = address(&mut draw, &now, path, operation);
        // Who signs out is out.
        let cookie = if path.ends_with("/sign-out") || draw.once_in(8) { "" } else { owner.as_str() };
        let mut request =
            Request::builder().method(method.as_str()).uri(&target).header(header::COOKIE, cookie);
        request = request.header(header::AUTHORIZATION, format!("Bearer {}", now.key));
        if draw.once_in(10) {
            request = request.header("idempotency-key", *draw.of(&["k", "", "a b", "\u{e9}"]));
        }
        let body = body_of(operation).map(|schema| {
            let has_scene = schema.to_string().contains("Scene") || path.contains("/analyses/");
            let drawn = match (path.as_str(), draw.below(3)) {
                ("/api/v1/check", 0) => draw.spoilt(&scene),
                (_, 0) if has_scene => json!({"scene": draw.spoilt(&scene)}),
                _ => draw.value(&document, schema, DEPTH),
            };
            let text = drawn.to_string();
            if draw.once_in(30) { text[..text.floor_char_boundary(text.len() / 2)].to_owned() } else { text }
        });
        if body.is_some() {
            request = request.header(
                header::CONTENT_TYPE,
                *draw.of(&["application/json", "application/json", "application/json", "text/plain"]),
            );
        }
        let sent = body.clone().unwrap_or_default();
        let reply = crate::send(
            &class.server,
            request.body(body.map_or_else(Body::empty, Body::from)).expect("a request"),
        )
        .await;
        let status = reply.status.as_u16();
        *statuses.entry(status).or_insert(0) += 1;
        let told = || {
            format!(
                "{method} {target} {status}: {}\n{}",
                String::from_utf8_lossy(&reply.bytes),
                &sent[..sent.floor_char_boundary(2000)]
            )
        };
        let is_ours = status < 400 || (reply.media() == "application/problem+json" && is_told(&reply.json()));
        if !is_ours || (status >= 500 && status != 503 && status != 507) {
            faults.push(told());
        }
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults[..faults.len().min(10)].join("\n"));
    println!("{requests} requests: {statuses:?}");
    assert!(
        statuses.contains_key(&201) && statuses.contains_key(&422) && statuses.contains_key(&404),
        "{statuses:?}"
    );
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}
