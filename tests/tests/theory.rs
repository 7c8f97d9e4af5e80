//! THEORY.md and the code agree: every equation that the code cites exists, every equation is cited where the engine computes
//! it, the equations are numbered in order, and constants have the values that are stated.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use triad_tests::root;

/// Number of an equation: section and place.
type Label = (u32, u32);

fn theory() -> String {
    std::fs::read_to_string(root().join("THEORY.md")).unwrap()
}

/// `4.2` at the beginning of a text.
fn label(text: &str) -> Option<Label> {
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (section, place) = text[..end].split_once('.')?;
    Some((section.parse().ok()?, place.parse().ok()?))
}

/// What follows each `mark` in a text.
fn after<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.match_indices(mark).map(|(at, mark)| &text[at + mark.len()..])
}

/// The equations that a text cites: `eq. (4.2)`, `eq. (11.4), (11.5)`, `eqs. (6.3), (6.5) and (6.6)`, `eqs. (4.3) to (4.7)`.
fn cited(text: &str) -> BTreeSet<Label> {
    let mut found = BTreeSet::new();
    for mut rest in ["eq. (", "eqs. ("].iter().flat_map(|mark| after(text, mark)) {
        let mut range = None;
        while let Some(next) = label(rest) {
            found.extend(range.map_or(next.1..=next.1, |first| first..=next.1).map(|place| (next.0, place)));
            rest = rest.split_once(')').map_or("", |(_, rest)| rest);
            let joint = [", (", " and (", " to ("].into_iter().find(|joint| rest.starts_with(joint));
            let Some(joint) = joint else { break };
            range = (joint == " to (").then_some(next.1);
            rest = &rest[joint.len()..];
        }
    }
    found
}

/// Rust files of a folder and the folders in it.
fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if !path.ends_with("node_modules") && !path.ends_with("target") {
                rust_files(&path, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// Path from the root and text of each Rust file of these folders.
fn sources(folders: &[&str]) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for folder in folders {
        rust_files(&root().join(folder), &mut files);
    }
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        (path.strip_prefix(root()).unwrap().to_path_buf(), text)
    };
    files.into_iter().map(read).collect()
}

/// Whether a file is part of the engine itself, neither a test nor an example.
fn computes(path: &Path) -> bool {
    path.starts_with("engine") && path.components().nth(2).is_some_and(|c| c.as_os_str() == "src")
}

#[test]
fn equations_are_numbered_in_order() {
    let theory = theory();
    let labels: Vec<Label> = after(&theory, "\\tag{").map(|rest| label(rest).unwrap()).collect();
    assert!(labels.len() > 50, "only {} equations found", labels.len());
    assert_eq!(labels[0].1, 1);
    for pair in labels.windows(2) {
        let follows = if pair[0].0 == pair[1].0 { pair[0].1 + 1 } else { 1 };
        assert!(pair[1].0 >= pair[0].0 && pair[1].1 == follows, "{:?} stands after {:?}", pair[1], pair[0]);
    }
    let mut section = 0;
    for line in theory.lines() {
        if let Some(number) = line.strip_prefix("## ").and_then(|l| l.split_once(". ")) {
            section = number.0.parse().unwrap();
        }
        for found in after(line, "\\tag{").filter_map(label) {
            assert_eq!(found.0, section, "{found:?} stands in section {section}");
        }
    }
}

#[test]
fn every_citation_has_its_equation_and_every_equation_its_citation() {
    let theory = theory();
    let labels: BTreeSet<Label> = after(&theory, "\\tag{").filter_map(label).collect();
    let sections: BTreeSet<u32> = labels.iter().map(|label| label.0).chain([1, 12]).collect();
    let mut computed = BTreeSet::new();
    for (path, text) in sources(&["engine", "lessons", "server", "tests"]) {
        let at = path.display();
        for found in cited(&text) {
            assert!(labels.contains(&found), "{at}: THEORY.md has no eq. {found:?}");
            if computes(&path) {
                computed.insert(found);
            }
        }
        for rest in ["THEORY section ", "THEORY.md section "].iter().flat_map(|mark| after(&text, mark)) {
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            if let Ok(section) = rest[..end].parse() {
                assert!(sections.contains(&section), "{at}: THEORY.md has no section {section}");
            }
        }
    }
    let nowhere: Vec<_> = labels.difference(&computed).collect();
    assert!(nowhere.is_empty(), "cited nowhere under engine/*/src: {nowhere:?}");
    // THEORY.md refers to its own equations as (4.2).
    for found in after(&theory, "(").filter(|rest| rest.split(')').next().is_some_and(|n| n.len() < 6)) {
        if let Some(found) = label(found) {
            assert!(labels.contains(&found), "THEORY.md refers to {found:?}, which it does not have");
        }
    }
}

/// `NAME` and value of a line `const NAME: f64 = 1e-9;`, if that is a number.
fn constant(line: &str) -> Option<(&str, f64)> {
    let (before, rest) = line.split_once("const ")?;
    let (name, rest) = rest.split_once(": ")?;
    let (_, value) = rest.strip_suffix(';')?.split_once(" = ")?;
    let declares = before.trim_start().is_empty() || before.trim_start().starts_with("pub");
    declares.then(|| Some((name, value.replace('_', "").parse().ok()?))).flatten()
}

#[test]
fn constants_have_the_values_that_are_stated() {
    let mut constants: BTreeMap<String, Vec<(PathBuf, f64)>> = BTreeMap::new();
    for (path, text) in sources(&["engine"]).into_iter().filter(|(path, _)| computes(path)) {
        for (name, value) in text.lines().filter_map(constant) {
            constants.entry(name.to_owned()).or_default().push((path.clone(), value));
        }
    }
    let theory = theory();
    let mut compared = 0;
    for (at, _) in theory.match_indices("` = ") {
        let written = theory[..at].rsplit('`').next().unwrap();
        let (module, name) = written.rsplit_once("::").map_or((None, written), |(m, name)| (Some(m), name));
        let value = theory[at + 4..].split_whitespace().next().unwrap();
        let value: f64 = value.trim_end_matches(['.', ',', ';', ':', ')']).parse().unwrap();
        // `module::NAME` is in module.rs; a name without a module means the same value wherever it stands.
        let named = constants.get(name).into_iter().flatten();
        let mut meant = named
            .filter(|(path, _)| module.is_none_or(|module| path.file_stem().unwrap() == module))
            .peekable();
        assert!(meant.peek().is_some(), "THEORY.md states `{written}`, and the engine has no such constant");
        for (path, found) in meant {
            assert!(*found == value, "THEORY.md: `{written}` = {value}; {}: {found}", path.display());
        }
        compared += 1;
    }
    assert!(compared >= 15, "only {compared} constants found: has the way to state them changed?");
}
