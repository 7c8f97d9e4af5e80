//! What the build is made of: one build for the program and its tests, one version of the viewer, licences and sources.

#![allow(clippy::unwrap_used)] // a test stops where something is missing

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;
use triad_tests::root;

/// Packages with their versions and features, as `cargo` builds them for the whole workspace.
fn packages(edges: &str) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["tree", "--offline", "--workspace", "--edges", edges, "--prefix", "none"]);
    let output = cargo.args(["--format", "{p} {f}"]).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .map(|line| line.trim_end_matches(" (*)").to_owned())
        .collect()
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

/// What follows `before` in the lines of a file that begin with it, up to the next quotation mark.
fn told(file: &str, before: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(file)).unwrap();
    let lines = text.lines().filter_map(|line| line.trim_start().strip_prefix(before));
    lines.map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
}

/// One version in all that tells one, and the changes of the newest release on the day that is cited.
#[test]
fn a_release_has_one_version_and_one_day() {
    let version = env!("CARGO_PKG_VERSION");
    let places = [
        ("Cargo.toml", "version = \""),
        ("engine/python/Cargo.toml", "version = \""),
        ("engine/python/pyproject.toml", "version = \""),
        ("web/package.json", "\"version\": \""),
        ("web/package-lock.json", "\"version\": \""),
        ("CITATION.cff", "version: "),
    ];
    for (file, before) in places {
        assert_eq!(told(file, before).first().map(String::as_str), Some(version), "{file}");
    }
    let headings = told("CHANGELOG.md", "## ");
    let released =
        headings.iter().find(|heading| heading.starts_with(|first: char| first.is_ascii_digit())).unwrap();
    let days = told("CITATION.cff", "date-released: ");
    assert_eq!(*released, format!("{version} ({})", days.first().unwrap()), "CHANGELOG.md");
    assert_eq!(headings.first().unwrap(), "Unreleased", "what comes next has its place in CHANGELOG.md");
    // What the release wrote is read for ever.
    assert!(root().join("tests/data/kept").join(version).join("grades.db").exists(), "{version}");
}

/// The parts of a licence expression between words that stand outside brackets.
fn parts<'a>(expression: &'a str, word: &str) -> Vec<&'a str> {
    let (mut depth, mut from, mut parts) = (0, 0, Vec::new());
    for (at, letter) in expression.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ if depth == 0 && expression[at..].starts_with(word) && at >= from => {
                parts.push(&expression[from..at]);
                from = at + word.len();
            }
            _ => {}
        }
    }
    parts.push(&expression[from..]);
    parts
}

/// Whether a licence expression allows a use under licences of which `allowed` holds.
fn permits(expression: &str, allowed: &dyn Fn(&str) -> bool) -> bool {
    let expression = expression.trim();
    for word in [" OR ", "/"] {
        let choices = parts(expression, word);
        if choices.len() > 1 {
            return choices.iter().any(|choice| permits(choice, allowed));
        }
    }
    let all = parts(expression, " AND ");
    if all.len() > 1 {
        return all.iter().all(|one| permits(one, allowed));
    }
    match expression.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
        Some(inner) => permits(inner, allowed),
        None => allowed(expression),
    }
}

/// What `cargo verify deny` finds out with cargo-deny, without it: `deny.toml` says what may be used.
#[test]
fn packages_have_licences_and_sources_that_are_allowed() {
    let rules: toml::Table = fs::read_to_string(root().join("deny.toml")).unwrap().parse().unwrap();
    let words = |value: &toml::Value| -> Vec<String> {
        value.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
    };
    let allow = words(&rules["licenses"]["allow"]);
    let exceptions = rules["licenses"]["exceptions"].as_array().unwrap();
    let registries = words(&rules["sources"]["allow-registry"]);
    let mut cargo = Command::new(env!("CARGO"));
    let output =
        cargo.args(["metadata", "--offline", "--format-version", "1"]).current_dir(root()).output().unwrap();
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut wrong = Vec::new();
    let packages = all["packages"].as_array().unwrap();
    assert!(packages.len() > 100);
    for package in packages {
        let (name, source) = (package["name"].as_str().unwrap(), package["source"].as_str());
        let also = exceptions.iter().filter(|rule| rule["crate"].as_str() == Some(name));
        let also: Vec<String> = also.flat_map(|rule| words(&rule["allow"])).collect();
        let licence = package["license"].as_str().unwrap_or("none");
        if !permits(licence, &|one| allow.iter().chain(&also).any(|allowed| allowed == one)) {
            wrong.push(format!("{name}: {licence}"));
        }
        let known = |source: &str| registries.iter().any(|registry| source == format!("registry+{registry}"));
        wrong.extend(source.filter(|source| !known(source)).map(|source| format!("{name}: {source}")));
    }
    assert!(wrong.is_empty(), "deny.toml does not allow {wrong:#?}");
}

#[test]
fn licence_expressions_are_read() {
    let allowed = |one: &str| ["MIT", "Unicode-3.0"].contains(&one);
    for good in [
        "MIT",
        "GPL-3.0 OR MIT",
        "Apache-2.0/MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "MIT AND (GPL-3.0 OR MIT)",
        "MIT AND (GPL-3.0 OR Unicode-3.0) AND Unicode-3.0",
        "MIT AND Unicode-3.0",
    ] {
        assert!(permits(good, &allowed), "{good}");
    }
    for bad in
        ["GPL-3.0", "MIT AND GPL-3.0", "(MIT OR Apache-2.0) AND GPL-3.0", "none", "BSD-3-Clause OR GPL-3.0"]
    {
        assert!(!permits(bad, &allowed), "{bad}");
    }
}
