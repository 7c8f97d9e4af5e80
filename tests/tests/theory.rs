//! Every equation and section that the code cites exists in THEORY.md, once.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use triad_tests::root;

/// Every place where `text` continues after `mark`, as the run of digits and dots found there.
fn numbers_after<'a>(text: &'a str, mark: &str) -> impl Iterator<Item = &'a str> {
    text.match_indices(mark).map(move |(at, _)| {
        let rest = &text[at + mark.len()..];
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        rest[..end].trim_end_matches('.')
    })
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_cited_label_exists_once() {
    let theory = std::fs::read_to_string(root().join("THEORY.md")).unwrap();
    let labels: Vec<&str> = numbers_after(&theory, "\\tag{").collect();
    let sections: BTreeSet<&str> = numbers_after(&theory, "\n## ").filter(|n| !n.is_empty()).collect();
    let unique: BTreeSet<&str> = labels.iter().copied().collect();
    assert_eq!(unique.len(), labels.len(), "a label is used twice");
    for label in &labels {
        let (section, _) = label.split_once('.').unwrap();
        assert!(sections.contains(section), "({label}) belongs to no section");
    }

    let mut files = Vec::new();
    for folder in ["engine/dynamics/src", "engine/engine/src", "server/src", "tests/src", "tests/tests"] {
        rust_files(&root().join(folder), &mut files);
    }
    let mut cited = 0;
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let at = file.display();
        for label in ["eq. (", "eqs. ("].iter().flat_map(|mark| numbers_after(&text, mark)) {
            assert!(label.is_empty() || unique.contains(label), "{at}: THEORY.md has no eq. ({label})");
            cited += usize::from(!label.is_empty());
        }
        for section in ["THEORY section ", "THEORY.md section "].iter().flat_map(|m| numbers_after(&text, m))
        {
            assert!(
                section.is_empty() || sections.contains(section),
                "{at}: THEORY.md has no section {section}"
            );
            cited += usize::from(!section.is_empty());
        }
    }
    assert!(cited > 15, "only {cited} citations found: has the way to cite changed?");
    // THEORY.md refers to its own equations as (4.2).
    for label in numbers_after(&theory, " (")
        .filter(|n| n.split_once('.').is_some_and(|(a, b)| !a.is_empty() && !b.is_empty()))
    {
        assert!(unique.contains(label), "THEORY.md refers to ({label}), which it does not have");
    }
}
