//! `cargo verify`: everything that must hold before a change is taken, step by step, with the time of each.
//!
//! `cargo verify setup` alone installs what the tests need and the machine lacks; no test installs anything itself. Steps
//! that need the network are done only where they are named: `cargo verify deny peers`, before a release. Steps build in the release profile, so that build scripts and macros
//! are compiled once, but for what is built for another place: that has the profile `tried` where its speed is no matter. A step that
//! fails does not stop those after it, but the program ends with a failure.

mod ahead;
mod bits;
mod deny;
mod lti;
mod others;
mod python;
mod setup;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

/// One step: its name, what it is for, and what it does in the repository's root.
struct Step {
    name: &'static str,
    purpose: &'static str,
    run: fn(&Path) -> Result<(), String>,
    /// What it builds that can be made ahead, beside the tests.
    build: fn(&Path) -> Option<Command>,
    /// Whether it is done only where it is named: it needs the network, and programs or packages that nothing else needs.
    named: bool,
}

impl Step {
    const fn new(name: &'static str, purpose: &'static str, run: fn(&Path) -> Result<(), String>) -> Self {
        Self { name, purpose, run, build: |_| None, named: false }
    }

    const fn building(self, build: fn(&Path) -> Option<Command>) -> Self {
        Self { build, ..self }
    }

    const fn if_named(self) -> Self {
        Self { named: true, ..self }
    }
}

/// The step that leaves the processors idle now and then.
const TESTS: &str = "test";

/// The steps in their order.
const STEPS: [Step; 14] = [
    Step::new("setup", "install what the tests need: Chromium, Octave, packages of npm and PyPI", setup::run),
    Step::new("format", "cargo fmt", |root| cargo(root, "fmt --all --check")),
    Step::new(TESTS, "all tests of all crates", tests),
    Step::new("bits", "the same results from builds for old and for new processors", bits::run)
        .building(bits::build),
    Step::new("size", "the program is at most 56 MB", size),
    Step::new("python", "the Python module: its wheel, its types, its tests and its notebooks", python::run)
        .building(python::build),
    Step::new("lint", "clippy on all targets, the fuzz targets included, without warnings", |root| {
        let targets = "--workspace --all-targets --features triad-fuzz/fuzzing";
        cargo(root, &format!("clippy --release --quiet {targets} -- -D warnings"))
    }),
    Step::new("doc", "cargo doc, without warnings", documentation),
    Step::new("page", "types, lints and tests of the web page", page),
    Step::new("deny", "licences, sources and known weaknesses of all packages, by cargo-deny", deny::run)
        .if_named(),
    Step::new("peers", "the comparison with a sparse library compiles", |root| {
        cargo(
            root,
            "check --release --quiet --manifest-path tests/peers/sparse/Cargo.toml --target-dir target/peers",
        )
    })
    .if_named(),
    Step::new("http", "the interface, asked by Schemathesis as it is described", |root| {
        others::play(root, "schemathesis", "the interface by Schemathesis")
    })
    .if_named(),
    Step::new("lti", "a session with Open edX's learning platform, judged by PyLTI1p3 too", lti::run)
        .if_named(),
    Step::new("oidc", "a session with an institution's sign-in, Django's", |root| {
        others::play(root, "oidc", "the session with an institution's sign-in")
    })
    .if_named(),
];

/// The largest program, MB: what somebody downloads and keeps. Without accounts, grades and backups it had 37; PostgreSQL,
/// encrypted connections to learning platforms, the documentation and the engine for the page brought it from 42 to 50, sign-in by
/// institutions, lectures and an allocator that gives memory back to 52.6, joints in vectors and the German of notes to 53.7, hinges in space and
/// single bodies in vectors and searches of four times at once to 54.8.
const LARGEST: f64 = 56.0;

/// All tests. The server is the largest crate, and its own tests need it once more: they have it unoptimized, which is compiled sooner.
fn tests(root: &Path) -> Result<(), String> {
    let parts =
        ["--bins --examples --test *", "--lib --config profile.release.package.triad.opt-level=0", "--doc"];
    let failed: Vec<String> = parts
        .iter()
        .filter_map(|part| cargo(root, &format!("test --release --workspace --no-fail-fast {part}")).err())
        .collect();
    if failed.is_empty() { Ok(()) } else { Err(failed.join("; ")) }
}

