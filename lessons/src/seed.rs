//! Whose numbers: what everything that is drawn for a student is drawn from.

use std::fmt::Write;

use sha2::{Digest, Sha256};
use thiserror::Error;
use unicode_normalization::UnicodeNormalization;

/// Longest seed, in characters: that of a student's name.
pub const LONGEST: usize = 100;

/// Bytes of the keyed fingerprint that are used: far more than anybody can try.
const USED: usize = 16;

/// What a student's numbers, states and options of a lesson are drawn from. `secret` is known to those who run the class
/// alone: nobody can tell whose numbers a name gives, nor look for a name with convenient ones, in a copy of the program.
/// Without a secret it is the name itself, and every copy of the program gives the same numbers.
pub fn seed(student: &str, lesson: &str, secret: &str) -> String {
    if secret.is_empty() {
        return student.to_owned();
    }
    // The lengths are fixed or told, so that no two pairs of names run together.
    let mut hash = Sha256::new();
    hash.update(Sha256::digest(secret));
    hash.update((lesson.len() as u64).to_le_bytes());
    hash.update(lesson);
    hash.update(student);
    hash.finalize()[..USED].iter().fold(String::with_capacity(2 * USED), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Why something is no seed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the seed has more than {LONGEST} characters, or control characters")]
pub struct SeedError;

/// A seed of reasonable length, without control characters; all spellings of a name's letters are the same seed.
///
/// Errors if it is too long or has control characters.
pub fn checked(seed: &str) -> Result<String, SeedError> {
    let seed = seed.trim();
    if seed.chars().count() > LONGEST || seed.chars().any(char::is_control) {
        return Err(SeedError);
    }
    Ok(shown(seed))
}

/// A name as it is shown: composed letters, single spaces, nothing invisible.
pub fn shown(name: &str) -> String {
    let visible: String =
        name.nfc().filter(|c| c.is_whitespace() || !(c.is_control() || is_invisible(*c))).collect();
    visible.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Characters of the category Cf that names are spoofed with: soft hyphen, joiners, marks of direction, byte order mark.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, checked, seed};

    #[test]
    fn a_seed_is_a_name_however_it_is_spelled() {
        assert_eq!(checked("  Zoe\u{308} \u{200b} B "), Ok("Zoë B".to_owned()));
        assert_eq!(checked(&"é".repeat(LONGEST)).map(|seed| seed.chars().count()), Ok(LONGEST));
        assert!(checked(&"e".repeat(LONGEST + 1)).is_err() && checked("a\u{7}b").is_err());
    }

    #[test]
    fn a_secret_changes_every_seed_and_without_one_the_name_is_it() {
        assert_eq!(seed("ada", "screw", ""), "ada");
        // Recorded once: a change would give every class other numbers.
        assert_eq!(seed("ada", "screw", "a secret"), "acfc4c38589036fd217d3fe905fdae9a");
        let seeds: std::collections::BTreeSet<String> = [
            seed("ada", "screw", "a secret"),
            seed("ada", "screw", "another"),
            seed("emmy", "screw", "a secret"),
            seed("ada", "drift", "a secret"),
            seed("a", "screwad", "a secret"),
        ]
        .into();
        assert_eq!(seeds.len(), 5);
    }
}
