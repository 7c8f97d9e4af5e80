//! A lesson with everything that belongs to it.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use triad_engine::scene::{Scene, SceneError};

use super::numbering::Places;
use super::personal::{describe, shuffle_options};
use super::reader::{LessonError, LessonReader, fingerprint, line_of, named};
use crate::exercise::{self, BuildContext, Exercise, Parameters, Question};
use crate::files::{ExerciseFile, Files, LessonFile, OpensFile, ReferenceFile, WrongFile};
use crate::rendering::markdown::{self, Rendered};

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
    /// Whose numbers these are: a student, or a seed that was chosen; empty for the defaults.
    pub seed: String,
    /// When right answers are shown.
    pub opens: OpensFile,
    /// Whether verdicts are not told as they are given: then nothing that is told at once may follow from what is right.
    pub held: bool,
    /// Title of the part of its course that it stands in.
    pub part: Option<String>,
    /// What the numbers were drawn from: the name, or its keyed fingerprint where the class has a secret.
    pub(crate) drawn_from: String,
    /// The version of the lesson whose numbers students have already, where that is another one.
    pub(crate) dealer: Option<Arc<Lesson>>,
    pub(crate) sources: QuestionSources,
    pub(crate) files: Arc<Files>,
    pub(crate) figures: BTreeMap<String, String>,
    /// Files below `wrong/` that a wrong answer sends.
    pub(crate) wrong_files: BTreeSet<String>,
}

/// What the questions are built from, kept to build them again with other numbers.
#[derive(Debug, Clone)]
pub(crate) struct QuestionSources {
    pub(crate) exercise: ExerciseFile,
    pub(crate) references: BTreeMap<String, ReferenceFile>,
    /// The description of the scene, before numbers are put into it.
    pub(crate) description: String,
}

impl Lesson {
    /// Number and slug in the name of a lesson's folder, `NN-slug`.
    ///
    /// Errors if it is no such name.
    pub(super) fn name(folder: &str) -> Result<(u32, &str), LessonError> {
        folder.split_once('-').and_then(|(n, slug)| Some((n.parse::<u32>().ok()?, slug))).ok_or_else(|| {
            let problem = "a lesson's folder is named NN-slug, for example 02-simple-pendulum".to_owned();
            LessonError::Unreadable { file: folder.to_owned(), line: 1, problem }
        })
    }

    /// Reads a lesson by itself from its files; `folder` is `NN-slug`.
    ///
    /// Errors if a file is missing or cannot be read.
    pub fn from_files(folder: &str, files: Files) -> Result<Self, LessonError> {
        let (number, slug) = Self::name(folder)?;
        let mut places = Places::default();
        places.put(slug, number, number);
        Self::at_its_place(folder, files, &places)
    }

    /// Reads a lesson of a course.
    ///
    /// Errors if a file is missing or cannot be read.
    pub(super) fn at_its_place(folder: &str, files: Files, places: &Places) -> Result<Self, LessonError> {
        let (_, slug) = Self::name(folder)?;
        let (hash, files) = (fingerprint(&files), places.renumber(slug, files));
        let reader = LessonReader { folder, files: &files };
        let about = reader.toml("lesson.toml", "it holds title, summary, minutes and objectives")?;
        let mut figures = BTreeMap::new();
        for name in named(&files, "figures/", "svg") {
            figures.insert(name.clone(), reader.text(name, "")?.to_owned());
        }
        let text = markdown::render(reader.text("lesson.md", "it holds the text of the lesson")?, &figures);
        let mut scene = scene(&reader)?;
        let sources = QuestionSources {
            exercise: reader.toml("exercise.toml", "it holds the questions")?,
            references: reader
                .toml("reference/answers.toml", "it holds the right answers and their sources")?,
            description: scene["description"].as_str().unwrap_or_default().to_owned(),
        };
        let parameters = Parameters::defaults(&sources.exercise.parameters);
        describe(&mut scene, &sources.description, &parameters);
        let mut exercise = questions(&reader, &sources, &parameters, &scene)?;
        shuffle_options(&mut exercise, slug, "");
        let mut wrong = BTreeMap::new();
        let mut wrong_files = BTreeSet::new();
        for name in named(&files, "wrong/", "toml") {
            let mut file: WrongFile = reader.toml(name, "")?;
            wrong_files.extend(reader.fetch_files(name, &mut file)?);
            wrong.insert(name.clone(), file);
        }
        Ok(Self {
            slug: slug.to_owned(),
            number: places.of(slug),
            folder: folder.to_owned(),
            about,
            text,
            scene,
            exercise,
            wrong,
            hash,
            parameters,
            seed: String::new(),
            opens: OpensFile::default(),
            held: false,
            part: None,
            drawn_from: String::new(),
            dealer: None,
            sources,
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

/// The scenario as JSON. It is also read as a scene here, so that a fault is reported with its own file and line and not by
/// the first question.
fn scene(reader: &LessonReader) -> Result<serde_json::Value, LessonError> {
    let text = reader.text("scene.json", "it holds the scenario; start from a built-in one")?;
    let unreadable = |line, problem| LessonError::Unreadable {
        file: format!("{}/scene.json", reader.folder),
        line,
        problem,
    };
    let scene = serde_json::from_str(text).map_err(|e| unreadable(e.line(), e.to_string()))?;
    Scene::from_json(text).map_err(|error| {
        let line = if let SceneError::Syntax { line, .. } = &error { *line } else { 1 };
        unreadable(line, error.to_string())
    })?;
    Ok(scene)
}

/// The questions with their answers; an error is reported with the line of its question.
fn questions(
    reader: &LessonReader,
    sources: &QuestionSources,
    parameters: &Parameters,
    scene: &serde_json::Value,
) -> Result<Exercise, LessonError> {
    let patches = &sources.exercise.scene;
    let context = BuildContext { parameters, scene, files: reader.files, patches };
    exercise::build(sources.exercise.clone(), sources.references.clone(), &context).map_err(|error| {
        let file = if error.in_reference { "reference/answers.toml" } else { "exercise.toml" };
        let line = line_of(reader.text(file, "").unwrap_or_default(), &error.question);
        LessonError::Question { file: format!("{}/{file}", reader.folder), line, error }
    })
}
