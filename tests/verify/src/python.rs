//! The Python module: its wheel is built, installed into an environment of its own, and tested from there.
//!
//! Python is no part of the project's build. Where it is missing, or the packages of the tests cannot be fetched, the step says so
//! in one line and is left out.

use crate::must;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Whether a Python can make environments, and is one that the wheel is for.
const USABLE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";
/// What the tests import, and what builds the wheel.
const NEEDED: &str = "engine/python/tests/requirements.txt";
/// Where its wheel is put.
const WHEELS: &str = "target/python/wheels";

fn environment(root: &Path) -> PathBuf {
    root.join("target/python/venv")
}

/// What runs Python in the environment.
fn python(root: &Path) -> PathBuf {
    environment(root).join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// Where the environment keeps the list of packages that were installed into it.
fn installed(root: &Path) -> PathBuf {
    environment(root).join("requirements.txt")
}

/// Makes the environment with what the tests need, unless it is there.
pub fn install(root: &Path) -> Result<(), String> {
    let needed = fs::read_to_string(root.join(NEEDED)).map_err(|error| format!("{NEEDED}: {error}"))?;
    if fs::read_to_string(installed(root)).is_ok_and(|done| done == needed) {
        return Ok(());
    }
    let mut tried = Command::new("python3");
    tried.args(["-c", USABLE]).stdout(Stdio::null()).stderr(Stdio::null());
    if !tried.status().is_ok_and(|status| status.success()) {
        println!(
            "verify: the Python module will be left out: python3 3.10 or later with venv is missing (apt-get install \
             python3-venv)"
        );
        return Ok(());
    }
    must(Command::new("python3").args(["-m", "venv", "--clear"]).arg(environment(root)))?;
    let mut pip = Command::new(python(root));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement", NEEDED]);
    if let Err(why) = must(pip.current_dir(root)) {
        println!("verify: the Python module will be left out: its tests' packages cannot be fetched ({why})");
        return Ok(());
    }
    fs::write(installed(root), needed).map_err(|error| error.to_string())
}

/// The module, as its wheel will have it; `None` where it is left out.
pub fn build(root: &Path) -> Option<Command> {
    installed(root).exists().then(|| maturin(root, "target/python/ahead"))
}

/// Builds the wheel into a folder.
fn maturin(root: &Path, wheels: &str) -> Command {
    let mut maturin = Command::new(python(root));
    maturin.args(["-m", "maturin", "build", "--profile", "tried", "--quiet"]);
    maturin.args(["--manifest-path", "engine/python/Cargo.toml", "--target-dir", "target/python", "--out"]);
    maturin.arg(wheels).current_dir(root);
    maturin
}

/// Builds the wheel, installs it and runs its tests beside the program.
pub fn run(root: &Path) -> Result<(), String> {
    if !installed(root).exists() {
        println!("verify: NOT CHECKED: the Python module; `cargo verify setup` says what is missing");
        return Ok(());
    }
    let wheels = root.join(WHEELS);
    if wheels.exists() {
        fs::remove_dir_all(&wheels).map_err(|error| error.to_string())?;
    }
    must(&mut maturin(root, WHEELS))?;
    let wheel = fs::read_dir(&wheels).map_err(|error| error.to_string())?.flatten().next();
    let wheel = wheel.ok_or("maturin built no wheel")?.path();
    let mut pip = Command::new(python(root));
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        "--force-reinstall",
    ]);
    must(pip.arg(wheel))?;
    // The program, whose numbers the module must give, lies beside this one.
    crate::cargo(root, "build --release --quiet --workspace")?;
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut tests = Command::new(python(root));
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "."]).current_dir(root.join("engine/python"));
    tests.env("TRIAD_PROGRAM", program.with_file_name(format!("triad{}", std::env::consts::EXE_SUFFIX)));
    must(&mut tests)
}
