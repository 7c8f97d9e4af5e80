//! LTI 1.3: a course of a learning platform sends its people here, chooses lessons, and takes scores back.
//!
//! The platform signs who comes and why ([`verify`]); we sign what we ask of it ([`keys`], [`services`]). Specifications: LTI
//! Core 1.3, Deep Linking 2.0, Assignment and Grade Services 2.0, Names and Role Provisioning Services 2.0, Security Framework
//! 1.0, all of 1EdTech.

pub mod address;
pub mod choice;
pub mod claims;
pub mod http;
pub mod keys;
pub mod refusal;
pub mod registration;
pub mod roles;
pub mod roster;
pub mod scores;
pub mod services;
pub mod ticket;
pub mod verify;

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use jsonwebtoken::jwk::JwkSet;
use url::Url;

use crate::policy::Moment;
use crate::store::hash::sha256;
use crate::store::{CLASS, Platform, Store};
use http::Http;
use refusal::Refusal;

/// How long keys of a platform are taken as they were found, in milliseconds: an hour.
const FRESH: i64 = 3_600_000;
/// A key that is not among them has them fetched again, at most so often, in milliseconds: a minute.
const AGAIN: i64 = 60_000;

/// What a server knows that is reached by learning platforms.
#[derive(Debug)]
pub struct Lti {
    /// Where browsers find us, without a slash at the end.
    base: String,
    /// Signs what comes back to us.
    secret: String,
    http: Http,
    keys: Mutex<HashMap<String, KnownKeys>>,
    tokens: services::Tokens,
}

/// Keys of a platform, and when they were fetched.
#[derive(Debug, Clone)]
struct KnownKeys {
    set: JwkSet,
    at: Moment,
}

impl Lti {
    /// Reached at `base`, as `https://triad.example.org`; `secret` is the class's own.
    ///
    /// Errors if browsers would not come back there with what they were given: it takes encryption, or the machine itself.
    pub fn at(base: &str, secret: &str) -> Result<Self, Refusal> {
        let url = address::safe(base).ok_or_else(|| Refusal::NotServed(base.to_owned()))?;
        if url.query().is_some() || url.fragment().is_some() {
            return Err(Refusal::NotServed(base.to_owned()));
        }
        Ok(Self {
            base: url.as_str().trim_end_matches('/').to_owned(),
            secret: sha256(&serde_json::json!(["lti", secret]).to_string()),
            http: Http::new(),
            keys: Mutex::default(),
            tokens: services::Tokens::default(),
        })
    }

    /// One of our addresses: `path` begins with a slash.
    pub fn url(&self, path: &str) -> String {
        format!("{}{path}", self.base)
    }

    /// What signs the tickets that we give browsers along.
    pub fn secret(&self) -> &str {
        &self.secret
    }

    /// Whether browsers reach us encrypted.
    pub fn is_encrypted(&self) -> bool {
        self.base.starts_with("https:")
    }

    /// What the names of our cookies begin with, so that browsers hold them to what they are: of this host alone where it is ours to
    /// its root, and sent encrypted.
    pub fn cookie_prefix(&self) -> &'static str {
        let root = Url::parse(&self.base).is_ok_and(|url| url.path() == "/");
        match (self.is_encrypted(), root) {
            (true, true) => "__Host-",
            (true, false) => "__Secure-",
            (false, _) => "",
        }
    }

    /// The path of an address of ours, with a slash before it.
    ///
    /// Errors if it is another's.
    pub fn own_path(&self, target: &str) -> Result<String, Refusal> {
        let other = || Refusal::Target(target.chars().take(200).collect());
        let (url, base) = (Url::parse(target).map_err(|_| other())?, Url::parse(&self.base));
        let base = base.map_err(|_| other())?;
        let path = url.path().strip_prefix(base.path().trim_end_matches('/')).ok_or_else(other)?;
        let is_ours = url.origin() == base.origin() && url.username().is_empty() && url.password().is_none();
        if !is_ours || !(path.is_empty() || path.starts_with('/')) {
            return Err(other());
        }
        Ok(if path.is_empty() { "/".to_owned() } else { path.to_owned() })
    }

    /// Asks others.
    pub fn http(&self) -> &Http {
        &self.http
    }

    /// The keys of a platform, fetched where they are not known, old, or lack the one of that name.
    ///
    /// Errors if they are not known and cannot be fetched.
    pub async fn keys_of(
        &self,
        platform: &Platform,
        kid: Option<&str>,
        now: Moment,
    ) -> Result<JwkSet, Refusal> {
        let keys = self.keys_at(&platform.keys_url, kid, now).await;
        keys.map_err(|why| Refusal::NoKeys { at: platform.keys_url.clone(), why })
    }

    /// The keys at an address, as [`Self::keys_of`].
    ///
    /// Errors with the reason if they are not known and cannot be fetched.
    pub async fn keys_at(&self, url: &str, kid: Option<&str>, now: Moment) -> Result<JwkSet, String> {
        let known = self.keys.lock().unwrap_or_else(PoisonError::into_inner).get(url).cloned();
        if let Some(known) = &known {
            let age = now.0 - known.at.0;
            let has = kid.is_some_and(|kid| known.set.find(kid).is_some());
            if age < AGAIN || (has && age < FRESH) {
                return Ok(known.set.clone());
            }
        }
        let fetched = async {
            let answer = self.http.get(url, &[]).await.map_err(|error| error.to_string())?;
            if !answer.status.is_success() {
                return Err(format!("it answers {}", answer.status.as_u16()));
            }
            serde_json::from_slice::<JwkSet>(&answer.body).map_err(|_| "it is no set of keys".to_owned())
        };
        match (fetched.await, known) {
            (Ok(set), _) => {
                let known = KnownKeys { set: set.clone(), at: now };
                let mut all = self.keys.lock().unwrap_or_else(PoisonError::into_inner);
                all.insert(url.to_owned(), known);
                Ok(set)
            }
            // What was good an hour ago serves while the platform is silent.
            (Err(_), Some(known)) => Ok(known.set),
            (Err(why), None) => Err(why),
        }
    }
}

/// The platform that a word names: by issuer, and by client where there are several or it says so.
///
/// Errors if it is not registered.
pub async fn platform(
    store: &Store,
    issuer: &str,
    client_id: Option<&str>,
) -> Result<Result<Platform, Refusal>, crate::store::StoreError> {
    let all = store.platforms(CLASS).await?;
    let mut fitting = all.into_iter().filter(|one| {
        one.issuer == issuer && client_id.is_none_or(|client| client.is_empty() || client == one.client_id)
    });
    let unknown = || Refusal::Platform { issuer: refusal::shortened(issuer) };
    Ok(match (fitting.next(), fitting.next()) {
        (Some(one), None) => Ok(one),
        (Some(_), Some(_)) => Err(Refusal::Client { issuer: refusal::shortened(issuer) }),
        (None, _) => Err(unknown()),
    })
}
