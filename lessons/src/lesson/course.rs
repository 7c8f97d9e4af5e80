//! A course: the lessons in order, built into the program or read from a folder.

use std::collections::BTreeMap;
use std::path::Path;

use thiserror::Error;

use super::content::Lesson;
use super::numbering::Places;
use super::reader::LessonError;
use crate::files::{CourseFile, Files, OpensFile, PartFile};

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
    /// Notions that students bring along.
    pub assumes: Vec<String>,
    /// When the right answer to a question is shown.
    pub opens: OpensFile,
    lessons: Vec<Lesson>,
    others: Vec<Lesson>,
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
        let head = head(&files)?;
        let (mut folders, stray) = split(files);
        let own = by_number(folders.keys())?;
        let order = match (&head.lessons, head.built_in) {
            (None, false) => None,
            (order, false) => order.clone(),
            (order, true) => {
                let built_in = built_in(&own, &mut folders)?;
                Some(order.clone().unwrap_or_else(|| {
                    let new = own.iter().map(|(_, slug, _)| slug).filter(|slug| !built_in.contains(slug));
                    built_in.iter().chain(new).cloned().collect()
                }))
            }
        };
        let all = by_number(folders.keys())?;
        let places = places(&all, order.as_deref())?;
        let mut lessons: Vec<Lesson> = Vec::new();
        for (folder, files) in folders {
            let lesson = Lesson::at_its_place(&folder, files, &places)?;
            lessons.push(Lesson { opens: head.opens, ..lesson });
        }
        lessons.sort_by_key(|l| l.number);
        let others = order.map_or_else(Vec::new, |order| lessons.split_off(order.len()));
        divide(&mut lessons, &head.parts)?;
        Ok(Self { title: head.title, assumes: head.assumes, opens: head.opens, lessons, others, stray })
    }

    /// The lessons that are taken, in order.
    pub fn lessons(&self) -> &[Lesson] {
        &self.lessons
    }

    /// Lessons that are at hand and not taken; links may lead to them.
    pub fn others(&self) -> &[Lesson] {
        &self.others
    }

    /// A lesson by its slug (`simple-pendulum`), its folder (`02-simple-pendulum`) or its number (`2`), taken or not.
    pub fn lesson(&self, name: &str) -> Option<&Lesson> {
        self.lessons
            .iter()
            .chain(&self.others)
            .find(|l| l.slug == name || l.folder == name || l.number.to_string() == name)
    }

    /// The same course with each lesson, taken or not, as it is changed.
    #[must_use]
    pub fn with_lessons(self, mut change: impl FnMut(Lesson) -> Lesson) -> Self {
        let lessons = self.lessons.into_iter().map(&mut change).collect();
        let others = self.others.into_iter().map(change).collect();
        Self { lessons, others, ..self }
    }

    /// Files beside the lessons that do not belong there.
    pub(crate) fn stray(&self) -> &[String] {
        &self.stray
    }
}

/// `course.toml`.
fn head(files: &Files) -> Result<CourseFile, CourseError> {
    let head = files.get("course.toml").ok_or_else(|| CourseError::Head {
        problem: "it is missing; write format_version = 1 and a title into it".to_owned(),
    })?;
    let head: CourseFile = toml::from_str(&String::from_utf8_lossy(head))
        .map_err(|error| CourseError::Head { problem: error.message().to_owned() })?;
    if head.format_version != 1 {
        let problem = format!("format_version {} is not known; this program reads 1", head.format_version);
        return Err(CourseError::Head { problem });
    }
    Ok(head)
}

/// Gives each lesson the title of the part that it stands in.
fn divide(lessons: &mut [Lesson], parts: &[PartFile]) -> Result<(), CourseError> {
    for part in parts {
        let Some(first) = lessons.iter().position(|lesson| lesson.slug == part.from) else {
            let problem = format!(
                "parts begins \"{}\" from {}, which is none of the lessons that are taken; correct the name",
                part.title, part.from
            );
            return Err(CourseError::Head { problem });
        };
        for lesson in &mut lessons[first..] {
            lesson.part = Some(part.title.clone());
        }
    }
    Ok(())
}

/// The files of each folder, and those that lie beside the folders.
fn split(files: Files) -> (BTreeMap<String, Files>, Vec<String>) {
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
    (folders, stray)
}

/// Number, slug and name of each folder, by number.
fn by_number<'a>(
    folders: impl Iterator<Item = &'a String>,
) -> Result<Vec<(u32, String, String)>, CourseError> {
    let mut all = Vec::new();
    for folder in folders {
        let (number, slug) = Lesson::name(folder)?;
        all.push((number, slug.to_owned(), folder.clone()));
    }
    all.sort();
    Ok(all)
}

/// Adds the built-in lessons that the folder does not replace, and tells their order.
fn built_in(
    own: &[(u32, String, String)],
    folders: &mut BTreeMap<String, Files>,
) -> Result<Vec<String>, CourseError> {
    let files = EMBEDDED.iter().map(|(path, bytes)| ((*path).to_owned(), bytes.to_vec())).collect();
    let order = head(&files)?.lessons;
    let (built_in, _) = split(files);
    let order = match order {
        Some(order) => order,
        None => by_number(built_in.keys())?.into_iter().map(|(_, slug, _)| slug).collect(),
    };
    for (folder, files) in built_in {
        let (_, slug) = Lesson::name(&folder)?;
        if own.iter().all(|(_, known, _)| known != slug) {
            folders.insert(folder, files);
        }
    }
    Ok(order)
}

/// The place of each lesson: as `order` says, what it leaves out behind; without it by number.
fn places(all: &[(u32, String, String)], order: Option<&[String]>) -> Result<Places, CourseError> {
    let mut places = Places::default();
    for (k, (number, slug, folder)) in all.iter().enumerate() {
        let same = |(n, s, _): &&(u32, String, String)| s == slug || order.is_none() && n == number;
        if let Some((_, _, first)) = all[..k].iter().find(same) {
            return Err(CourseError::Twice { first: first.clone(), second: folder.clone() });
        }
        places.put(slug, *number, *number);
    }
    let Some(order) = order else { return Ok(places) };
    let left_out = all.iter().map(|(_, slug, _)| slug).filter(|slug| !order.contains(slug));
    for (place, slug) in (1..).zip(order.iter().chain(left_out)) {
        let Some((number, ..)) = all.iter().find(|(_, known, _)| known == slug) else {
            let problem = format!("lessons names {slug}, which is no folder NN-{slug}; correct the name");
            return Err(CourseError::Head { problem });
        };
        if order[..order.len().min(place as usize - 1)].contains(slug) {
            let problem = format!("lessons names {slug} twice; remove one");
            return Err(CourseError::Head { problem });
        }
        places.put(slug, *number, place);
    }
    Ok(places)
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
