//! Finding scenes: built-in ones by name, others in files; and the engine's errors as problems.

use std::io::Read;
use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use triad_engine::EngineError;
use triad_engine::analysis::AnalysisError;
use triad_engine::catalogue;
use triad_engine::scene::{self, Scene};
use triad_lab::paper::PaperError;
use triad_urdf::UrdfError;

use crate::limits::Limits;
use crate::problem::{Problem, suggest};

impl From<PaperError> for Problem {
    fn from(error: PaperError) -> Self {
        match error {
            PaperError::Engine(error) => error.into(),
            other @ PaperError::Singular { .. } => {
                Self::new(StatusCode::UNPROCESSABLE_ENTITY, other.code(), other.to_string(), other.hint())
            }
        }
    }
}

impl From<UrdfError> for Problem {
    fn from(error: UrdfError) -> Self {
        let detail = error.to_string();
        let (status, code, line, hint) = match &error {
            UrdfError::NoLongerWanted => return AnalysisError::NoLongerWanted.into(),
            UrdfError::TooLong { .. } => {
                (StatusCode::PAYLOAD_TOO_LARGE, "urdf-too-long", None, "import a smaller robot".to_owned())
            }
            UrdfError::Xml { line, .. } => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "not-xml",
                Some(*line),
                "a xacro file must be expanded first: xacro robot.xacro > robot.urdf".to_owned(),
            ),
            UrdfError::Wrong { line, hint, .. } => {
                (StatusCode::UNPROCESSABLE_ENTITY, "not-a-robot", Some(*line), (*hint).to_owned())
            }
            UrdfError::Unknown { name, known, .. } => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "unknown-in-side-car",
                None,
                suggest(name, known.iter().map(String::as_str)),
            ),
        };
        let problem = Self::new(status, code, detail.clone(), hint);
        match line {
            Some(line) => problem.at(format!("line={line}"), detail),
            None => problem,
        }
    }
}

/// The built-in scene called `name`, such as `n-four-bar:2`.
///
/// Errors if there is none, with the names that are near.
pub fn builtin(name: &str) -> Result<Scene, Problem> {
    catalogue::scene(name).map_err(|error| EngineError::from(error).into())
}

/// The built-in scene of that name, or the scene in that file.
///
/// Errors if there is neither, or the file is no scene.
pub fn named_or_in_file(spec: &str) -> Result<Scene, Problem> {
    let path = Path::new(spec);
    // Also a pipe: `triad check <(…)`.
    if path.exists() && !path.is_dir() {
        return in_file(path);
    }
    let unknown = match catalogue::scene(spec) {
        Ok(scene) => return Ok(scene),
        Err(error) => Problem::from(EngineError::from(error)),
    };
    // A name with a separator or an extension was meant as a file, but `n-four-bar:0` was not.
    let looks_like_file = spec.contains(['/', '\\']) || path.extension().is_some();
    let names = || catalogue::ENTRIES.iter().map(|entry| entry.name);
    let base = spec.split(':').next().unwrap_or(spec);
    if looks_like_file {
        return Err(Problem::new(
            StatusCode::NOT_FOUND,
            "no-such-file",
            format!("there is no file {spec}"),
            format!("check the path, or run a built-in scene: {}", names().collect::<Vec<_>>().join(", ")),
        ));
    }
    if names().any(|name| name.split(':').next() == Some(base)) {
        return Err(unknown);
    }
    Err(Problem::new(
        StatusCode::NOT_FOUND,
        "unknown-scene",
        format!("there is no built-in scene and no file called \"{spec}\""),
        suggest(base, names()),
    ))
}

fn in_file(path: &Path) -> Result<Scene, Problem> {
    let text = read(path, scene::MAX_TEXT as u64)?;
    Ok(Scene::from_json(&text)?)
}

/// A text file of at most `limit` bytes.
///
/// Errors if it cannot be read, is larger, or is not UTF-8.
pub fn read(path: &Path, limit: u64) -> Result<String, Problem> {
    let refused = |cause: String, hint: &'static str| {
        let shown: PathBuf = path.to_owned();
        Problem::new(
            StatusCode::BAD_REQUEST,
            "unreadable-file",
            format!("{} cannot be read: {cause}", shown.display()),
            hint,
        )
    };
    let file = std::fs::File::open(path).map_err(|e| refused(e.to_string(), "check the path"))?;
    let mut bytes = Vec::new();
    // A pipe does not tell its size.
    let size = file.take(limit + 1).read_to_end(&mut bytes);
    if size.map_err(|e| refused(e.to_string(), "check the path"))? as u64 > limit {
        return Err(refused(format!("it has more than {limit} bytes"), "use a smaller file"));
    }
    String::from_utf8(bytes).map_err(|e| refused(e.to_string(), "it must be a text file in UTF-8"))
}

/// A scene for the server: the built-in of that name, within the server's bounds.
///
/// Errors if there is none, or it is larger than the bounds.
pub fn builtin_within(name: &str, limits: &Limits) -> Result<Scene, Problem> {
    let scene = builtin(name)?;
    crate::session::bounded(&scene, limits)?;
    Ok(scene)
}
