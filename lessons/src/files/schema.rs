//! JSON Schemas of an author's files, generated from the types that read them.

use schemars::schema_for;

use super::exercise::ExerciseFile;
use super::lesson::{CourseFile, LessonFile};
use super::reference::{ReferenceFile, WrongFile};

/// Names of the files that have a schema.
pub const NAMES: [&str; 5] = ["course", "lesson", "exercise", "reference", "wrong"];

/// The schema of a file: `lesson` for lesson.toml, `exercise` for exercise.toml, `reference` for one entry of
/// reference/answers.toml, `wrong` for wrong/*.toml, `course` for course.toml.
pub fn of(name: &str) -> Option<serde_json::Value> {
    Some(match name {
        "course" => schema_for!(CourseFile).into(),
        "lesson" => schema_for!(LessonFile).into(),
        "exercise" => schema_for!(ExerciseFile).into(),
        "reference" => {
            let one: serde_json::Value = schema_for!(ReferenceFile).into();
            let definitions = one.get("$defs").cloned().unwrap_or_default();
            let mut entry = one;
            if let Some(entry) = entry.as_object_mut() {
                entry.remove("$defs");
                entry.remove("$schema");
            }
            serde_json::json!({
                "$schema": "https://json-schema.org/draft/2020-12/schema",
                "title": "References of a lesson, by question",
                "type": "object",
                "additionalProperties": entry,
                "$defs": definitions,
            })
        }
        "wrong" => schema_for!(WrongFile).into(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_file_has_a_schema_that_refuses_unknown_keys() {
        for name in super::NAMES {
            let schema = super::of(name).unwrap();
            let closed = schema.get("additionalProperties").is_some();
            assert!(closed, "{name}: {schema}");
        }
        let exercise = super::of("exercise").unwrap().to_string();
        for word in ["implement", "trajectory", "tuning", "follows", "other-side", "misconception"] {
            assert!(exercise.contains(word), "{word}");
        }
        assert!(super::of("poem").is_none());
    }
}
