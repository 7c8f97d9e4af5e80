//! `triad lesson`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use clap::{Args, Subcommand};
use serde_json::json;
use triad_lessons::{Course, Lesson};

use crate::api::unknown_lesson;
use crate::cli::output::{not_standard, write};
use crate::cli::terminal::{Outcome, counted, print_json, print_line};
use crate::problem::Problem;
use crate::variants::Variants;

#[derive(Debug, Args)]
pub(in crate::cli) struct Starter {
    /// The lesson.
    lesson: String,
    /// The question.
    question: String,
    /// python, octave (the same as matlab) or julia.
    #[arg(long, default_value = "python")]
    language: String,
    /// Whose states; without it, those that everybody sees.
    #[arg(long, default_value = "", value_name = "NAME")]
    student: String,
    /// The folder for the program and states.json.
    #[arg(long, default_value = ".", value_name = "DIR")]
    out: PathBuf,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum LessonCommand {
    /// List the lessons.
    List,
    /// Tell what each lesson introduces and needs, and from where: what may be left out, and what must come before.
    #[command(after_help = "Examples:\n  triad lesson graph\n  triad --course my-course lesson graph --dot")]
    Graph {
        /// As a graph for Graphviz.
        #[arg(long)]
        dot: bool,
    },
    /// Prove the course: references pass, wrong answers get their own feedback, every number has a source.
    #[command(after_help = "Examples:\n  triad lesson check\n  triad lesson check simple-pendulum\n  \
        triad --course my-course lesson check")]
    Check {
        /// Only this lesson.
        lesson: Option<String>,
    },
    /// Begin a lesson: a skeleton that runs, with TODO where your words belong.
    #[command(after_help = "Example:\n  triad lesson new my-lesson --into my-course\n  \
        triad --course my-course lesson preview my-lesson\n  triad --course my-course lesson check my-lesson")]
    New {
        /// Its name in addresses: small letters, digits and dashes.
        slug: String,
        /// The folder of the course; made if it is not there.
        #[arg(long, default_value = ".", value_name = "DIR")]
        into: PathBuf,
    },
    /// Show a lesson in the browser while you write it: every saved file is shown at once, with its faults.
    #[command(after_help = "Example:\n  triad --course my-course lesson preview my-lesson")]
    Preview {
        /// The lesson.
        lesson: String,
        /// Port to listen at; 0 takes any free one.
        #[arg(long, default_value_t = 8090)]
        port: u16,
    },
    /// Write the starter of a question that asks for a program, and the states that are dealt to a student.
    #[command(
        after_help = "Example:\n  triad lesson starter rigid-body-rows program --language octave --student ada --out ."
    )]
    Starter(Starter),
}

/// The course in a folder, or the one that is built in.
pub(in crate::cli) fn course(folder: Option<&Path>) -> Result<Course, Problem> {
    Ok(match folder {
        Some(folder) => Course::load(folder)?,
        None => Course::embedded()?,
    })
}

/// The lesson of that name.
pub(in crate::cli) fn find<'a>(course: &'a Course, name: &str) -> Result<&'a Lesson, Problem> {
    course.lesson(name).ok_or_else(|| unknown_lesson(course, name))
}

