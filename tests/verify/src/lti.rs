//! A session with a learning platform that others wrote.

use crate::{cargo, cargo_command, must};
use std::path::Path;
use std::process::Command;

/// Plays the session of `tests/lti/session.py`: in a Python environment of its own, below the build folder.
pub fn run(root: &Path) -> Result<(), String> {
    // This program lies in the release folder of the build.
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let release = program.parent().ok_or("this program lies nowhere")?;
    let folder = release.parent().unwrap_or(release).join("lti");
    let python = folder.join("venv/bin/python");
    if let Err(why) = installed(root, &folder, &python) {
        println!(
            "verify: NOT CHECKED: the session with Open edX's platform. It takes Python 3.11 with venv, and its packages \
             from pypi.org ({why})."
        );
        return Ok(());
    }
    cargo(root, "build --release --quiet --workspace")?;
    let word = folder.join("word.json");
    let mut test = cargo_command(root);
    test.args("test --release --quiet -p triad --test http what_this_platform_signs".split(' '));
    must(test.env("TRIAD_LTI_WORD", &word))?;
    let triad = program.with_file_name(format!("triad{}", std::env::consts::EXE_SUFFIX));
    must(Command::new(python).arg("tests/lti/session.py").arg(triad).arg(word).current_dir(root))
}

/// Makes the environment, or finds it made.
fn installed(root: &Path, folder: &Path, python: &Path) -> Result<(), String> {
    if !python.exists() {
        must(Command::new("python3").args(["-m", "venv"]).arg(folder.join("venv")))?;
    }
    let mut pip = Command::new(python);
    pip.args("-m pip install --quiet --disable-pip-version-check -r tests/lti/requirements.txt".split(' '));
    must(pip.current_dir(root))
}
