//! Numbers of equations follow the place of a lesson in its course, whatever its folder is called.
//!
//! An author writes `\\tag{7.2}` and `eq. (7.2)` with the number of the lesson's folder. Where the course puts the lesson
//! at another place, its files are read as if the author had written that number.

use std::collections::BTreeMap;

use crate::files::Files;

/// Files whose texts name equations.
const TEXTS: [&str; 4] = ["lesson.md", "lesson.toml", "exercise.toml", "reference/answers.toml"];
/// Stands before a number that has been replaced, so that it is not replaced again. No text contains it.
const DONE: char = '\u{e000}';

/// Number of the folder and place in the course, by slug.
#[derive(Debug, Clone, Default)]
pub(super) struct Places(BTreeMap<String, (u32, u32)>);

impl Places {
    /// Puts the lesson of folder number `folder` at a place.
    pub(super) fn put(&mut self, slug: &str, folder: u32, place: u32) {
        self.0.insert(slug.to_owned(), (folder, place));
    }

    /// The place of a lesson; 0 if it has none.
    pub(super) fn of(&self, slug: &str) -> u32 {
        self.0.get(slug).map_or(0, |(_, place)| *place)
    }

    /// The files of a lesson with the numbers of its equations, and of those that it links to, by place.
    pub(super) fn renumber(&self, slug: &str, mut files: Files) -> Files {
        if self.0.values().all(|(folder, place)| folder == place) {
            return files;
        }
        for name in TEXTS {
            // What is no UTF-8 is reported by the reader.
            let Some(bytes) = files.get_mut(name) else { continue };
            if let Ok(text) = std::str::from_utf8(bytes) {
                *bytes = self.renumbered(slug, text).into_bytes();
            }
        }
        files
    }

    fn renumbered(&self, slug: &str, text: &str) -> String {
        let mut text = text.to_owned();
        for (other, (folder, place)) in &self.0 {
            let (from, to) = (format!("](/lessons/{other}#eq-{folder}."), format!("](/lessons/{other}#eq-"));
            text = linked(&text, &from, &to, *folder, *place);
        }
        if let Some((folder, place)) = self.0.get(slug) {
            for head in ["\\tag{", "#eq-", "eq. (", "Eq. (", "eqs. (", "Eqs. ("] {
                text = text.replace(&format!("{head}{folder}."), &format!("{head}{DONE}{place}."));
            }
        }
        text.replace(DONE, "")
    }
}

/// Replaces the number in links that begin with `from`, and in the text of each link, `[eq. (7.2)]`.
fn linked(text: &str, from: &str, to: &str, folder: u32, place: u32) -> String {
    let mut rest = text;
    let mut done = String::with_capacity(text.len());
    while let Some(at) = rest.find(from) {
        let (before, after) = (&rest[..at], &rest[at + from.len()..]);
        let opens = before.rfind('[').unwrap_or(0);
        done.push_str(&before[..opens]);
        done.push_str(&before[opens..].replace(&format!("({folder}."), &format!("({DONE}{place}.")));
        done.push_str(to);
        done.push(DONE);
        done.extend([&*place.to_string(), "."]);
        rest = after;
    }
    done + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_numbered_by_the_place_of_their_lesson() {
        let mut places = Places::default();
        places.put("here", 2, 11);
        places.put("there", 11, 2);
        let text = "\\tag{2.1} [eq. (2.1)](#eq-2.1), [eq. (11.3)](/lessons/there#eq-11.3), (2.1) m, Eq. (2.4), $f(11.5)$";
        assert_eq!(
            places.renumbered("here", text),
            "\\tag{11.1} [eq. (11.1)](#eq-11.1), [eq. (2.3)](/lessons/there#eq-2.3), (2.1) m, Eq. (11.4), $f(11.5)$"
        );
    }
}
