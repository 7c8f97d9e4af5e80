//! The folders of the systems: what is read there, and the result.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;
use triad_lessons::Lesson;

/// What is wrong with the box itself, not with what was handed in.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Broken {
    /// The lesson cannot be read.
    #[error("{path}: {problem}; export the lesson again")]
    Lesson {
        /// Its file.
        path: String,
        /// What is wrong.
        problem: String,
    },
    /// The result cannot be written.
    #[error("{path} cannot be written: {problem}")]
    Result {
        /// Its file.
        path: String,
        /// What the system says.
        problem: String,
    },
}

/// The lesson in a file that `triad export` wrote.
///
/// Errors if it cannot be read.
pub fn lesson(file: &Path) -> Result<Lesson, Broken> {
    let broken = |problem: String| Broken::Lesson { path: file.display().to_string(), problem };
    let text = fs::read_to_string(file).map_err(|error| broken(error.to_string()))?;
    Lesson::from_bundle(&text).map_err(|error| broken(error.to_string()))
}

/// A JSON document that the system wrote; null if there is none.
pub fn told(file: &Path) -> Value {
    fs::read(file).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
}

/// Where the result goes.
#[derive(Debug)]
pub struct Results(PathBuf);

impl Results {
    /// The file below the folder of the system, which is made if it is not there.
    ///
    /// Errors if it cannot be made.
    pub fn below(root: &Path) -> Result<Self, Broken> {
        let folder = root.join("results");
        let this = Self(folder.join("results.json"));
        fs::create_dir_all(&folder).map_err(|error| this.failed(&error))?;
        Ok(this)
    }

    /// Writes the result in place of the one before: a reader finds one or the other, and never a part.
    ///
    /// Errors if the file cannot be written.
    pub fn write(&self, result: &Value) -> Result<(), Broken> {
        let beside = self.0.with_extension("new");
        fs::write(&beside, result.to_string())
            .and_then(|()| fs::rename(&beside, &self.0))
            .map_err(|error| self.failed(&error))
    }

    fn failed(&self, error: &std::io::Error) -> Broken {
        Broken::Result { path: self.0.display().to_string(), problem: error.to_string() }
    }
}
