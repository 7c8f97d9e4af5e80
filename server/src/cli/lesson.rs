//! `triad lesson`.

use std::path::Path;

use serde_json::json;
use triad_lessons::{Course, Lesson};

use super::Outcome;
use super::terminal::{print_json, print_line};
use crate::api::unknown_lesson;
use crate::problem::Problem;

/// The course in a folder, or the one that is built in.
pub(super) fn course(folder: Option<&Path>) -> Result<Course, Problem> {
    Ok(match folder {
        Some(folder) => Course::load(folder)?,
        None => Course::embedded()?,
    })
}

/// The lesson of that name.
pub(super) fn find<'a>(course: &'a Course, name: &str) -> Result<&'a Lesson, Problem> {
    course.lesson(name).ok_or_else(|| unknown_lesson(course, name))
}

/// Lists the lessons.
pub(super) fn list(course: &Course, json: bool) -> Outcome {
    let summaries: Vec<_> = course.lessons().iter().map(Lesson::summary).collect();
    if json {
        print_json(&summaries);
        return Outcome::Done;
    }
    let width = summaries.iter().map(|s| s.slug.len()).max().unwrap_or(0);
    for s in summaries {
        print_line(&format!("{:>2}  {:width$}  {} ({} min)", s.number, s.slug, s.title, s.minutes));
    }
    Outcome::Done
}

/// Proves the course, or one lesson of it.
pub(super) fn check(course: &Course, lesson: Option<&str>, json: bool) -> Result<Outcome, Problem> {
    let (checked, faults) = match lesson {
        Some(name) => (1, triad_lessons::check_lesson(course, find(course, name)?)),
        None => (course.lessons().len(), triad_lessons::check_course(course)),
    };
    if json {
        print_json(&json!({"lessons": checked, "faults": faults}));
    } else {
        for fault in &faults {
            print_line(&fault.to_string());
        }
        print_line(&format!("{checked} lessons checked, {} faults", faults.len()));
    }
    Ok(if faults.is_empty() { Outcome::Done } else { Outcome::No })
}
