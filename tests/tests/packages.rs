//! What the build is made of: one build for the program and its tests, one version of the viewer.

#![allow(clippy::unwrap_used)] // a test stops where something is missing

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;
use triad_tests::root;

/// Packages with their versions and features, as `cargo` builds them for the whole workspace.
fn packages(edges: &str) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["tree", "--offline", "--workspace", "--edges", edges, "--prefix", "none", "--no-dedupe"]);
    let output = cargo.args(["--format", "{p} {f}"]).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

/// A feature that only a dev-dependency turns on would have the second command compile a crate, and all that use it, a
/// second time. `default-members` is the whole workspace for the same reason.
#[test]
fn program_and_tests_share_one_build() {
    let tested = packages("normal,build,dev");
    let twice: Vec<_> = packages("normal,build").into_iter().filter(|one| !tested.contains(one)).collect();
    assert!(
        twice.is_empty(),
        "the tests need other features of these crates, which are built twice: make the dependency that turns \
         them on a normal one of triad-tests\n{twice:#?}"
    );
}

/// A viewer warns about recordings of another version, and reads only its own minor version and the one before.
#[test]
fn recordings_and_viewer_are_of_one_version() {
    let page: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(root().join("web/package-lock.json")).unwrap()).unwrap();
    let viewer = page["packages"]["node_modules/@rerun-io/web-viewer"]["version"].as_str().unwrap();
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap();
    let mut lines = lock.lines();
    let mut seen = 0;
    while let Some(line) = lines.next() {
        if let Some(name) = line.strip_prefix("name = \"re_") {
            assert_eq!(lines.next(), Some(format!("version = \"{viewer}\"").as_str()), "re_{name}");
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen} crates of the viewer's SDK");
}
