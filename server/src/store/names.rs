//! Names of people: as they are shown, and as they are told apart.

use unicode_normalization::UnicodeNormalization;

/// Longest name, in characters.
pub const LONGEST: usize = 100;

/// The name as it is shown: composed letters, single spaces, nothing invisible.
pub fn shown(name: &str) -> String {
    let visible: String =
        name.nfc().filter(|c| c.is_whitespace() || !(c.is_control() || is_invisible(*c))).collect();
    visible.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What two spellings of one name share: also compatibility forms and case do not count.
pub fn key(name: &str) -> String {
    shown(name).nfkc().flat_map(char::to_lowercase).nfc().collect()
}

/// Characters of the category Cf that names are spoofed with: soft hyphen, joiners, marks of direction, byte order mark.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
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
    }
}
