//! A course: the lessons in order, built into the program or read from a folder.

use std::collections::BTreeMap;
use std::path::Path;

use thiserror::Error;

use super::content::Lesson;
use super::reader::LessonError;
use crate::files::{CourseFile, Files};

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// Largest file of a course, in bytes.
const MAX_FILE: u64 = 4 * 1024 * 1024;
/// Most files of a course.
const MAX_FILES: usize = 5000;

/// All lessons of a course, in order.
#[derive(Debug, Clone)]
pub struct Course {
    /// Title of the course.
    pub title: String,
    lessons: Vec<Lesson>,
    stray: Vec<String>,
}

/// Why a course could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CourseError {
    /// A file or folder could not be read.
    #[error("{path} cannot be read: {problem}")]
    Unreadable {
        /// The path.
        path: String,
        /// What the system says.
        problem: String,
    },
    /// Too large to be a course.
    #[error("{path} is too large for a course; {remedy}")]
    TooLarge {
        /// The path.
        path: String,
        /// What to do.
        remedy: &'static str,
    },
    /// `course.toml` is missing or wrong.
    #[error("course.toml: {problem}")]
    Head {
        /// What is wrong, and what to write.
        problem: String,
    },
    /// Two lessons share a number or a name.
    #[error("the lessons {first} and {second} have the same number or name; rename one of the folders")]
    Twice {
        /// Folder of the first.
        first: String,
        /// Folder of the second.
        second: String,
    },
    /// A lesson could not be read.
    #[error(transparent)]
    Lesson(#[from] LessonError),
}

impl CourseError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "course-unreadable",
            Self::TooLarge { .. } => "course-too-large",
            Self::Head { .. } => "course-head",
            Self::Twice { .. } => "course-lesson-twice",
            Self::Lesson(error) => error.code(),
        }
    }
}

impl Course {
    /// The course that is built into the program.
    ///
    /// Errors if its files cannot be read, which a test excludes.
    pub fn embedded() -> Result<Self, CourseError> {
        Self::from_files(EMBEDDED.iter().map(|(path, bytes)| ((*path).to_owned(), bytes.to_vec())).collect())
    }

    /// A course from a folder.
    ///
    /// Errors if the folder, a file or a lesson cannot be read.
    pub fn load(folder: &Path) -> Result<Self, CourseError> {
        let mut files = Files::new();
        read_folder(folder, "", &mut files)?;
        Self::from_files(files)
    }

    /// A course from its files; keys are paths below the course's folder, with `/`.
    ///
    /// Errors if a lesson cannot be read.
    pub fn from_files(files: Files) -> Result<Self, CourseError> {
        let head = files.get("course.toml").ok_or_else(|| CourseError::Head {
            problem: "it is missing; write format_version = 1 and a title into it".to_owned(),
        })?;
        let head: CourseFile = toml::from_str(&String::from_utf8_lossy(head))
            .map_err(|error| CourseError::Head { problem: error.message().to_owned() })?;
        if head.format_version != 1 {
            let problem =
                format!("format_version {} is not known; this program reads 1", head.format_version);
            return Err(CourseError::Head { problem });
        }
        let mut folders: BTreeMap<String, Files> = BTreeMap::new();
        let mut stray = Vec::new();
        for (path, bytes) in files {
            match path.split_once('/') {
                Some((folder, rest)) => {
                    folders.entry(folder.to_owned()).or_default().insert(rest.to_owned(), bytes);
                }
                None if path == "course.toml" => {}
                None => stray.push(path),
            }
        }
        let mut lessons: Vec<Lesson> = Vec::new();
        for (folder, files) in folders {
            lessons.push(Lesson::from_files(&folder, files)?);
        }
        lessons.sort_by_key(|l| l.number);
        for (k, lesson) in lessons.iter().enumerate() {
            if let Some(other) =
                lessons[..k].iter().find(|o| o.number == lesson.number || o.slug == lesson.slug)
            {
                return Err(CourseError::Twice {
                    first: other.folder.clone(),
                    second: lesson.folder.clone(),
                });
            }
        }
        Ok(Self { title: head.title, lessons, stray })
    }

    /// The lessons in order.
    pub fn lessons(&self) -> &[Lesson] {
        &self.lessons
    }

    /// A lesson by its slug (`simple-pendulum`), its folder (`02-simple-pendulum`) or its number (`2`).
    pub fn lesson(&self, name: &str) -> Option<&Lesson> {
        self.lessons.iter().find(|l| l.slug == name || l.folder == name || l.number.to_string() == name)
    }

    /// Files beside the lessons that do not belong there.
    pub(crate) fn stray(&self) -> &[String] {
        &self.stray
    }
}

fn read_folder(folder: &Path, prefix: &str, files: &mut Files) -> Result<(), CourseError> {
    let unreadable = |error: std::io::Error| CourseError::Unreadable {
        path: folder.display().to_string(),
        problem: error.to_string(),
    };
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let kind = entry.file_type().map_err(unreadable)?;
        // Links could lead out of the folder or in a circle; hidden files belong to other programs.
        if name.starts_with('.') || kind.is_symlink() {
            continue;
        }
        let path = if prefix.is_empty() { name } else { format!("{prefix}/{name}") };
        if kind.is_dir() {
            read_folder(&entry.path(), &path, files)?;
            continue;
        }
        if entry.metadata().map_err(unreadable)?.len() > MAX_FILE {
            return Err(CourseError::TooLarge { path, remedy: "a file may have 4 MiB" });
        }
        if files.len() >= MAX_FILES {
            return Err(CourseError::TooLarge { path, remedy: "name the folder that holds course.toml" });
        }
        files.insert(path, std::fs::read(entry.path()).map_err(unreadable)?);
    }
    Ok(())
}
