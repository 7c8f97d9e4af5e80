//! Every answer is described, and is as it is described.

use axum::Router;
use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};

use crate::schema::contradictions;
use crate::{Reply, get, send, server};

/// The schema of a success answer, or of a request's body.
fn content(part: &Value) -> Option<&Value> {
    let kinds = ["/content/application~1json/schema", "/content/application~1problem+json/schema"];
    kinds.into_iter().find_map(|place| part.pointer(place))
}

/// All schemas of requests and of success answers, with their addresses.
fn described(document: &Value) -> Vec<(String, &Value)> {
    let mut all = Vec::new();
    for (path, item) in document["paths"].as_object().expect("paths") {
        for (method, operation) in item.as_object().expect("methods") {
            let answers = operation["responses"].as_object().expect("answers").iter();
            let good = answers.filter(|(status, _)| status.starts_with('2')).map(|(_, answer)| answer);
            let parts = good.chain(operation.get("requestBody"));
            all.extend(parts.filter_map(content).map(|schema| (format!("{method} {path}"), schema)));
        }
    }
    all
}

/// Whether a schema says no more than that there is an object.
fn is_bare(schema: &Value) -> bool {
    let says = ["properties", "oneOf", "anyOf", "allOf", "$ref"];
    let values = schema.get("additionalProperties").is_some_and(Value::is_object);
    schema["type"] == "object" && !values && says.iter().all(|keyword| schema.get(keyword).is_none())
}

fn walk(schema: &Value, place: &str, look: &mut impl FnMut(&Value, &str)) {
    look(schema, place);
    let members = schema.as_object().into_iter().flatten().map(|(name, one)| (name.clone(), one));
    let items = schema.as_array().into_iter().flatten().enumerate().map(|(k, one)| (k.to_string(), one));
    for (name, one) in members.chain(items) {
        walk(one, &format!("{place}/{name}"), look);
    }
}

#[tokio::test]
async fn no_answer_and_no_request_is_a_bare_object() {
    let document = get(&server(), "/api/openapi.json").await.json();
    let all = described(&document);
    assert!(all.len() > 50, "{}", all.len());
    for (address, schema) in all {
        let named = schema["$ref"].as_str().unwrap_or_default();
        assert!(named.starts_with("#/components/schemas/"), "{address}: {schema}");
    }
    for (name, schema) in document["components"]["schemas"].as_object().expect("schemas") {
        let is_type_name = name.starts_with(|c: char| c.is_ascii_uppercase())
            && name.chars().all(|c| c.is_ascii_alphabetic());
        assert!(is_type_name, "{name}: two types of one name, or a generic one");
        walk(schema, name, &mut |schema, place| {
            // A JSON Schema is described by the standard, not here.
            assert!(place == "SceneSchema" || !is_bare(schema), "{place} is a bare object");
            if let Some(address) = schema["$ref"].as_str() {
                assert!(document.pointer(&address[1..]).is_some(), "{place}: {address} is not described");
            }
        });
    }
}

/// A server whose answers are held against their description.
struct Watched {
    server: Router,
    document: Value,
    seen: usize,
}

impl Watched {
    /// Asks, and checks request and answer. The template is the address as it is described.
    async fn ask(&mut self, method: &str, template: &str, path: &str, body: Option<Value>) -> Value {
        let operation = &self.document["paths"][template][method.to_lowercase()];
        assert!(operation.is_object(), "{method} {template} is not described");
        if let Some(body) = &body {
            let schema = content(&operation["requestBody"]).expect("a schema of the request");
            assert_eq!(contradictions(&self.document, schema, body), Vec::<String>::new(), "{method} {path}");
        }
        let request =
            Request::builder().method(method).uri(path).header(header::CONTENT_TYPE, "application/json");
        let body = body.map_or_else(Body::empty, |body| Body::from(body.to_string()));
        let reply: Reply = send(&self.server, request.body(body).expect("a request")).await;
        let answer = &operation["responses"][reply.status.as_str()];
        assert!(answer.is_object(), "{method} {path}: {} is not described: {}", reply.status, reply.json());
        self.seen += 1;
        match content(answer) {
            Some(schema) => {
                let value = reply.json();
                let wrong = contradictions(&self.document, schema, &value);
                assert_eq!(wrong, Vec::<String>::new(), "{method} {path}");
                value
            }
            None => Value::Null,
        }
    }

    async fn get(&mut self, template: &str, path: &str) -> Value {
        self.ask("GET", template, path, None).await
    }
}

async fn watched() -> Watched {
    let server = server();
    let document = get(&server, "/api/openapi.json").await.json();
    Watched { server, document, seen: 0 }
}

#[tokio::test]
async fn lessons_and_submissions_are_as_described() {
    let mut api = watched().await;
    let lessons = api.get("/api/v1/lessons", "/api/v1/lessons").await;
    for lesson in lessons.as_array().expect("lessons") {
        let slug = lesson["slug"].as_str().expect("a slug");
        let path = format!("/api/v1/lessons/{slug}");
        let lesson = api.get("/api/v1/lessons/{slug}", &path).await;
        for question in lesson["exercise"]["questions"].as_array().expect("questions") {
            let at = format!("{path}/questions/{}", question["id"].as_str().expect("an id"));
            if question["kind"] == "implement" {
                api.get("/api/v1/lessons/{slug}/questions/{id}/states", &format!("{at}/states")).await;
            }
            if question["hints_available"] != 0 {
                api.get("/api/v1/lessons/{slug}/questions/{id}/hints/{k}", &format!("{at}/hints/1")).await;
            }
        }
        let submit = "/api/v1/lessons/{slug}/submissions";
        let answers = json!({"student": "ada", "answers": {}});
        api.ask("POST", submit, &format!("{path}/submissions"), Some(answers)).await;
    }
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    for period in ["2.37", "a word"] {
        let answers = json!({"student": "eve", "answers": {"period": {"value": period, "unit": "s"}}});
        api.ask("POST", "/api/v1/lessons/{slug}/submissions", path, Some(answers)).await;
    }
    let kept = api.get("/api/v1/submissions", "/api/v1/submissions").await;
    assert!(kept.as_array().is_some_and(|all| all.len() > 5), "{kept}");
    api.get("/api/v1/health", "/api/v1/health").await;
    assert!(api.seen > 30);
}

