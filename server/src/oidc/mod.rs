//! Sign-in by OpenID Connect: people of the class come back with the account that they have at their institution.
//!
//! An account there is one more way to come back, like four words. It is connected by somebody who is signed in, and who they are and
//! what they may do is said by the class alone. Authorization code with PKCE; what a browser brings along is a signed ticket, so that any
//! of several servers may finish what another began. LTI is OpenID Connect with more to it: its client, its tickets, and its reading of
//! keys and words serve here too. Specifications: OpenID Connect Core 1.0 and Discovery 1.0, RFC 7636 (PKCE), RFC 9207 (the issuer in
//! an answer).

pub mod refusal;

use std::sync::{Arc, Mutex, PoisonError};

use axum::http::header;
use base64::Engine;
use base64::prelude::{BASE64_STANDARD, BASE64_URL_SAFE_NO_PAD};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use url::Url;
use url::form_urlencoded::{Serializer, byte_serialize};

use crate::lti::claims::Claims;
use crate::lti::refusal::{Refusal as Word, shortened};
use crate::lti::ticket::{self, Ticket};
use crate::lti::{Lti, address, verify};
use crate::policy::Moment;
use crate::store::hash::sha256;
use crate::store::{identifier, secret};
use refusal::Refusal;

/// Our address to which the provider sends browsers back.
pub const BACK: &str = "/oidc/callback";
/// How long what a provider says of itself is taken as it was found, in milliseconds: an hour.
const FRESH: i64 = 3_600_000;

/// A provider, as whoever runs the server names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provider {
    /// Its address, under which it says where it is asked.
    pub issuer: String,
    /// What it calls us.
    pub client_id: String,
    /// Shows it that we are who asks; nothing where PKCE alone does.
    pub client_secret: Option<String>,
    /// What people call it.
    pub name: Option<String>,
}

/// What a provider says of itself.
#[derive(Debug, Clone, Deserialize)]
struct Discovered {
    issuer: String,
    authorization_endpoint: String,
    token_endpoint: String,
    jwks_uri: String,
    /// How it wants to see the secret; where it does not say, in a header.
    #[serde(default)]
    token_endpoint_auth_methods_supported: Vec<String>,
}

/// A sign-in that was begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Begun {
    /// What the provider's word has to answer.
    nonce: String,
    /// Hash of what the browser was given.
    browser: String,
    /// Who connects their account; nothing where somebody comes back.
    pub person: Option<String>,
}

impl Ticket for Begun {
    const KIND: &str = "sign-in";
    const LIFE: i64 = ticket::LAUNCH;
}

/// Where a browser goes to be known, and the cookie by which it is known again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Departure {
    /// The provider's address.
    pub to: String,
    /// Name and value.
    pub cookie: (String, String),
}

/// What a browser brings back.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Return {
    code: Option<String>,
    state: Option<String>,
    iss: Option<String>,
    error: Option<String>,
    error_description: Option<String>,
}

/// What the provider gives for a code.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Given {
    id_token: Option<String>,
    error: Option<String>,
    error_description: Option<String>,
}

/// Sign-in at one provider.
#[derive(Debug)]
pub struct Oidc {
    provider: Provider,
    /// Our own address, and the means to ask others.
    lti: Arc<Lti>,
    known: Mutex<Option<(Discovered, Moment)>>,
}

impl Oidc {
    /// At this provider. `lti`: where browsers find us.
    pub fn new(provider: Provider, lti: Arc<Lti>) -> Self {
        Self { provider, lti, known: Mutex::default() }
    }

    /// What people call the provider.
    pub fn name(&self) -> Option<&str> {
        self.provider.name.as_deref()
    }

    /// Begins a sign-in, or with `person` connects their account.
    ///
    /// Errors if the provider does not say where.
    pub async fn begin(&self, person: Option<String>, now: Moment) -> Result<Departure, Refusal> {
        let discovered = self.discovered(now).await?;
        let secret = secret();
        let begun = Begun { nonce: identifier(), browser: sha256(&secret), person };
        let state = ticket::write(self.lti.secret(), &begun, now).ok_or(Refusal::State)?;
        let mut to = self.endpoint(&discovered.authorization_endpoint)?;
        let challenge = BASE64_URL_SAFE_NO_PAD.encode(Sha256::digest(verifier(&secret)));
        to.query_pairs_mut()
            .append_pair("response_type", "code")
            .append_pair("scope", "openid")
            .append_pair("client_id", &self.provider.client_id)
            .append_pair("redirect_uri", &self.lti.url(BACK))
            .append_pair("state", &state)
            .append_pair("nonce", &begun.nonce)
            .append_pair("code_challenge", &challenge)
            .append_pair("code_challenge_method", "S256");
        Ok(Departure { to: to.into(), cookie: (self.cookie_name(&begun.nonce), secret) })
    }

    /// The sign-in that a browser comes back from, and the name and the value of its cookie. `cookie` finds one by its name.
    ///
    /// Errors if it was not begun here, not in this browser, or did not go well.
    pub fn begun(
        &self,
        back: &Return,
        cookie: impl Fn(&str) -> Option<String>,
        now: Moment,
    ) -> Result<(Begun, (String, String)), Refusal> {
        let state =
            back.state.as_deref().filter(|state| state.len() <= verify::LONGEST).ok_or(Refusal::State)?;
        let begun: Begun = ticket::read(self.lti.secret(), state, now).ok_or(Refusal::State)?;
        let name = self.cookie_name(&begun.nonce);
        let secret =
            cookie(&name).filter(|secret| sha256(secret) == begun.browser).ok_or(Refusal::Browser)?;
        if back.iss.as_ref().is_some_and(|issuer| *issuer != self.provider.issuer) {
            return Err(Refusal::OtherProvider);
        }
        if let Some(error) = &back.error {
            let said = back.error_description.as_deref().unwrap_or_default();
            return Err(Refusal::Reported(shortened(format!("{error} {said}").trim_end())));
        }
        Ok((begun, (name, secret)))
    }

