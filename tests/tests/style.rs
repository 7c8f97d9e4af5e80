//! Formatting, lints and the page's own tests: what a contributor would forget.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::path::Path;
use std::process::Command;
use triad_tests::root;

fn must(program: &str, arguments: &[&str], folder: &Path) {
    let output = Command::new(program).args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
    let said = [output.stdout, output.stderr].concat();
    assert!(
        output.status.success(),
        "{program} {}:\n{}",
        arguments.join(" "),
        String::from_utf8_lossy(&said)
    );
}

#[test]
fn the_code_is_formatted() {
    must(env!("CARGO"), &["fmt", "--all", "--check"], &root());
}

/// The server is left out here: the lints would have to read the viewer's library once more, which takes minutes.
#[test]
fn the_lints_are_content() {
    let packages = ["-p", "triad-engine", "-p", "triad-lessons", "-p", "triad-tests"];
    let arguments =
        [&["clippy", "--quiet", "--all-targets"], &packages[..], &["--", "-D", "warnings"]].concat();
    must(env!("CARGO"), &arguments, &root());
}

#[test]
fn the_page_passes_its_types_lints_and_tests() {
    let web = root().join("web");
    if !web.join("node_modules/.bin/biome").exists() {
        must("npm", &["ci", "--no-audit", "--no-fund"], &web);
    }
    must("npm", &["run", "check"], &web);
}