#[tokio::test]
async fn scenes_and_analyses_are_as_described() {
    let mut api = watched().await;
    let scenes = api.get("/api/v1/scenes", "/api/v1/scenes").await;
    for entry in scenes.as_array().expect("scenes") {
        let name = entry["name"].as_str().expect("a name").replace('N', "2");
        let reply = get(&api.server, &format!("/api/v1/scenes/{name}")).await;
        if reply.status == 200 {
            let scene = api.get("/api/v1/scenes/{name}", &format!("/api/v1/scenes/{name}")).await;
            api.ask("POST", "/api/v1/check", "/api/v1/check", Some(scene)).await;
        }
    }
    api.get("/api/v1/schema/scene", "/api/v1/schema/scene").await;
    let scene = get(&api.server, "/api/v1/scenes/simple-pendulum").await.json();
    for analysis in ["assembly", "equilibrium", "modes"] {
        let path = format!("/api/v1/analyses/{analysis}");
        api.ask("POST", &path, &path, Some(json!({"scene": scene}))).await;
    }
    let benchmark = get(&api.server, "/api/v1/lessons/verification").await.json()["scene"].clone();
    let path = "/api/v1/lessons/{slug}/questions/{id}/table";
    let asked = "/api/v1/lessons/verification/questions/your-run/table";
    api.ask("POST", path, asked, Some(json!({"scene": benchmark}))).await;
    let path = "/api/v1/analyses/table";
    let asked = json!({"scene": scene, "outputs": ["joints"], "every": 0.1, "until": 1.0});
    api.ask("POST", path, path, Some(asked)).await;
    let driven = get(&api.server, "/api/v1/scenes/slider-crank").await;
    let path = "/api/v1/analyses/kinematics";
    let scene = if driven.status == 200 { driven.json() } else { scene };
    api.ask("POST", path, path, Some(json!({"scene": scene}))).await;
    let urdf = r#"<robot name="r"><link name="base"/><link name="arm"><inertial><mass value="1"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint></robot>"#;
    let path = "/api/v1/import/urdf";
    api.ask("POST", path, path, Some(json!({"urdf": urdf, "with": {"root": "ground"}}))).await;
}

#[tokio::test]
async fn sessions_and_lectures_are_as_described() {
    let mut api = watched().await;
    let new = json!({"builtin": "n-four-bar:2", "overrides": {"duration": 2.0}});
    let state = api.ask("POST", "/api/v1/sessions", "/api/v1/sessions", Some(new)).await;
    let at = state["links"]["self"].as_str().expect("an address").to_owned();
    let id = state["id"].as_str().expect("an id").to_owned();
    let body = state["bodies"][0]["name"].clone();
    for (method, what, body) in [
        ("POST", "step", Some(json!({"seconds": 0.1}))),
        ("PUT", "drawing", Some(json!({"arrows": {"on": "i", "drawn": {"body": body}}, "fit": true}))),
        ("PUT", "camera", Some(json!({"from": "side"}))),
        ("PUT", "pull", Some(json!({"body": body, "to": [1.0, 0.0, 0.0]}))),
        ("DELETE", "pull", None),
        ("POST", "parameters", Some(json!({"places": {"/simulation/tolerance": 1e-6}, "then": "continue"}))),
        ("POST", "play", Some(json!({"speed": 2.0}))),
        ("POST", "pause", None),
    ] {
        api.ask(method, &format!("/api/v1/sessions/{{id}}/{what}"), &format!("{at}/{what}"), body).await;
    }
    let new = json!({"session": id});
    let room = api.ask("POST", "/api/v1/rooms", "/api/v1/rooms", Some(new)).await;
    let room = format!("/api/v1/rooms/{}", room["code"].as_str().expect("a code"));
    api.get("/api/v1/rooms/{code}", &room).await;
    let asked = json!({"text": "Why is the multiplier negative?", "voter": "a"});
    api.ask("POST", "/api/v1/rooms/{code}/remarks", &format!("{room}/remarks"), Some(asked)).await;
    for what in ["scene", "jacobian", "augmented", "schur", "multipliers", "reactions"] {
        api.get(&format!("/api/v1/sessions/{{id}}/{what}"), &format!("{at}/{what}")).await;
        api.get(&format!("/api/v1/rooms/{{code}}/{what}"), &format!("{room}/{what}")).await;
    }
    api.get("/api/v1/sessions/{id}", &at).await;
    api.ask("POST", "/api/v1/sessions/{id}/reset", &format!("{at}/reset"), None).await;
    api.ask("DELETE", "/api/v1/sessions/{id}", &at, None).await;
    let problem = api.get("/api/v1/sessions/{id}", &at).await;
    assert_eq!(problem["code"], "unknown-session");
}
