//! A lesson as one text, to be kept beside the verdicts that it gave and to grade again with.

use std::fmt::Write;
use std::sync::Arc;

use serde_json::{Map, Value, json};

use super::content::Lesson;
use super::reader::LessonError;
use crate::files::{Files, OpensFile};

impl Lesson {
    /// All files of the lesson as one JSON text; the same files always give the same text.
    pub fn bundle(&self) -> String {
        let content = |bytes: &Vec<u8>| match std::str::from_utf8(bytes) {
            Ok(text) => json!(text),
            Err(_) => json!({ "hex": hexadecimal(bytes) }),
        };
        let files: Map<String, Value> =
            self.files.iter().map(|(path, bytes)| (path.clone(), content(bytes))).collect();
        // Its place in the course and what opens its answers are not in the files, and their fingerprint is that of the folder
        // before it got its place.
        let mut bundle = json!({
            "folder": self.folder, "number": self.number, "hash": self.hash, "opens": self.opens, "files": files
        });
        // Nothing is said of what holds for almost all: the bundles of before stay as they are.
        if self.held {
            bundle["held"] = true.into();
        }
        if let Some(dealer) = &self.dealer {
            bundle["dealer"] = dealer.bundle().into();
        }
        bundle.to_string()
    }

    /// The lesson of a bundle, with the numbers that everybody sees.
    ///
    /// Errors if the text is no bundle, or this version of the program cannot read the lesson.
    pub fn from_bundle(text: &str) -> Result<Self, LessonError> {
        let broken = |problem: &str| LessonError::Unreadable {
            file: "bundle".to_owned(),
            line: 1,
            problem: problem.to_owned(),
        };
        let bundle: Value = serde_json::from_str(text).map_err(|error| broken(&error.to_string()))?;
        let folder = bundle["folder"].as_str().ok_or_else(|| broken("it names no folder"))?;
        let listed = bundle["files"].as_object().ok_or_else(|| broken("it has no files"))?;
        let mut files = Files::new();
        for (path, content) in listed {
            let bytes = match (content.as_str(), content["hex"].as_str()) {
                (Some(text), _) => Some(text.as_bytes().to_vec()),
                (None, hex) => hex.and_then(bytes),
            };
            files
                .insert(path.clone(), bytes.ok_or_else(|| broken("a file is neither text nor hexadecimal"))?);
        }
        let number = bundle["number"].as_u64().and_then(|number| u32::try_from(number).ok());
        let hash = bundle["hash"].as_str().ok_or_else(|| broken("it has no fingerprint"))?;
        // Bundles of before courses had rules open as a course without any does.
        let opens = match bundle.get("opens") {
            Some(opens) => {
                serde_json::from_value(opens.clone()).map_err(|error| broken(&error.to_string()))?
            }
            None => OpensFile::default(),
        };
        let lesson = Self::from_files(folder, files)?;
        let held = bundle["held"] == true;
        let dealer = bundle["dealer"].as_str().map(Self::from_bundle).transpose()?.map(Arc::new);
        Ok(Self {
            number: number.unwrap_or(lesson.number),
            hash: hash.to_owned(),
            opens,
            held,
            dealer,
            ..lesson
        })
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn bytes(hexadecimal: &str) -> Option<Vec<u8>> {
    let digits = hexadecimal.as_bytes();
    let pairs = digits.is_ascii() && digits.len().is_multiple_of(2);
    let byte =
        |pair: &[u8]| std::str::from_utf8(pair).ok().and_then(|pair| u8::from_str_radix(pair, 16).ok());
    pairs.then(|| digits.chunks(2).map(byte).collect()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Course;

    #[test]
    fn a_lesson_is_the_same_after_being_kept() {
        for lesson in Course::embedded().unwrap().lessons() {
            let again = Lesson::from_bundle(&lesson.bundle()).unwrap();
            assert_eq!((&again.hash, again.bundle()), (&lesson.hash, lesson.bundle()), "{}", lesson.slug);
            assert_eq!((again.number, again.opens), (lesson.number, lesson.opens), "{}", lesson.slug);
        }
    }

    #[test]
    fn a_bundle_says_that_verdicts_are_held_back_only_where_they_are() {
        let lesson = Course::embedded().unwrap().lessons()[0].clone();
        assert!(!lesson.bundle().contains("\"held\""));
        let held = Lesson { held: true, ..lesson };
        assert!(Lesson::from_bundle(&held.bundle()).unwrap().held);
    }

    #[test]
    fn files_of_any_bytes_are_kept() {
        let mut lesson = Course::embedded().unwrap().lessons()[0].clone();
        let mut files = (*lesson.files).clone();
        files.insert("figures/photo.png".to_owned(), vec![0, 255, 128, 10]);
        lesson = Lesson::from_files(&lesson.folder, files).unwrap();
        assert_eq!(Lesson::from_bundle(&lesson.bundle()).unwrap().files, lesson.files);
    }

    #[test]
    fn what_is_no_bundle_is_refused() {
        for text in [
            "",
            "{}",
            r#"{"folder": "01-x", "files": {"a": 3}}"#,
            r#"{"folder": "01-x", "files": {"a": {"hex": "0g"}}}"#,
        ] {
            assert!(Lesson::from_bundle(text).is_err(), "{text}");
        }
    }
}
