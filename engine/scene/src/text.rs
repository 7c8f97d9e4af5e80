//! Words of a scene, and names that were meant.

use std::fmt;

/// The text is none of the words of a scene for this choice, which are listed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no such word here; there are {0}")]
pub struct UnknownWord(pub String);

/// The choice that a scene writes as `word`.
pub(crate) fn choice<T: fmt::Display>(
    word: &str,
    choices: impl Iterator<Item = T> + Clone,
) -> Result<T, UnknownWord> {
    choices.clone().find(|choice| choice.to_string() == word).ok_or_else(|| {
        let words: Vec<String> = choices.map(|choice| choice.to_string()).collect();
        UnknownWord(words.join(", "))
    })
}

/// Gives a choice of a scene its words from one table: `ALL`, `Display` and `FromStr`. A variant that the table lacks does
/// not compile; one with numbers stands there with its usual ones.
macro_rules! words {
    ($(#[$example:meta])* $choice:ident {
        $($variant:ident $({ $($field:ident: $usual:expr),+ })? => $word:literal),+ $(,)?
    }) => {
        impl $choice {
            /// All of them, where they have numbers with the usual ones.
            $(#[$example])*
            pub const ALL: [Self; [$($word),+].len()] =
                [$(Self::$variant $({ $($field: $usual),+ })?),+];

            /// What a scene writes for it.
            const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $word,)+
                }
            }
        }

        impl std::fmt::Display for $choice {
            /// As a scene writes it.
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.as_str())
            }
        }

        impl std::str::FromStr for $choice {
            type Err = $crate::text::UnknownWord;

            fn from_str(word: &str) -> Result<Self, Self::Err> {
                $crate::text::choice(word, Self::ALL.into_iter())
            }
        }
    };
}
pub(crate) use words;

/// A number, by its power of ten where it would fill the line.
///
/// ```
/// use triad_scene::text::short;
///
/// assert_eq!([2.5, 0.0, 1e-300].map(short), ["2.5", "0", "1e-300"]);
/// ```
pub fn short(number: f64) -> String {
    let size = number.abs();
    if size >= 1e21 || (size > 0.0 && size < 1e-14) { format!("{number:e}") } else { number.to_string() }
}

/// The candidate that differs from `name` in the fewest letters, if it is near.
pub fn nearest_name<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    candidates
        .take(1000)
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .min()
        .filter(|(distance, _)| *distance <= name.len().max(3) / 3)
        .map(|(_, candidate)| candidate.to_owned())
}

fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_length_are_compared_by_their_first_letters() {
        let known = "a".repeat(64) + "b";
        let long = "a".repeat(64) + &"c".repeat(1000);
        assert_eq!(nearest_name(&long, [known.as_str()].into_iter()), Some(known.clone()));
        assert_eq!(edit_distance(&long, &known), 0);
    }
}