fn size(root: &Path) -> Result<(), String> {
    cargo(root, "build --release --quiet --workspace")?;
    // This program lies beside it.
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let program = program.with_file_name(format!("triad{}", std::env::consts::EXE_SUFFIX));
    let bytes = std::fs::metadata(&program).map_err(|error| format!("{}: {error}", program.display()))?.len();
    let megabytes = bytes as f64 / 1e6;
    println!("verify: {} has {megabytes:.1} MB of {LARGEST}", program.display());
    if megabytes > LARGEST { Err(format!("{megabytes:.1} MB, more than {LARGEST}")) } else { Ok(()) }
}

fn documentation(root: &Path) -> Result<(), String> {
    let mut command = cargo_command(root);
    command.env("RUSTDOCFLAGS", "-D warnings");
    command.args("doc --release --quiet --workspace --no-deps".split(' '));
    must(&mut command)
}

fn page(root: &Path) -> Result<(), String> {
    must(Command::new(setup::NPM).args(["run", "check"]).current_dir(root.join("web")))
}

fn cargo(root: &Path, arguments: &str) -> Result<(), String> {
    must(cargo_command(root).args(arguments.split(' ')))
}

/// Cargo in a folder, without what the cargo that started this program set for it: with another environment build
/// scripts would run again.
fn cargo_command(root: &Path) -> Command {
    let mut command = Command::new("cargo");
    command.current_dir(root);
    for (name, _) in std::env::vars_os() {
        let shown = name.to_string_lossy();
        if shown.starts_with("CARGO_PKG_") || shown.starts_with("CARGO_MANIFEST_") {
            command.env_remove(name);
        }
    }
    command
}

/// Runs a command whose output goes where this program's goes.
fn must(command: &mut Command) -> Result<(), String> {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let shown = words.map(OsStr::to_string_lossy).collect::<Vec<_>>().join(" ");
    println!("verify: {shown}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{shown}: {status}")),
        Err(error) => Err(format!("{shown}: {error}")),
    }
}

/// Runs steps one after the other and reports each; whether all succeeded.
fn all_pass(steps: &[&Step], root: &Path) -> bool {
    let mut report = Vec::new();
    let mut passed = true;
    for step in steps {
        println!("\nverify: step {} - {}", step.name, step.purpose);
        let began = Instant::now();
        if step.name == TESTS {
            ahead::begin(steps.iter().filter_map(|step| (step.build)(root)).collect());
        }
        let result = (step.run)(root);
        passed &= result.is_ok();
        let said = result.map_or_else(|why| format!("FAILED: {why}"), |()| "ok".to_owned());
        report.push(format!("verify: {:<8} {:>7.1} s  {said}", step.name, began.elapsed().as_secs_f64()));
    }
    println!("\n{}", report.join("\n"));
    passed
}

fn main() -> ExitCode {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let unknown = wanted.iter().find(|name| STEPS.iter().all(|step| step.name != **name));
    if let Some(unknown) = unknown {
        let help = unknown == "--help" || unknown == "-h";
        if !help {
            eprintln!("verify: there is no step \"{unknown}\"");
        }
        println!("cargo verify [STEP…]: without a step, all but those with a star, in this order");
        for step in &STEPS {
            println!("{} {:<8} {}", if step.named { '*' } else { ' ' }, step.name, step.purpose);
        }
        return if help { ExitCode::SUCCESS } else { ExitCode::from(2) };
    }
    let chosen: Vec<&Step> = STEPS
        .iter()
        .filter(|step| (wanted.is_empty() && !step.named) || wanted.iter().any(|name| name == step.name))
        .collect();
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    if all_pass(&chosen, &root) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_failing_step_fails_the_whole() {
        let good = Step::new("good", "", |_| Ok(()));
        let bad = Step::new("bad", "", |_| must(&mut Command::new("false")));
        let root = Path::new(".");
        assert!(all_pass(&[&good, &good], root));
        assert!(!all_pass(&[&bad, &good], root));
        assert!(!all_pass(&[&good, &bad], root));
    }
}
