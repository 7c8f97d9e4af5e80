//! Programs in Python that others wrote, each in an environment of its own below the build folder.

use crate::{cargo, must};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a session in Python needs.
pub struct Session {
    /// Python with the packages of `tests/NAME/requirements.txt`.
    pub python: PathBuf,
    /// The built program.
    pub triad: PathBuf,
    /// The folder of the environment.
    pub folder: PathBuf,
}

/// Makes the environment of `tests/NAME`, or finds it made, and builds the program; nothing, and a line that says so, where `what`
/// cannot be checked here.
pub fn session(root: &Path, name: &str, what: &str) -> Result<Option<Session>, String> {
    // This program lies in the release folder of the build.
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let release = program.parent().ok_or("this program lies nowhere")?;
    let folder = release.parent().unwrap_or(release).join(name);
    let python = folder.join("venv/bin/python");
    if let Err(why) = installed(root, name, &folder, &python) {
        println!(
            "verify: NOT CHECKED: {what}. It takes Python 3.11 or later with venv (apt-get install python3-venv), and its packages \
             from pypi.org ({why})."
        );
        return Ok(None);
    }
    cargo(root, "build --release --quiet --workspace")?;
    let triad = program.with_file_name(format!("triad{}", std::env::consts::EXE_SUFFIX));
    Ok(Some(Session { python, triad, folder }))
}

/// Plays `tests/NAME/session.py` with nothing but the program.
pub fn play(root: &Path, name: &str, what: &str) -> Result<(), String> {
    let Some(session) = session(root, name, what)? else { return Ok(()) };
    let script = format!("tests/{name}/session.py");
    must(Command::new(session.python).arg(script).arg(session.triad).current_dir(root))
}

fn installed(root: &Path, name: &str, folder: &Path, python: &Path) -> Result<(), String> {
    if !python.exists() {
        let mut venv = Command::new("python3");
        must(venv.args(["-m", "venv"]).arg(folder.join("venv")).stderr(Stdio::null()))?;
    }
    let mut pip = Command::new(python);
    pip.args("-m pip install --quiet --disable-pip-version-check -r".split(' '));
    must(pip.arg(format!("tests/{name}/requirements.txt")).current_dir(root))
}
