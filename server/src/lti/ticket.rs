//! What we give a browser along and want back unchanged: signed by us, for one use, for a short time.

use jsonwebtoken::{Algorithm, DecodingKey, EncodingKey, Header, Validation};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::policy::Moment;
use crate::store::hash::sha256;

/// How long a launch may take, in milliseconds, signing in at the platform included: ten minutes.
pub const LAUNCH: i64 = 600_000;
/// How long lessons may be chosen, in milliseconds: an hour.
pub const CHOICE: i64 = 3_600_000;

/// A launch that was begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Begun {
    /// The platform.
    pub platform: String,
    /// What the platform's word has to answer.
    pub nonce: String,
    /// Hash of what the browser was given; empty where it could keep nothing, being in a frame of the platform.
    pub browser: String,
}

/// A choice that was begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Choosing {
    /// The platform.
    pub platform: String,
    /// Its deployment.
    pub deployment: String,
    /// Where the choice goes.
    pub return_url: String,
    /// Whether it may be more than one lesson.
    pub several: bool,
    /// Whether columns may come with them.
    pub columns: bool,
    /// What the platform wants back.
    pub data: Option<String>,
}

#[derive(Serialize, Deserialize)]
struct Dated<T> {
    exp: i64,
    what: T,
}

/// A kind of ticket: each has a key of its own, so that none is taken for another.
pub trait Ticket: Serialize + DeserializeOwned {
    /// Its name.
    const KIND: &str;
    /// How long it is good, in milliseconds.
    const LIFE: i64;
}

impl Ticket for Begun {
    const KIND: &str = "launch";
    const LIFE: i64 = LAUNCH;
}

impl Ticket for Choosing {
    const KIND: &str = "choice";
    const LIFE: i64 = CHOICE;
}

fn key<T: Ticket>(secret: &str) -> String {
    sha256(&serde_json::json!([T::KIND, secret]).to_string())
}

/// Writes a ticket; nothing if it cannot be, which does not happen.
pub fn write<T: Ticket>(secret: &str, what: &T, now: Moment) -> Option<String> {
    let dated = Dated { exp: now.after(T::LIFE).0, what };
    let key = EncodingKey::from_secret(key::<T>(secret).as_bytes());
    jsonwebtoken::encode(&Header::new(Algorithm::HS256), &dated, &key).ok()
}

/// Reads a ticket; nothing if it is not ours, of another kind, or too old.
pub fn read<T: Ticket>(secret: &str, text: &str, now: Moment) -> Option<T> {
    let key = DecodingKey::from_secret(key::<T>(secret).as_bytes());
    let mut validation = Validation::new(Algorithm::HS256);
    // Its time is in milliseconds and asked for here.
    validation.validate_exp = false;
    validation.required_spec_claims.clear();
    let dated = jsonwebtoken::decode::<Dated<T>>(text, &key, &validation).ok()?.claims;
    (dated.exp > now.0).then_some(dated.what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ticket_is_good_for_its_time_its_kind_and_its_server() {
        let begun = Begun { platform: "p".into(), nonce: "n".into(), browser: String::new() };
        let now = Moment(1_000_000);
        let text = write("secret", &begun, now).expect("written");
        let read_at = |secret: &str, text: &str, at: Moment| read::<Begun>(secret, text, at);
        assert_eq!(read_at("secret", &text, now.after(LAUNCH - 1)), Some(begun));
        assert_eq!(read_at("secret", &text, now.after(LAUNCH)), None);
        assert_eq!(read_at("other", &text, now), None);
        assert_eq!(read::<Choosing>("secret", &text, now), None);
        let (head, tail) = text.split_at(text.len() / 2);
        assert_eq!(read_at("secret", &format!("{head}x{tail}"), now), None);
    }
}
