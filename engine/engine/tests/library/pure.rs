//! The engine is pure: nothing in it reads a clock or a file, starts a thread or writes to a terminal.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use std::path::Path;

/// What would make the same scene give other bits, or bring a surprise to a program that uses the engine.
const FORBIDDEN: [&str; 8] =
    ["std::fs", "std::time", "std::thread", "std::env", "std::net", "std::process", "std::io", "println!("];

fn find(folder: &Path, words: &[&str], found: &mut Vec<String>) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            find(&path, words, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let bad = code.filter(|line| words.iter().any(|word| line.contains(word)));
            found.extend(bad.map(|line| format!("{}: {}", path.display(), line.trim())));
        }
    }
}

/// With `test = false` they would never run.
#[test]
fn the_library_has_no_tests_in_its_sources() {
    let engine = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for name in ["linalg", "dynamics", "engine"] {
        find(&engine.join(name).join("src"), &["#[test]", "cfg(test)"], &mut found);
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_engine_reads_no_clock_and_no_file_and_starts_no_thread() {
    let engine = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for name in ["scene", "linalg", "dynamics", "engine"] {
        find(&engine.join(name).join("src"), &FORBIDDEN, &mut found);
    }
    assert!(found.is_empty(), "{found:#?}");
}
