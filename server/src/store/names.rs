//! Names of people: as they are shown, and as they are told apart.

pub use triad_lessons::seed::shown;
use unicode_normalization::UnicodeNormalization;

/// Longest name, in characters.
pub const LONGEST: usize = 100;

/// Whether no name is as long as what was typed, in whatever letters and marks: it is not looked at.
pub fn is_endless(typed: &str) -> bool {
    typed.len() > 16 * LONGEST
}

/// What two spellings of one name share: also compatibility forms and case do not count.
pub fn key(name: &str) -> String {
    shown(name).nfkc().flat_map(char::to_lowercase).nfc().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_one_name_are_one_person() {
        assert_eq!(shown("  Zoe\u{308} \t  B\u{200b}\u{202e} "), "Zoë B");
        for other in ["Zoë B", "zoë b", "ZOE\u{308}  B", "Ｚoë b\u{feff}"] {
            assert_eq!(key(other), "zoë b", "{other:?}");
        }
        assert_ne!(key("Zoe B"), key("Zoë B"));
        assert_eq!(key("\u{200b} \n"), "");
        assert!(is_endless(&" ".repeat(10_000)) && !is_endless(&"e\u{302}\u{323}".repeat(LONGEST)));
    }
}