/// Lists the lessons.
pub(in crate::cli) fn list(course: &Course, json: bool) -> Outcome {
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

/// Proves the course, or one lesson of it, and tells how long each lesson took.
pub(in crate::cli) fn check(course: &Course, lesson: Option<&str>, json: bool) -> Result<Outcome, Problem> {
    let start = Instant::now();
    let mut faults = triad_lessons::check_course_files(course);
    let lessons: Vec<&Lesson> = match lesson {
        Some(name) => vec![find(course, name)?],
        None => course.lessons().iter().collect(),
    };
    let mut times = Vec::with_capacity(lessons.len());
    for (lesson, (found, took)) in lessons.iter().zip(triad_lessons::check_lessons(course, &lessons)) {
        faults.extend(found);
        times.push(json!({"lesson": lesson.slug, "seconds": rounded(took)}));
    }
    if json {
        print_json(
            &json!({"lessons": lessons.len(), "faults": faults, "seconds": rounded(start.elapsed()), "times": times}),
        );
    } else {
        for fault in &faults {
            print_line(&fault.to_string());
        }
        for time in &times {
            print_line(&format!(
                "{:>8.2} s  {}",
                time["seconds"],
                time["lesson"].as_str().unwrap_or_default()
            ));
        }
        let (n, seconds) = (lessons.len(), rounded(start.elapsed()));
        print_line(&format!(
            "{} checked in {seconds} s, {}",
            counted(n, "lesson"),
            counted(faults.len(), "fault")
        ));
    }
    Ok(if faults.is_empty() { Outcome::Done } else { Outcome::No })
}

/// Seconds, to hundredths.
fn rounded(took: Duration) -> f64 {
    (took.as_secs_f64() * 100.0).round() / 100.0
}

/// Writes the skeleton of a lesson into a course.
pub(in crate::cli) fn new(slug: &str, into: &Path, json: bool) -> Result<Outcome, Problem> {
    let sound = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if slug.is_empty() || slug.len() > 60 || !slug.chars().all(sound) || slug.starts_with('-') {
        let what = format!("\"{slug}\" cannot be the name of a lesson");
        let hint = "use small letters, digits and dashes, such as double-pendulum";
        return Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "lesson-name", what, hint));
    }
    not_standard("--into", into)?;
    let head = into.join("course.toml");
    let number = if head.exists() {
        let course = Course::load(into)?;
        if let Some(lesson) = course.lesson(slug) {
            let what = format!("there is a lesson {slug} in {} already", into.join(&lesson.folder).display());
            let hint = "choose another name, or edit that one";
            return Err(Problem::new(StatusCode::CONFLICT, "lesson-exists", what, hint));
        }
        course.lessons().iter().chain(course.others()).map(|l| l.number).max().unwrap_or(0) + 1
    } else {
        write(&head, "format_version = 1\ntitle = \"A course\"\n")?;
        1
    };
    let folder = into.join(format!("{number:02}-{slug}"));
    for (name, text) in triad_lessons::files::skeleton::files(number, slug) {
        write(&folder.join(name), &text)?;
    }
    if json {
        print_json(&json!({"folder": folder.display().to_string(), "number": number}));
        return Ok(Outcome::Done);
    }
    print_line(&format!("Lesson {number} begins in {}", folder.display()));
    print_line(&format!("See it while you write:  triad --course {} lesson preview {slug}", into.display()));
    print_line(&format!("What is still to do:     triad --course {} lesson check {slug}", into.display()));
    Ok(Outcome::Done)
}

/// Writes a starter and its states.
pub(in crate::cli) fn starter(course: &Course, options: &Starter, json: bool) -> Result<Outcome, Problem> {
    not_standard("--out", &options.out)?;
    let lesson = Variants::default().of(find(course, &options.lesson)?, &options.student)?;
    let (name, text) = crate::api::starter_of(&lesson, &options.question, &options.language)?;
    let instances = crate::api::instances(&lesson, &options.question)?;
    let states = serde_json::to_string_pretty(&instances).map_err(Problem::internal)?;
    write(&options.out.join(name), &text)?;
    write(&options.out.join("states.json"), &states)?;
    if json {
        print_json(&json!({"starter": name, "states": "states.json", "seed": lesson.seed}));
    } else {
        let folder = options.out.display();
        print_line(&format!("{name} and states.json are in {folder}; the program writes answer.json"));
        print_line(&format!(
            "Hand it in: {{\"answers\": {{\"{}\": {{\"file\": \"…\"}}}}}}",
            options.question
        ));
    }
    Ok(Outcome::Done)
}

/// Prints a schema.
pub(in crate::cli) fn schema(of: &str) -> Result<Outcome, Problem> {
    let schema = match of {
        "scene" => Some(triad_engine::scene::schema()),
        other => triad_lessons::files::schema::of(other),
    };
    let schema = schema.ok_or_else(|| {
        let names = triad_lessons::files::schema::NAMES.join(", ");
        Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "unknown-schema",
            format!("there is no schema of \"{of}\""),
            format!("there are schemas of scene, {names}"),
        )
    })?;
    print_json(&schema);
    Ok(Outcome::Done)
}