    /// The account that a browser comes back with: a name for it that tells nothing, the same each time.
    ///
    /// Errors if the provider does not vouch for it.
    pub async fn account(
        &self,
        back: &Return,
        begun: &Begun,
        secret: &str,
        now: Moment,
    ) -> Result<String, Refusal> {
        let code = back.code.as_deref().filter(|code| !code.is_empty());
        let code = code.ok_or(Word::Missing("for what its word is given (code)"))?;
        let discovered = self.discovered(now).await?;
        let token = self.exchanged(&discovered, code, secret).await?;
        let name = verify::key_name(&token)?;
        let keys = self.lti.keys_at(&discovered.jwks_uri, Some(&name), now).await;
        let keys = keys.map_err(|why| Word::NoKeys { at: discovered.jwks_uri, why })?;
        let claims: Claims = verify::signed(&token, &name, &keys)?;
        verify::of_now(&claims, &self.provider.issuer, &self.provider.client_id, &begun.nonce, now)?;
        Ok(sha256(&serde_json::json!([self.provider.issuer, claims.sub]).to_string()))
    }

    /// The signed word that the provider gives for a code.
    async fn exchanged(&self, discovered: &Discovered, code: &str, secret: &str) -> Result<String, Refusal> {
        let Provider { client_id, client_secret, .. } = &self.provider;
        let (us, verifier) = (self.lti.url(BACK), verifier(secret));
        let mut fields = vec![
            ("grant_type", "authorization_code"),
            ("code", code),
            ("redirect_uri", &us),
            ("client_id", client_id),
            ("code_verifier", &verifier),
        ];
        let mut headers = vec![
            (header::CONTENT_TYPE, "application/x-www-form-urlencoded".to_owned()),
            (header::ACCEPT, "application/json".to_owned()),
        ];
        let methods = &discovered.token_endpoint_auth_methods_supported;
        match client_secret {
            Some(secret) if methods.is_empty() || methods.iter().any(|one| one == "client_secret_basic") => {
                let encoded = |text: &str| byte_serialize(text.as_bytes()).collect::<String>();
                let both = BASE64_STANDARD.encode(format!("{}:{}", encoded(client_id), encoded(secret)));
                headers.push((header::AUTHORIZATION, format!("Basic {both}")));
            }
            Some(secret) => fields.push(("client_secret", secret)),
            None => {}
        }
        let body = Serializer::new(String::new()).extend_pairs(fields).finish();
        let headers: Vec<_> = headers.iter().map(|(name, value)| (name.clone(), value.as_str())).collect();
        let endpoint = self.endpoint(&discovered.token_endpoint)?;
        let answer = self.lti.http().post(endpoint.as_str(), &headers, body).await;
        let answer = answer.map_err(|error| self.failed(error.to_string()))?;
        let given: Given = serde_json::from_slice(&answer.body).unwrap_or_default();
        if let Some(error) = given.error.filter(|_| !answer.status.is_success()) {
            let said = given.error_description.unwrap_or_default();
            return Err(Refusal::Code(shortened(format!("{error} {said}").trim_end())));
        }
        if !answer.status.is_success() {
            return Err(self.failed(format!("it answers {}", answer.status.as_u16())));
        }
        given.id_token.ok_or_else(|| Word::Missing("who it is (id_token)").into())
    }

    /// What the provider says of itself, asked again after an hour; what was good then serves while it is silent.
    async fn discovered(&self, now: Moment) -> Result<Discovered, Refusal> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some((known, at)) = &known
            && now.0 - at.0 < FRESH
        {
            return Ok(known.clone());
        }
        let place =
            format!("{}/.well-known/openid-configuration", self.provider.issuer.trim_end_matches('/'));
        let asked = async {
            let answer = self.lti.http().get(&place, &[]).await.map_err(|error| error.to_string())?;
            if !answer.status.is_success() {
                return Err(format!("it answers {}", answer.status.as_u16()));
            }
            let said = serde_json::from_slice::<Discovered>(&answer.body);
            let said = said.map_err(|error| shortened(&format!("it does not describe itself: {error}")))?;
            if said.issuer == self.provider.issuer {
                Ok(said)
            } else {
                Err(format!("it is {}", shortened(&said.issuer)))
            }
        };
        match (asked.await, known) {
            (Ok(said), _) => {
                *self.known.lock().unwrap_or_else(PoisonError::into_inner) = Some((said.clone(), now));
                Ok(said)
            }
            (Err(_), Some((known, _))) => Ok(known),
            (Err(why), None) => Err(self.failed(why)),
        }
    }

    fn endpoint(&self, text: &str) -> Result<Url, Refusal> {
        address::safe(text).ok_or_else(|| self.failed(format!("{} is not encrypted", shortened(text))))
    }

    fn failed(&self, why: String) -> Refusal {
        Refusal::Provider { at: self.provider.issuer.clone(), why }
    }

    /// Several sign-ins may be under way in one browser.
    fn cookie_name(&self, nonce: &str) -> String {
        format!("{}triad-oidc-{}", self.lti.cookie_prefix(), nonce.get(..8).unwrap_or_default())
    }
}

/// What shows the provider that whoever exchanges a code began the sign-in: only the browser's cookie leads to it.
fn verifier(secret: &str) -> String {
    sha256(&serde_json::json!(["verifier", secret]).to_string())
}
