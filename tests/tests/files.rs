//! What commands write, and where: nothing is replaced, mixed or left out without a word, and mechanisms of any size keep their digits.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use triad_engine::catalogue;
use triad_tests::program::run;

/// A call: its exit code, and what it printed to standard output and to the other stream.
fn said(line: &[&str]) -> (Option<i32>, String, String) {
    let done = run(line);
    let [out, err] = [&done.stdout, &done.stderr].map(|stream| String::from_utf8_lossy(stream).into_owned());
    (done.status.code(), out, err)
}

/// A path in a folder, as a word.
fn within(folder: &Path, name: &str) -> String {
    folder.join(name).to_string_lossy().into_owned()
}

#[test]
fn errors_that_a_scene_chooses_and_does_not_estimate_are_not_left_out_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let (path, table) = (within(folder.path(), "scene.json"), within(folder.path(), "a.csv"));
    let mut scene = serde_json::to_value(catalogue::scene("simple-pendulum").unwrap()).unwrap();
    scene["simulation"]["duration"] = json!(0.1);
    let write = |estimate: bool, outputs: Option<Value>| {
        let mut scene = scene.clone();
        scene["simulation"]["error_estimate"] = json!(estimate);
        if let Some(outputs) = outputs {
            scene["simulation"]["outputs"] = outputs;
        }
        fs::write(&path, scene.to_string()).unwrap();
    };
    let run = |more: &[&str]| said(&[&["run", path.as_str(), "--out", &table], more].concat());
    let sweep =
        |more: &[&str]| said(&[&["sweep", path.as_str(), "--vary", "/bodies/0/mass=1:2:2"], more].concat());
    write(false, Some(json!(["energy", "errors"])));
    for (code, _, err) in [run(&[]), sweep(&[])] {
        assert!(
            code == Some(3) && err.contains("[no-errors]") && err.contains("\"error_estimate\": false"),
            "{err}"
        );
    }
    assert!(!Path::new(&table).exists());
    assert_eq!(run(&["--outputs", "energy"]).0, Some(0));
    assert_eq!(said(&["run", &path]).0, Some(0), "no table, nothing lost");
    // The usual outputs are no choice.
    write(false, None);
    assert_eq!((run(&[]).0, sweep(&[]).0), (Some(0), Some(0)));
    write(true, Some(json!(["energy", "errors"])));
    assert_eq!((run(&[]).0, run(&["--no-estimate"]).0), (Some(0), Some(3)));
}
