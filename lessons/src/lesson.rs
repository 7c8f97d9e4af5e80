//! A lesson: read from its folder, shown to students without its answers.

mod view;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use thiserror::Error;
use triad_engine::scene::{Scene, SceneError};

use crate::exercise::{self, Exercise, Ground, Question, QuestionError};
use crate::files::{ExerciseFile, LessonFile, ReferenceFile, WrongFile};
use crate::markdown::{self, Rendered};
use crate::variant::Parameters;

pub use view::{
    ColumnView, ExerciseView, LessonSummary, LessonView, OptionView, QuestionView, StepView, TuningView,
};

/// The files of one folder: path below it, content.
pub type Files = BTreeMap<String, Vec<u8>>;

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

/// A lesson with everything that belongs to it, answers included. Only its views may leave the server.
#[derive(Debug, Clone)]
pub struct Lesson {
    /// Stable name for addresses: the folder's name without its number.
    pub slug: String,
    /// Place in the course, from 1.
    pub number: u32,
    /// Name of the folder.
    pub folder: String,
    /// Title, summary, objectives and steps.
    pub about: LessonFile,
    /// The text, rendered.
    pub text: Rendered,
    /// The scenario as JSON.
    pub scene: serde_json::Value,
    /// The questions with their answers.
    pub exercise: Exercise,
    /// Wrong submissions that must be recognised, by file name.
    pub wrong: BTreeMap<String, WrongFile>,
    /// Fingerprint of every file of the lesson.
    pub hash: String,
    /// The numbers drawn for a student, by name; the defaults where no student is known.
    pub parameters: Parameters,
    /// Whose numbers these are: the seed that they were drawn from; empty for the defaults.
    pub seed: String,
    pub(crate) source: Source,
    pub(crate) files: Arc<Files>,
    pub(crate) figures: BTreeMap<String, String>,
    /// Files below `wrong/` that a wrong answer sends.
    pub(crate) wrong_files: BTreeSet<String>,
}

/// What the questions are built from, kept to build them again with other numbers.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) exercise: ExerciseFile,
    pub(crate) references: BTreeMap<String, ReferenceFile>,
}

impl Lesson {
    /// Reads a lesson from its files; `folder` is `NN-slug`.
    pub fn from_files(folder: &str, files: Files) -> Result<Self, LessonError> {
        let path = |file: &str| format!("{folder}/{file}");
        let split = folder.split_once('-').and_then(|(n, slug)| Some((n.parse::<u32>().ok()?, slug)));
        let Some((number, slug)) = split else {
            let problem = "a lesson's folder is named NN-slug, for example 02-simple-pendulum".to_owned();
            return Err(LessonError::Unreadable { file: folder.to_owned(), line: 1, problem });
        };
        let reader = Reader { folder, files: &files };
        let about: LessonFile =
            reader.toml("lesson.toml", "it holds title, summary, minutes and objectives")?;
        let mut figures = BTreeMap::new();
        for name in named(&files, "figures/", "svg") {
            figures.insert(name.clone(), reader.text(name, "")?.to_owned());
        }
        let text = markdown::render(reader.text("lesson.md", "it holds the text of the lesson")?, &figures);
        let scene_text = reader.text("scene.json", "it holds the scenario; start from a built-in one")?;
        let scene = serde_json::from_str(scene_text).map_err(|e| LessonError::Unreadable {
            file: path("scene.json"),
            line: e.line(),
            problem: e.to_string(),
        })?;
        // Read as a scene here, so that a fault is told with its own file and line and not by the first question.
        Scene::from_json(scene_text).map_err(|error| LessonError::Unreadable {
            file: path("scene.json"),
            line: match &error {
                SceneError::Syntax { line, .. } => *line,
                _ => 1,
            },
            problem: error.to_string(),
        })?;
        let source = Source {
            exercise: reader.toml("exercise.toml", "it holds the questions")?,
            references: reader
                .toml("reference/answers.toml", "it holds the right answers and their sources")?,
        };
        let parameters = Parameters::defaults(&source.exercise.parameters);
        let (questions, references) = (source.exercise.clone(), source.references.clone());
        let ground = Ground { parameters: &parameters, scene: &scene, files: &files };
        let exercise = exercise::build(questions, references, &ground).map_err(|error| {
            let file = if error.in_reference { "reference/answers.toml" } else { "exercise.toml" };
            let content = reader.text(file, "").unwrap_or_default();
            let line = line_of(content, &error.question);
            LessonError::Question { file: path(file), line, error }
        })?;
        let mut wrong = BTreeMap::new();
        let mut wrong_files = BTreeSet::new();
        for name in named(&files, "wrong/", "toml") {
            let mut file: WrongFile = reader.toml(name, "")?;
            wrong_files.extend(reader.fetch_files(name, &mut file)?);
            wrong.insert(name.clone(), file);
        }
        let (slug, hash) = (slug.to_owned(), fingerprint(&files));
        let folder = folder.to_owned();
        Ok(Self {
            slug,
            number,
            folder,
            about,
            text,
            scene,
            exercise,
            wrong,
            hash,
            parameters,
            seed: String::new(),
            source,
            files: Arc::new(files),
            figures,
            wrong_files,
        })
    }

    /// A question by its id.
    pub fn question(&self, id: &str) -> Option<&Question> {
        self.exercise.questions.iter().find(|q| q.id == id)
    }

    /// Hint number `k` (from 1) of a question, as HTML.
    pub fn hint_html(&self, question: &str, k: usize) -> Option<String> {
        Some(markdown::render_short(self.question(question)?.hints.get(k.checked_sub(1)?)?))
    }
}

/// Names of the files in one subfolder with this extension.
fn named<'a>(files: &'a Files, folder: &'a str, extension: &'a str) -> impl Iterator<Item = &'a String> {
    files.keys().filter(move |name| {
        name.starts_with(folder) && Path::new(name).extension().is_some_and(|e| e == extension)
    })
}

/// Reads the files of one folder and names the place of every error.
struct Reader<'a> {
    folder: &'a str,
    files: &'a Files,
}

impl<'a> Reader<'a> {
    fn text(&self, name: &str, remedy: &'static str) -> Result<&'a str, LessonError> {
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

    fn toml<T: DeserializeOwned>(&self, name: &str, remedy: &'static str) -> Result<T, LessonError> {
        let text = self.text(name, remedy)?;
        toml::from_str(text).map_err(|error| LessonError::Unreadable {
            file: format!("{}/{name}", self.folder),
            line: error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1),
            problem: error.message().to_owned(),
        })
    }
}

impl Reader<'_> {
    /// An answer `file = "@wrong/name.json"` stands for the content of that file.
    fn fetch_files(&self, name: &str, wrong: &mut WrongFile) -> Result<Vec<String>, LessonError> {
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
fn fingerprint(files: &Files) -> String {
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
