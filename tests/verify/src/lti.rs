//! A session with a learning platform that others wrote.

use crate::{cargo_command, must, others};
use std::path::Path;
use std::process::Command;

/// Plays the session of `tests/lti/session.py`, with a word of the tests' own platform for the other judge.
pub fn run(root: &Path) -> Result<(), String> {
    let what = "the session with Open edX's platform";
    let Some(session) = others::session(root, "lti", what)? else { return Ok(()) };
    let word = session.folder.join("word.json");
    let mut test = cargo_command(root);
    test.args("test --release --quiet --workspace --test http what_this_platform_signs".split(' '));
    must(test.env("TRIAD_LTI_WORD", &word))?;
    must(
        Command::new(session.python)
            .arg("tests/lti/session.py")
            .arg(session.triad)
            .arg(word)
            .current_dir(root),
    )
}
