//! Replays the kept corpus: what fuzzing has found, and what readers must keep to accept.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;

fn replay(folder: &str, target: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(folder);
    let mut files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        target(&bytes);
        // What is cut off or damaged must be refused as calmly.
        target(&bytes[..bytes.len() / 2]);
        let mut damaged = bytes.clone();
        for byte in damaged.iter_mut().step_by(97) {
            *byte ^= 0x11;
        }
        target(&damaged);
        files += 1;
    }
    assert!(files > 0);
}

#[test]
fn scenes_are_read_or_refused() {
    replay("scene", triad_fuzz::scene);
}

#[test]
fn lessons_are_read_or_refused() {
    replay("lesson", triad_fuzz::lesson);
}

#[test]
fn submissions_are_read_or_refused() {
    replay("submission", triad_fuzz::submission);
}

#[test]
fn answers_are_read_or_refused() {
    replay("answer", triad_fuzz::answer);
}

#[test]
fn requests_are_answered_or_refused() {
    replay("requests", triad_fuzz::requests);
}
