//! Why a text is not a scene.

use crate::limits::MAX_TEXT;
use crate::settings::Settings;
use crate::text::nearest_name;
use serde::Deserialize;
use serde_json::json;

/// Why a text is not a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The text is too long to be read.
    #[error("the scene's text has {bytes} bytes, more than the {MAX_TEXT} that are read")]
    TooLong {
        /// Its length.
        bytes: usize,
    },
    /// Not JSON, an unknown key, or a value of the wrong type.
    #[error("{path} (line {line}, column {column}): {reason}")]
    Syntax {
        /// Where, as a path of keys.
        path: String,
        /// The same place as a JSON pointer.
        pointer: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        reason: String,
    },
    /// More bodies, joints, drivers or loads than allowed.
    #[error("{what}: {count} are more than the {limit} that a scene may have")]
    TooMany {
        /// Which list.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A place that should hold a number holds none.
    #[error("{pointer}: {found}")]
    NoNumber {
        /// Where, as a JSON pointer.
        pointer: String,
        /// What is there instead.
        found: String,
    },
    /// The scene has no parameter of that name.
    #[error("the scene has no parameter \"{name}\"")]
    UnknownParameter {
        /// The name.
        name: String,
        /// The names that it has.
        known: Vec<String>,
    },
    /// A value outside the range of its parameter.
    #[error("parameter \"{name}\": {value} is not between {low} and {high}")]
    OutsideParameter {
        /// The parameter.
        name: String,
        /// The value.
        value: f64,
        /// Its least value.
        low: f64,
        /// Its greatest value.
        high: f64,
    },
}

impl SceneError {
    /// What was meant by a key that is none, if that can be told.
    pub fn meant(&self) -> Option<String> {
        let Self::Syntax { pointer, reason, .. } = self else { return None };
        let (key, known) = reason.strip_prefix("unknown field `")?.split_once("`, expected ")?;
        if pointer.strip_prefix('/') == Some(key) && is_setting(key) {
            return Some(format!("\"{key}\" is one of the settings: write it within \"simulation\"."));
        }
        // Names stand between backticks.
        let nearest = nearest_name(key, known.split('`').skip(1).step_by(2))?;
        Some(format!("Did you mean \"{nearest}\"?"))
    }
}

/// Whether the settings know a key.
fn is_setting(key: &str) -> bool {
    let alone = json!({ key: null });
    Settings::deserialize(&alone).err().is_none_or(|error| !error.to_string().starts_with("unknown field"))
}

/// The error of a reader that knows the path of keys.
pub(crate) fn syntax_error(error: &serde_path_to_error::Error<serde_json::Error>) -> SceneError {
    let path = error.path().to_string();
    let pointer: String = error
        .path()
        .iter()
        .map(|segment| match segment {
            serde_path_to_error::Segment::Seq { index } => format!("/{index}"),
            serde_path_to_error::Segment::Map { key } => format!("/{key}"),
            serde_path_to_error::Segment::Enum { variant } => format!("/{variant}"),
            serde_path_to_error::Segment::Unknown => String::new(),
        })
        .collect();
    match plain_error(error.inner(), &pointer) {
        SceneError::Syntax { pointer, line, column, reason, .. } => {
            let path = if path == "." { "scene".to_owned() } else { path };
            SceneError::Syntax { path, pointer, line, column, reason }
        }
        other => other,
    }
}

/// The error of a reader that knows line and column only.
pub(crate) fn plain_error(error: &serde_json::Error, pointer: &str) -> SceneError {
    let text = error.to_string();
    let reason = text.rsplit_once(" at line ").map_or(text.as_str(), |(reason, _)| reason);
    // The place is where the reader noticed it: the brace behind all that is there.
    let reason = match reason.strip_prefix("missing field ") {
        Some(key) => format!("{key} is missing: write it between the braces that end here"),
        None => in_plain_words(reason),
    };
    SceneError::Syntax {
        path: "scene".to_owned(),
        pointer: pointer.to_owned(),
        line: error.line(),
        column: error.column(),
        reason,
    }
}

/// What the reader expected, without the words of this program's language.
fn in_plain_words(reason: &str) -> String {
    match reason {
        // Behind the components that a vector has.
        "trailing characters" => return "more values than belong here".to_owned(),
        // A number where a word or an object stands.
        "expected value" => return "another kind of value belongs here".to_owned(),
        _ => {}
    }
    let Some((given, expected)) = reason.rsplit_once(", expected ") else { return reason.to_owned() };
    let expected = match expected {
        "f64" => "a number",
        "u32" | "u64" | "usize" | "i32" | "i64" => "a whole number",
        "a sequence" => "a list in brackets",
        "a map" => "an object in braces",
        other if other.starts_with("struct ") => "an object in braces",
        other => other,
    };
    format!("{given}, expected {expected}")
}
