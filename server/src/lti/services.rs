//! Asking a platform's services: with a token that it gives us for our signed proof.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use axum::http::{StatusCode, header};
use serde::Deserialize;
use serde_json::json;

use super::address::is_service;
use super::http::{Answer, Failure, Http};
use super::{Lti, keys};
use crate::policy::Moment;
use crate::store::{Platform, Store, identifier};

/// To make and find columns.
pub const LINE_ITEM: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/lineitem";
/// To write scores.
pub const SCORE: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/score";
/// To read who belongs to a course.
pub const PEOPLE: &str = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly";

/// How long a proof of ours is good, in seconds.
const PROOF: i64 = 300;
/// A token is asked for anew when so much of its time is left, in milliseconds.
const SPARE: i64 = 60_000;
/// Longest time that a token is kept, in milliseconds: what a platform forgets meanwhile costs one request.
const LONGEST: i64 = 3_600_000;

/// Tokens that platforms gave us, by platform and scope, with their ends.
#[derive(Debug, Default)]
pub(super) struct Tokens(Mutex<HashMap<(String, &'static str), Token>>);

/// A token and its end.
#[derive(Clone)]
struct Token {
    text: String,
    ends_at: i64,
}

impl std::fmt::Debug for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a token until {}", self.ends_at)
    }
}

/// Why a service gives no answer that can be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Unserved {
    /// The address is not the platform's.
    #[error("{0} is not at an address that was registered: add it with triad lti add … --service ORIGIN")]
    Foreign(String),
    /// It gave no token.
    #[error("no token is given for {scope}: {why}")]
    NoToken {
        /// For what.
        scope: &'static str,
        /// What it said.
        why: String,
    },
    /// Nothing came back.
    #[error(transparent)]
    Silent(#[from] Failure),
    /// We cannot sign or read.
    #[error("{0}")]
    Ours(String),
}

/// What is sent to a service.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// For what the token is.
    pub scope: &'static str,
    /// Where.
    pub url: &'a str,
    /// The media type of what is sent and of what is wanted.
    pub media: &'static str,
    /// What is sent; nothing is sent where something is asked for.
    pub body: Option<&'a str>,
}

impl Lti {
    /// Asks a service. A token that it no longer knows is asked for anew, once.
    ///
    /// Errors if there is no answer; one that refuses is an answer.
    pub async fn ask(
        &self,
        store: &Store,
        platform: &Platform,
        asked: Asked<'_>,
        now: Moment,
    ) -> Result<Answer, Unserved> {
        if !is_service(platform, asked.url) {
            return Err(Unserved::Foreign(super::refusal::shortened(asked.url)));
        }
        let mut answer = self.once(store, platform, asked, now).await?;
        if answer.status == StatusCode::UNAUTHORIZED {
            self.tokens.forget(&platform.id, asked.scope);
            answer = self.once(store, platform, asked, now).await?;
        }
        Ok(answer)
    }

    async fn once(
        &self,
        store: &Store,
        platform: &Platform,
        asked: Asked<'_>,
        now: Moment,
    ) -> Result<Answer, Unserved> {
        let token = if let Some(token) = self.tokens.known(&platform.id, asked.scope, now) {
            token
        } else {
            let token = token(&self.http, store, platform, asked.scope, now).await?;
            self.tokens.keep(&platform.id, asked.scope, &token);
            token.text
        };
        let bearer = format!("Bearer {token}");
        let authorized = (header::AUTHORIZATION, bearer.as_str());
        Ok(match asked.body {
            Some(body) => {
                let headers = [authorized, (header::CONTENT_TYPE, asked.media)];
                self.http.post(asked.url, &headers, body.to_owned()).await?
            }
            None => self.http.get(asked.url, &[authorized, (header::ACCEPT, asked.media)]).await?,
        })
    }
}

impl Tokens {
    fn known(&self, platform: &str, scope: &'static str, now: Moment) -> Option<String> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let token = all.get(&(platform.to_owned(), scope))?;
        (token.ends_at > now.0 + SPARE).then(|| token.text.clone())
    }

    fn keep(&self, platform: &str, scope: &'static str, token: &Token) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert((platform.to_owned(), scope), token.clone());
    }

    fn forget(&self, platform: &str, scope: &'static str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&(platform.to_owned(), scope));
    }
}

/// What a platform answers to a proof.
#[derive(Deserialize)]
struct Given {
    access_token: String,
    expires_in: Option<f64>,
}

/// Gets a token: OAuth 2 client credentials with a signed assertion, as the Security Framework has it.
async fn token(
    http: &Http,
    store: &Store,
    platform: &Platform,
    scope: &'static str,
    now: Moment,
) -> Result<Token, Unserved> {
    let seconds = now.0 / 1000;
    let said = json!({
        "iss": platform.client_id, "sub": platform.client_id, "aud": platform.audience,
        "iat": seconds - 5, "exp": seconds + PROOF, "jti": identifier(),
    });
    let proof = keys::sign(store, &said).await.map_err(|problem| Unserved::Ours(problem.to_string()))?;
    let form = url::form_urlencoded::Serializer::new(String::new())
        .append_pair("grant_type", "client_credentials")
        .append_pair("client_assertion_type", "urn:ietf:params:oauth:client-assertion-type:jwt-bearer")
        .append_pair("client_assertion", &proof)
        .append_pair("scope", scope)
        .finish();
    let headers =
        [(header::CONTENT_TYPE, "application/x-www-form-urlencoded"), (header::ACCEPT, "application/json")];
    let answer = http.post(&platform.token_url, &headers, form).await?;
    let refused = |why: String| Unserved::NoToken { scope, why };
    if !answer.status.is_success() {
        return Err(refused(format!("it answers {}", answer.status.as_u16())));
    }
    let given: Given =
        serde_json::from_slice(&answer.body).map_err(|_| refused("its answer has no token".to_owned()))?;
    if given.access_token.is_empty() || !given.access_token.bytes().all(|byte| byte.is_ascii_graphic()) {
        return Err(refused("its token is none".to_owned()));
    }
    // Bounded, and a number: what comes from elsewhere is not computed with as it is.
    #[allow(clippy::cast_possible_truncation, reason = "within a day")]
    let life = (given.expires_in.unwrap_or(3600.0).clamp(0.0, 86_400.0) * 1000.0) as i64;
    Ok(Token { text: given.access_token, ends_at: now.0 + life.min(LONGEST) })
}
