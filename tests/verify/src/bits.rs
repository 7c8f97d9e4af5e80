//! The same scene gives the same bits, whatever instructions the compiler may use.

use crate::cargo_command;
use std::path::Path;
use std::process::Command;

/// What the second build may use: vectors of four numbers and fused products, as processors have had since 2013.
const NEWER: &str = "x86-64-v3";
/// Its kernels are compiled in parts, which takes a third of the time and is another way to the same bits.
const IN_PARTS: [&str; 2] = [
    "profile.release.package.triad-dynamics.codegen-units=16",
    "profile.release.package.triad-linalg.codegen-units=16",
];

/// The build for newer processors.
pub fn build(root: &Path) -> Option<Command> {
    runs_here().then(|| newer(root, "build"))
}

/// Compares what `engine/lab/examples/bits.rs` prints in a build for any processor and in one for newer ones.
pub fn run(root: &Path) -> Result<(), String> {
    if !runs_here() {
        println!("verify: NOT CHECKED: this processor does not run builds for {NEWER}.");
        return Ok(());
    }
    let (any, newer) = (results(&mut example(root, "run"))?, results(&mut newer(root, "run"))?);
    let differing: Vec<&str> =
        any.lines().zip(newer.lines()).filter(|(one, other)| one != other).map(|(one, _)| one).collect();
    println!("verify: {} results, {} of them other for {NEWER}", any.lines().count(), differing.len());
    if any.lines().count() != newer.lines().count() {
        return Err(format!("another number of results for {NEWER}"));
    }
    if differing.is_empty() { Ok(()) } else { Err(format!("other bits:\n{}", differing.join("\n"))) }
}

#[cfg(target_arch = "x86_64")]
fn runs_here() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") && is_x86_feature_detected!("bmi2")
}

#[cfg(not(target_arch = "x86_64"))]
const fn runs_here() -> bool {
    false
}

/// The example built, or run; without `--package`, so that the crates have the features with which they were tested.
fn example(root: &Path, what: &str) -> Command {
    let mut command = cargo_command(root);
    command.args([what, "--release", "--quiet", "--example", "bits"]);
    command
}

/// The same for newer processors.
fn newer(root: &Path, what: &str) -> Command {
    let mut command = example(root, what);
    for setting in IN_PARTS {
        command.args(["--config", setting]);
    }
    command.env("RUSTFLAGS", format!("-C target-cpu={NEWER}"));
    command.args(["--target-dir", &format!("target/{NEWER}")]);
    command
}

/// What the example prints.
fn results(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    String::from_utf8(output.stdout).map_err(|error| error.to_string())
}
