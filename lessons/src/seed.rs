//! Whose numbers: what everything that is drawn for a student is drawn from.

use std::fmt::Write;

use sha2::{Digest, Sha256};

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

#[cfg(test)]
mod tests {
    use super::seed;

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
