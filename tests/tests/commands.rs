//! What the program prints for people: help, runs, counts, reactions, analyses, the course. Texts that were read stand in
//! `tests/data/reviewed/`.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fmt::Write as _;
use std::process::{Command, Stdio};
use triad_tests::options::subcommands;
use triad_tests::program::triad;
use triad_tests::reviewed::{reviewed, settled};
use triad_tests::root;

/// Lines of one output that are compared; the rest is counted.
const MAX_LINES: usize = 100;

/// Runs the program at the repository's root, as somebody does who tries it; its exit code and all that it printed.
fn said(line: &str) -> String {
    let mut program = Command::new(triad());
    // Help is as wide as the terminal, and shows what these hold.
    let shown = |name: &str| name == "COLUMNS" || name.starts_with("TRIAD_");
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_str().is_some_and(shown)) {
        program.env_remove(name);
    }
    let output =
        program.args(line.split_whitespace()).current_dir(root()).stdin(Stdio::null()).output().unwrap();
    let mut text = format!("$ triad {line}\n");
    for stream in [&output.stdout, &output.stderr] {
        let printed = String::from_utf8_lossy(stream);
        let mut lines = printed.lines().map(str::trim_end);
        for line in lines.by_ref().take(MAX_LINES) {
            let _ = writeln!(text, "{line}");
        }
        match lines.count() {
            0 => {}
            more => writeln!(text, "… {more} more lines").unwrap(),
        }
    }
    match output.status.code() {
        Some(0) => {}
        code => {
            let _ = writeln!(text, "exit code {code:?}");
        }
    }
    text + "\n"
}

/// All of it, without what rounding decides.
fn settled_output(lines: &[&str]) -> String {
    settled(lines.iter().map(|line| said(line)).collect::<String>().trim_end())
}

#[test]
fn help_is_what_was_read() {
    let mut text = said("--help");
    for command in subcommands(&text) {
        let help = said(&format!("{command} --help"));
        let inner = subcommands(&help);
        text.push_str(&help);
        for inner in inner {
            text.push_str(&said(&format!("{command} {inner} --help")));
        }
    }
    assert!(text.matches("\nUsage: triad").count() > 18, "{text}");
    reviewed("help", text.trim_end());
}

#[test]
fn runs_tell_what_was_read() {
    let text = settled_output(&[
        "run simple-pendulum --until 1",
        "run simple-pendulum --until 1 --verify",
        "run n-four-bar:2 --until 2 --explain",
        "run spatial-slider-crank --until 1 --explain",
        "run tests/data/scenes/islands.json --explain",
        "run tests/data/scenes/events.json",
        "run n-four-bar:1 --until 3 --treatment penalty --integrator dop853",
        "run free-body-flip --until 1 --tolerance 1e-5",
        "run simple-pendulum --until 1 --most-steps 2",
        "run simple-pendulm",
    ]);
    reviewed("runs", &text);
}

#[test]
fn counts_and_reactions_are_what_was_read() {
    let text = settled_output(&[
        "check simple-pendulum",
        "check n-four-bar:2",
        "check bricard",
        "check tests/data/scenes/rough-four-bar.json",
        "reactions simple-pendulum --at 0.3",
        "reactions simple-pendulum --at 0.3 --on i --about origin --in body",
        "reactions n-four-bar:1 --at 0.1",
        "reactions tests/data/scenes/driver-angle-ramp.json --at 0.2",
    ]);
    reviewed("counts-and-reactions", &text);
}

#[test]
fn analyses_are_what_was_read() {
    let text = settled_output(&[
        "equilibrium simple-pendulum",
        "modes simple-pendulum",
        "modes n-four-bar:2 --at-start",
        "kinematics tests/data/scenes/lesson-16-inverse-dynamics.json",
        "kinematics n-four-bar:1",
        "assemble tests/data/scenes/rough-four-bar.json --keep crank",
        "import tests/data/arm.urdf --out /dev/null",
    ]);
    reviewed("analyses", &text);
}

#[test]
fn lists_are_what_was_read() {
    let text = settled_output(&["scenes", "lesson list", "schema course"]);
    reviewed("lists", &text);
}
