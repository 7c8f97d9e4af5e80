//! The interface, asked by a program that others wrote for that.

use crate::{cargo, must};
use std::path::Path;
use std::process::{Command, Stdio};

/// Lets Schemathesis read the interface's description and ask every operation: `tests/schemathesis/session.py`, in a Python
/// environment of its own, below the build folder.
pub fn run(root: &Path) -> Result<(), String> {
    // This program lies in the release folder of the build.
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let release = program.parent().ok_or("this program lies nowhere")?;
    let folder = release.parent().unwrap_or(release).join("schemathesis");
    let python = folder.join("bin/python");
    if let Err(why) = installed(root, &folder, &python) {
        println!(
            "verify: NOT CHECKED: the interface by Schemathesis. It takes Python 3.10 or later with venv (apt-get install \
             python3-venv), and its packages from pypi.org ({why})."
        );
        return Ok(());
    }
    cargo(root, "build --release --quiet --workspace")?;
    let triad = program.with_file_name(format!("triad{}", std::env::consts::EXE_SUFFIX));
    must(Command::new(python).arg("tests/schemathesis/session.py").arg(triad).current_dir(root))
}

/// Makes the environment, or finds it made.
fn installed(root: &Path, folder: &Path, python: &Path) -> Result<(), String> {
    if !python.exists() {
        must(Command::new("python3").args(["-m", "venv"]).arg(folder).stderr(Stdio::null()))?;
    }
    let mut pip = Command::new(python);
    pip.args(
        "-m pip install --quiet --disable-pip-version-check -r tests/schemathesis/requirements.txt"
            .split(' '),
    );
    must(pip.current_dir(root))
}
