//! Whether a platform's word is its own, meant for us, of now, and about something that we know.

use jsonwebtoken::jwk::{JwkSet, KeyAlgorithm, PublicKeyUse};
use jsonwebtoken::{Algorithm, DecodingKey, Validation};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::claims::Claims;
use super::refusal::{Refusal, shortened};
use crate::policy::Moment;
use crate::store::Platform;

/// Longest word, in bytes: real ones have two to six thousand.
pub const LONGEST: usize = 64 << 10;
/// How far the platform's clock may be from ours, in seconds.
const CLOCKS: f64 = 60.0;

/// The name of the key that a word says it is signed with.
///
/// Errors if it cannot be a word of ours: too long, of another form, or signed in another way than by RS256.
pub fn key_name(token: &str) -> Result<String, Refusal> {
    if token.len() > LONGEST {
        return Err(Refusal::TooLong(LONGEST));
    }
    // A header that names no algorithm, or one that the library does not know, is refused here.
    let header = jsonwebtoken::decode_header(token).map_err(|error| match error.kind() {
        jsonwebtoken::errors::ErrorKind::Json(_) => Refusal::Algorithm,
        _ => Refusal::Unreadable("it is no signed token".to_owned()),
    })?;
    if header.alg != Algorithm::RS256 {
        return Err(Refusal::Algorithm);
    }
    header.kid.ok_or(Refusal::Missing("with which key its word is signed (kid)"))
}

/// What the word says, if it is signed by the key `name` of `keys`.
///
/// Errors if it is not, or says what cannot be read.
pub fn signed<T: DeserializeOwned>(token: &str, name: &str, keys: &JwkSet) -> Result<T, Refusal> {
    let key = keys.find(name).ok_or(Refusal::Key)?;
    let is_for_it = key.common.key_algorithm.is_none_or(|algorithm| algorithm == KeyAlgorithm::RS256)
        && key.common.public_key_use.as_ref().is_none_or(|used| *used == PublicKeyUse::Signature);
    let key = DecodingKey::from_jwk(key).ok().filter(|_| is_for_it).ok_or(Refusal::Key)?;
    // The key decides nothing about the algorithm, and the token neither.
    let mut validation = Validation::new(Algorithm::RS256);
    // Every claim is asked for in `meant`, each with its own refusal.
    validation.required_spec_claims.clear();
    validation.validate_exp = false;
    validation.validate_aud = false;
    let read = jsonwebtoken::decode::<Value>(token, &key, &validation);
    let claims = read.map_err(|_| Refusal::Signature)?.claims;
    serde_path_to_error::deserialize(claims)
        .map_err(|error| Refusal::Unreadable(shortened(&format!("at {}: {}", error.path(), error.inner()))))
}

fn required(value: Option<&str>, what: &'static str) -> Result<String, Refusal> {
    value.filter(|text| !text.is_empty()).ok_or(Refusal::Missing(what)).map(str::to_owned)
}

/// Whether signed claims are the platform's, for us, of now, and answer `nonce`; what they are not is refused.
pub fn meant(claims: &Claims, platform: &Platform, nonce: &str, now: Moment) -> Result<(), Refusal> {
    of_now(claims, &platform.issuer, &platform.client_id, nonce, now)?;
    let version = required(claims.version.as_deref(), "its version of LTI")?;
    if version != "1.3.0" {
        return Err(Refusal::Version(shortened(&version)));
    }
    let deployment = required(claims.deployment.as_deref(), "which of its deployments it is")?;
    if !platform.deployments.contains(&deployment) {
        return Err(Refusal::Deployment(shortened(&deployment)));
    }
    Ok(())
}

/// Whether signed claims are of an issuer, for a client, of now, and answer `nonce`, as OpenID Connect asks of all words.
pub fn of_now(
    claims: &Claims,
    issuer: &str,
    client_id: &str,
    nonce: &str,
    now: Moment,
) -> Result<(), Refusal> {
    if required(claims.iss.as_deref(), "who it is (iss)")? != issuer {
        return Err(Refusal::Issuer);
    }
    let audience = claims.aud.as_ref().ok_or(Refusal::Missing("for whom its word is (aud)"))?.all();
    if !audience.iter().any(|one| one == client_id) {
        return Err(Refusal::Audience);
    }
    match &claims.azp {
        Some(party) if party != client_id => return Err(Refusal::AuthorizedParty),
        None if audience.len() > 1 => return Err(Refusal::AuthorizedParty),
        _ => {}
    }
    let seconds = now.0 as f64 / 1000.0;
    let ends = claims.exp.ok_or(Refusal::Missing("until when its word is good (exp)"))?;
    let made = claims.iat.ok_or(Refusal::Missing("when it gave its word (iat)"))?;
    if ends <= seconds - CLOCKS {
        return Err(Refusal::Expired);
    }
    if made.max(claims.nbf.unwrap_or(made)) > seconds + CLOCKS {
        return Err(Refusal::Early);
    }
    if required(claims.nonce.as_deref(), "which launch it answers (nonce)")? != nonce {
        return Err(Refusal::Nonce);
    }
    required(claims.sub.as_deref(), "who comes (sub)").map(drop)
}
