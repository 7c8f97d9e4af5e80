//! Installs what the tests need and the machine lacks.

use crate::{must, python};
use std::path::Path;
use std::process::{Command, Stdio};

/// Node's package manager.
pub const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// What lets programs believe in another time, as Debian's package has it.
const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

/// Programs of Debian packages, and packages of npm.
pub fn run(root: &Path) -> Result<(), String> {
    let mut missing = Vec::new();
    if !Path::new("/usr/bin/chromium").exists() {
        missing.push("chromium");
    }
    if !starts("octave-cli") && std::env::var_os("TRIAD_SKIP_OCTAVE").is_none() {
        missing.push("octave");
    }
    if !starts("pg_config") && !Path::new("/usr/lib/postgresql").exists() {
        missing.push("postgresql");
    }
    if cfg!(target_arch = "x86_64") && !Path::new(FAKETIME).exists() {
        missing.push("libfaketime");
    }
    if !starts_with("ip", "-V") {
        missing.push("iproute2");
    }
    if !missing.is_empty() {
        install(&missing)?;
    }
    // Licences and sources are looked up for every system; a build brings the packages of this one only.
    must(Command::new(env!("CARGO")).args(["fetch", "--locked", "--quiet"]).current_dir(root))?;
    add_target();
    // The page's own build leaves out the tools that check it, so that a time of the lock file says nothing here.
    node_packages(&root.join("web"), "node_modules/.bin/biome")?;
    node_packages(&root.join("tests/browser"), "node_modules/playwright-core")?;
    python::install(root)
}

/// The target of the program that `triad export` packs. Tests that need it say so where it cannot be had.
fn add_target() {
    let add = ["target", "add", "x86_64-unknown-linux-musl"];
    if must(Command::new("rustup").args(add)).is_err() {
        println!("verify: no autograder will be run: rustup {} does not succeed here", add.join(" "));
    }
}

fn starts(program: &str) -> bool {
    starts_with(program, "--version")
}

fn starts_with(program: &str, word: &str) -> bool {
    Command::new(program).arg(word).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

/// Installs Debian packages, as root.
fn install(packages: &[&str]) -> Result<(), String> {
    let user = Command::new("id").arg("-u").output().map_err(|error| format!("id -u: {error}"))?;
    if String::from_utf8_lossy(&user.stdout).trim() != "0" {
        return Err(format!(
            "missing: {names}. Install it (apt-get install {names}) or run this step as root; TRIAD_SKIP_OCTAVE=1 leaves \
             the Octave starter unproven",
            names = packages.join(" ")
        ));
    }
    must(Command::new("apt-get").args(["update", "-qq"]))?;
    let mut command = Command::new("apt-get");
    command.env("DEBIAN_FRONTEND", "noninteractive");
    must(command.args(["install", "-y", "-qq", "--no-install-recommends"]).args(packages))
}

/// Installs what a lock file names, unless that is done: `tool` is there, and not older than the lock file.
fn node_packages(folder: &Path, tool: &str) -> Result<(), String> {
    let time = |name: &str| std::fs::metadata(folder.join(name)).and_then(|data| data.modified()).ok();
    let installed = time("node_modules/.package-lock.json");
    if folder.join(tool).exists() && installed.is_some() && installed >= time("package-lock.json") {
        return Ok(());
    }
    must(Command::new(NPM).args(["ci", "--no-audit", "--no-fund"]).current_dir(folder))
}
