//! Our keys: what we say to a platform is signed with the newest, and all are published.

use aws_lc_rs::encoding::{AsDer, Pkcs8V1Der};
use aws_lc_rs::rsa::{KeyPair, KeySize};
use jsonwebtoken::jwk::{Jwk, JwkSet, PublicKeyUse, ThumbprintHash};
use jsonwebtoken::{Algorithm, EncodingKey, Header};
use serde::Serialize;

use crate::problem::Problem;
use crate::store::Store;
use crate::store::hash::hexadecimal;

/// Bytes before the key of RFC 8017 in one of RSA with 2048 bits as PKCS #8 has it (RFC 5208): a sequence, a version, an
/// algorithm and the head of a string of bytes, all of fixed length.
const HEAD: usize = 26;

/// The name of a new key, and the key itself as it is kept.
///
/// Errors if the system has no randomness.
pub fn generate() -> Result<(String, String), Problem> {
    let pair = KeyPair::generate(KeySize::Rsa2048).map_err(Problem::internal)?;
    let der: Pkcs8V1Der<'_> = pair.as_der().map_err(Problem::internal)?;
    let private = der.as_ref().get(HEAD..).unwrap_or_default();
    let name = public(private)?.thumbprint(ThumbprintHash::SHA256).map_err(Problem::internal)?;
    Ok((name, hexadecimal(private)))
}

fn public(private: &[u8]) -> Result<Jwk, Problem> {
    let key = EncodingKey::from_rsa_der(private);
    Jwk::from_encoding_key(&key, Algorithm::RS256).map_err(Problem::internal)
}

/// The bytes that [`hexadecimal`] wrote.
fn bytes(digits: &str) -> Result<Vec<u8>, Problem> {
    let pair = |at: usize| digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
    let read: Option<Vec<u8>> = (0..digits.len()).step_by(2).map(pair).collect();
    read.ok_or_else(|| Problem::internal("a key of this server is damaged"))
}

/// Our keys, the newest first; one is made if there is none.
///
/// Errors if the gradebook fails.
async fn all(store: &Store) -> Result<Vec<(String, String)>, Problem> {
    let known = store.lti_keys().await?;
    if !known.is_empty() {
        return Ok(known);
    }
    renew(store).await?;
    Ok(store.lti_keys().await?)
}

/// Makes a key that signs from now on; its name.
///
/// Errors if the gradebook fails.
pub async fn renew(store: &Store) -> Result<String, Problem> {
    let (name, private) = crate::blocking(generate).await?;
    store.add_lti_key(&name, &private).await?;
    Ok(name)
}

/// The keys that we publish.
///
/// Errors if the gradebook fails.
pub async fn published(store: &Store) -> Result<JwkSet, Problem> {
    let mut keys = Vec::new();
    for (name, private) in all(store).await? {
        let mut key = public(&bytes(&private)?)?;
        key.common.key_id = Some(name);
        key.common.public_key_use = Some(PublicKeyUse::Signature);
        keys.push(key);
    }
    Ok(JwkSet { keys })
}

/// Something that we say, signed with our newest key.
///
/// Errors if the gradebook fails.
pub async fn sign(store: &Store, said: &impl Serialize) -> Result<String, Problem> {
    let keys = all(store).await?;
    let (name, private) = keys.first().ok_or_else(|| Problem::internal("there is no key"))?;
    let header = Header { kid: Some(name.clone()), ..Header::new(Algorithm::RS256) };
    let key = EncodingKey::from_rsa_der(&bytes(private)?);
    jsonwebtoken::encode(&header, said, &key).map_err(Problem::internal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jsonwebtoken::{DecodingKey, Validation};

    #[tokio::test]
    async fn what_is_signed_can_be_checked_by_what_is_published_after_a_renewal_too() {
        let store = Store::in_memory();
        let said = serde_json::json!({"iss": "us", "exp": 4_000_000_000_u64});
        let before = sign(&store, &said).await.expect("signed");
        renew(&store).await.expect("another key");
        let after = sign(&store, &said).await.expect("signed");
        let set = published(&store).await.expect("keys");
        assert_eq!(set.keys.len(), 2);
        let mut names = Vec::new();
        for token in [before, after] {
            let name = jsonwebtoken::decode_header(&token).expect("a header").kid.expect("a name");
            let key = DecodingKey::from_jwk(set.find(&name).expect("published")).expect("a key");
            let read =
                jsonwebtoken::decode::<serde_json::Value>(&token, &key, &Validation::new(Algorithm::RS256));
            assert_eq!(read.expect("signed by it").claims["iss"], "us");
            names.push(name);
        }
        assert_ne!(names[0], names[1], "the newest signs");
        let text = serde_json::to_string(&set).expect("JSON");
        assert!(!text.contains("\"d\"") && text.contains("\"use\":\"sig\""), "{text}");
    }
}
