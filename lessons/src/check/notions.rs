//! No notion is used before it is introduced.

use super::findings::Findings;
use crate::lesson::{Course, Lesson, need};

/// What the lesson needs is known by then, and whatever its texts use is needed or introduced.
pub(super) fn in_order(course: &Course, found: &mut Findings) {
    let lesson = found.lesson;
    for notion in &lesson.about.needs {
        let need = need(course, lesson, notion);
        if need.met {
            continue;
        }
        let (what, remedy) = match need.from {
            Some(slug) => (
                format!("the notion {notion} is introduced by {slug}, which does not come before"),
                format!("take {slug} earlier, or write {notion} under assumes in course.toml"),
            ),
            None => (
                format!("no lesson introduces the notion {notion}"),
                "correct the name, or write it under assumes in course.toml".to_owned(),
            ),
        };
        found.add("lesson.toml", 0, what, remedy);
    }
    let texts = texts(lesson);
    for other in course.lessons().iter().chain(course.others()) {
        for (notion, words) in &other.about.introduces {
            let declared = lesson.about.needs.contains(notion)
                || lesson.about.introduces.contains_key(notion)
                || course.assumes.contains(notion);
            let Some(word) = words.iter().find(|word| uses(&texts, word)).filter(|_| !declared) else {
                continue;
            };
            let what = format!("it uses \u{201c}{word}\u{201d}, the notion {notion} of {}", other.slug);
            let remedy = format!("add {notion} to needs, or say it in other words");
            found.add("lesson.toml", 0, what, remedy);
        }
    }
}

/// All that a student reads of a lesson, in small letters.
fn texts(lesson: &Lesson) -> String {
    let text = lesson.files.get("lesson.md").map(Vec::as_slice).unwrap_or_default();
    let mut all = String::from_utf8_lossy(text).into_owned();
    for step in &lesson.about.steps {
        all.push('\n');
        all.push_str(&step.text);
    }
    for prediction in &lesson.about.predictions {
        let options = prediction.options.iter().map(|option| &option.text);
        for text in options.chain([&prediction.text, &prediction.shows]) {
            all.push('\n');
            all.push_str(text);
        }
    }
    for text in lesson.exercise.questions.iter().flat_map(|question| question.texts()) {
        all.push('\n');
        all.push_str(text);
    }
    all.to_lowercase().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Whether a word, or several, stand in a text, one or many of it, and not inside another word or an address.
fn uses(text: &str, word: &str) -> bool {
    let word = word.to_lowercase();
    let inside = |c: char| c.is_alphanumeric() || c == '-' || c == '/';
    text.match_indices(&word).any(|(at, _)| {
        let rest = &text[at + word.len()..];
        let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric());
        !text[..at].ends_with(inside) && (ends(rest) || rest.strip_prefix('s').is_some_and(ends))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_whole() {
        assert!(uses("two multipliers", "multiplier") && uses("by virtual work.", "Virtual work"));
        assert!(!uses("to carry", "car") && uses("a row car,", "CAR"));
        assert!(!uses("a codriver", "driver") && !uses("see /lessons/jacobian", "jacobian"));
    }
}
