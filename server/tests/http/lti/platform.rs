//! A learning platform as small as it can be: keys, tokens, columns, scores and people, on a port of this machine. PyLTI1p3,
//! a tool that others wrote, takes what it signs: `tests/lti`.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Form, Json, Router};
use jsonwebtoken::jwk::{Jwk, JwkSet};
use jsonwebtoken::{Algorithm, DecodingKey, EncodingKey, Header, Validation};
use serde_json::{Value, json};
use tokio::net::TcpListener;
use triad::lti::keys;
use triad::lti::registration::Registration;

/// What the platform calls us.
pub(super) const CLIENT: &str = "triad-at-school";
/// Its deployment.
pub(super) const DEPLOYMENT: &str = "7";
/// Its course.
pub(super) const CONTEXT: &str = "mechanics-2";

/// A key with its name.
pub(crate) struct Signing {
    pub(crate) name: String,
    pub(crate) key: EncodingKey,
}

impl Signing {
    pub(crate) fn new() -> Self {
        let (name, digits) = keys::generate().expect("a key");
        let byte = |at| u8::from_str_radix(&digits[at..at + 2], 16).expect("digits");
        let der: Vec<u8> = (0..digits.len()).step_by(2).map(byte).collect();
        Self { name, key: EncodingKey::from_rsa_der(&der) }
    }

    pub(crate) fn public(&self) -> Jwk {
        let mut key = Jwk::from_encoding_key(&self.key, Algorithm::RS256).expect("a public key");
        key.common.key_id = Some(self.name.clone());
        key
    }

    pub(crate) fn sign(&self, said: &Value) -> String {
        let header = Header { kid: Some(self.name.clone()), ..Header::new(Algorithm::RS256) };
        jsonwebtoken::encode(&header, said, &self.key).expect("signed")
    }
}

/// What the platform was asked, and what it is to answer.
#[derive(Default)]
pub(super) struct Seen {
    /// Scores that it took: path and body.
    pub(super) scores: Vec<(String, Value)>,
    /// Everything that was sent as a score, taken or not.
    pub(super) tried: usize,
    /// Tokens that it gave.
    pub(super) tokens: usize,
    /// Columns that were made.
    pub(super) made: Vec<Value>,
    /// Answers to the next scores, instead of taking them: status and `retry-after`; 0 drops the answer of one that is taken.
    pub(super) answers: VecDeque<(u16, Option<&'static str>)>,
    /// Tokens of before this number are no longer known.
    pub(super) forgotten: usize,
    /// People, page by page.
    pub(super) people: Vec<Vec<Value>>,
    /// Where the list of people goes on after its last page.
    pub(super) elsewhere: Option<String>,
    /// How often its keys were fetched.
    pub(super) fetched: usize,
    /// Its keys.
    pub(super) keys: Vec<Jwk>,
    /// Ours, by which it knows us.
    pub(super) ours: Option<JwkSet>,
}

type Shared = Arc<Mutex<Seen>>;

pub(super) struct Platform {
    pub(super) url: String,
    /// Where it believes the class to be.
    pub(super) tool: String,
    pub(super) signing: Signing,
    pub(super) seen: Shared,
}

impl Platform {
    pub(super) async fn start(tool: &str) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let signing = Signing::new();
        let seen: Shared = Arc::default();
        seen.lock().expect("whole").keys = vec![signing.public()];
        let router = Router::new()
            .route("/keys", get(published))
            .route("/token", post(token))
            .route("/items", get(items).post(make))
            .route("/items/{n}/scores", post(score))
            .route("/people", get(people))
            .with_state((seen.clone(), url.clone()));
        tokio::spawn(async move { axum::serve(listener, router).await });
        Self { url, tool: tool.to_owned(), signing, seen }
    }

    pub(super) fn registration(&self) -> Registration {
        let at = |path: &str| format!("{}{path}", self.url);
        Registration {
            issuer: self.url.clone(),
            client_id: CLIENT.into(),
            keys_url: at("/keys"),
            login_url: at("/auth?tenant=1"),
            token_url: at("/token"),
            audience: None,
            services: Vec::new(),
            deployments: vec![DEPLOYMENT.into()],
        }
    }

    /// What it says of somebody who opens a lesson.
    pub(super) fn word(&self, nonce: &str, subject: &str, role: &str, lesson: &str) -> Value {
        let now = jiff::Timestamp::now().as_second();
        json!({
            "iss": self.url, "aud": CLIENT, "sub": subject, "iat": now, "exp": now + 300, "nonce": nonce,
            "name": format!("{subject} of school"),
            "https://purl.imsglobal.org/spec/lti/claim/message_type": "LtiResourceLinkRequest",
            "https://purl.imsglobal.org/spec/lti/claim/version": "1.3.0",
            "https://purl.imsglobal.org/spec/lti/claim/deployment_id": DEPLOYMENT,
            "https://purl.imsglobal.org/spec/lti/claim/target_link_uri": format!("{}/lessons/{lesson}", self.tool),
            "https://purl.imsglobal.org/spec/lti/claim/resource_link": {"id": format!("link-{lesson}")},
            "https://purl.imsglobal.org/spec/lti/claim/roles":
                [format!("http://purl.imsglobal.org/vocab/lis/v2/membership#{role}")],
            "https://purl.imsglobal.org/spec/lti/claim/context": {"id": CONTEXT, "title": "Mechanics at school"},
            "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint": {
                "scope": ["https://purl.imsglobal.org/spec/lti-ags/scope/lineitem",
                    "https://purl.imsglobal.org/spec/lti-ags/scope/score"],
                "lineitems": format!("{}/items", self.url),
            },
            "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice": {
                "context_memberships_url": format!("{}/people?limit=2", self.url), "service_versions": ["2.0"],
            },
        })
    }
}

