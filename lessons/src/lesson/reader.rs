//! Reading the files of a lesson's folder, with the place of every error.

use std::path::Path;

use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::exercise::QuestionError;
use crate::files::{Files, WrongFile};

/// Why a lesson could not be read. Each names the file and says what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LessonError {
    /// A file is not there.
    #[error("{file} is missing; {remedy}")]
    Missing {
        /// Path of the file.
        file: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A file is not what its name says.
    #[error("{file}, line {line}: {problem}")]
    Unreadable {
        /// Path of the file.
        file: String,
        /// Line from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
    },
    /// A question cannot be used.
    #[error("{file}, line {line}: {error}")]
    Question {
        /// Path of the file.
        file: String,
        /// Line of the question.
        line: usize,
        /// What is wrong with it.
        error: QuestionError,
    },
}

impl LessonError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Missing { .. } => "lesson-file-missing",
            Self::Unreadable { .. } => "lesson-file-unreadable",
            Self::Question { .. } => "lesson-question",
        }
    }
}

/// Names of the files in one subfolder with this extension.
pub(super) fn named<'a>(
    files: &'a Files,
    folder: &'a str,
    extension: &'a str,
) -> impl Iterator<Item = &'a String> {
    files.keys().filter(move |name| {
        name.starts_with(folder) && Path::new(name).extension().is_some_and(|e| e == extension)
    })
}

/// Reads the files of one folder and names the place of every error.
pub(super) struct LessonReader<'a> {
    pub(super) folder: &'a str,
    pub(super) files: &'a Files,
}

impl<'a> LessonReader<'a> {
    /// A file as text; `remedy` says what it is for if it is missing.
    pub(super) fn text(&self, name: &str, remedy: &'static str) -> Result<&'a str, LessonError> {
        let file = format!("{}/{name}", self.folder);
        let bytes =
            self.files.get(name).ok_or_else(|| LessonError::Missing { file: file.clone(), remedy })?;
        std::str::from_utf8(bytes).map_err(|error| {
            let line = String::from_utf8_lossy(&bytes[..error.valid_up_to()]).matches('\n').count() + 1;
            LessonError::Unreadable {
                file,
                line,
                problem: "it is not UTF-8 text; save it as UTF-8".to_owned(),
            }
        })
    }

    /// A file as TOML.
    pub(super) fn toml<T: DeserializeOwned>(
        &self,
        name: &str,
        remedy: &'static str,
    ) -> Result<T, LessonError> {
        let text = self.text(name, remedy)?;
        toml::from_str(text).map_err(|error| LessonError::Unreadable {
            file: format!("{}/{name}", self.folder),
            line: error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1),
            problem: error.message().to_owned(),
        })
    }
}

impl LessonReader<'_> {
    /// An answer `file = "@wrong/name.json"` stands for the content of that file.
    pub(super) fn fetch_files(&self, name: &str, wrong: &mut WrongFile) -> Result<Vec<String>, LessonError> {
        let mut fetched = Vec::new();
        for answer in wrong.answers.values_mut() {
            let Some(path) = answer.file.as_deref().and_then(|f| f.strip_prefix('@')) else { continue };
            let path = path.to_owned();
            let path = path.as_str();
            if !path.starts_with("wrong/") {
                let problem = format!("{name}: a file of a wrong answer lies below wrong/");
                return Err(LessonError::Unreadable {
                    file: format!("{}/{name}", self.folder),
                    line: 1,
                    problem,
                });
            }
            fetched.push(path.to_owned());
            answer.file = Some(self.text(path, "a wrong answer names it")?.to_owned());
        }
        Ok(fetched)
    }
}

/// Line of the question with this id, or of its reference.
pub(crate) fn line_of(toml: &str, id: &str) -> usize {
    let (wanted, table) = (format!("\"{id}\""), format!("[{id}]"));
    toml.lines()
        .position(|l| l.trim() == table || l.trim_start().starts_with("id") && l.contains(&wanted))
        .map_or(1, |index| index + 1)
}

/// 64-bit FNV-1a over all names and contents. It tells versions apart; it is no protection against forgery.
pub(super) fn fingerprint(files: &Files) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut feed = |bytes: &[u8]| {
        for byte in bytes.iter().chain(&[0]) {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for (name, content) in files {
        feed(name.as_bytes());
        feed(content);
    }
    format!("{hash:016x}")
}
