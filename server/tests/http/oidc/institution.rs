//! A provider of sign-ins as small as it can be, which a test can have lie.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Form, Json, Router};
use base64::Engine;
use base64::prelude::{BASE64_STANDARD, BASE64_URL_SAFE_NO_PAD};
use jsonwebtoken::jwk::JwkSet;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use tokio::net::TcpListener;
use triad::oidc::{BACK, Provider};
use url::Url;

use crate::Reply;
use crate::lti::platform::Signing;

/// What the provider calls us, and what shows it that we are who asks.
const CLIENT: (&str, &str) = ("triad", "a secret: with signs");

/// A provider as small as it can be.
pub struct Institution {
    pub url: String,
    pub seen: Shared,
}

pub type Shared = Arc<Mutex<Seen>>;

pub struct Seen {
    url: String,
    /// The address of the class that is registered there.
    home: String,
    pub signing: Signing,
    /// What it gives for a code, once: the claims, and the challenge with which it was asked.
    codes: HashMap<String, (Value, String)>,
    /// What it says of itself instead of what it should.
    pub describes: Option<Value>,
    /// What it answers instead of a token.
    pub answers: Option<(StatusCode, Value)>,
    /// What it signs with instead of its published key.
    pub forges: Option<Signing>,
    pub in_body: bool,
}

impl Institution {
    pub async fn start(home: &str) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let seen = Arc::new(Mutex::new(Seen {
            url: url.clone(),
            home: home.to_owned(),
            signing: Signing::new(),
            codes: HashMap::new(),
            describes: None,
            answers: None,
            forges: None,
            in_body: false,
        }));
        let router = Router::new()
            .route("/.well-known/openid-configuration", get(describes))
            .route("/keys", get(keys))
            .route("/token", post(token))
            .with_state(Arc::clone(&seen));
        tokio::spawn(async move { axum::serve(listener, router).await });
        Self { url, seen }
    }

    pub fn provider(&self) -> Provider {
        Provider {
            issuer: self.url.clone(),
            client_id: CLIENT.0.into(),
            client_secret: Some(CLIENT.1.into()),
            name: Some("the school".into()),
        }
    }

    /// Somebody says there who they are: the code with which their browser is sent back.
    pub fn agrees(&self, asked: &Asked, subject: &str, change: impl FnOnce(&mut Value)) -> String {
        let now = jiff::Timestamp::now().as_second();
        let mut claims = json!({
            "iss": self.url, "aud": CLIENT.0, "sub": subject, "iat": now, "exp": now + 300, "nonce": asked.of("nonce"),
        });
        change(&mut claims);
        let mut seen = self.seen.lock().expect("whole");
        let code = format!("code {}", seen.codes.len());
        seen.codes.insert(code.clone(), (claims, asked.of("code_challenge")));
        code
    }
}

pub async fn describes(State(seen): State<Shared>) -> Json<Value> {
    let seen = seen.lock().expect("whole");
    let url = &seen.url;
    let method = if seen.in_body { "client_secret_post" } else { "client_secret_basic" };
    Json(seen.describes.clone().unwrap_or_else(|| {
        json!({
            "issuer": url, "authorization_endpoint": format!("{url}/auth?tenant=1"), "token_endpoint": format!("{url}/token"),
            "jwks_uri": format!("{url}/keys"), "token_endpoint_auth_methods_supported": [method],
        })
    }))
}

async fn keys(State(seen): State<Shared>) -> Json<JwkSet> {
    Json(JwkSet { keys: vec![seen.lock().expect("whole").signing.public()] })
}

async fn token(
    State(seen): State<Shared>,
    headers: HeaderMap,
    Form(form): Form<HashMap<String, String>>,
) -> Response {
    let mut seen = seen.lock().expect("whole");
    if let Some(answer) = seen.answers.take() {
        return (answer.0, Json(answer.1)).into_response();
    }
    if seen.in_body {
        assert_eq!(form["client_secret"], CLIENT.1);
    } else {
        let both = BASE64_STANDARD.encode(format!("{}:{}", CLIENT.0, "a+secret%3A+with+signs"));
        assert_eq!(headers[header::AUTHORIZATION], format!("Basic {both}"));
    }
    assert_eq!((form["grant_type"].as_str(), form["client_id"].as_str()), ("authorization_code", CLIENT.0));
    assert_eq!(form["redirect_uri"], format!("{}{BACK}", seen.home));
    let Some((claims, challenge)) = seen.codes.remove(&form["code"]) else {
        return (StatusCode::BAD_REQUEST, Json(json!({"error": "invalid_grant"}))).into_response();
    };
    let proof = BASE64_URL_SAFE_NO_PAD.encode(Sha256::digest(&form["code_verifier"]));
    assert_eq!(proof, challenge, "PKCE");
    let signing = seen.forges.as_ref().unwrap_or(&seen.signing);
    Json(json!({"token_type": "Bearer", "access_token": "none", "id_token": signing.sign(&claims)}))
        .into_response()
}

/// What a browser was sent on with, and what it keeps.
pub struct Asked {
    pub to: Url,
    pub cookie: String,
}

impl Asked {
    pub fn new(to: &str, reply: &Reply) -> Self {
        let set = reply.headers[header::SET_COOKIE].to_str().expect("text");
        assert!(
            (set.starts_with("__Host-triad-oidc-") || set.starts_with("__Secure-triad-oidc-"))
                && set.contains("HttpOnly")
                && set.contains("Secure"),
            "{set}"
        );
        assert!(set.contains("SameSite=Lax"), "it comes back by a link: {set}");
        let cookie = set.split(';').next().unwrap_or_default().to_owned();
        Self { to: Url::parse(to).expect("an address"), cookie }
    }

    pub fn of(&self, wanted: &str) -> String {
        let found = self.to.query_pairs().find(|(name, _)| name == wanted);
        found.map(|(_, value)| value.into_owned()).unwrap_or_default()
    }
}
