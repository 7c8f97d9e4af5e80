//! Proving a course: what an author promises is tried out, and every complaint names its place and a remedy.

mod answers;
mod measured;
mod question;
mod tasks;
mod variants;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

pub use answers::reference_submission;

use schemars::JsonSchema;
use serde::Serialize;

use crate::course::Course;
use crate::files::StepKind;
use crate::lesson::{Lesson, line_of};
use crate::markdown;

/// Something an author has to put right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Problem {
    /// File below the course's folder.
    pub file: String,
    /// Line from 1, or 0 where the whole file is meant.
    pub line: usize,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        write!(f, ": {}; {}", self.what, self.remedy)
    }
}

/// Checks a whole course. Empty means proven.
pub fn check_course(course: &Course) -> Vec<Problem> {
    let mut problems = check_course_files(course);
    for lesson in course.lessons() {
        problems.extend(check_lesson(course, lesson));
    }
    problems
}

/// Checks that every file of a course belongs to a lesson.
pub fn check_course_files(course: &Course) -> Vec<Problem> {
    let stray = |file: &String| Problem {
        file: file.clone(),
        line: 0,
        what: "it belongs to no lesson".to_owned(),
        remedy: "move it into a lesson or remove it".to_owned(),
    };
    course.stray().iter().map(stray).collect()
}

/// Checks one lesson of a course.
pub fn check_lesson(course: &Course, lesson: &Lesson) -> Vec<Problem> {
    let mut found = Found { lesson, problems: Vec::new() };
    about(course, &mut found);
    text(course, &mut found);
    stray_files(&mut found);
    unfinished(&mut found);
    measured::scene(&mut found);
    for question in &lesson.exercise.questions {
        question::itself(question, &mut found);
        tasks::task(question, &mut found);
    }
    answers::starter_fails(&mut found);
    answers::reference_passes(&mut found);
    answers::wrong_answers_fail(&mut found);
    variants::all_fit(&mut found);
    found.problems
}

struct Found<'a> {
    lesson: &'a Lesson,
    problems: Vec<Problem>,
}

impl Found<'_> {
    fn add(&mut self, file: &str, line: usize, what: impl Into<String>, remedy: impl Into<String>) {
        let file = format!("{}/{file}", self.lesson.folder);
        self.problems.push(Problem { file, line, what: what.into(), remedy: remedy.into() });
    }

    fn question(&mut self, id: &str, what: impl fmt::Display, remedy: impl Into<String>) {
        let bytes = self.lesson.files.get("exercise.toml").map(Vec::as_slice).unwrap_or_default();
        let line = line_of(&String::from_utf8_lossy(bytes), id);
        self.add("exercise.toml", line, format!("question {id}: {what}"), remedy);
    }
}

fn about(course: &Course, found: &mut Found) {
    let lesson = found.lesson;
    let about = &lesson.about;
    for (key, text) in [("title", &about.title), ("summary", &about.summary)] {
        if text.trim().is_empty() {
            found.add("lesson.toml", 0, format!("{key} is empty"), "write one");
        }
    }
    if !(10..=40).contains(&about.minutes) {
        found.add("lesson.toml", 0, "a lesson takes 10 to 40 minutes", "split or join lessons");
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

fn text(course: &Course, found: &mut Found) {
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

/// Checks a text that stands in a TOML file: its links, and that it is plain Markdown without figures.
fn short(course: &Course, text: &str, file: &str, line: usize, found: &mut Found) {
    let rendered = markdown::render(text, &BTreeMap::new());
    for (_, what) in rendered.problems {
        found.add(file, line, what, "correct the text");
    }
    for (target, _) in rendered.links {
        link(course, &target, file, line, found);
    }
}

fn link(course: &Course, target: &str, file: &str, line: usize, found: &mut Found) {
    let (page, fragment) = target.split_once('#').unwrap_or((target, ""));
    let there = match page.strip_prefix("/lessons/") {
        _ if page.is_empty() => Some(found.lesson),
        Some(slug) => course.lessons().iter().find(|l| l.slug == slug),
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
fn unfinished(found: &mut Found) {
    let lesson = found.lesson;
    for (name, bytes) in lesson.files.iter() {
        let text = String::from_utf8_lossy(bytes);
        for (at, _) in text.lines().enumerate().filter(|(_, line)| line.contains(crate::skeleton::TODO)) {
            found.add(name, at + 1, "it still says TODO", "write what belongs there");
        }
    }
}

fn stray_files(found: &mut Found) {
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
        for id in crate::figure::check(svg).unwrap_or_default() {
            if let Some(other) = ids.insert(id.clone(), name) {
                let what = format!("the id {id} is also used in {other}; both are part of one page");
                found.add(name, 0, what, "rename it");
            }
        }
    }
}
