//! What an author has to put right, with its place and a remedy.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use crate::lesson::{Lesson, line_of};

/// Something an author has to put right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Fault {
    /// File below the course's folder.
    pub file: String,
    /// Line from 1, or 0 where the whole file is meant.
    pub line: usize,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        write!(f, ": {}; {}", self.what, self.remedy)
    }
}

/// What is found while a lesson is checked.
pub(super) struct Findings<'a> {
    pub(super) lesson: &'a Lesson,
    pub(super) faults: Vec<Fault>,
}

impl<'a> Findings<'a> {
    /// Nothing yet.
    pub(super) fn new(lesson: &'a Lesson) -> Self {
        Self { lesson, faults: Vec::new() }
    }

    /// A fault in a file of the lesson.
    pub(super) fn add(
        &mut self,
        file: &str,
        line: usize,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        let file = format!("{}/{file}", self.lesson.folder);
        self.faults.push(Fault { file, line, what: what.into(), remedy: remedy.into() });
    }

    /// A fault of a question.
    pub(super) fn question(&mut self, id: &str, what: impl fmt::Display, remedy: impl Into<String>) {
        let bytes = self.lesson.files.get("exercise.toml").map(Vec::as_slice).unwrap_or_default();
        let line = line_of(&String::from_utf8_lossy(bytes), id);
        self.add("exercise.toml", line, format!("question {id}: {what}"), remedy);
    }
}
