//! What the binary carries beside its code: the web page, with an engine of its own, and the letters of pictures.

mod engine;
mod glyphs;
mod page;

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;
use std::process::Command;
use std::{env, fs};

use flate2::Compression;
use flate2::write::ZlibEncoder;

fn main() {
    println!("cargo::rerun-if-changed=build");
    if let Err(error) = prepare() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

fn prepare() -> Result<(), Box<dyn Error>> {
    page::embed()?;
    glyphs::write()?;
    name_build()?;
    embed_grader()?;
    fold_equal_functions()
}

/// Packs the program that `triad export` gives along, where `TRIAD_GRADE` names it: a release carries it, so that a teacher
/// needs one file. Elsewhere the command finds it beside itself, or says how it is built.
fn embed_grader() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=TRIAD_GRADE");
    let packed = match env::var_os("TRIAD_GRADE").filter(|path| !path.is_empty()).map(PathBuf::from) {
        None => Vec::new(),
        Some(path) => {
            println!("cargo::rerun-if-changed={}", path.display());
            let bytes =
                fs::read(&path).map_err(|error| format!("TRIAD_GRADE: {}: {error}", path.display()))?;
            let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
            packer.write_all(&bytes)?;
            packer.finish()?
        }
    };
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("triad-grade.z"), packed)?;
    Ok(())
}

/// Version, commit and target, as `0.1.0 (1a2b3c4d, x86_64-unknown-linux-gnu)`; without a repository there is no commit.
fn name_build() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=../.git/logs/HEAD");
    let asked = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    let known = asked.ok().filter(|output| output.status.success());
    let commit = known.map_or_else(
        || "no commit".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    );
    println!(
        "cargo::rustc-env=TRIAD_BUILD={} ({commit}, {})",
        env::var("CARGO_PKG_VERSION")?,
        env::var("TARGET")?
    );
    Ok(())
}

/// Has the linker keep one of several functions whose instructions are equal: 2 MB of the binary. LLD can, which the
/// toolchain brings and links with on this target; another linker would refuse the option.
fn fold_equal_functions() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=CARGO_ENCODED_RUSTFLAGS");
    if env::var("TARGET")? != "x86_64-unknown-linux-gnu" || env::var("HOST")? != env::var("TARGET")? {
        return Ok(());
    }
    // Whoever chooses a linker chooses its options.
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    let asked = Command::new(env::var("RUSTC")?).args(["--print", "target-libdir"]).output()?;
    let libraries = PathBuf::from(String::from_utf8(asked.stdout)?.trim());
    if !flags.contains("link") && libraries.join("../bin/gcc-ld/ld.lld").exists() {
        println!("cargo::rustc-link-arg-bins=-Wl,--icf=all");
    }
    Ok(())
}
