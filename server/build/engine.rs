//! The engine for the page: built for WebAssembly where that target is installed. Nothing needs it: without it the page has
//! all runs computed by the server.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What it is built for.
const TARGET: &str = "wasm32-unknown-unknown";
/// How it is compiled: with vectors, and what is larger than 64 bytes copied and cleared by them. Left to itself the compiler writes
/// `memory.copy` and `memory.fill` for that, each of which leaves the compiled code for a function of the browser.
const FLAGS: &str =
    "-Ctarget-feature=+simd128 -Cllvm-args=-max-store-memcpy=64 -Cllvm-args=-max-store-memset=64";
/// What it is made from, relative to the repository.
const SOURCES: [&str; 7] = [
    "engine/scene",
    "engine/linalg",
    "engine/dynamics",
    "engine/engine",
    "engine/session",
    "engine/web",
    "Cargo.toml",
];

/// Builds it, and returns its file; none where it is left out, which is said in one line.
pub fn build(root: &Path) -> Result<Option<PathBuf>, Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=TRIAD_ENGINE_WASM");
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    // One that was built elsewhere; an empty word leaves it out.
    if let Some(file) = env::var_os("TRIAD_ENGINE_WASM") {
        return Ok(Some(PathBuf::from(file)).filter(|file| !file.as_os_str().is_empty()));
    }
    // A program that is not optimized is built to be tried at once: it does not wait for minutes of optimizing this.
    if env::var("OPT_LEVEL")? == "0" {
        return Ok(None);
    }
    let asked =
        Command::new(env::var("RUSTC")?).args(["--print", "target-libdir", "--target", TARGET]).output()?;
    let libraries = PathBuf::from(String::from_utf8(asked.stdout)?.trim());
    if !asked.status.success() || !libraries.exists() {
        println!(
            "cargo::warning=the page is built without its own engine and has all runs computed by the server; \
             to have it: rustup target add {TARGET}, then build again"
        );
        return Ok(None);
    }
    // Beside the folders of Cargo, as `target/release/build/triad-…/out` says where these are; a folder of its own, as
    // the one of this build is locked.
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let folder = out.ancestors().nth(4).ok_or("the build's folder has no parent")?.join("engine");
    let mut cargo = Command::new(env::var("CARGO")?);
    cargo.current_dir(root).arg("rustc").args([
        "--release",
        "--lib",
        "--crate-type",
        "cdylib",
        "-p",
        "triad-web",
    ]);
    cargo.args(["--target", TARGET, "--target-dir"]).arg(&folder);
    // What Cargo set for this build is not meant for another one.
    for (name, _) in env::vars_os() {
        let shown = name.to_string_lossy();
        if shown.starts_with("CARGO_") && shown != "CARGO_HOME" && shown != "CARGO_NET_OFFLINE"
            // With the wrapper of clippy it would be looked at instead of built.
            || shown == "RUSTFLAGS"
            || shown == "RUSTC_WORKSPACE_WRAPPER"
        {
            cargo.env_remove(name);
        }
    }
    let output = cargo.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", FLAGS).output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("the engine for the page could not be built:\n{said}").into());
    }
    let file = folder.join(TARGET).join("release/triad_web.wasm");
    fs::metadata(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(Some(file))
}