async fn published(State((seen, _)): State<(Shared, String)>) -> Json<JwkSet> {
    let mut seen = seen.lock().expect("whole");
    seen.fetched += 1;
    Json(JwkSet { keys: seen.keys.clone() })
}

async fn token(
    State((seen, url)): State<(Shared, String)>,
    Form(form): Form<std::collections::HashMap<String, String>>,
) -> Response {
    let mut seen = seen.lock().expect("whole");
    let proof = &form["client_assertion"];
    let ours = seen.ours.clone().expect("our keys");
    let name = jsonwebtoken::decode_header(proof).expect("a header").kid.expect("a name");
    let key = DecodingKey::from_jwk(ours.find(&name).expect("published")).expect("a key");
    let mut validation = Validation::new(Algorithm::RS256);
    validation.set_audience(&[format!("{url}/token")]);
    validation.set_issuer(&[CLIENT]);
    let claims = jsonwebtoken::decode::<Value>(proof, &key, &validation).expect("our proof").claims;
    assert_eq!(claims["sub"], CLIENT);
    assert_eq!(form["grant_type"], "client_credentials");
    seen.tokens += 1;
    let text = format!("{}|{}", seen.tokens, form["scope"].rsplit('/').next().expect("a scope"));
    Json(json!({"access_token": text, "token_type": "Bearer", "expires_in": 3600, "scope": form["scope"]}))
        .into_response()
}

/// Whether the request brings a token that is still known, for this scope.
fn knows(seen: &Seen, headers: &HeaderMap, scope: &str) -> bool {
    let text = headers[header::AUTHORIZATION].to_str().expect("text");
    let (number, given) =
        text.strip_prefix("Bearer ").and_then(|rest| rest.split_once('|')).expect("a token");
    given == scope && number.parse::<usize>().expect("a number") > seen.forgotten
}

async fn items(
    State((seen, url)): State<(Shared, String)>,
    Query(query): Query<std::collections::HashMap<String, String>>,
    headers: HeaderMap,
) -> Response {
    let seen = seen.lock().expect("whole");
    if !knows(&seen, &headers, "lineitem") {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    let found = seen.made.iter().enumerate().filter(|(_, item)| item["resourceId"] == query["resource_id"]);
    let found =
        found.map(|(n, item)| json!({"id": format!("{url}/items/{n}"), "resourceId": item["resourceId"]}));
    Json(found.collect::<Vec<_>>()).into_response()
}

async fn make(State((seen, url)): State<(Shared, String)>, headers: HeaderMap, body: String) -> Response {
    let mut seen = seen.lock().expect("whole");
    assert_eq!(headers[header::CONTENT_TYPE], "application/vnd.ims.lis.v2.lineitem+json");
    if !knows(&seen, &headers, "lineitem") {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    seen.made.push(serde_json::from_str(&body).expect("JSON"));
    (StatusCode::CREATED, Json(json!({"id": format!("{url}/items/{}", seen.made.len() - 1)}))).into_response()
}

async fn score(
    State((seen, _)): State<(Shared, String)>,
    Path(n): Path<String>,
    headers: HeaderMap,
    body: String,
) -> Response {
    let mut seen = seen.lock().expect("whole");
    seen.tried += 1;
    assert_eq!(headers[header::CONTENT_TYPE], "application/vnd.ims.lis.v1.score+json");
    if !knows(&seen, &headers, "score") {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    let answer = seen.answers.pop_front();
    if let Some((status, after)) = answer.filter(|(status, _)| *status > 0) {
        let status = StatusCode::from_u16(status).expect("a status");
        return match after {
            Some(after) => (status, [(header::RETRY_AFTER, after)]).into_response(),
            None => status.into_response(),
        };
    }
    seen.scores.push((n, serde_json::from_str(&body).expect("JSON")));
    if answer.is_some() {
        // It is taken, and the answer is lost.
        return StatusCode::BAD_GATEWAY.into_response();
    }
    StatusCode::OK.into_response()
}

async fn people(
    State((seen, url)): State<(Shared, String)>,
    Query(query): Query<std::collections::HashMap<String, String>>,
    headers: HeaderMap,
) -> Response {
    let seen = seen.lock().expect("whole");
    if !knows(&seen, &headers, "contextmembership.readonly") {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    let page: usize = query.get("page").map_or(0, |page| page.parse().expect("a number"));
    let next = match &seen.elsewhere {
        _ if page + 1 < seen.people.len() => Some(format!("{url}/people?limit=2&page={}", page + 1)),
        elsewhere => elsewhere.clone(),
    };
    let body = Json(json!({"id": url, "members": seen.people.get(page)}));
    match next {
        Some(next) => ([(header::LINK, format!("<{next}>; rel=\"next\""))], body).into_response(),
        None => body.into_response(),
    }
}
