//! Checks the texts, labels, links and figures of a lesson.

use std::collections::{BTreeMap, BTreeSet};

use super::findings::Findings;
use crate::files::StepKind;
use crate::files::skeleton::TODO;
use crate::lesson::{Course, line_of};
use crate::rendering::figure::Figure;
use crate::rendering::markdown;

/// What the lesson says of itself.
pub(super) fn about(course: &Course, found: &mut Findings) {
    let lesson = found.lesson;
    let about = &lesson.about;
    for (key, text) in [("title", &about.title), ("summary", &about.summary)] {
        if text.trim().is_empty() {
            found.add("lesson.toml", 0, format!("{key} is empty"), "write one");
        }
    }
    if !(10..=180).contains(&about.minutes) {
        found.add("lesson.toml", 0, "a lesson takes 10 to 180 minutes", "split or join lessons");
    }
    if about.objectives.is_empty() || about.objectives.iter().any(|o| o.trim().is_empty()) {
        found.add(
            "lesson.toml",
            0,
            "an objective is missing or empty",
            "say what the student can do afterwards",
        );
    }
    let plain = about.objectives.iter().chain([&about.title, &about.summary]);
    if let Some(text) = plain.into_iter().find(|t| t.contains('$')) {
        let what = format!("\u{201c}{text}\u{201d} has a formula");
        found.add("lesson.toml", 0, what, "title, summary and objectives are shown as plain text");
    }
    for slug in &about.prerequisites {
        if !course.lessons().iter().any(|l| l.slug == *slug && l.number < lesson.number) {
            found.add(
                "lesson.toml",
                0,
                format!("the prerequisite {slug} is no earlier lesson"),
                "correct the slug",
            );
        }
    }
    let order: Vec<StepKind> = about.steps.iter().map(|step| step.kind).collect();
    if order != [StepKind::Predict, StepKind::Run, StepKind::Check, StepKind::Explain] {
        found.add(
            "lesson.toml",
            0,
            "the steps are not predict, run, check, explain",
            "write one [[step]] of each kind, in this order",
        );
    }
    for step in &about.steps {
        if step.text.trim().is_empty() {
            found.add("lesson.toml", 0, "a step has no text", "say what to do");
        }
    }
}

/// The text of the lesson: its problems, labels and links, and the short texts of steps and questions.
pub(super) fn text(course: &Course, found: &mut Findings) {
    let lesson = found.lesson;
    for (line, what) in &lesson.text.problems {
        found.add("lesson.md", *line, what.clone(), "correct the line");
    }
    let mut seen = BTreeSet::new();
    for (k, (label, line)) in lesson.text.labels.iter().enumerate() {
        if !seen.insert(label.as_str()) {
            found.add(
                "lesson.md",
                *line,
                format!("the equation label {label} is used twice"),
                "renumber one",
            );
        }
        let expected = format!("{}.{}", lesson.number, k + 1);
        if *label != expected {
            let remedy = format!("number the equations in order: \\tag{{{expected}}}");
            found.add("lesson.md", *line, format!("the equation label is {label}"), remedy);
        }
    }
    for (target, line) in &lesson.text.links {
        link(course, target, "lesson.md", *line, found);
    }
    for step in &lesson.about.steps {
        short(course, &step.text, "lesson.toml", 0, found);
    }
    let bytes = lesson.files.get("exercise.toml").map(Vec::as_slice).unwrap_or_default();
    let exercise = String::from_utf8_lossy(bytes);
    for question in &lesson.exercise.questions {
        let line = line_of(&exercise, &question.id);
        for text in question.texts() {
            short(course, text, "exercise.toml", line, found);
        }
    }
}

/// A name in double braces for which nothing is drawn: students would read it as it is written.
fn placeholders(text: &str, file: &str, line: usize, found: &mut Findings) {
    for name in found.lesson.parameters.unknown(text) {
        let remedy = format!("correct the name, or add {name} to [parameters] of exercise.toml");
        found.add(file, line, format!("{{{{{name}}}}} is no parameter"), remedy);
    }
}

/// The same of the scene's description, and of the lesson's text, which is the same for everybody.
pub(super) fn all_placeholders(found: &mut Findings) {
    let lesson = found.lesson;
    placeholders(&lesson.sources.description, "scene.json", 0, found);
    let text = lesson.files.get("lesson.md").map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
    for (at, line) in text.lines().enumerate() {
        placeholders(line, "lesson.md", at + 1, found);
        for (name, _) in
            lesson.parameters.iter().filter(|(name, _)| line.contains(&format!("{{{{{name}}}}}")))
        {
            let what = format!("{{{{{name}}}}} stands in the text, which is the same for everybody");
            found.add("lesson.md", at + 1, what, "name the number in a step or a question");
        }
    }
}

/// Checks a text that stands in a TOML file: its links, its numbers, and that it is plain Markdown without figures.
pub(super) fn short(course: &Course, text: &str, file: &str, line: usize, found: &mut Findings) {
    placeholders(text, file, line, found);
    let rendered = markdown::render(text, &BTreeMap::new());
    for (_, what) in rendered.problems {
        found.add(file, line, what, "correct the text");
    }
    for (target, _) in rendered.links {
        link(course, &target, file, line, found);
    }
}

fn link(course: &Course, target: &str, file: &str, line: usize, found: &mut Findings) {
    let (page, fragment) = target.split_once('#').unwrap_or((target, ""));
    let there = match page.strip_prefix("/lessons/") {
        _ if page.is_empty() => Some(found.lesson),
        Some(slug) => course.lesson(slug).filter(|l| l.slug == slug),
        None if page.starts_with('/') => None,
        None => return,
    };
    let known = there.is_some_and(|l| match fragment.strip_prefix("eq-") {
        Some(label) => l.text.labels.iter().any(|(known, _)| known == label),
        None => fragment.is_empty(),
    });
    if !known {
        let remedy = "link to #eq-N.M, /lessons/SLUG or /lessons/SLUG#eq-N.M";
        found.add(file, line, format!("the link {target} leads nowhere"), remedy);
    }
}

/// Places that a skeleton left to the author.
pub(super) fn unfinished(found: &mut Findings) {
    let lesson = found.lesson;
    for (name, bytes) in lesson.files.iter() {
        let text = String::from_utf8_lossy(bytes);
        for (at, _) in text.lines().enumerate().filter(|(_, line)| line.contains(TODO)) {
            found.add(name, at + 1, "it still says TODO", "write what belongs there");
        }
    }
}

/// Files that nothing uses, and ids that two figures define.
pub(super) fn stray_files(found: &mut Findings) {
    let lesson = found.lesson;
    for name in lesson.files.keys() {
        let belongs = matches!(name.as_str(), "lesson.toml" | "lesson.md" | "scene.json" | "exercise.toml")
            || name.starts_with("reference/")
            || name.starts_with("scenes/")
            || lesson.wrong.contains_key(name)
            || lesson.wrong_files.contains(name)
            || lesson.text.figures.contains(name);
        if !belongs {
            found.add(name, 0, "nothing uses this file", "use it or remove it");
        }
    }
    let mut ids: BTreeMap<String, &str> = BTreeMap::new();
    for (name, svg) in &lesson.figures {
        for id in Figure::parse(svg).map(|figure| figure.ids).unwrap_or_default() {
            if let Some(other) = ids.insert(id.clone(), name) {
                let what = format!("the id {id} is also used in {other}; both are part of one page");
                found.add(name, 0, what, "rename it");
            }
        }
    }
}
