//! The skeleton of a new lesson: everything that the check demands, with TODO where the author's own words belong.

use std::collections::BTreeMap;

/// The files of a new lesson, by path below its folder.
pub fn files(number: u32, slug: &str) -> BTreeMap<String, String> {
    let title: String = slug.replace('-', " ");
    let fill = |text: &str| {
        text.replace("{{number}}", &number.to_string()).replace("{{slug}}", slug).replace("{{title}}", &title)
    };
    [
        ("lesson.toml", include_str!("../../skeleton/lesson.toml")),
        ("lesson.md", include_str!("../../skeleton/lesson.md")),
        ("scene.json", include_str!("../../skeleton/scene.json")),
        ("exercise.toml", include_str!("../../skeleton/exercise.toml")),
        ("reference/answers.toml", include_str!("../../skeleton/answers.toml")),
        ("wrong/weight-only.toml", include_str!("../../skeleton/weight-only.toml")),
        ("wrong/other-side.toml", include_str!("../../skeleton/other-side.toml")),
        ("wrong/as-the-ball.toml", include_str!("../../skeleton/as-the-ball.toml")),
        ("figures/sketch.svg", include_str!("../../skeleton/sketch.svg")),
    ]
    .into_iter()
    .map(|(name, text)| (name.to_owned(), fill(text)))
    .collect()
}

/// What marks a place that the author still has to fill.
pub const TODO: &str = "TODO";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Course, check_lesson};

    fn problems(change: impl Fn(String) -> String) -> Vec<String> {
        let mut all = BTreeMap::new();
        all.insert("course.toml".to_owned(), b"format_version = 1\ntitle = \"x\"\n".to_vec());
        for (name, text) in files(1, "my-lesson") {
            all.insert(format!("01-my-lesson/{name}"), change(text).into_bytes());
        }
        let course = Course::from_files(all).unwrap_or_else(|e| panic!("{e}"));
        check_lesson(&course, &course.lessons()[0]).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_new_lesson_lists_its_todos_and_passes_when_they_are_filled() {
        let open = problems(|text| text);
        assert!(!open.is_empty() && open.iter().all(|p| p.contains("TODO")), "{open:#?}");
        let filled = problems(|text| text.replace("TODO", "Written by the author, with care."));
        assert!(filled.is_empty(), "{filled:#?}");
    }

    /// Of however few questions a lesson has.
    #[test]
    fn a_new_lesson_must_not_be_passed_with_what_others_know() {
        let changed =
            |from: &str, to: &str| problems(|text| text.replace("TODO", "With care.").replace(from, to));
        let coarse = changed("step = 0.05", "step = 2");
        assert!(coarse.iter().any(|p| p.contains("what is right in the answers of 6 others")), "{coarse:#?}");
        let heavy = changed("points = 1", "points = 5");
        assert!(heavy.iter().any(|p| p.contains("the same for everybody have 5 of 9 points;")), "{heavy:#?}");
        let of_two = changed(
            "points = 2\nprompt = \"With care. which velocity",
            "points = 0.1\nprompt = \"With care. which velocity",
        );
        assert!(of_two.iter().any(|p| p.contains("one number more 2: together they pass")), "{of_two:#?}");
    }
}
