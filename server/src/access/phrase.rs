//! Four words with which somebody comes back, and their hash.

use argon2::Argon2;
use argon2::password_hash::{PasswordHash, PasswordHasher, PasswordVerifier, SaltString};

use crate::problem::Problem;

/// Words, 512 of them, none the beginning of another: four are 36 bits, of which a guesser tries one a minute.
const WORDS: &str = include_str!("words.txt");
/// How many words one comes back with.
const COUNT: usize = 4;

/// The hash of words that nobody has.
const NOBODY: &str =
    "$argon2id$v=19$m=19456,t=2,p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

/// Four words by chance.
///
/// Errors if the system has no randomness.
pub fn generate() -> Result<String, Problem> {
    let words: Vec<&str> = WORDS.split_whitespace().collect();
    let mut bytes = [0; 2 * COUNT];
    getrandom::fill(&mut bytes).map_err(Problem::internal)?;
    // 65536 is a multiple of 512: each word is as likely as any other.
    let word = |pair: &[u8]| words[usize::from(u16::from_le_bytes([pair[0], pair[1]])) % words.len()];
    Ok(bytes.chunks(2).map(word).collect::<Vec<_>>().join(" "))
}

/// The hash that is kept: slow to compute, so that few words stay hard to guess from a stolen file.
///
/// Errors if the system has no randomness.
pub fn hash(phrase: &str) -> Result<String, Problem> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(Problem::internal)?;
    let salt = SaltString::encode_b64(&bytes).map_err(Problem::internal)?;
    let hashed = Argon2::default().hash_password(plain(phrase).as_bytes(), &salt);
    Ok(hashed.map_err(Problem::internal)?.to_string())
}

/// Whether the phrase is the one whose hash is kept. Takes as long where there is none.
pub fn fits(phrase: &str, kept: Option<&str>) -> bool {
    let parsed = PasswordHash::new(kept.unwrap_or(NOBODY));
    parsed.is_ok_and(|kept| Argon2::default().verify_password(plain(phrase).as_bytes(), &kept).is_ok())
}

/// As people type it: any case, any number of spaces, commas or dashes between.
fn plain(phrase: &str) -> String {
    let words = phrase.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn words_are_many_and_cannot_be_confused() {
        let words: Vec<&str> = WORDS.split_whitespace().collect();
        assert_eq!(words.iter().collect::<BTreeSet<_>>().len(), 512);
        for (a, b) in words.iter().flat_map(|a| words.iter().map(move |b| (a, b))) {
            assert!(a == b || !b.starts_with(a), "{a} {b}");
        }
        let (one, other) = (generate().unwrap(), generate().unwrap());
        assert!(one != other && one.split(' ').count() == COUNT, "{one}, {other}");
    }

    #[test]
    fn a_phrase_fits_as_people_type_it() {
        let kept = hash("otter maple zinc harbor").unwrap();
        assert!(fits(" Otter-maple,  ZINC harbor. ", Some(&kept)));
        assert!(!fits("otter maple zinc", Some(&kept)) && !fits("otter maple zinc harbor", None));
        assert!(PasswordHash::new(NOBODY).is_ok());
        assert_ne!(kept, hash("otter maple zinc harbor").unwrap(), "salted");
    }
}
