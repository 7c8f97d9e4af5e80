//! Grades one lesson where another system runs autograders: reads what a student handed in, writes the result in that
//! system's format. One file without libraries of the machine, so that it runs in any image of Linux, without network.
//!
//! `triad export` packs it with a lesson. In reading order: [`handed_in`] (the student's file), [`outcome`] (a verdict, or why
//! there is none), [`gradescope`] and [`prairielearn`] (the formats), [`places`] (the folders of both systems).

mod handed_in;

mod outcome;

mod gradescope;

mod prairielearn;

mod places;

use std::path::Path;
use std::process::ExitCode;

use places::Broken;

const USAGE: &str = "\
Grades a lesson of Triad in the autograder of another system; triad export packs it.

Usage:
  triad-grade gradescope [--root DIR] [--numbers-of-email]   write DIR/results/results.json (DIR: /autograder)
  triad-grade prairielearn [--root DIR]                      write DIR/results/results.json (DIR: /grade)
  triad-grade verdict LESSON ANSWERS                         print the verdict on a file with answers
  triad-grade --version

A result is written whatever was handed in; the exit code is 0 if one could be written, else 4.
triad-grade verdict exits with 3 where there is no verdict, and with 2 whoever is not understood.";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["gradescope", options @ ..] => match Options::read(options, "/autograder", true) {
            Some(options) => written(gradescope::run(Path::new(options.root), options.numbers_of_email)),
            None => misunderstood(),
        },
        ["prairielearn", options @ ..] => match Options::read(options, "/grade", false) {
            Some(options) => written(prairielearn::run(Path::new(options.root))),
            None => misunderstood(),
        },
        ["verdict", lesson, answers] => verdict(Path::new(lesson), Path::new(answers)),
        ["--version"] => {
            println!("triad-grade {}", env!("CARGO_PKG_VERSION"));
            ExitCode::SUCCESS
        }
        ["--help" | "-h"] => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => misunderstood(),
    }
}

/// What may stand behind the name of a system.
struct Options<'a> {
    root: &'a str,
    numbers_of_email: bool,
}

impl<'a> Options<'a> {
    fn read(mut words: &[&'a str], root: &'a str, may_ask_email: bool) -> Option<Self> {
        let mut options = Self { root, numbers_of_email: false };
        loop {
            words = match words {
                [] => return Some(options),
                ["--root", folder, rest @ ..] => {
                    options.root = folder;
                    rest
                }
                ["--numbers-of-email", rest @ ..] if may_ask_email => {
                    options.numbers_of_email = true;
                    rest
                }
                _ => return None,
            };
        }
    }
}

fn misunderstood() -> ExitCode {
    eprintln!("{USAGE}");
    ExitCode::from(2)
}

fn written(result: Result<(), Broken>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(broken) => {
            eprintln!("triad-grade: {broken}");
            ExitCode::from(4)
        }
    }
}

/// Prints a verdict as `triad grade --json` does.
fn verdict(lesson: &Path, answers: &Path) -> ExitCode {
    let graded = places::lesson(lesson).map_err(|broken| broken.to_string()).and_then(|lesson| {
        handed_in::text(answers)
            .and_then(|text| handed_in::grade(&lesson, &text, None))
            .map_err(|e| e.to_string())
    });
    match graded.and_then(|verdict| serde_json::to_string_pretty(&verdict).map_err(|e| e.to_string())) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("triad-grade: {why}");
            ExitCode::from(3)
        }
    }
}
